"""Races: every scene of data/ on four threads, four scenes beside each other in one process, under the thread
sanitizer. Needs the test program of preset tsan:

    sh cmake/build_tsan_tbb.sh && cmake --preset tsan && cmake --build build/tsan --target test_run_threads
    python3 tests/tools/campaign --program build/release/bough races --races-test build/tsan/tests/test_run_threads"""
import os
import pathlib
import re
import shutil
import subprocess

from process import Outcome


def add_arguments(parser):
    parser.add_argument("--races-test", type=pathlib.Path, help="test_run_threads, built with the thread sanitizer")
    parser.add_argument("--races-steps", type=int, default=6, help="steps of every scene (default: 6, times --scale)")


def run(options):
    outcome = Outcome({"scenes": 0, "races": 0})
    if options.races_test is None:
        outcome.skipped = "--races-test names no test program"
        return outcome
    steps = max(1, round(options.races_steps * options.scale))
    words = [str(options.races_test.resolve()), "--gtest_filter=Threads.scenes_beside_each_other*"]
    bits = pathlib.Path("/proc/sys/vm/mmap_rnd_bits")
    if bits.exists() and int(bits.read_text()) > 28 and shutil.which("setarch"):  # as in .ci/sections.bash
        words = ["setarch", "-R", *words]
    done = subprocess.run(words, capture_output=True, text=True, env={
        **os.environ, "BOUGH_TEST_STEPS": str(steps), "TSAN_OPTIONS": "halt_on_error=0 second_deadlock_stack=1"})
    said = done.stdout + done.stderr
    scenes = options.source / "data"
    outcome.counts["scenes"] = len([*scenes.glob("scenarios/*.json"), *scenes.glob("gallery/*.json")])
    races = re.findall(r"SUMMARY: ThreadSanitizer: .*", said)
    outcome.counts["races"] = len(races)
    outcome.failures += sorted(set(races))
    if done.returncode != 0 and not races:
        outcome.failures.append(f"status {done.returncode}: {said[-500:]}")
    return outcome
