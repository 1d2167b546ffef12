#!/usr/bin/env python3
"""check_poisoned.py PROGRAM CASES SOLO   a batch of small scenes, one in twenty of them poisoned: each of these is told
with its cause, and the others are as if they ran alone; SOLO of them are run alone and compared byte for byte."""
import csv
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time

program, cases, solo = str(pathlib.Path(sys.argv[1]).resolve()), int(sys.argv[2]), int(sys.argv[3])
failures = []


def pendulum(k):
    return {"schema_version": 1, "gravity": [0, -9.81, 0],
            "bodies": [{"name": "bob", "kind": "point_mass", "mass": 1, "position": [1, 0.001 * k, 0]}],
            "joints": [{"name": "pin", "kind": "spherical", "first": "ground", "second": "bob", "position": [0, 0, 0]}],
            "sensors": [{"name": "bob", "kind": "position", "at": "bob"}],
            "measures": [{"name": "low", "quantity": "bob.y", "figure": "min"}],
            "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01}}


def beam(elements):
    return {"schema_version": 1, "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
            "sections": [{"name": "s", "stiffness": [1e6, 1e6, 1e6, 10, 10, 10], "mass": [1, 1, 1, 1e-3, 1e-3, 1e-3]}],
            "beams": [{"name": "bar", "section": "s", "start": "a", "end": "b", "elements": elements}],
            "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
            "sensors": [{"name": "tip", "kind": "position", "at": "b"}],
            "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01}}


def poison(kind, k):
    """Text of a scene, the status that it has to get, and a word of its cause."""
    scene = pendulum(k)
    if kind == 0:
        return "{\"schema_version\": 1,", "bad_input", "not JSON"
    if kind == 1:
        scene["bodies"][0]["mass"] = "NaN"
        return json.dumps(scene), "bad_input", "without quotes"
    if kind == 2:  # a load that grows beyond all numbers
        scene["loads"] = [{"at": "bob", "force": [1, 0, 0], "law": {"expression": "exp(1e4*t)"}}]
        return json.dumps(scene), "bad_input", "not finite"
    if kind == 6:  # no step can converge
        scene["analysis"].update(max_iterations=1, max_cuts=0, step_size=0.05)
        return json.dumps(scene), "failed", "fails"
    if kind == 3:  # hangs: a million seconds of steps
        scene["analysis"].update(end_time=1e6, step_size=1e-6)
        scene["output"] = {"stride": 1000000000}
        return json.dumps(scene), "timed_out", "time limit"
    if kind == 4:
        return json.dumps(beam(1000000)), "bad_input", "memory"
    if kind in (7, 8):  # the test sends its process a signal as a fault of the program would raise it
        scene["analysis"].update(end_time=1e6, step_size=1e-6)
        scene["output"] = {"stride": 1000000000}
        return json.dumps(scene), "crashed", f"signal {int(SIGNALS[kind])}"
    # Writes more than a file may hold, within hundreds of steps: far from the limit of time, however busy the machine.
    scene["sensors"] += [{"name": f"again {n}", "kind": "position", "at": "bob"} for n in range(100)]
    scene["analysis"].update(end_time=400)
    return json.dumps(scene), "failed", "File too large"

SIGNALS = {7: signal.SIGABRT, 8: signal.SIGSEGV}


def case_of(process):
    """The case that a worker runs: it holds the folder that it writes, .NAME.bough-new."""
    try:
        for link in os.scandir(f"/proc/{process}/fd"):
            name = pathlib.Path(os.readlink(link.path)).name
            if name.startswith(".case_") and name.endswith(".bough-new"):
                return name[1:-len(".bough-new")]
    except OSError:
        pass
    return None


def break_cases(batch, signals):
    """Sends each case of these its signal, once its worker has begun with it."""
    left = dict(signals)
    while batch.poll() is None and left:
        children = pathlib.Path(f"/proc/{batch.pid}/task/{batch.pid}/children")
        for process in children.read_text().split() if children.exists() else []:
            case = case_of(process)
            if case in left:
                os.kill(int(process), left.pop(case))
        time.sleep(0.01)
    return batch.wait()


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    scenes, out = folder / "scenes", folder / "out"
    scenes.mkdir()
    wanted = {}
    for k in range(cases):
        name = f"case_{k:04d}"
        if k % 20 != 7:
            (scenes / f"{name}.json").write_text(json.dumps(pendulum(k)))
            continue
        kind = (k // 20) % 9
        if kind == 3 and k > 300:
            kind = 0  # a few hang: each takes its limit of time
        text, status, word = poison(kind, k)
        (scenes / f"{name}.json").write_text(text)
        wanted[name] = (kind, status, word)
    batch = subprocess.Popen([program, "batch", str(scenes), "--out", str(out), "--quiet", "--time-limit", "10",
                              "--memory-limit", "2G", "--keep", "all"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2 << 20, 2 << 20)))
    status = break_cases(batch, {name: SIGNALS[kind] for name, (kind, _, _) in wanted.items() if kind in SIGNALS})
    if status != 1:
        failures.append(f"status {status}")
    with open(out / "batch.csv", newline="") as table:
        rows = {row["case"]: row for row in csv.DictReader(table)}
    if len(rows) != cases:
        failures.append(f"{len(rows)} rows")
    for name, row in rows.items():
        if name not in wanted:
            if row["status"] != "ok" or not row["low"]:
                failures.append(f"{name}: {row['status']}, {row['cause']}")
            continue
        kind, status, word = wanted[name]
        if row["status"] != status or word not in row["cause"]:
            failures.append(f"{name}, poison {kind}: {row['status']}, {row['cause']}")
    good = [name for name in rows if name not in wanted]
    for name in good[:: max(1, len(good) // solo)]:
        alone = folder / "alone" / name
        subprocess.run([program, "run", str(scenes / f"{name}.json"), "--out", str(alone), "--threads", "1", "--quiet"],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if (alone / "history.csv").read_bytes() != (out / name / "history.csv").read_bytes():
            failures.append(f"{name}: not as alone")
for failure in failures[:20]:
    print("FAIL:", failure)
print(f"{len(rows)} cases, {len(wanted)} poisoned, {len(failures)} failures")
sys.exit(1 if failures else 0)
