"""Random inputs: mutations of scenes, studies, motions, chains of frames, and --set. Most go to the readers within one
process (fuzz_inputs, built with the tests), which also runs small scenes for some steps; a share goes to the program
itself. --scale 1 is 100 000 and 2000 inputs.

Every input has to be processed in 2 s of processor time and 512 MB, with exit status 0, 1 or 2 and with messages
that are safe for a terminal. A run with status ok must contain only finite numbers."""
import json
import math
import pathlib
import random
import re
import subprocess
import tempfile

import mutate
import process

SECONDS, MEGABYTES = 2.0, 512
SMALL = [
    {"schema_version": 1, "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
     "sections": [{"name": "s", "stiffness": [1e6, 1e6, 1e6, 1e3, 1e3, 1e3],
                   "mass": {"mass_per_length": 1, "rotary": [1e-3, 5e-4, 5e-4]}}],
     "beams": [{"name": "bar", "section": "s", "start": "a", "end": "b", "elements": 2}],
     "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a", "position": [0, 0, 0]}],
     "loads": [{"name": "push", "at": "b", "force": [0, 1, 0], "law": {"expression": "abs(sin(9*t))"}}],
     "sensors": [{"name": "tip", "kind": "position", "at": "b"}],
     "expected": [{"quantity": "tip.x", "value": 1, "tolerance": 1, "source": "none"}],
     "analysis": {"kind": "dynamic", "end_time": 0.01, "step_size": 0.001}},
    {"schema_version": 1, "gravity": [0, 0, -9.81],
     "frames": [{"name": "table", "position": [0, 0, 0], "turns": [{"axis": [0, 0, 1],
                                                                    "angle": {"expression": "2*t"}}]}],
     "bodies": [{"name": "p", "mass": 1, "inertia": [0.1, 0.2, 0.25], "position": [1, 0, 0]},
                {"name": "q", "kind": "point_mass", "mass": 2, "position": [2, 0, 0]}],
     "joints": [{"name": "h", "kind": "revolute", "first": "table", "second": "p", "position": [0, 0, 0],
                 "axis": [0, 1, 0],
                 "drives": [], "forces": [{"stiffness": 10, "damping": 0.1}]}],
     "springs": [{"name": "k", "first": "p", "second": "q", "stiffness": 100}],
     "motions": [{"name": "m", "at": "q", "x": {"kind": "harmonic", "amplitude": 0.1, "omega": 3}}],
     "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "h"}, {"name": "e", "kind": "total_energy"}],
     "analysis": {"kind": "dynamic", "end_time": 0.02, "step_size": 0.002}},
    {"schema_version": 1, "parameters": {"N": 3, "M": {"expression": "N - 1"}, "L": {"expression": "1/M"}},
     "repeat": [{"index": "i", "count": {"expression": "N"},
                 "bodies": [{"name": "p {i}", "mass": {"expression": "L + i"}, "inertia": [0.1, 0.2, 0.25],
                             "position": [{"expression": "i*L"}, 0, 0]}],
                 "repeat": [{"index": "j", "first": 1, "count": {"expression": "i"},
                             "loads": [{"at": "p {i}", "force": [0, 1, 0], "law": {"expression": "L*sin(j*t)"}}]}]},
                {"index": "i", "count": {"expression": "M"},
                 "springs": [{"name": "k {i}", "first": "p {i}", "second": "p {i+1}", "stiffness": 100}]}],
     "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "p {N-1}"}],
     "sensors": [{"name": "end", "kind": "position", "at": "p 0"}],
     "analysis": {"kind": "dynamic", "end_time": 0.02, "step_size": 0.002}},
]


def add_arguments(parser):
    parser.add_argument("--fuzz-inputs", type=pathlib.Path,
                        help="program fuzz_inputs (default: tests/fuzz_inputs beside the program)")


def corpus(source):
    """(kind, text) of every seed, and all keys in them."""
    seeds = [("scene", json.dumps(scene).encode()) for scene in SMALL] * 4
    seeds += [("scene", path.read_bytes()) for path in sorted((source / "data/scenarios").glob("*.json"))]
    seeds += [("study", path.read_bytes()) for path in sorted((source / "data/studies").glob("*.json"))]
    seeds += [("sweep", path.read_bytes()) for path in sorted((source / "data/sweeps").glob("*.json"))] * 4
    seeds += [("frames", json.dumps({
        "schema_version": 1, "frames": [{"name": "shaft", "turns": [{"axis": [0, 0, 1],
                                                                     "angle": {"expression": "t"}}]},
                                        {"name": "disc", "position": [0, {"expression": "t"}, 0],
                                         "turns": [{"axis": [1, 0, 0], "angle": 0.5}]}],
        "point": {"position": [1, 0, 0]}, "time": {"start": 0, "end": 1, "points": 5}}).encode())] * 4
    seeds += [("motion", json.dumps({"schema_version": 1, "to": {"position": [1, 2, 3],
                                                                 "rotation": {"axis": [0, 0, 1],
                                                                              "angle": 1}}}).encode())] * 4
    keys = sorted({key.decode() for _, text in seeds for key in re.findall(rb'"([a-z_0-9]+)"\s*:', text)})
    return seeds, keys


