#!/usr/bin/env python3
"""twin_errors.py PROGRAM DATA [--only NAME ...] [--limit SECONDS] [--markdown]   told errors against true ones

Runs the scenes of DATA/scenarios and DATA/gallery that take steps of equal size, or load steps, with --errors, and
compares the errors that twins tell with true ones: in time against a run in steps of an eighth, of the mesh against one
with four times the elements, both extrapolated by twins of their own where these are resolved. Of each scene: how many columns are resolved of those above round-off; the smallest and the
largest ratio of told over true error of resolved columns, largest over the times; and the error in time that is left
after extrapolation, over that of the run. A scene whose reference takes longer than SECONDS (300) is left out."""
import argparse
import copy
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("program")
parser.add_argument("data", type=pathlib.Path)
parser.add_argument("--only", nargs="*")
parser.add_argument("--limit", type=float, default=300.0)
parser.add_argument("--markdown", action="store_true")
arguments = parser.parse_args()
program = str(pathlib.Path(arguments.program).resolve())
scratch = tempfile.TemporaryDirectory()


def run(scene, name, words=()):
    """Summary, times and columns of a run of a scene; nothing where it fails or takes too long."""
    file, out = pathlib.Path(scratch.name) / f"{name}.json", pathlib.Path(scratch.name) / f"{name}.out"
    file.write_text(json.dumps(scene))
    call = [program, "run", file, "--out", out, "--quiet", "--replace", "--threads", "2", "--set",
            "/output/motion=false", "--set", "/output/checkpoint=0", *words]
    try:
        subprocess.run(list(map(str, call)), capture_output=True, timeout=arguments.limit, check=False)
        summary = json.loads((out / "summary.json").read_text())
        rows = list(csv.reader((out / "history.csv").open()))
    except (subprocess.TimeoutExpired, OSError):
        return None
    if summary["status"] != "ok":
        return None
    errors = out / "errors.csv"
    limits = list(csv.reader(errors.open())) if errors.exists() else [[]]
    return summary, read(rows), read(limits)


def read(rows):
    columns = {name: [float(row[c]) for row in rows[1:]] for c, name in enumerate(rows[0])}
    return columns


def with_elements(scene, factor):
    """The scene with so many times the elements, inner nodes "<beam>.<k>" that it names renamed; nothing without beams."""
    names = {beam["name"] for beam in scene.get("beams", [])}

    def renamed(value):
        if isinstance(value, dict):
            return {k: renamed(v) for k, v in value.items()}
        if isinstance(value, list):
            return [renamed(v) for v in value]
        if isinstance(value, str) and value.rpartition(".")[0] in names and value.rpartition(".")[2].isdigit():
            return f"{value.rpartition('.')[0]}.{factor * int(value.rpartition('.')[2])}"
        return value

    other = renamed(copy.deepcopy(scene))
    for beam in other.get("beams", []):
        beam["elements"] = factor * int(beam.get("elements", 1))
    return other


def limit_of(fine, column, kind):
    """A column of the reference, extrapolated where that is resolved."""
    state = fine[0]["errors"]["columns"][column].get(kind, {}).get("state")
    return fine[2][f"{column}.extrapolated"] if state == "resolved" else fine[1][column]


def true_errors(own, fine, column, rows, limit):
    """Errors at the rows whose times both have: of a column, and of what is extrapolated from it."""
    place = {round(t, 9): k for k, t in enumerate(fine["time"])}
    pairs = [(k, place[round(t, 9)]) for k, t in enumerate(own["time"]) if round(t, 9) in place]
    plain = max((abs(own[column][a] - limit[b]) for a, b in pairs), default=math.nan)
    left = max((abs(rows[f"{column}.extrapolated"][a] - limit[b]) for a, b in pairs), default=math.nan)
    return plain, left


def compare(kind, scene, reference, name):
    """Ratios of told over true errors of one kind."""
    told = run(scene, name, [f"--errors={kind}"])
    fine = run(reference, name + "_fine", [f"--errors={kind}"]) if told else None
    if not told or not fine:
        return None
    summary, own, rows = told
    ratios, left, counted, resolved, worst = [], [], 0, 0, ""
    for column, about in summary["errors"].get("columns", {}).items():
        part = about.get(kind, {"state": "not measured"})
        if part["state"] in ("round-off", "not measured"):
            continue
        counted += 1
        if part["state"] != "resolved":
            continue
        resolved += 1
        truth, remains = true_errors(own, fine[1], column, rows, limit_of(fine, column, kind))
        if not truth > 0.0:
            continue
        # rotations are told as an angle: their columns are compared with what was told of them in the rows
        largest = max(abs(e) for e in rows[f"{column}.error_" + ("in_time" if kind == "time" else "of_mesh")])
        # What the tolerance of Newton's method leaves open is no error of steps or meshes.
        scale = max(abs(v) for v in own[column])
        if truth < 1e-8 * scale:
            continue
        ratios.append(largest / truth)
        left.append(remains / truth)
        if ratios[-1] in (min(ratios), max(ratios)):
            worst = f"{column} {ratios[-1]:.2f}"
    return counted, resolved, ratios, left, worst


def row(name, kind, found):
    if found is None:
        return [name, kind, "-", "-", "-", "no reference"]
    counted, resolved, ratios, left, worst = found
    if not ratios:
        return [name, kind, f"{resolved}/{counted}", "-", "-", ""]
    return [name, kind, f"{resolved}/{counted}", f"{min(ratios):.2f} to {max(ratios):.2f}",
            f"{sorted(left)[len(left) // 2]:.1e}", worst]


head = ["scene", "error", "resolved", "told / true", "left, median", "last extreme"]
if arguments.markdown:
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
else:
    print("  ".join(head))
for file in sorted([*arguments.data.glob("scenarios/*.json"), *arguments.data.glob("gallery/*.json")]):
    name = file.parent.name[0] + "_" + file.stem
    if arguments.only and file.stem not in arguments.only:
        continue
    text = subprocess.run([program, "expand", str(file)], capture_output=True, text=True, check=True).stdout
    scene = json.loads(text)
    scene["expected"], scene["measures"] = [], []
    analysis = scene["analysis"]
    if "step_control" in analysis or "arc_length" in analysis:
        continue
    if analysis["kind"] == "dynamic":
        fine = copy.deepcopy(scene)
        fine["analysis"]["step_size"] = analysis.get("step_size", 1e-3) / 8
        stride = fine.setdefault("output", {}).get("stride", 1)
        fine["output"] = {**fine["output"], "stride": 8 * stride, "checks": False}
        found = row(file.stem, "time", compare("time", scene, fine, name))
        print("| " + " | ".join(found) + " |" if arguments.markdown else "  ".join(found), flush=True)
    if scene.get("beams"):
        fine = with_elements(scene, 4)
        fine["output"] = {**fine.get("output", {}), "checks": False}
        found = row(file.stem, "mesh", compare("mesh", scene, fine, name))
        print("| " + " | ".join(found) + " |" if arguments.markdown else "  ".join(found), flush=True)
sys.exit(0)
