"""check_python.py PROGRAM FOLDER_OF_BOUGH_PY   the reader and runner for NumPy against the files themselves: names,
units, values to the last bit, pictures against the history, errors in words. Exit status 77: there is no NumPy."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

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
sys.path.insert(0, sys.argv[2])
import bough  # noqa: E402

SCENE = {
    "schema_version": 1, "title": "swing", "gravity": [0, 0, -9.81],
    "materials": [{"name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850}],
    "sections": [{"name": "bar", "material": "steel", "shape": {"kind": "rectangle", "width": 0.02, "height": 0.01}}],
    "nodes": [{"name": "root"}],
    "bodies": [{"name": "ball, \"heavy\"", "mass": 2, "shape": {"kind": "sphere", "radius": 0.1}, "position": [1, 0, 0]}],
    "beams": [{"name": "bar", "section": "bar", "start": "root", "end": "ball, \"heavy\"", "elements": 4}],
    "joints": [{"name": "pin", "kind": "revolute", "first": "ground", "second": "root", "position": [0, 0, 0], "axis": [0, 1, 0]}],
    "signals": [{"name": "height", "kind": "position", "at": "ball, \"heavy\"", "axis": "z"}],
    "sensors": [{"name": "ball", "kind": "position", "at": "ball, \"heavy\""},
                {"name": "ball speed", "kind": "velocity", "at": "ball, \"heavy\""},
                {"name": "root force", "kind": "section_force", "beam": "bar", "station": 0},
                {"name": "energy", "kind": "total_energy"}],
    "analysis": {"kind": "dynamic", "end_time": 0.2, "step_size": 0.01},
}


def main():
    folder = pathlib.Path(tempfile.mkdtemp())
    scene = folder / "swing.json"
    scene.write_text(json.dumps(SCENE))
    run = bough.run(scene, folder / "out", set={"/output/motion": True, "/analysis/end_time": 0.1}, threads=1)
    assert run.status == "ok" and len(run) == 11 and run.time[-1] == 0.1, (run.status, len(run))
    units = {"time": "s", "iterations": "", "ball.x": "m", "ball speed.wy": "rad/s", "root force.N": "N",
             "root force.M2": "N m", "energy": "J"}
    for column, unit in units.items():
        assert run.unit(column) == unit, (column, run.unit(column))
    assert run["ball"].shape == (11, 3) and run["energy"].shape == (11,) and "ball.z" in run and "none" not in run
    rows = (folder / "out/history.csv").read_text().splitlines()
    for k, line in enumerate(rows[1:]):
        assert [float(v) for v in line.split(",")] == list(run._table[k]), k
    try:
        run["ball.q"]
        raise AssertionError("a column that is not there was given")
    except KeyError as error:
        assert "ball.x" in str(error)
    for look in (lambda name: run[name], run.unit):  # a name that is not there is told with those near it
        try:
            look("bal.z")
            raise AssertionError("a column that is not there was given")
        except KeyError as error:
            assert "did you mean 'ball.z'" in str(error), error

    motion = bough.read_motion(folder / "out")
    assert numpy.array_equal(motion.times, run.time)
    assert numpy.abs(motion.bodies['ball, "heavy"'] - run["ball"]).max() < 1e-7
    assert numpy.abs(motion.velocities['ball, "heavy"'] - run["ball speed"][:, :3]).max() < 1e-6
    assert numpy.abs(motion.curves["bar"][:, -1] - run["ball"]).max() < 1e-7
    assert numpy.abs(motion.signals["height"] - run["ball.z"]).max() < 1e-7
    assert motion.signal_units == {"height": "m"}
    scale = numpy.abs(run["root force"]).max()
    assert numpy.abs(motion.forces["bar"][:, 0] - run["root force"]).max() < 1e-6 * scale
    whole = (folder / "out/motion.bin").read_bytes()
    (folder / "cut.bin").write_bytes(whole[:-5])
    assert len(bough.Motion(folder / "cut.bin").times) == 10

    (folder / "cut").mkdir()
    (folder / "cut/history.csv").write_text("\n".join(rows[:4]) + "\n0.03,0.0")
    assert len(bough.read(folder / "cut")) == 3 and bough.read(folder / "cut").status == "unfinished"

    # A table has its numbers as arrays and its texts as lists.
    modes = bough.run(scene, folder / "modes", set={"/analysis": {"kind": "modes", "count": 3}})
    table = modes.tables["modes"]
    assert len(table["frequency"]) == 3 and (numpy.diff(table["frequency"]) > 0).all() and run.tables == {}
    assert table["kind"] == ["vibration"] * 3 and "ball" in table["what"][0], table
    listed = (folder / "modes/modes.csv").read_text(encoding="utf-8").splitlines()
    assert listed[0].startswith("mode,kind,frequency [Hz],") and float(listed[1].split(",")[2]) == table["frequency"][0]

    # Long histories have a twin for NumPy with the same bits; one that a crash left tells its rows by its size.
    assert not (folder / "out/history.npy").exists()
    rest = bough.run(scene, folder / "rest", set={"/analysis/end_time": 0.2}, start=folder / "out", start_time=0.1)
    assert abs(rest.time[0] - 0.1) < 1e-12 and rest.time[-1] == 0.2, "it does not start from the state of another run"
    long = bough.run(scene, folder / "long", set={"/analysis/step_size": 1e-5, "/analysis/end_time": 0.11})
    assert len(long) == 11001 and isinstance(long._table, numpy.memmap)
    loaded = numpy.load(folder / "long/history.npy")
    rows = (folder / "long/history.csv").read_text().splitlines()
    assert loaded.shape == (11001, len(long.columns)) and numpy.array_equal(loaded, long._table)
    for k in [0, 1, 5000, 9999, 10000, 10001, 11000]:
        assert [float(v) for v in rows[k + 1].split(",")] == list(loaded[k]), k
    listed = json.loads((folder / "long/manifest.json").read_text(encoding="utf-8"))
    assert "history.npy" in json.dumps(listed) and "history.npy" in json.dumps(long.summary["files"])
    whole = (folder / "long/history.npy").read_bytes()
    head = len(whole) - loaded.nbytes
    (folder / "cut.npy").write_bytes(whole[:head].replace(b"11001", b"    0") + whole[head:-70])
    cut = bough.read_npy(folder / "cut.npy")
    missing = -(-70 // (8 * len(long.columns)))
    assert len(cut) == 11001 - missing and numpy.array_equal(cut, loaded[:-missing])

    # A run that is killed leaves its rows in the folder that it fills: both files tell them, the same to the last bit.
    (folder / "killed").mkdir()
    words = [sys.argv[1], "run", scene, "--out", folder / "killed/out", "--quiet", "--set", "/analysis/step_size=1e-5",
             "--set", "/analysis/end_time=1000"]
    run = subprocess.Popen(words)
    until, twin = time.monotonic() + 60, []
    while time.monotonic() < until and run.poll() is None and not (twin and twin[0].stat().st_size > 1_000_000):
        twin = list((folder / "killed").rglob("history.npy.partial"))
        time.sleep(0.05)
    run.kill()
    run.wait()
    assert twin, "no history.npy.partial within a minute"
    left = bough.read(twin[0].parent)
    assert left.status == "unfinished" and len(left) > 10_001 and left.columns == long.columns, len(left)
    assert numpy.array_equal(left._table[:5000], loaded[:5000]), "not the rows of the run that was not killed"
    rows = twin[0].with_name("history.csv.partial").read_text().splitlines()
    for k in [0, 9999, 10001, min(len(rows) - 3, len(left) - 1)]:
        assert [float(v) for v in rows[k + 1].split(",")] == list(left._table[k]), k

    try:
        bough.run(scene, folder / "bad", set={"/analysis/step_size": -1})
        raise AssertionError("bad input was taken")
    except bough.BoughError as error:
        assert error.status == 2 and "step_size" in str(error)
    (folder / "scenes").mkdir()
    for name, end in [("a", 0.05), ("b", 0.1)]:
        (folder / f"scenes/{name}.json").write_text(json.dumps({**SCENE, "analysis": {**SCENE["analysis"], "end_time": end}}))
    cases = bough.batch(folder / "scenes", folder / "batch", threads=1)
    assert len(cases) == 2 and all(isinstance(v, (str, float)) for v in cases[0].values()), cases
    print("bough.py: runs, names, units, values and pictures agree with the files")


main()
