#!/usr/bin/env python3
"""check_pages.py PROGRAM SOURCE [SHOTS]   makes every kind of page and looks at it in a headless browser (check_html.py): views of
runs, two runs over each other, stiff cases, a study, a profile, a sweep, a batch. Views are handled as a reader does
(view_behaviour.js): drag, wheel, play, select, colours, ghosts, traces, plots. Names that look like markup, long ones and
right-to-left ones stay text. Exit status 77: there is no browser."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
SHOTS = pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None
sys.path.insert(0, str(SOURCE / "tests/tools"))
import browser  # noqa: E402
import check_html  # noqa: E402

MARKUP = "<script>wasCalled=1<img src=x onerror=wasCalled=1>"
LONG, HEBREW = "n" * 100, "שלום עולם"
HINGE = {"name": "hinge", "kind": "revolute", "first": "tip", "second": "block", "position": [2, 0, 0], "axis": [0, 0, 1]}
# Every kind of thing that the legend of a motion names, a sensor with a long name, and little motion above the legend.
PARTS = {
    "schema_version": 1, "gravity": [0, -9.81, 0],
    "sections": [{"name": "s", "stiffness": {"EA": 1e5, "GA2": 1e5, "GA3": 1e5, "GJ": 10, "EI2": 10, "EI3": 10},
                  "mass": {"mass_per_length": 1, "rotary": [1e-3, 1e-3, 1e-3]}}],
    "nodes": [{"name": "root"}, {"name": "tip", "position": [2, 0, 0]}],
    "bodies": [{"name": "block", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [2.5, 0, 0]}],
    "beams": [{"name": "beam", "section": "s", "start": "root", "end": "tip", "elements": 4}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "root", "position": [0, 0, 0]}, HINGE],
    "springs": [{"name": "coil", "first": "block", "second": {"to": "ground", "position": [2.5, 1, 0]}, "stiffness": 40}],
    "sensors": [{"name": "reaction of the wall on the root of the beam", "kind": "joint_reaction", "joint": "wall"}],
    "analysis": {"kind": "dynamic", "end_time": 0.012345, "step_size": 1e-3}, "output": {"motion": True},
}
NAMES = {
    "schema_version": 1, "title": "</script><script>wasCalled=1</script><img src=x onerror=wasCalled=1>" + "t" * 300,
    "gravity": [0, 0, -9.81],
    "bodies": [{"name": MARKUP, "mass": 1, "inertia": [1, 1, 1]},
               {"name": LONG, "mass": 1, "shape": {"kind": "sphere", "radius": 0.2}, "position": [1, 0, 0]},
               {"name": HEBREW, "mass": 1, "shape": {"kind": "box", "size": [0.2, 0.3, 0.4]}, "position": [2, 0, 0]}],
    "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": MARKUP, "position": [-0.5, 0, 0],
                "axis": [0, 1, 0]},
               {"name": "pin", "kind": "spherical", "first": LONG, "second": HEBREW, "position": [1.5, 0, 0]}],
    "sensors": [{"name": "\"><img src=x onerror=wasCalled=1>", "kind": "velocity", "at": MARKUP},
                {"name": LONG, "kind": "position", "at": LONG}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}, "output": {"motion": True},
}


def call(*words, status=0):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != status:
        sys.exit(f"{' '.join(map(str, words))}: {done.returncode}, {done.stderr[:1000]}")


def make_view(name, scene, *options):
    if isinstance(scene, dict):
        text, scene = json.dumps(scene), f"{name}.json"
        pathlib.Path(scene).write_text(text, encoding="utf-8")
    call("run", scene, "--out", name, "--quiet", *options)
    call("view", name)
    return f"{name}/view.html"


def make_pages():
    """Views that are handled, and all pages."""
    short = ["--set", "/analysis/end_time=0.5"]
    views = [make_view(name, SOURCE / f"data/gallery/{name}.json", *short) for name in ("robot_arm", "rotor")]
    views.append(make_view("names", NAMES))
    pages = views + [make_view("parts", PARTS)]
    pages.append(make_view("one_plot", {**PARTS, "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "hinge"}]}))
    pages.append(make_view("no_motion", {**PARTS, "output": {"motion": False}}))
    make_view("softer", PARTS, "--set", "/springs/coil/stiffness=20")
    call("view", "softer", "parts")
    pages.append("softer/view.html")
    call("stress", "--case", "condition", "--out", "stress", "--quiet")
    call("study", SOURCE / "data/studies/princeton_beam.json", "--out", "study", "--threads", 1, "--repetitions", 1, "--quiet")
    call("profile", SOURCE / "data/scenarios/four_bar_planar.json", "--out", "profile", "--steps", 10, "--quiet")
    sweep = json.loads((SOURCE / "data/sweeps/rotor_clearance.json").read_text(encoding="utf-8"))
    sweep["scene"] = str(SOURCE / "data/sweeps" / sweep["scene"])
    sweep["designs"][0]["samples"] = 12
    pathlib.Path("sweep.json").write_text(json.dumps(sweep), encoding="utf-8")
    call("sweep", "sweep.json", "--out", "sweep", "--quiet")
    folder = pathlib.Path("scenes")
    folder.mkdir()
    for name, scene in [("good", PARTS), ("bad", {**PARTS, "gravity": 1}), (HEBREW, NAMES)]:
        (folder / f"{name}.json").write_text(json.dumps(scene), encoding="utf-8")
    call("batch", folder, "--out", "batch", "--quiet", status=1)
    return views, pages + ["stress/stress.html", "study/study.html", "profile/profile.html", "sweep/batch.html", "batch/batch.html"]


def main():
    if not browser.find():
        print("no chromium found")
        return 77
    os.chdir(tempfile.mkdtemp())
    views, pages = make_pages()
    if SHOTS:
        SHOTS.mkdir(parents=True, exist_ok=True)
    behaviour = (SOURCE / "tests/tools/view_behaviour.js").read_text(encoding="utf-8")
    faults = []
    with browser.Browser() as chromium:
        for page in map(pathlib.Path, pages):
            found = check_html.look(chromium, page, SHOTS)
            if str(page) in views:
                for width in (1300, 400):
                    chromium.open(page, width=width)
                    found += [f"{page}, {width} px: {fault}" for fault in chromium.evaluate(behaviour) + chromium.faults]
            print(f"{page}: {len(found)} faults")
            faults += found
    print("\n".join(faults))
    return 1 if faults else 0


sys.exit(main())
