"""One run of the program: its arguments, its limits, and its outcome."""
import dataclasses
import os
import re
import resource
import signal
import subprocess
import tempfile
import threading
import time

GOOD_STATUSES = (0, 1, 2)  # done, failed, bad input: those that the manual names
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")  # all but tabs and ends of lines


@dataclasses.dataclass
class Outcome:
    """The findings of a part of a campaign. A failure is a line of text that says how to reproduce it."""
    counts: dict = dataclasses.field(default_factory=dict)
    failures: list = dataclasses.field(default_factory=list)
    skipped: str = ""


@dataclasses.dataclass
class Result:
    status: int        # of the exit; below 0: ended by this signal
    out: bytes
    err: bytes
    seconds: float
    cpu_seconds: float
    megabytes: float   # largest resident set
    timed_out: bool


def run(command, seconds, cwd=None, limits=None, stdin=b"", environment=None):
    """Runs a command for at most `seconds`. limits: {resource.RLIMIT_...: value}."""
    def set_limits():
        os.setpgid(0, 0)
        for which, value in (limits or {}).items():
            resource.setrlimit(which, (value, value))

    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err, tempfile.TemporaryFile() as given:
        given.write(stdin)
        given.seek(0)
        start = time.monotonic()
        child = subprocess.Popen([str(word) for word in command], stdin=given, stdout=out, stderr=err, cwd=cwd,
                                 preexec_fn=set_limits, env={**os.environ, **(environment or {})})
        expired = threading.Event()

        def stop():
            expired.set()
            try:
                os.killpg(child.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

        timer = threading.Timer(seconds, stop)
        timer.start()
        _, status, usage = os.wait4(child.pid, 0)
        timer.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        elapsed = time.monotonic() - start
        out.seek(0)
        err.seek(0)
        return Result(child.returncode, out.read(), err.read(), elapsed, usage.ru_utime + usage.ru_stime,
                      usage.ru_maxrss / 1024, expired.is_set())


def faults_of(result, what="the program"):
    """Faults of a run: undocumented exit status, crash, hang, bytes unsafe for a terminal, no message."""
    faults = []
    if result.timed_out:
        return [f"{what} did not end within {result.seconds:.1f} s"]
    if result.status not in GOOD_STATUSES:
        faults.append(f"exit status {result.status}")
    for name, text in (("output", result.out), ("messages", result.err)):
        try:
            if CONTROL.search(text.decode("utf-8")):
                faults.append(f"{name} hold control characters")
        except UnicodeDecodeError:
            faults.append(f"{name} are not UTF-8")
    if result.status in (1, 2) and not result.err.strip() and not result.out.strip():
        faults.append("a failure without a word")
    return faults
