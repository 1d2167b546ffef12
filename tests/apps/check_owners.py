#!/usr/bin/env python3
"""check_owners.py PROGRAM   a folder has one owner: results of another verb, another scene or another sweep are refused
with what is there and what to do, whether they are finished, stopped or still being written, and nothing of them
changes. --replace takes their place as a whole. A damaged manifest beside a whole journal is made anew with --resume."""
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

program = str(pathlib.Path(sys.argv[1]).resolve())
failures = []
count = 0
SCENE = {"schema_version": 1, "gravity": [0, -9.81, 0], "parameters": {"l": 1},
         "bodies": [{"name": "bob", "kind": "point_mass", "mass": 1, "position": [{"expression": "-l"}, 0, 0]}],
         "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
                     "axis": [0, 0, 1]}],
         "sensors": [{"name": "bob", "kind": "position", "at": "bob"}],
         "analysis": {"kind": "dynamic", "end_time": 0.2, "step_size": 0.01}}
SWEEP = {"schema_version": 1, "scene": "a.json",
         "designs": [{"kind": "grid", "variables": [{"name": "l", "values": [1, 2, 3]}]}]}
STUDY = {"schema_version": 1, "scene": "a.json", "quantities": [{"name": "place", "sensor": "bob"}], "repetitions": 1,
         "reference": {"set": [{"pointer": "/analysis/step_size", "value": 0.001}],
                       "check": [{"pointer": "/analysis/step_size", "value": 0.002}], "order": 2},
         "grids": [{"name": "steps", "axes": [{"name": "step size", "values": [0.02, 0.01, 0.005]}],
                    "orders": [{"quantity": "place", "order": 2, "theory": "second order"}]}]}


def expect(what, words, status, *texts):
    global count
    count += 1
    done = subprocess.run([program, *words], capture_output=True, text=True, timeout=60, check=False)
    said = done.stdout + done.stderr
    if done.returncode != status:
        failures.append(f"{what}: status {done.returncode} instead of {status}: {said[-300:].strip()}")
    for text in texts:
        if text not in said:
            failures.append(f"{what}: no word of {text!r}: {said[-300:].strip()}")


