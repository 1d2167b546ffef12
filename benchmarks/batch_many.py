#!/usr/bin/env python3
"""batch_many.py PROGRAM SCENARIOS [CASES] [few|none]   what very many cases cost besides their steps

A sweep of CASES (100000) pendulums of five steps with one variable and two measures, by one worker; the same once more
with --resume; what a million would take in proportion. `few` stores their results, `none` keeps the rows only."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

program, scenarios = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
cases = int(sys.argv[3]) if len(sys.argv) > 3 else 100_000
keep = sys.argv[4] if len(sys.argv) > 4 else "few"


def run(words):
    """Seconds, and the largest memory of the process itself [MB]."""
    start = time.monotonic()
    child = subprocess.Popen([program, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    peak = 0
    while child.poll() is None:
        try:
            for line in open(f"/proc/{child.pid}/status"):
                if line.startswith("VmHWM:"):
                    peak = max(peak, int(line.split()[1]))
        except OSError:
            pass
        time.sleep(0.02)
    if child.returncode != 0:
        sys.exit(f"status {child.returncode}")
    return time.monotonic() - start, peak / 1e3 * 1.024


def sweep(folder, count):
    file = folder / f"{count}.json"
    file.write_text(json.dumps({
        "schema_version": 1, "scene": str(scenarios / "pendulum.json"),
        "set": [{"pointer": "/analysis/end_time", "value": 0.01}, {"pointer": "/expected", "value": []}],
        "measures": [{"name": "low", "quantity": "bob.z", "figure": "min"},
                     {"name": "mean", "quantity": "bob.x", "figure": "mean"}],
        "designs": [{"kind": "random", "samples": count, "variables": [
            {"name": "g", "pointer": "/gravity/2", "distribution": {"kind": "uniform", "low": -10, "high": -9}}]}]}))
    return file


with tempfile.TemporaryDirectory(dir=os.environ.get("BOUGH_SCRATCH")) as folder:
    folder = pathlib.Path(folder)
    out = folder / "out"
    _, least = run(["sweep", sweep(folder, 300), "--out", folder / "least", "--keep", keep, "--threads", 1])
    seconds, memory = run(["sweep", sweep(folder, cases), "--out", out, "--keep", keep, "--threads", 1])
    files = list(out.iterdir())
    size = sum(file.stat().st_size for file in files) / 1e6
    print(f"{cases} cases, --keep {keep}: {seconds:.1f} s, {memory:.0f} MB in the parent ({least:.0f} MB of few cases, "
          f"so {1e6 * (memory - least) / cases:.0f} bytes a case), {size:.0f} MB in {len(files)} files")
    for file in sorted(files):
        print(f"  {file.name}: {file.stat().st_size / 1e6:.2f} MB")
    again, memory_again = run(["sweep", sweep(folder, cases), "--out", out, "--keep", keep, "--threads", 1, "--resume"])
    print(f"--resume where all is done: {again:.1f} s, {memory_again:.0f} MB in the parent")
    share = 1e6 / cases
    print(f"1000000 cases in proportion: {share * seconds / 60:.0f} min on one thread, "
          f"{least + share * (memory - least):.0f} MB in the parent, "
          f"{least + share * (memory_again - least):.0f} MB to resume, {share * size / 1e3:.1f} GB in {len(files)} files")
