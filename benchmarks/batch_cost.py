#!/usr/bin/env python3
"""batch_cost.py PROGRAM SCENARIOS   what a batch takes besides the steps of its cases, in processor seconds a case.

Steps: the slope over the end time of cases whose results nobody keeps. Besides: what is left of a case with that end time
when its steps are taken off, for cases of 10 and 100 ms, with results in stores, in folders, and not kept. Then two
workers against two loops of `bough run` side by side, on the same cases with folders of results. Medians of ROUNDS
interleaved rounds; other work on the machine makes all of them larger."""
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
    return cpu([program, "sweep", str(file), "--out", str(folder / name), "--keep", keep, "--threads", str(threads), "--quiet"]) / cases


with tempfile.TemporaryDirectory(dir=os.environ.get("BOUGH_SCRATCH")) as folder:
    folder = pathlib.Path(folder)
    cases = 201  # so many that `few` stores
    slope = statistics.median((sweep(folder, "out", cases, 0.4, "none") - sweep(folder, "out", cases, 0.1, "none")) / 0.3
                              for _ in range(rounds))
    print(f"steps: {1e3 * slope:.1f} ms a simulated second")
    for wanted in [0.010, 0.100]:
        end = round(wanted / slope, 3)
        for keep, name in [("none", "not kept"), ("few", "stored"), ("all", "folders")]:
            total = statistics.median(sweep(folder, "out", cases, end, keep) for _ in range(rounds if wanted < 0.05 else 1))
            print(f"cases of {1e3 * wanted:.0f} ms of steps, {name}: {1e3 * total:.2f} ms, besides steps "
                  f"{100.0 * (1.0 - slope * end / total):.1f} %")
    end, count = round(0.010 / slope, 3), 60
    loop = folder / "loop.sh"
    loop.write_text("#!/bin/sh\nfor i in $(seq %d); do %s run %s --set /analysis/end_time=%g --set '/expected=[]' "
                    "--set /parameters/g=9.$i --threads 1 --quiet --out $1/$i || exit 1; done\n" % (count // 2, program, scene, end))
    both = folder / "both.sh"
    both.write_text(f"#!/bin/sh\nsh {loop} {folder}/a & sh {loop} {folder}/b; wait\n")
    ratios = []
    for _ in range(rounds):
        solo = cpu(["sh", str(both)]) / count
        batch = sweep(folder, "two", count, end, "all", threads=2)
        ratios.append(batch / solo)
    print(f"two workers with folders over two loops of single runs: {statistics.median(ratios):.2f} "
          f"({min(ratios):.2f} to {max(ratios):.2f})")
