#!/usr/bin/env python3
"""check_start_from.py PROGRAM SCENARIOS   a run that starts from a state of another one (--from, --time): what it says
of times, folders and scenes that do not fit, which instants there are, that it goes on with --resume, and that nothing
of the folder it starts from is touched."""
import csv
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

program, scenarios = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
failures = []


def expect(holds, what):
    if not holds:
        failures.append(what)


def run(*words, status=0, says=()):
    """Its output, after a look at its status and at what it has to say."""
    done = subprocess.run([program, "run", *map(str, words)], capture_output=True, text=True)
    said = done.stdout + done.stderr
    expect(done.returncode == status, f"{' '.join(map(str, words))}: status {done.returncode} instead of {status}: {said[-400:]}")
    for text in says:
        expect(text in said, f"{' '.join(map(str, words))}: it does not say '{text}': {said[-600:]}")
    return said


def last_row(folder):
    with open(folder / "history.csv") as file:
        return [float(x) for x in list(csv.reader(file))[-1]]


def contents(folder):
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in folder.rglob("*") if p.is_file()}


def write(path, change):
    scene = json.loads((scenarios / "double_pendulum.json").read_text())
    scene.pop("expected", None)
    change(scene)
    path.write_text(json.dumps(scene))
    return path


with tempfile.TemporaryDirectory() as place:
    place = pathlib.Path(place)
    scene = write(place / "scene.json", lambda s: s["analysis"].update(end_time=0.4, step_size=1e-3))
    longer = write(place / "longer.json", lambda s: s["analysis"].update(end_time=0.8, step_size=1e-3))
    first = place / "first"
    run(scene, "--out", first, "--quiet", "--set", "/output/motion=true")
    before = contents(first)
    run(longer, "--out", place / "whole", "--quiet")

    # The end, without a time; a picture; both end where the whole run does.
    for name, words in (("end", []), ("picture", ["--time", "0.2"])):
        run(longer, "--out", place / name, "--from", first, *words, says=["starts from the state of another one"])
        a, b = last_row(place / "whole"), last_row(place / name)
        off = max(abs(x - y) for x, y in zip(a[3:], b[3:])) / max(map(abs, a[3:]))
        expect(off < 1e-5, f"{name}: the end is off by {off:.2g}")
        with open(place / name / "history.csv") as file:
            start = float(list(csv.reader(file))[1][0])
        expect(abs(start - (0.2 if name == "picture" else 0.4)) < 1e-12, f"{name}: it starts at {start}")
        origin = json.loads((place / name / "summary.json").read_text())["origin"]["from"]
        expect(origin["folder"] == str(first) and len(origin["hash"]) > 8, f"{name}: its summary does not name the origin")
    expect(contents(first) == before, "the folder that a run starts from was changed")

    # Instants that are not there.
    run(longer, "--out", place / "no", "--from", first, "--time", "0.2001", status=2,
        says=["no state of 0.2001", "not interpolated", "0.2", "the nearest of"])
    run(longer, "--out", place / "no", "--from", place / "nothing", status=2, says=["is not a folder"])
    said = subprocess.run([program, "view", str(scene)], capture_output=True, text=True).stderr
    expect("is a file, not a folder of results" in said, f"view of a file says: {said}")
    (place / "pipe").mkdir()
    os.mkfifo(place / "pipe" / "states.bin")
    run(longer, "--out", place / "no", "--from", place / "pipe", status=2, says=["a pipe, not a file"])
    (place / "lies").mkdir()
    for text in ("bough states 1\nnan,3,ab\nabc", "bough states 1\n1,99999999999999999999,ab\n", "bough states 1\n1,3,ab\nabc",
                 "another\n", ""):
        (place / "lies" / "states.bin").write_text(text)
        run(longer, "--out", place / "no", "--from", place / "lies", status=2, says=["cannot start from a state"])
    (place / "empty").mkdir()
    run(longer, "--out", place / "no", "--from", place / "empty", status=2, says=["holds no states"])
    expect(not (place / "no").exists(), "a run that does not start leaves a folder")
    run(longer, "--out", first, "--from", first, "--replace", status=2, says=[str(first)])
    expect(contents(first) == before, "a run was written over the one from which it starts")

    # Scenes that do not fit.
    run(scene, "--out", place / "no", "--from", first, status=2, says=["/analysis/end_time", "0.4"])
    other = place / "other.json"
    shutil.copy(scenarios / "elastica.json", other)
    run(other, "--out", place / "no", "--from", first, status=2, says=["/analysis/kind"])

    # A state that was altered is not used; the one before it is named.
    altered = place / "altered"
    shutil.copytree(first, altered)
    content = bytearray((altered / "states.bin").read_bytes())
    content[-20] ^= 1
    (altered / "states.bin").write_bytes(content)
    run(longer, "--out", place / "before_end", "--from", altered, "--time", "0.4", status=2, says=["damaged"])
    run(longer, "--out", place / "before_end", "--from", altered, "--time", "0.2", "--quiet")

    # From the checkpoint of a run that was killed, and stopped.
    long = write(place / "long.json", lambda s: (s["analysis"].update(end_time=50.0, step_size=1e-3),
                                                 s.update(output={"checkpoint_time": 0.2})))
    child = subprocess.Popen([program, "run", str(long), "--out", str(place / "cut"), "--quiet"],
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(600):
        if (place / ".cut.bough-new" / "checkpoint.2").exists():
            break
        time.sleep(0.01)
    child.send_signal(signal.SIGKILL)
    child.wait()
    run(long, "--out", place / "branch", "--from", place / "cut", "--quiet", "--set", "/analysis/end_time=20")

    # A run that starts from a state goes on from its checkpoints, and only with the same state.
    words = [long, "--out", place / "branched", "--from", first, "--time", "0.4"]
    child = subprocess.Popen([program, "run", *map(str, words), "--quiet"], stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL)
    for _ in range(600):
        if (place / ".branched.bough-new" / "checkpoint.2").exists():
            break
        time.sleep(0.01)
    child.send_signal(signal.SIGTERM)
    child.wait()
    shutil.copytree(place / "branched", place / "otherwise")
    run(*words, "--resume", says=["going on from time"])
    run(long, "--out", place / "uncut", "--from", first, "--time", "0.4", "--quiet")
    for name in ("history.csv", "states.bin"):
        expect((place / "branched" / name).read_bytes() == (place / "uncut" / name).read_bytes(),
               f"{name} of a run that started from a state and was cut is another one")
    words[2] = place / "otherwise"
    run(*words[:-1], "0.2", "--resume", says=["another scene, or of other values of --set or --from", "the run begins"])

    # A run that is to go on in a folder that does not exist yet, nor its parent, begins.
    run(scene, "--out", place / "of" / "others" / "new", "--resume", says=["the run begins"])

    # A run that has ended has nothing left to do.
    before = contents(place / "whole")
    run(longer, "--out", place / "whole", "--resume", says=["has ended", "nothing was done"])
    expect(contents(place / "whole") == before, "--resume of a run that has ended changed its folder")
    run(longer, "--out", place / "whole", "--resume", "--replace", "--quiet")
    run(longer, "--out", place / "whole", "--resume", "--set", "/output/stride=2", says=["the run begins"])
for failure in failures:
    print("FAIL:", failure)
print(f"{len(failures)} failures")
sys.exit(1 if failures else 0)
