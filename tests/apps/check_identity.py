#!/usr/bin/env python3
"""check_identity.py PROGRAM [COUNT]   stops a sweep or a batch at a random moment, changes it, and goes on with --resume. The
tables, the folders of the cases, the stores and what `view --case` draws are then those of the changed sweep made in one
go, whatever the change is: cases are found by what they are made of, not by their names. COUNT: so many of the changes, drawn at random."""
import json
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

program = str(pathlib.Path(sys.argv[1]).resolve())
draw = random.Random(51)
failures = []
TABLES = ["batch.csv", "batch.json", "batch.html", "keys.csv"]
SCENE = {"schema_version": 1, "gravity": [0, -9.81, 0], "parameters": {"l": 1, "m": 1},
         "bodies": [{"name": "bob", "kind": "point_mass", "mass": {"expression": "m"},
                     "position": [{"expression": "-l"}, 0, 0]}],
         "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
                     "axis": [0, 0, 1]}],
         "sensors": [{"name": "bob", "kind": "position", "at": "bob"}],
         "output": {"motion": True, "motion_stride": 100},
         "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.002}}


def listed(name, values):
    return {"name": name, "values": values}


class Sweep:
    """A sweep, or a batch of as many scenes, as files in a folder."""

    def __init__(self, folder, values):
        self.folder, self.values, self.words, self.out = folder, values, [], folder / "out"
        self.scene, self.scene_name = json.loads(json.dumps(SCENE)), "scene.json"
        self.spec = {"schema_version": 1, "measures": [{"name": "low", "quantity": "bob.y", "figure": "min"}]}
        self.others, self.after = [], None
        folder.mkdir()

    def write(self):
        (self.folder / self.scene_name).write_text(json.dumps(self.scene))
        self.spec["scene"] = self.scene_name
        self.spec["designs"] = [{"kind": "grid", "variables": [listed("l", self.values), *self.others]}]
        (self.folder / "sweep.json").write_text(json.dumps(self.spec))

    def command(self, out):
        return [program, "sweep", str(self.folder / "sweep.json"), "--out", str(out), "--quiet", *self.words]


class Batch(Sweep):
    def write(self):
        shutil.rmtree(self.folder / "scenes", ignore_errors=True)
        (self.folder / "scenes").mkdir()
        for k, value in enumerate(self.values):
            self.scene["parameters"]["l"] = value
            (self.folder / "scenes" / f"case{k}.json").write_text(json.dumps(self.scene))

    def command(self, out):
        return [program, "batch", str(self.folder / "scenes"), "--out", str(out), "--quiet", *self.words]


def values_changed(change):
    def apply(sweep):
        sweep.values = change(list(sweep.values))
    return apply


def scene_changed(change):
    return lambda sweep: change(sweep.scene)


def words_added(*words):
    return lambda sweep: sweep.words.extend(words)


def renamed(sweep):
    (sweep.folder / "scene.json").rename(sweep.folder / "other.json")
    sweep.scene_name = "other.json"


def moved(sweep):
    sweep.out = sweep.out.rename(sweep.folder / "elsewhere")


def folder_lost(sweep):
    for folder in sorted(sweep.out.glob("*/summary.json"))[:2]:
        shutil.rmtree(folder.parent)