def make_inputs(generator, seeds, keys, count):
    for _ in range(count):
        kind, text = generator.choice(seeds)
        overrides = []
        way = generator.randrange(10)
        if way < 2:
            text = mutate.of_bytes(generator, text)
        elif way < 5:
            text = mutate.of_tokens(generator, text)
        elif kind == "scene" and way < 7:
            overrides = mutate.of_overrides(generator, text, keys)
        else:
            text = mutate.of_structure(generator, text, keys)
        yield kind, text, overrides


def encoded(kind, text, overrides):
    blocks = [text] + [override.encode("utf-8", "replace") for override in overrides]
    return f"{kind} {len(overrides)}\n".encode() + b"".join(f"{len(b)}\n".encode() + b for b in blocks) + b"\n"


class Readers:
    """The process fuzz_inputs, which is started again after an input that ends it."""

    def __init__(self, program, folder):
        self.command = [str(program), str(folder)]
        self.child = None

    def answer(self, given):
        if self.child is None or self.child.poll() is not None:
            self.child = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                          stderr=subprocess.DEVNULL)
        try:
            self.child.stdin.write(given)
            self.child.stdin.flush()
            words = self.child.stdout.readline().decode("utf-8", "replace").rstrip("\n").split(" ", 3)
        except BrokenPipeError:
            words = []
        if len(words) < 4:
            self.child.kill()
            status = self.child.wait()
            return "refused", f"the process ended with status {status}"
        fault = words[3]
        if float(words[1]) > SECONDS:
            fault = f"{words[1]} s of processor time {fault}"
        if float(words[2]) > MEGABYTES:
            fault = f"{words[2]} MB {fault}"
            self.close()  # the peak stays
        return words[0], fault

    def close(self):
        if self.child is not None:
            self.child.stdin.close()
            self.child.wait()
            self.child = None


def keep(options, number, text):
    if options.keep is None:
        return ""
    options.keep.mkdir(parents=True, exist_ok=True)
    file = options.keep / f"fuzz_{options.seed}_{number}.bin"
    file.write_bytes(text)
    return f", kept as {file}"


def run_readers(options, outcome, seeds, keys):
    program = options.fuzz_inputs or options.program.parent / "tests" / "fuzz_inputs"
    if not program.exists():
        outcome.skipped = f"there is no program {program}"
        return
    generator = random.Random(options.seed)
    readers = Readers(program, options.source / "data/studies")
    count = math.ceil(100_000 * options.scale)
    accepted = 0
    for number, (kind, text, overrides) in enumerate(make_inputs(generator, seeds, keys, count)):
        given = encoded(kind, text, overrides)
        status, fault = readers.answer(given)
        accepted += status == "ok"
        if fault:
            outcome.failures.append(f"{kind}, seed {options.seed}, input {number}: {fault}"
                                    f"{keep(options, number, given)}")
    readers.close()
    outcome.counts["inputs in one process"] = count
    outcome.counts["of them sound"] = accepted


def command_for(generator, kind, file, overrides, folder):
    sets = [word for override in overrides for word in ("--set", override)]
    if kind == "frames":
        return ["kinematics", "razi", "--chain", file]
    if kind == "motion":
        return ["kinematics", "motion", file]
    if kind == "study":
        return ["check", file]
    verb = generator.choice(("check", "check", "run", "plan"))
    if verb == "run":
        sets += ["--set", "/analysis/end_time=0.001", "--out", folder / "out", "--replace", "--quiet"]
    return [verb, file] + sets


def run_program(options, outcome, seeds, keys):
    generator = random.Random(options.seed + 1)
    count = math.ceil(2000 * options.scale)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        file = folder / "input.json"
        for number, (kind, text, overrides) in enumerate(make_inputs(generator, seeds, keys, count)):
            file.write_bytes(text)
            command = command_for(generator, kind, file, [o for o in overrides if "\0" not in o], folder)
            result = process.run([options.program] + command, 3.0 if command[0] == "run" else 60.0, cwd=folder)
            if result.timed_out and command[0] == "run":  # a run may be long
                continue
            faults = process.faults_of(result)
            if command[0] == "check" and result.cpu_seconds > SECONDS:
                faults.append(f"check took {result.cpu_seconds:.1f} s of processor time")
            if command[0] == "check" and result.megabytes > MEGABYTES:
                faults.append(f"check took {result.megabytes:.0f} MB")
            if faults:
                outcome.failures.append(f"{command[0]} of a {kind}, seed {options.seed}, program's input {number}: "
                                        f"{'; '.join(faults)}{keep(options, 10**9 + number, text)}")
    outcome.counts["inputs of the program"] = count


def run(options):
    outcome = process.Outcome()
    seeds, keys = corpus(options.source)
    run_readers(options, outcome, seeds, keys)
    run_program(options, outcome, seeds, keys)
    return outcome