def content(folder):
    return {str(path.relative_to(folder)): hashlib.sha1(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def unchanged(what, folder, before):
    if content(folder) != before:
        failures.append(f"{what}: it changed {folder.name}")


with tempfile.TemporaryDirectory() as place:
    place = pathlib.Path(place)
    os.chdir(place)
    for name in ["a", "b"]:
        pathlib.Path(f"{name}.json").write_text(json.dumps(SCENE))
        pathlib.Path(name).mkdir()
        shutil.copy("a.json", f"{name}/one.json")
        pathlib.Path(f"sweep_{name}.json").write_text(json.dumps(SWEEP))
        pathlib.Path(f"study_{name}.json").write_text(json.dumps(STUDY))
    verbs = {
        "run a": ["run", "a.json", "--quiet"], "run b": ["run", "b.json", "--quiet"],
        "profile a": ["profile", "a.json", "--steps", "2", "--quiet"],
        "sweep a": ["sweep", "sweep_a.json", "--quiet"], "sweep b": ["sweep", "sweep_b.json", "--quiet"],
        "batch a": ["batch", "a", "--quiet"], "batch b": ["batch", "b", "--quiet"],
        "study a": ["study", "study_a.json", "--quiet", "--threads", "1"],
        "stress": ["stress", "--quick", "--case", "one_body", "--quiet"],
    }
    has_rows = ("sweep", "batch")
    for name, words in verbs.items():
        expect(name, [*words, "--out", f"{name}.out".replace(" ", "_")], 0)
    for name in verbs:
        out = pathlib.Path(f"{name}.out".replace(" ", "_"))
        before = content(out)
        for other, words in verbs.items():
            what = f"{other} into the folder of {name}"
            if other == name and not name.startswith(has_rows):
                continue  # a run is replaced by one of the same scene
            texts = ["--resume", "--replace"] if other == name else [f"bough {name.split()[0]}", "--replace"]
            expect(what, [*words, "--out", str(out)], 2, *texts)
            unchanged(what, out, before)
            if other != name and other.startswith(has_rows):
                expect(what + ", --resume", [*words, "--out", str(out), "--resume"], 2, f"bough {name.split()[0]}")
                unchanged(what, out, before)
        for other, words in verbs.items():
            copy = pathlib.Path("copy")
            shutil.copytree(out, copy)
            expect(f"{other} in place of {name}", [*words, "--out", "copy", "--replace"], 0)
            made = {path.split("/")[0] for path in content(copy)}
            fresh = {path.split("/")[0] for path in content(pathlib.Path(f"{other}.out".replace(" ", "_")))}
            if (made ^ fresh) - {"references"}:  # a cache, which a study makes before its results
                failures.append(f"{other} in place of {name}: {sorted(made ^ fresh)}")
            if left := [path.name for path in place.iterdir() if path.name.startswith((".copy", "copy."))]:
                failures.append(f"{other} in place of {name}: left {left}")
            shutil.rmtree(copy)
    # A result that somebody changed, in a folder or in a case of a batch, is not bough's any more.
    history = pathlib.Path("run_a.out/history.csv")
    text = history.read_text()
    history.write_text(text[:-2] + ("7" if text[-2] != "7" else "8") + "\n")
    for words in [verbs["run a"], [*verbs["run a"], "--replace"], [*verbs["sweep a"], "--replace"]]:
        expect("a result of the same size", [*words, "--out", "run_a.out"], 2, "history.csv", "changed since")
    pathlib.Path("sweep_a.out/2/notes.txt").write_text("mine")
    expect("notes in a case", [*verbs["run a"], "--out", "sweep_a.out", "--replace"], 2, "notes.txt")
    expect("notes in a case", [*verbs["sweep a"], "--out", "sweep_a.out", "--replace"], 2, "notes.txt")
    pathlib.Path("sweep_a.out/2/notes.txt").unlink()
    # Folders that are being written.
    slow = ["--set", "/analysis/step_size=1e-6", "--set", "/analysis/end_time=50"]  # minutes: longer than all others take beside it
    for name in ["sweep a", "batch a", "run b"]:
        out = pathlib.Path("busy")
        busy = subprocess.Popen([program, *verbs[name], "--out", "busy", *slow], stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL)
        there = pathlib.Path(".busy.bough-new/history.csv.partial" if name == "run b" else "busy/keys.csv")
        until = time.monotonic() + 10
        while not there.exists() and time.monotonic() < until:
            time.sleep(0.05)
        for other, words in verbs.items():
            if other == "stress" or (name, other) == ("run b", "run b"):
                continue
            status = 2 if other.startswith(has_rows) or name != "run b" else 1
            expect(f"{other} beside {name}", [*words, "--out", "busy"], status)
        if busy.poll() is not None:
            failures.append(f"{name}: it ended beside others")
        busy.send_signal(signal.SIGTERM)
        busy.wait()
        for path in place.glob("busy*"):
            shutil.rmtree(path)
    # A damaged manifest.
    for damage in ["", "{", json.dumps({"format": "of another program"})]:
        pathlib.Path("sweep_a.out/manifest.json").write_text(damage)
        before = {k: v for k, v in content(pathlib.Path("sweep_a.out")).items() if k != "manifest.json"}
        expect("a damaged manifest", [*verbs["sweep a"], "--out", "sweep_a.out"], 2, "manifest.json")
        expect("a damaged manifest, --resume", [*verbs["sweep a"], "--out", "sweep_a.out", "--resume"], 0,
               "was damaged", "3 whole rows")
        if json.loads(pathlib.Path("sweep_a.out/manifest.json").read_text())["state"] != "good":
            failures.append("a damaged manifest: it is not good after --resume")
    # Former results stay until the new ones are good.
    before = content(pathlib.Path("sweep_a.out"))
    expect("new results that fail", [*verbs["sweep a"], "--out", "sweep_a.out", "--replace", "--time-limit", "0.3", *slow], 1,
           "kept in", "sweep_a.out.former")
    former = {k: v for k, v in content(pathlib.Path("sweep_a.out.former")).items() if k != "manifest.json"}
    if former != {k: v for k, v in before.items() if k != "manifest.json"}:
        failures.append("new results that fail: the former ones are not whole")
    expect("new results that are good", [*verbs["sweep a"], "--out", "sweep_a.out", "--replace"], 0)
    if pathlib.Path("sweep_a.out.former").exists():
        failures.append("new results that are good: the former ones are still there")
for failure in failures:
    print("FAIL:", failure)
print(f"{count} commands, {len(failures)} failures")
sys.exit(1 if failures else 0)
