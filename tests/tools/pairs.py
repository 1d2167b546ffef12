#!/usr/bin/env python3
"""Runs two programs of bough on the same scenes, in interleaved pairs, and says whether they compute the same, and how
long each takes.

    python3 tests/tools/pairs.py OLD NEW [SCENE ...] [--rounds 15] [--twins 10] [--at-most 1.03] [--process-at-most 1.02]

Results: 'bits' if both histories are equal to the last bit. Otherwise the largest difference of a column relative to
the range of its sensor, compared with that of twins: runs of OLD in which each mass, stiffness and force is changed
by one rounding. A difference above that of the worst twin is reported as BEYOND, with exit status 1.
Times: medians over the rounds of NEW over OLD, of the whole process (user and system; also in ms) and of the phases
of its steps (assemble, factor, solve, update). A median of the phases above --at-most, or of the process above
--process-at-most, is reported as SLOWER, with exit status 1. Processes of few ms need some hundred rounds.
Without scenes, those of data/scenarios are run. One thread; needs only standard Python.
"""
import argparse
import csv
import glob
import json
import os
import random
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

PERTURBED = {"mass", "inertia", "stiffness", "mass_per_length", "rotary", "force", "moment", "damping", "velocity",
             "angular_velocity"}
PHASES = ("assemble", "factor", "solve", "update")


def run(program, scene, out):
    """Processor time of a run [s], its summary and its history (names and rows); None if it failed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "run", scene, "--out", out, "--quiet", "--threads", "1"], capture_output=True,
                          text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    try:
        with open(os.path.join(out, "summary.json")) as file:
            summary = json.load(file)
        with open(os.path.join(out, "history.csv"), newline="") as file:
            rows = list(csv.reader(file))
    except OSError:
        return used, None, f"{program} wrote no results: {done.stderr.strip()[:300]}"
    return used, summary, (rows[0], [[float(x) for x in row] for row in rows[1:]])


def perturbed(value, draw, inside=False):
    """The scene, with each number under a key of PERTURBED changed by one rounding."""
    if isinstance(value, dict):
        return {k: perturbed(v, draw, inside or k in PERTURBED) for k, v in value.items() if k != "expected"}
    if isinstance(value, list):
        return [perturbed(v, draw, inside) for v in value]
    if inside and isinstance(value, (int, float)) and not isinstance(value, bool):
        return value * (1.0 + draw.choice((-1.0, 1.0)) * 2.0**-52)
    return value


def difference(a, b):
    """The largest difference of a column relative to the range of its sensor's columns, and the name of the column."""
    names, rows = a
    if names != b[0]:
        return float("inf"), "columns differ"
    if len(rows) != len(b[1]):
        return float("inf"), f"{len(rows)} and {len(b[1])} rows"
    ranges = {}
    for c, name in enumerate(names):
        sensor = name.rsplit(".", 1)[0]
        ranges[sensor] = max([ranges.get(sensor, 0.0)] + [abs(row[c]) for row in rows])
    worst, where = 0.0, ""
    for c, name in enumerate(names):
        if name in ("step_size", "iterations"):
            continue
        whole = ranges[name.rsplit(".", 1)[0]]
        most = max((abs(x[c] - y[c]) for x, y in zip(rows, b[1])), default=0.0)
        if most > worst * whole:
            worst, where = most / whole if whole > 0.0 else float("inf"), name
    return worst, where


def phases(summary):
    return sum(summary["time_s"][p] for p in PHASES)


def compare(scene, args, scratch):
    """One scene: a line of text, and whether the result is acceptable."""
    title = os.path.splitext(os.path.basename(scene))[0]
    place = os.path.join(scratch, os.path.basename(os.path.dirname(scene)) + "_" + title)  # a folder has one scene
    process, steps, spent = [], [], []
    first = None
    for _ in range(args.rounds):
        old = run(args.old, scene, place + ".old")
        new = run(args.new, scene, place + ".new")
        for result in (old, new):
            if result[1] is None:
                return f"{title}: FAILED {result[2]}", False
        spent.append((1e3 * old[0], 1e3 * new[0]))
        if old[0] > 0.0:
            process.append(new[0] / old[0])
        if phases(old[1]) > 0.0:
            steps.append(phases(new[1]) / phases(old[1]))
        first = first or (old, new)
    (_, old_summary, old_history), (_, new_summary, new_history) = first
    of_steps, of_process = (statistics.median(x) if x else float("nan") for x in (steps, process))
    old_ms, new_ms = (statistics.median(x) for x in zip(*spent))
    line = f"{title:26} phases {of_steps:6.3f}  process {of_process:6.3f} ({old_ms:.2f} -> {new_ms:.2f} ms)"
    counts = [s["steps"].get("newton_iterations", 0) for s in (old_summary, new_summary)]
    line += f"  iterations {counts[0]} -> {counts[1]}  "
    ok = True
    if old_history == new_history:
        line += "bits"
    else:
        worst, where = difference(old_history, new_history)
        bar = 0.0
        with open(scene) as file:
            original = json.load(file)
        for seed in range(args.twins):
            twin = os.path.join(scratch, "twin.json")
            with open(twin, "w") as file:
                json.dump(perturbed(original, random.Random(seed)), file)
            result = run(args.old, twin, os.path.join(scratch, "twin"))
            if result[1] is not None:
                bar = max(bar, difference(old_history, result[2])[0])
        ok = worst <= bar
        line += f"{'within twins' if ok else 'BEYOND twins'}: {worst:.1e} at {where} of {bar:.1e}"
    for median, most in ((of_steps, args.at_most), (of_process, args.process_at_most)):
        if most and median > most:
            ok = False
            line += f"  SLOWER than {most}"
    return line, ok


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--twins", type=int, default=10)
    parser.add_argument("--at-most", type=float, default=0.0)
    parser.add_argument("--process-at-most", type=float, default=0.0)
    args = parser.parse_args()
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    scenes = args.scenes or sorted(glob.glob(os.path.join(root, "data", "scenarios", "*.json")))
    good = True
    # Both programs are copied to files beside NEW: how the file of a program was written affects the time of small
    # scenes, since its pages are mapped singly or in groups. The same program took 6.1 ms as the linker wrote it,
    # 5.2 as a copy.
    beside = os.path.dirname(os.path.abspath(args.new))
    with tempfile.TemporaryDirectory() as scratch, tempfile.TemporaryDirectory(dir=beside) as programs:
        args.old = shutil.copy(args.old, os.path.join(programs, "old"))
        args.new = shutil.copy(args.new, os.path.join(programs, "new"))
        for scene in scenes:
            line, ok = compare(scene, args, scratch)
            print(line, flush=True)
            good = good and ok
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
