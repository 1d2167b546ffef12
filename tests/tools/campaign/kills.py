"""Processes killed at random moments: verbs that write, ended by SIGKILL or SIGTERM from the first instruction to
after the last.

Afterwards no process may be left, no file may be incomplete under its final name, the former good results or the new
ones must be complete, and the next run must work as usual."""
import os
import pathlib
import random
import signal
import subprocess
import tempfile
import time

from process import Outcome
from results import Bench


def add_arguments(parser):
    parser.add_argument("--kills-count", type=int, default=300, help="kills (default: 300, times --scale)")


def seconds_of(program, words, place):
    start = time.monotonic()
    subprocess.run([program, *words], cwd=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    return time.monotonic() - start


def members_of(group):
    """Processes of a group that still run."""
    running = []
    for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(fields[2]) == group and fields[0] not in "ZX":
            running.append(int(path.parent.name))
    return running


def kill_once(program, words, place, which, delay):
    """Faults of the processes themselves."""
    child = subprocess.Popen([program, *words], cwd=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                             start_new_session=True)
    time.sleep(delay)
    child.send_signal(which)
    try:
        child.wait(20)
    except subprocess.TimeoutExpired:
        os.killpg(child.pid, signal.SIGKILL)
        child.wait()
        return ["it did not end within 20 s of the signal"]
    for _ in range(100):
        left = members_of(child.pid)
        if not left:
            return []
        time.sleep(0.01)
    os.killpg(child.pid, signal.SIGKILL)
    return [f"{len(left)} processes outlive it"]


def run(options):
    outcome = Outcome({"kills": 0})
    draw = random.Random(options.seed)
    count = max(1, round(options.kills_count * options.scale))
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.program, folder, end_time=2.0)
        commands = bench.commands()
        seconds = {verb: seconds_of(options.program, words, bench.start()) for verb, (words, _) in commands.items()}
        for number in range(count):
            verb = draw.choice(["run", "run", "batch", "batch", "study", "view"])
            words, folders = commands[verb]
            which = signal.SIGKILL if draw.random() < 0.7 else signal.SIGTERM
            delay = draw.uniform(0.0, 1.1 * seconds[verb])
            place = bench.start()
            faults = kill_once(options.program, words, place, which, delay)
            faults += bench.faults(folders)
            if number % 3 == 0 and not faults:
                faults += bench.faults_of_next(words, folders)
            outcome.counts["kills"] += 1
            outcome.failures += [f"{verb}, {which.name} after {delay:.4f} s: {fault}" for fault in faults]
    return outcome
