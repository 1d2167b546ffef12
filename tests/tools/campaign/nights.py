"""A sweep of many minutes whose every case takes longer than the time between two kills: gone on with by --resume until
it is done, it has the tables and the folders of one that was never cut, byte for byte, summaries apart from times.

This is what a queue with short slots, or a machine that is switched off at night, makes of a sweep."""
import json
import pathlib
import random
import shutil
import signal
import subprocess
import tempfile
import time

from checkpoints import differences
from process import Outcome

TABLES = ("batch.csv", "batch.json", "cases.csv", "keys.csv")


def add_arguments(parser):
    parser.add_argument("--nights-kills", type=int, default=40, help="kills of the sweep (default: 40, times --scale)")
    parser.add_argument("--nights-case", type=float, default=50.0, help="seconds that a case takes (default: 50)")


def write_sweep(options, place, end_time, cases):
    scene = json.loads((options.source / "data" / "scenarios" / "slider_crank.json").read_text())
    scene["analysis"]["end_time"] = end_time
    scene["parameters"] = {"g": 9.81}
    scene["gravity"] = [0, 0, {"expression": "-g"}]
    scene.pop("expected", None)
    scene["output"] = {"stride": 20, "checkpoint": 1.0}
    (place / "scene.json").write_text(json.dumps(scene))
    (place / "sweep.json").write_text(json.dumps({
        "schema_version": 1, "scene": "scene.json",
        "designs": [{"kind": "grid", "variables": [{"name": "g", "values": [1.0 + 1.5 * k for k in range(cases)]}]}]}))
    return [str(options.program), "sweep", str(place / "sweep.json"), "--quiet", "--threads", "1", "--out"]


def seconds_of(words, out):
    start = time.monotonic()
    done = subprocess.run([*words, str(out)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"the sweep failed: {done.stderr[-500:]}")
    return time.monotonic() - start


def cut_again_and_again(words, out, kills, draw, between):
    """Kills it so often, as long as it is not done. Returns kills, the last status, and what cases were cut."""
    done, code = 0, None
    while done < kills:
        child = subprocess.Popen([*words, str(out), *(["--resume"] if done else [])], stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True)
        try:
            child.communicate(timeout=draw.uniform(*between))
            code = child.returncode
            break
        except subprocess.TimeoutExpired:
            child.send_signal(signal.SIGKILL if draw.random() < 0.7 else signal.SIGTERM)
            child.communicate()
            done += 1
    if code is None:
        code = subprocess.run([*words, str(out), "--resume"], capture_output=True).returncode
    return done, code


def run(options):
    outcome = Outcome({"kills of a long sweep": 0, "cases": 0, "seconds": 0})
    draw = random.Random(options.seed)
    kills = max(1, round(options.nights_kills * options.scale))
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        probe = 4.0
        words = write_sweep(options, place, probe, 1)
        rate = seconds_of(words, place / "probe") / probe
        between = (0.12 * options.nights_case, 0.25 * options.nights_case)
        # The work of a case since its last checkpoint is lost at a kill, and none if it is stopped.
        cases = max(2, round(kills * (sum(between) / 2 - 1.0) / options.nights_case) + 1)
        shutil.rmtree(place / "probe")
        words = write_sweep(options, place, options.nights_case / rate, cases)
        seconds_of(words, place / "whole")
        start = time.monotonic()
        done, code = cut_again_and_again(words, place / "cut", kills, draw, between)
        outcome.counts.update({"kills of a long sweep": done, "cases": cases, "seconds": round(time.monotonic() - start)})
        if code != 0:
            outcome.failures.append(f"status {code} of the last --resume")
        for name in TABLES:
            a, b = place / "whole" / name, place / "cut" / name
            if not b.exists() or a.read_bytes() != b.read_bytes():
                outcome.failures.append(f"{name} is not that of a sweep that was never cut")
        for k in range(1, cases + 1):
            outcome.failures += [f"case {k}: {d}" for d in differences(place / "whole" / str(k), place / "cut" / str(k))]
    return outcome
