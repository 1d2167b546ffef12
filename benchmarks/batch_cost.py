#!/usr/bin/env python3
"""batch_cost.py PROGRAM SCENARIOS [ROUNDS]   cost of a batch besides the steps of its cases, in processor seconds.

Cost besides steps: the time of cases of two steps without results (starting, reading, planning), and the difference
between cases with and without results (writing), relative to the whole; for cases of about 10 and 100 ms, with
results in stores and in folders. Then two workers with folders are compared with two loops of `bough run` at the
same time. Compared runs alternate, each into a new folder; medians of ROUNDS rounds are printed, since other work on
the machine makes seconds longer. Folders are written below the folder BOUGH_SCRATCH, if it is given: what they cost
depends on its file system (on ext4 without a journal 1.4 ms of the kernel for each folder, in memory 0.15 ms)."""
import itertools
import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

program, scenarios = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 5
numbers = itertools.count()
scene = scenarios / "rod_chain.json"  # ten rods, 1 ms a step


def cpu(words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    status = subprocess.run(words, stdout=subprocess.DEVNULL).returncode
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if status != 0:
        sys.exit(f"status {status} of {words}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def sweep(folder, name, cases, end, keep, threads=1):
    file = folder / "sweep.json"
    file.write_text(json.dumps({
        "schema_version": 1, "scene": str(scene),
        "set": [{"pointer": "/analysis/end_time", "value": end}, {"pointer": "/expected", "value": []}],
        "designs": [{"kind": "random", "samples": cases, "variables": [
            {"name": "g", "distribution": {"kind": "uniform", "low": 9, "high": 10}}]}]}))
    out = folder / f"{name} {next(numbers)}"  # a new one: removing and replacing former results is not writing
    return cpu([program, "sweep", str(file), "--out", str(out), "--keep", keep, "--threads", str(threads), "--quiet"]) / cases


with tempfile.TemporaryDirectory(dir=os.environ.get("BOUGH_SCRATCH")) as folder:
    folder = pathlib.Path(folder)
    cases = 201  # so many that `few` stores
    slope = sweep(folder, "out", cases, 0.4, "none") / 0.4
    for wanted in [0.010, 0.100]:
        end, rest, totals = round(wanted / slope, 3), {"few": [], "all": []}, {"few": [], "all": []}
        for _ in range(rounds if wanted < 0.05 else max(2, rounds // 2)):
            start = sweep(folder, "out", cases, 0.002, "none")
            bare = sweep(folder, "out", cases, end, "none")
            for keep in rest:
                total = sweep(folder, "out", cases, end, keep)
                totals[keep].append(total)
                rest[keep].append((start + total - bare) / total)
        for keep, name in [("few", "stores"), ("all", "folders")]:
            print(f"cases of {1e3 * statistics.median(totals[keep]):.1f} ms with {name}: besides steps "
                  f"{100.0 * statistics.median(rest[keep]):.1f} % ({100.0 * min(rest[keep]):.1f} to {100.0 * max(rest[keep]):.1f})")
    end, count = round(0.010 / slope, 3), 60
    loop = folder / "loop.sh"
    loop.write_text("#!/bin/sh\nfor i in $(seq %d); do %s run %s --set /analysis/end_time=%g --set '/expected=[]' "
                    "--set /parameters/g=9.$i --threads 1 --quiet --out $1/$i || exit 1; done\n" % (count // 2, program, scene, end))
    both = folder / "both.sh"
    both.write_text(f"#!/bin/sh\nsh {loop} {folder}/a$1 & sh {loop} {folder}/b$1; wait\n")
    ratios = []
    for _ in range(rounds):
        solo = cpu(["sh", str(both), str(next(numbers))]) / count
        batch = sweep(folder, "two", count, end, "all", threads=2)
        ratios.append(batch / solo)
    print(f"two workers with folders over two loops of single runs: {statistics.median(ratios):.2f} "
          f"({min(ratios):.2f} to {max(ratios):.2f})")
