"""check_linear_model.py PROGRAM SOURCE_DIR   files of a linear model as other programs read them: NumPy its .npz, and
Matrix Market; both forms have one frequency response. Exit status 77: there is no NumPy."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy
except ImportError:
    # Debian's packages belong to its own interpreter, which need not be the first of the PATH.
    debian = "/usr/bin/python3"
    if os.path.exists(debian) and not os.path.samefile(sys.executable, debian):
        os.execv(debian, [debian, *sys.argv])
    print("no NumPy")
    sys.exit(77)

os.environ["BOUGH"] = sys.argv[1]
sys.path.insert(0, str(pathlib.Path(sys.argv[2]) / "apps/python"))
import bough  # noqa: E402


def market(path):
    """A matrix of the format Matrix Market, coordinate real general."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("%")]
    rows, columns, count = map(int, lines[0].split())
    matrix = numpy.zeros((rows, columns))
    for line in lines[1:]:
        i, j, value = line.split()
        matrix[int(i) - 1, int(j) - 1] = float(value)
    assert len(lines) == count + 1
    return matrix


with tempfile.TemporaryDirectory() as folder:
    out = pathlib.Path(folder) / "model"
    scene = pathlib.Path(sys.argv[2]) / "data/gallery/servo_model.json"
    subprocess.run([sys.argv[1], "run", scene, "--out", out, "--quiet"], check=True)
    model = json.loads((out / "linear_model.json").read_text())
    arrays = numpy.load(out / "linear_model.npz")
    sparse = {}
    for name in "EABCD":
        sparse[name] = market(out / f"linear_model_{name}.mtx")
        again = numpy.zeros(arrays[f"{name}_shape"])
        again[arrays[f"{name}_row"], arrays[f"{name}_column"]] = arrays[f"{name}_value"]
        assert (again == sparse[name]).all(), name
        told = model["descriptor"][name]
        assert (told["rows"], told["columns"]) == again.shape and told["value"] == list(arrays[f"{name}_value"])
    for name in "ABCDT":
        assert (numpy.array(model["minimal"][name]) == arrays[name]).all(), name
    assert [u["name"] for u in model["inputs"]] == ["target", "push"]
    assert [y["name"] for y in model["outputs"]] == ["tip.x", "tip.y", "tip.z", "torque"]
    assert len(model["descriptor"]["states"]) == sparse["A"].shape[0]
    assert len(model["minimal"]["states"]) == arrays["A"].shape[0]
    for w in (0.0, 3.0, 80.0):
        of_minimal = arrays["C"] @ numpy.linalg.solve(
            1j * w * numpy.eye(len(arrays["A"])) - arrays["A"], arrays["B"]) + arrays["D"]
        of_descriptor = sparse["C"] @ numpy.linalg.solve(1j * w * sparse["E"] - sparse["A"], sparse["B"]) + sparse["D"]
        assert numpy.abs(of_minimal - of_descriptor).max() < 2e-6 * numpy.abs(of_descriptor).max(), w
    read = bough.read(out).linear_model
    assert (read["A"] == arrays["A"]).all() and read["inputs"] == ["target", "push"] and len(read["states"]) == len(read["A"])
    try:
        import scipy.io
        assert (scipy.io.mmread(out / "linear_model_A.mtx").toarray() == sparse["A"]).all()
        print("SciPy reads it, too")
    except ImportError:
        print("no SciPy")
print("ok")
