"""Failures injected by strace at the k-th write, fsync, rename, mkdir, open and mmap of verbs that write.

Every run has to end with a status that the manual names and with a message. Afterwards the former good results or
the new ones must be complete."""
import collections
import os
import pathlib
import random
import re
import shutil
import subprocess
import tempfile

from process import Outcome, faults_of
from process import run as run_program
from results import Bench

# System call: errors that it may meet.
CALLS = {"write": ("ENOSPC", "EIO"), "fsync": ("EIO", "ENOSPC"), "rename": ("EIO", "EACCES"),
         "renameat2": ("EIO", "EINVAL"),
         "mkdir": ("ENOSPC", "EACCES"), "openat": ("EMFILE", "EACCES"), "flock": ("EWOULDBLOCK", "ENOLCK"),
         "ftruncate": ("EIO",), "clone": ("EAGAIN",), "mmap": ("ENOMEM",)}
LOADER = ("openat", "mmap")  # the loader of the system makes these, too, before the program has a say


def add_arguments(parser):
    parser.add_argument("--faults-count", type=int, default=1500, help="faults (default: 1500, times --scale)")


def calls_of(program, words, place, folder):
    """Number of calls of each kind by a command, in the thread or process that makes most (strace counts each)."""
    trace = folder / "trace"
    subprocess.run(["strace", "-f", "-o", trace, "-e", "trace=" + ",".join(CALLS), program, *words], cwd=place,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    counts = collections.Counter()
    made = re.findall(r"^(\d+) +(\w+)\(", trace.read_text(errors="replace"), re.MULTILINE)
    for (_, call), count in collections.Counter(made).items():
        counts[call] = max(counts[call], count)
    return counts


def places_to_fail(program, commands, bench, folder):
    """(verb, call, number, error) of every call that the program makes itself."""
    loader = calls_of(program, ["--version"], bench.start(), folder)
    places = []
    for verb, (words, _) in commands.items():
        counts = calls_of(program, words, bench.start(), folder)
        for call, errors in CALLS.items():
            first = loader[call] + 1 if call in LOADER else 1
            places += [(verb, call, k, error) for k in range(first, counts[call] + 1) for error in errors]
    return places


def run(options):
    outcome = Outcome({"faults": 0, "met": 0})
    if shutil.which("strace") is None or subprocess.run(["strace", "-o", os.devnull, "true"], check=False).returncode:
        outcome.skipped = "strace cannot be used"
        return outcome
    draw = random.Random(options.seed)
    count = max(1, round(options.faults_count * options.scale))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        bench = Bench(options.program, folder)
        commands = bench.commands()
        places = places_to_fail(options.program, commands, bench, folder)
        chosen = draw.sample(places, min(count, len(places))) + draw.choices(places, k=max(0, count - len(places)))
        for number, (verb, call, k, error) in enumerate(chosen):
            words, folders = commands[verb]
            place, trace = bench.start(), folder / "trace"
            result = run_program(["strace", "-f", "-o", trace, "-e", f"trace={call}", "-e",
                                  f"inject={call}:error={error}:when={k}", options.program, *words], 60, cwd=place)
            is_met = "(INJECTED)" in trace.read_text(errors="replace")
            faults = faults_of(result)
            if call == "write":  # the write that failed may be the message itself
                faults = [fault for fault in faults if "without a word" not in fault]
            faults += bench.faults(folders)
            if number % 10 == 0 and not faults:
                faults += bench.faults_of_next(words, folders)
            outcome.counts["faults"] += 1
            outcome.counts["met"] += is_met
            outcome.failures += [f"{verb}, {error} at {call} {k}: {fault}" for fault in faults]
    return outcome