def store_cut(sweep):
    for store in sweep.out.glob("store_*.pack"):
        store.write_bytes(store.read_bytes()[:store.stat().st_size * 2 // 3])


def file_emptied(name):
    def apply(sweep):
        if (sweep.out / name).exists():
            (sweep.out / name).write_bytes(b"")
    return apply


def case_seen(sweep):
    """The folder of a stored case is made, and then the cases get other names."""
    for name in ["002", "2", "case2"]:
        subprocess.run([program, "view", str(sweep.out), "--case", name], capture_output=True, check=False)
    sweep.values = sweep.values[1:]


def shuffled(values):
    return draw.sample(values, len(values))


def others(sweep):
    sweep.others = [listed("m", [1, 2])]


CHANGES = {
    "nothing": lambda sweep: None,
    "a value before the others": values_changed(lambda v: [0.35, *v]),
    "a value after the others": values_changed(lambda v: [*v, 0.35]),
    "a value between the others": values_changed(lambda v: [*v[:3], 0.35, *v[3:]]),
    "without the first": values_changed(lambda v: v[1:]),
    "without the last": values_changed(lambda v: v[:-1]),
    "without one between": values_changed(lambda v: [*v[:2], *v[3:]]),
    "in reverse": values_changed(lambda v: v[::-1]),
    "in a circle": values_changed(lambda v: [*v[1:], v[0]]),
    "two exchanged": values_changed(lambda v: [v[1], v[0], *v[2:]]),
    "shuffled": values_changed(shuffled),
    "one twice": values_changed(lambda v: [v[0], *v]),
    "one replaced": values_changed(lambda v: [*v[:2], 0.35, *v[3:]]),
    "all replaced": values_changed(lambda v: [x + 0.001 for x in v]),
    "half as many": values_changed(lambda v: v[::2]),
    "twice as many": values_changed(lambda v: [y for x in v for y in (x, x + 0.003)]),
    "one alone": values_changed(lambda v: v[-1:]),
    "another gravity": scene_changed(lambda s: s.update(gravity=[0, -1.62, 0])),
    "other steps": scene_changed(lambda s: s["analysis"].update(step_size=0.004)),
    "another sensor": scene_changed(lambda s: s["sensors"].append({"name": "v", "kind": "velocity", "at": "bob"})),
    "a comment": scene_changed(lambda s: s.update(comment="none")),
    "a fault": scene_changed(lambda s: s["bodies"][0].update(position=[{"expression": "-l/(l - 0.5)"}, 0, 0])),
    "all folders": words_added("--keep", "all"),
    "no results": words_added("--keep", "none"),
    "a stride": words_added("--set", "/output/stride=5"),
    "tries": words_added("--retries", "1"),
    "one thread": words_added("--threads", "1"),
    "a folder moved": moved,
    "folders lost": folder_lost,
    "stores cut": store_cut,
    "an empty manifest": file_emptied("manifest.json"),
    "keys lost": lambda sweep: (sweep.out / "keys.csv").unlink(missing_ok=True),
    "a case seen": case_seen,
}
OF_SWEEPS = {
    "a scene of another name": renamed,
    "a second variable": others,
    "another title": lambda sweep: sweep.spec.update(title="another"),
    "another measure": lambda sweep: sweep.spec["measures"].append({"name": "x", "quantity": "bob.x", "figure": "max"}),
    "few cases become many": values_changed(lambda v: [*v, *(2 + 0.01 * k for k in range(220))]),
    "many cases become few": values_changed(lambda v: v[-6:]),
}


def fail(what, text):
    failures.append(f"{what}: {text}")


def stop(sweep, seconds):
    """Runs the sweep, and stops it at a random moment, or not."""
    child = subprocess.Popen(sweep.command(sweep.out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(draw.uniform(0.3, 1.3) * seconds)
    child.send_signal(draw.choice([signal.SIGKILL, signal.SIGTERM]))
    child.wait()


def key_of(folder):
    try:
        return json.loads((folder / "manifest.json").read_text()).get("key")
    except (OSError, ValueError):
        return None


def history_seen(what, out, name, page):
    """The history of the folder that `view --case` draws; None where it refuses."""
    done = subprocess.run([program, "view", str(out), "--case", name, "--out", str(page)], capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        return None
    return (out / name / "history.csv").read_bytes()


def compare(what, sweep, fresh, page):
    for table in TABLES:
        if not (sweep.out / table).exists() or (sweep.out / table).read_bytes() != (fresh / table).read_bytes():
            fail(what, f"{table} is not that of the sweep made in one go")
            return
    keys = dict(line.split(",") for line in (sweep.out / "keys.csv").read_text().splitlines()[1:])
    for folder in sweep.out.iterdir():
        if folder.is_dir() and keys.get(folder.name) != key_of(folder):
            fail(what, f"the folder {folder.name} is not of the case of this name")
    rows = {line.split(",")[0]: line.split(",")[1] for line in (sweep.out / "batch.csv").read_text().splitlines()[1:]}
    kept_none = "none" in sweep.words
    for name in draw.sample(sorted(keys), min(5, len(keys))):
        if not kept_none and rows[name] == "ok" and history_seen(what, fresh, name, page) is None:
            fail(what, f"no results of {name} of the sweep made in one go")
        if kept_none:
            continue
        if history_seen(what, sweep.out, name, page) != history_seen(what, fresh, name, page):
            fail(what, f"view --case {name} draws another case")
        folder = sweep.out / name
        if folder.exists() and (json.loads((folder / "summary.json").read_text())["status"] == "ok") != (rows[name] == "ok"):
            fail(what, f"the folder of {name} holds an attempt that was stopped")
    if list(sweep.out.glob(".*")):
        fail(what, f"left behind: {list(sweep.out.glob('.*'))}")


count = 0
with tempfile.TemporaryDirectory() as place:
    place = pathlib.Path(place)
    few, many = [0.1 + 0.1 * k for k in range(8)], [0.1 + 0.002 * k for k in range(210)]
    plans = [(kind, values, change, apply) for kind, values, changes in
             [(Sweep, few, CHANGES | OF_SWEEPS), (Batch, few, CHANGES), (Sweep, many, CHANGES | OF_SWEEPS)]
             for change, apply in changes.items()]
    if len(sys.argv) > 2:
        plans = draw.sample(plans, int(sys.argv[2]))
    for kind, values, change, apply in plans:
        count += 1
        what = f"{kind.__name__.lower()} of {len(values)}, {change}"
        sweep = kind(place / f"{count}", [round(x, 6) for x in values])
        sweep.write()
        stop(sweep, 0.15 if len(values) < 20 else 1.0)
        if not sweep.out.exists():
            sweep.out.mkdir()
        apply(sweep)
        sweep.values = [round(x, 6) for x in sweep.values]
        sweep.write()
        fresh = sweep.folder / "fresh"
        statuses = [subprocess.run([*sweep.command(out), *more], capture_output=True, text=True, check=False)
                    for out, more in [(fresh, []), (sweep.out, ["--resume"])]]
        if statuses[0].returncode != statuses[1].returncode:
            fail(what, f"status {statuses[1].returncode}: {statuses[1].stderr[-300:]}")
        else:
            compare(what, sweep, fresh, sweep.folder / "page.html")
        shutil.rmtree(sweep.folder)
for failure in failures:
    print("FAIL:", failure)
print(f"{count} changes between stop and --resume, {len(failures)} failures")
sys.exit(1 if failures else 0)
