"""Runs and sweeps cut at random moments and gone on with, again and again: in the end every file is that of a run that
was never cut, byte for byte, the summary apart from its times.

Half of the cuts of runs are SIGTERM or SIGUSR1, which a run answers with a checkpoint, the others SIGKILL. Between two
attempts a checkpoint is sometimes cut off, altered, or taken from another scene or program, or rows of the history
between the two are altered: it has to be refused by name, and the other one used. Cases of the sweeps take longer than the time between two kills."""
import json
import pathlib
import random
import shutil
import signal
import subprocess
import tempfile
import time

from process import Outcome

TIMES = {"time_s", "threads", "memory_peak_bytes"}
# By name: settings, and the time of the run between two checkpoints.
SCENES = {
    "slider_crank": (["/analysis/end_time=4"], 0.1),
    "slider_crank controlled": (["/analysis/end_time=5", '/analysis/step_control={"tolerance": 1e-6}'], 0.1),
    "slider_crank bdf": (["/analysis/end_time=4", "/analysis/integrator=bdf"], 0.1),
    "double_pendulum variational": (["/analysis/end_time=15", "/analysis/integrator=variational"], 0.5),
    "boom_servo": (["/analysis/end_time=4"], 0.1),
    "deep_arch": (["/analysis/arc_length/step=0.01", "/analysis/arc_length/largest_step=0.01",
                   "/analysis/arc_length/max_steps=100000"], 5.0),
}


def add_arguments(parser):
    parser.add_argument("--checkpoints-count", type=int, default=60, help="runs that are cut (default: 60, times --scale)")
    parser.add_argument("--checkpoints-sweeps", type=int, default=4, help="sweeps that are cut (default: 4, times --scale)")


def without_times(summary):
    data = json.loads(summary.read_text())
    for key in TIMES:
        data.pop(key, None)
    data.pop("files", None)
    data["origin"].pop("commit", None)
    data["solver"] = {k: v for k, v in data.get("solver", {}).items() if not k.endswith("_bytes")}
    return data


def differences(whole, resumed):
    """Files that are not the same, by name."""
    names = {str(p.relative_to(f)) for f in (whole, resumed) for p in f.rglob("*") if p.is_file()}
    wrong = []
    for name in sorted(names - {"manifest.json"}):
        a, b = whole / name, resumed / name
        if not a.exists() or not b.exists():
            wrong.append(f"{name} is in one of both alone")
        elif name == "summary.json":
            one, other = without_times(a), without_times(b)
            wrong += [f"summary: {key}: {str(one.get(key))[:200]} and {str(other.get(key))[:200]}"
                      for key in sorted(one.keys() | other.keys()) if one.get(key) != other.get(key)]
        elif a.read_bytes() != b.read_bytes():
            wrong.append(f"{name} differs")
    return wrong


def cut(words, which, delay):
    child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(delay)
    child.send_signal(which)
    _, said = child.communicate(timeout=120)
    return child.returncode, said


def checkpoint_files(folder):
    places = [folder.parent / f".{folder.name}.bough-new", folder, folder.parent / f"{folder.name}.failed"]
    for place in places:
        files = sorted(place.glob("checkpoint.[12]"), key=lambda f: int(f.read_bytes().split(b"\n", 1)[0].split(b",")[3]))
        if files:
            return files
    return []


def spoil(file, draw):
    """Returns what a run has to say of the file afterwards."""
    content = file.read_bytes()
    head, rest = content.split(b"\n", 1)
    words = head.split(b",")
    kind = draw.choice(["cut", "empty", "altered", "program", "scene", "version"])
    if kind == "cut":
        file.write_bytes(content[:draw.randrange(len(head) + 1, len(content))])
        return "cut off"
    if kind == "empty":
        file.write_bytes(b"")
        return "cut off"
    if kind == "altered":
        at = draw.randrange(len(rest))
        file.write_bytes(head + b"\n" + rest[:at] + bytes([rest[at] ^ 1]) + rest[at + 1:])
        return "damaged"
    place, said = {"program": (1, "another program"), "scene": (2, "another scene"),
                   "version": (0, "another version")}[kind]
    words[place] = b"bough checkpoint 0" if kind == "version" else b"0123456789abcdef"
    file.write_bytes(b",".join(words) + b"\n" + rest)
    return said


def spoil_output(files):
    """Alters what the history has got between the two checkpoints. Returns what a run has to say of the later one, or
    nothing where there are no such rows."""
    times = [float(f.read_bytes().split(b"\n", 1)[0].split(b",")[4]) for f in files]
    history = next((p for p in (files[-1].parent / "history.csv.partial", files[-1].parent / "history.csv") if p.exists()))
    content = history.read_bytes()
    at = content.index(b"\n") + 1
    while at < len(content):
        end = content.find(b"\n", at)
        if end < 0:
            return ""
        time_of_row = float(content[at:end].split(b",", 1)[0])
        if times[0] < time_of_row <= times[1]:
            last = content[end - 1]
            history.write_bytes(content[:end - 1] + (b"1" if last != ord("1") else b"2") + content[end:])
            return "not as it was"
        at = end + 1
    return ""


