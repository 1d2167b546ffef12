#!/usr/bin/env python3
"""check_resume.py PROGRAM SCENARIOS KILLS   kills a sweep and a batch at random moments and goes on with --resume: the
tables are those of an undisturbed run, byte for byte, whatever the moment. A stop by SIGTERM ends with status 3."""
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

program, scenarios, kills = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve(), int(sys.argv[3])
TABLES = ["batch.csv", "batch.json", "batch.html"]
draw = random.Random(28)
failures = []


def run(words):
    """Its status, followed by what it said if it failed."""
    done = subprocess.run([program, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    return "0" if done.returncode == 0 else f"{done.returncode} ({done.stderr[-300:].strip()})"


def disturb(words, out, whole, seconds):
    """Kills one run at a random moment, then again while it goes on, and lets it end."""
    for attempt in range(draw.randint(1, 3)):
        child = subprocess.Popen([program, *words, "--out", out, *(["--resume"] if attempt > 0 else [])],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(draw.uniform(0.0, seconds))
        which = signal.SIGKILL if draw.random() < 0.7 else signal.SIGTERM
        child.send_signal(which)
        status = child.wait()
        if which == signal.SIGTERM and status not in (0, 3, -signal.SIGTERM):
            failures.append(f"{words[0]}: status {status} after SIGTERM")
    status = run([*words, "--out", out, "--resume"])
    if status != "0":
        failures.append(f"{words[0]}: status {status} of --resume")
    for name in TABLES:
        table = pathlib.Path(out) / name
        if not table.exists() or table.read_bytes() != (whole / name).read_bytes():
            failures.append(f"{words[0]}: {name} is not that of an undisturbed run")


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    scenes = folder / "scenes"
    scenes.mkdir()
    for name in ["pendulum", "double_pendulum", "elastica", "helix", "lattice", "free_body"]:
        shutil.copy(scenarios / f"{name}.json", scenes)
    sweep = str(scenarios.parent / "sweeps" / "rod_chain_lengths.json")
    commands = [["sweep", sweep, "--quiet", "--threads", "2"], ["sweep", sweep, "--quiet", "--keep", "none"],
                ["batch", str(scenes), "--quiet", "--threads", "2"]]
    for number, words in enumerate(commands):
        whole = folder / f"whole{number}"
        start = time.monotonic()
        if run([*words, "--out", str(whole)]) != "0":
            failures.append(f"{words[0]}: the undisturbed run failed")
        seconds = time.monotonic() - start
        for k in range(kills // len(commands) + 1):
            disturb(words, str(folder / f"out{number}_{k}"), whole, 1.2 * seconds)
        # Nothing is run again where all is done, and something is where the scene is another.
        before = (whole / "journal.jsonl").read_text().count("\n")
        run([*words, "--out", str(whole), "--resume"])
        if (whole / "journal.jsonl").read_text().count("\n") != before:
            failures.append(f"{words[0]}: cases that were done ran again")
        run([*words, "--out", str(whole), "--resume", "--set", "/output/stride=2"])
        if (whole / "journal.jsonl").read_text().count("\n") != 2 * before:
            failures.append(f"{words[0]}: results of other cases were taken for those asked for")
for failure in failures:
    print("FAIL:", failure)
print(f"{kills} kills, {len(failures)} failures")
sys.exit(1 if failures else 0)
