#!/usr/bin/env python3
"""check_doors.py PROGRAM   puts pipes, links that lead to themselves, devices and very large files in the place of every
file that a verb reads: the verb ends at once with a status and the name of the file, and other cases are not affected.
A scene with a name that a batch uses itself is bad input of its case alone."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

program = str(pathlib.Path(sys.argv[1]).resolve())
failures = []
SCENE = {"schema_version": 1, "gravity": [0, -9.81, 0],
         "bodies": [{"name": "bob", "kind": "point_mass", "mass": 1, "position": [-1, 0, 0]}],
         "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
                     "axis": [0, 0, 1]}],
         "sensors": [{"name": "bob", "kind": "position", "at": "bob"}],
         "output": {"motion": True}, "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01}}


def pipe(path):
    os.mkfifo(path)


def loop(path):
    path.symlink_to(path.name)


def zeros(path):
    path.symlink_to("/dev/zero")


def large(path):
    path.write_text("{}")
    os.truncate(path, 1 << 40)


KINDS = [pipe, loop, zeros, large]


def run(words):
    """Status and all that it said; it has ten seconds."""
    try:
        done = subprocess.run([program, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=10, check=False)
    except subprocess.TimeoutExpired:
        return "hung", ""
    return done.returncode, done.stdout


def expect(what, words, status, *texts):
    got, said = run(words)
    if got not in (status if isinstance(status, tuple) else (status,)):
        failures.append(f"{what}: status {got} instead of {status}: {said[-200:]}")
    for text in texts:
        if text not in said:
            failures.append(f"{what}: no word of {text}: {said[-200:]}")


def replaced(path, kind):
    if path.exists() or path.is_symlink():
        path.unlink()
    kind(path)


count = 0
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    scene = folder / "scene.json"
    scene.write_text(json.dumps(SCENE))
    (folder / "table.csv").write_text("m\n1\n2\n")
    (folder / "sweep.json").write_text(json.dumps(
        {"schema_version": 1, "scene": "scene.json", "designs": [
            {"kind": "csv", "file": "table.csv", "variables": [{"name": "m", "pointer": "/bodies/bob/mass"}]}]}))
    expect("a run", ["run", scene, "--out", folder / "good", "--quiet"], 0)
    for kind in KINDS:
        name = kind.__name__
        for verb in [["check"], ["run", "--out", folder / "none"], ["plan"], ["expand"], ["study", "--out", folder / "none"],
                     ["sweep", "--out", folder / "none"], ["kinematics", "motion"]]:
            file = folder / f"{name}.json"
            replaced(file, kind)
            expect(f"{verb[0]} of {name}", [*verb, file] if len(verb) < 3 else [verb[0], file, *verb[1:]], 2, name)
            count += 1
        for file, text in [("table.csv", "/designs/0/file"), ("scene.json", "/scene")]:  # what a sweep names
            other = folder / f"sweep_{name}_{file}"
            other.mkdir()
            for one in ["scene.json", "table.csv", "sweep.json"]:
                shutil.copy(folder / one, other)
            replaced(other / file, kind)
            expect(f"sweep with {name} as {file}", ["sweep", other / "sweep.json", "--out", other / "out"], 2, text)
            count += 1
        for file in ["summary.json", "history.csv", "columns.json", "motion.bin", "manifest.json"]:
            other = folder / f"{name}_{file}"
            shutil.copytree(folder / "good", other)
            replaced(other / file, kind)
            status = 0 if file == "manifest.json" else 2  # a folder without a manifest can be read
            expect(f"view with {name} as {file}", ["view", other, "--out", folder / "page.html"], status)
            expect(f"compare with {name} as {file}", ["compare", folder / "good", other], 0 if file in
                   ("manifest.json", "motion.bin", "columns.json") else 2)
            expect(f"run into a folder with {name} as {file}", ["run", scene, "--out", other, "--quiet"], 2, file)
            count += 3
        # A batch: the case fails, by name, and the others are done.
        scenes = folder / f"scenes_{name}"
        scenes.mkdir()
        for one in ["a", "z"]:
            shutil.copy(scene, scenes / f"{one}.json")
        kind(scenes / f"{name}.json")
        out = folder / f"batch_{name}"
        expect(f"batch with {name}", ["batch", scenes, "--out", out, "--time-limit", "2"], 1, f"{name}: bad_input: ",
               "a: ok", "z: ok")
        for one in ["a", "z"]:
            if not (out / one / "history.csv").exists():
                failures.append(f"batch with {name}: no results of {one}")
        expect(f"batch with {name}, again", ["batch", scenes, "--out", out, "--resume"], 1, "3 of 3 cases are done")
        for file in ["journal.jsonl", "manifest.json"]:
            replaced(out / file, kind)
            expect(f"batch with {name} as {file}", ["batch", scenes, "--out", out, "--resume"], (1, 2), file)
            (out / file).unlink()
            shutil.rmtree(out)
            run(["batch", scenes, "--out", out])
        count += 4
    # Names that a batch uses itself.
    scenes = folder / "names"
    scenes.mkdir()
    taken = ["batch.csv", "batch.json", "batch.html", "cost.csv", "cases.csv", "keys.csv", "sensitivities.csv",
             "journal.jsonl", "manifest.json", "shard.json", "store_000.pack", "a.failed", "a.partial", "shard_001_of_002"]
    for one in ["a", *taken]:
        shutil.copy(scene, scenes / f"{one}.json")
    expect("names of a batch", ["batch", scenes, "--out", folder / "named"], 1, "a: ok",
           *[f"{one}: bad_input: " for one in taken])
    for one in ["batch.csv", "batch.json", "batch.html", "cost.csv", "journal.jsonl"]:
        if not (folder / "named" / one).is_file():
            failures.append(f"names of a batch: there is no file {one}")
    count += len(taken)
for failure in failures:
    print("FAIL:", failure)
print(f"{count} files of another kind or name, {len(failures)} failures")
sys.exit(1 if failures else 0)