class Runs:
    def __init__(self, options, folder):
        self.program, self.folder, self.wholes = str(options.program), folder, {}
        self.scenarios = options.source / "data" / "scenarios"

    def words(self, name, out, extra=()):
        sets = [w for s in ["/output/motion=true", f"/output/checkpoint_time={SCENES[name][1]}", *SCENES[name][0]] for w in ("--set", s)]
        return [self.program, "run", str(self.scenarios / f"{name.split()[0]}.json"), "--out", str(out), *sets, *extra]

    def whole(self, name):
        """Of a run that is never cut, and its seconds."""
        if name not in self.wholes:
            out = self.folder / f"whole {name}"
            start = time.monotonic()
            done = subprocess.run(self.words(name, out, ["--quiet"]), capture_output=True, text=True)
            if done.returncode != 0:
                raise RuntimeError(f"{name}: {done.stderr}")
            self.wholes[name] = out, time.monotonic() - start
        return self.wholes[name]

    def cut_one(self, name, number, draw, counts):
        whole, seconds = self.whole(name)
        out = self.folder / f"cut {number}"
        faults = []
        extra = []
        for _ in range(draw.randint(1, 4)):
            which = draw.choice([signal.SIGTERM, signal.SIGUSR1, signal.SIGKILL, signal.SIGKILL])
            threads = ["--threads", str(draw.randint(1, 3))]
            code, said = cut(self.words(name, out, [*extra, *threads]), which, draw.uniform(0.02, 0.8 * seconds))
            counts["cuts"] += 1
            if which != signal.SIGKILL and code not in (0, 3, -which):
                faults.append(f"status {code} after {which.name}: {said[-300:]}")
            if which != signal.SIGKILL and code == 3 and "--resume goes on from time" not in said:
                faults.append("it does not say how to go on")
            if code == 0:
                break
            extra = ["--resume"]
            files = checkpoint_files(out)
            if len(files) == 2 and draw.random() < 0.5:
                expected = spoil_output(files) if draw.random() < 0.3 else ""
                counts["altered outputs"] += 1 if expected else 0
                expected = expected or spoil(files[-1], draw)
                counts["spoiled checkpoints"] += 1
                code, said = cut(self.words(name, out, [*extra, *threads]), signal.SIGTERM, draw.uniform(0.1, 0.5 * seconds))
                if code not in (0, -signal.SIGTERM) and (files[-1].name not in said or expected not in said):
                    faults.append(f"{files[-1].name} was spoiled ({expected}), and it said: {said[-300:]}")
                if "begins" in said:
                    faults.append("it did not use the other checkpoint")
        done = subprocess.run(self.words(name, out, ["--resume", "--quiet"]), capture_output=True, text=True)
        if done.returncode != 0:
            faults.append(f"status {done.returncode} of the last --resume: {done.stderr[-300:]}")
        else:
            counts["gone on with"] += 1
            faults += differences(whole, out)
        # What was killed before its first checkpoint is kept beside the run that begins.
        left = [p.name for p in self.folder.glob(f"*cut {number}*") if p != out and ".failed" not in p.name]
        if left:
            faults.append(f"left behind: {left}")
        for kept in self.folder.glob(f"*cut {number}*"):
            shutil.rmtree(kept, ignore_errors=True)
        return faults


def cut_sweep(runs, number, draw, counts):
    """A sweep whose cases take longer than the time between two kills."""
    place = runs.folder / f"sweep{number}"
    place.mkdir()
    scene = json.loads((runs.scenarios / "slider_crank.json").read_text())
    scene["analysis"]["end_time"] = 2.0
    scene["parameters"] = {"g": 9.81}
    scene["gravity"] = [0, 0, {"expression": "-g"}]
    scene.pop("expected", None)
    scene["output"] = {"checkpoint_time": 0.02}
    (place / "scene.json").write_text(json.dumps(scene))
    (place / "sweep.json").write_text(json.dumps({
        "schema_version": 1, "scene": "scene.json",
        "designs": [{"kind": "grid", "variables": [{"name": "g", "values": [9.81, 5.0, 1.0]}]}]}))
    words = [runs.program, "sweep", str(place / "sweep.json"), "--quiet", "--threads", "2", "--out"]
    start = time.monotonic()
    done = subprocess.run([*words, str(place / "whole")], capture_output=True, text=True)
    seconds = time.monotonic() - start
    if done.returncode != 0:
        return [f"the sweep failed: {done.stderr[-500:]}"]
    kills = 0
    while kills < 60:
        extra = ["--resume"] if kills else []
        child = subprocess.Popen([*words, str(place / "cut"), *extra], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            child.communicate(timeout=draw.uniform(0.15, 0.3) * seconds)
        except subprocess.TimeoutExpired:
            child.send_signal(draw.choice([signal.SIGKILL, signal.SIGTERM]))
            child.communicate()
            kills += 1
            continue
        break
    counts["kills of sweeps"] += kills
    faults = [f"status {child.returncode}"] if child.returncode != 0 else []
    for case in ("1", "2", "3"):
        if not (place / "cut" / case).exists():
            faults.append(f"no folder of case {case}")
            continue
        faults += [f"case {case}: {d}" for d in differences(place / "whole" / case, place / "cut" / case)]
    shutil.rmtree(place)
    return faults


def run(options):
    outcome = Outcome({"cuts": 0, "gone on with": 0, "spoiled checkpoints": 0, "altered outputs": 0, "kills of sweeps": 0})
    draw = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(options, pathlib.Path(folder))
        names = list(SCENES)
        for number in range(max(1, round(options.checkpoints_count * options.scale))):
            name = names[number % len(names)]
            outcome.failures += [f"{name}: {fault}" for fault in runs.cut_one(name, number, draw, outcome.counts)]
        for number in range(max(1, round(options.checkpoints_sweeps * options.scale))):
            outcome.failures += [f"sweep: {fault}" for fault in cut_sweep(runs, number, draw, outcome.counts)]
    return outcome
