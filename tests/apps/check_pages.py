#!/usr/bin/env python3
"""check_pages.py PROGRAM SOURCE [SHOTS]   makes every kind of page and checks it in a headless browser (check_html.py):
views of runs, two runs over each other, stiff cases, studies, a profile, a sweep, a batch, the gallery. Views are
operated as by a reader (view_behaviour.js): drag, wheel, play, select, colours, ghosts, traces, plots. The files that
they save are read, and colours are compared as readers with two kinds of cones see them (view_maps.js). Names that look
like markup, long ones and right-to-left ones have to remain text. Exit status 77: there is no browser."""

import csv
import io
import json
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
SHOTS = pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None
sys.path.insert(0, str(SOURCE / "tests/tools"))
import browser  # noqa: E402
import check_html  # noqa: E402
import check_page  # noqa: E402

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
# Signals with units that follow, that are declared and that nobody knows.
SIGNALS = {
    **PARTS, "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 5e-3},
    "signals": [{"name": "turn", "kind": "joint_angle", "joint": "hinge"},
                {"name": "twice", "kind": "formula", "expression": "2*turn"},
                {"name": "pressure", "kind": "formula", "expression": "3*turn + 1", "unit": "<i>Pa"}],
    "sensors": [{"name": name, "kind": "signal", "signal": name} for name in ("turn", "twice", "pressure")],
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


# A small body that travels a thousand times its size, and a pendulum whose hinge transmits no moment.
FAR = {
    "schema_version": 1,
    "bodies": [{"name": "ball", "mass": 1, "shape": {"kind": "box", "size": [0.5, 0.4, 0.3]}, "position": [3, 2, 1]},
               {"name": "plate", "mass": 1, "shape": {"kind": "box", "size": [0.5, 0.4, 0.01]}, "position": [4, 2, 1]}],
    "joints": [{"name": "hinge", "kind": "revolute", "first": "ball", "second": "plate", "position": [3.5, 2, 1],
                "axis": [0, 1, 0]}],
    "initial_velocities": [{"of": "ball", "velocity": [700, 300, 650]}, {"of": "plate", "velocity": [700, 300, 650]}],
    "sensors": [{"name": "ball", "kind": "position", "at": "ball"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}, "output": {"motion": True},
}
SWING = {
    "schema_version": 1, "gravity": [7.848, -5.886, 0],
    "bodies": [{"name": "bob", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0.48, 0.64, -0.6]}],
    "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
                "axis": [0.36, 0.48, 0.8]}],
    "sensors": [{"name": "hinge", "kind": "joint_reaction", "joint": "hinge"}],
    "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 0.01}, "output": {"motion": True},
}


def rotor(flight):
    """Three blades that turn many times, on a base that flies far."""
    blades = range(3)
    ends = [[0, math.cos(2 * math.pi * k / 3), math.sin(2 * math.pi * k / 3)] for k in blades]
    return {
        "schema_version": 1,
        "sections": [{"name": "s", "stiffness": {"EA": 1e8, "GA2": 1e8, "GA3": 1e8, "GJ": 1e5, "EI2": 1e5, "EI3": 1e5},
                      "mass": {"mass_per_length": 1, "rotary": [1e-3, 1e-3, 1e-3]}}],
        "bodies": [{"name": "base", "mass": 100, "inertia": [0.2, 0.2, 0.2]}, {"name": "hub", "mass": 1, "inertia": [0.002, 0.002, 0.002]}],
        "nodes": [{"name": f"tip{k}", "position": ends[k]} for k in blades],
        "beams": [{"name": f"blade{k}", "section": "s", "start": "hub", "end": f"tip{k}", "elements": 2} for k in blades],
        "motions": [{"at": "base", "x": {"expression": f"{flight}*t"}, "y": 0, "z": 0, "rotation": "hold"}],
        "joints": [{"name": "axle", "kind": "revolute", "first": "base", "second": "hub", "position": [0, 0, 0], "axis": [1, 0, 0],
                    "drives": [{"law": 5, "rate": True}]}],
        "initial_velocities": [{"of": name, "velocity": [flight, 0, 0], "angular_velocity": [0 if name == "base" else 5, 0, 0]}
                               for name in ["base", "hub"]] +
                              [{"of": f"blade{k}", "velocity": [flight, 0, 0], "angular_velocity": [5, 0, 0]} for k in blades],
        "sensors": [{"name": "tip", "kind": "position", "at": "tip0"}],
        "analysis": {"kind": "dynamic", "end_time": 40, "step_size": 0.02}, "output": {"motion": True},
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
    views.append(make_view("rotor_on_vehicle", SOURCE / "data/scenarios/rotor_on_vehicle.json", *short,
                           "--set", "/output/motion=true"))
    views.append(make_view("deep_arch", SOURCE / "data/scenarios/deep_arch.json", "--set", "/output/motion=true"))
    views.append(make_view("names", NAMES))
    pages = views + [make_view("parts", PARTS)]
    pages.append(make_view("one_plot", {**PARTS, "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "hinge"}]}))
    pages.append(make_view("no_motion", {**PARTS, "output": {"motion": False}}))
    pages += [make_view("far", FAR), make_view("swing", SWING),
              make_view("splits", SOURCE / "data/scenarios/heavy_top_precession.json")]
    pages.append(make_view("roll_up", SOURCE / "data/scenarios/roll_up.json", "--set", "/output/motion=true"))
    make_view("softer", PARTS, "--set", "/springs/coil/stiffness=20")
    call("view", "softer", "parts")
    pages.append("softer/view.html")
    # Of two runs one of which stored no motion, the picture shows the other or none.
    make_view("moved", PARTS, "--set", "/springs/coil/stiffness=20")
    make_view("still", {**PARTS, "output": {"motion": False}})
    for first, second in (("moved", "still"), ("still", "moved")):
        call("view", first, second)
        pages.append(f"{first}/view.html")
    pages.append(make_view("signals", SIGNALS))
    make_view("of_signals", {**SIGNALS, "signals": SIGNALS["signals"][:2], "sensors": SIGNALS["sensors"][:2]},
              "--set", "/springs/coil/stiffness=20")
    call("view", "signals", "of_signals")
    os.rename("signals/view.html", "signals/both.html")
    call("view", "signals")
    pages.append("signals/both.html")
    call("stress", "--case", "condition", "--out", "stress", "--quiet")
    for name in ("princeton_beam", "four_bar"):
        call("study", SOURCE / f"data/studies/{name}.json", "--out", f"study_{name}", "--threads", 2,
             "--repetitions", 1, "--quiet")
    subprocess.run([sys.executable, SOURCE / "tests/tools/gallery.py", PROGRAM, "gallery",
                    *(SOURCE / f"data/scenarios/{s}.json" for s in ("pendulum", "heavy_top", "slider_crank")),
                    "names.json"], check=True, stdout=subprocess.DEVNULL)
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
    return views, pages + ["stress/stress.html", "study_princeton_beam/study.html", "study_four_bar/study.html",
                           "gallery/index.html", "profile/profile.html", "sweep/batch.html", "batch/batch.html"]


def check_saved(chromium, page):
    """What the buttons PNG and CSV save: the picture in the size of the canvas, and rows of the history."""
    faults = []
    chromium.open(page)
    chromium.evaluate("boughView.setTime(0.6 * boughView.runs[0].times.at(-1))")
    press = "document.evaluate(\"//button[.='%s']\", document, null, 9).singleNodeValue.click()"
    name, picture = chromium.saved(press % "PNG")
    pathlib.Path("saved.png").write_bytes(picture)
    size = chromium.evaluate("[boughView.canvas.width, boughView.canvas.height]")
    told = list(struct.unpack(">II", picture[16:24])) if picture[:4] == b"\x89PNG" else None
    if told != size or not name.endswith(".png"):
        faults.append(f"{page}: the PNG {name} has the size {told}, the canvas {size}")
    elif check_page.colours_of("saved.png")[0] < 20:
        faults.append(f"{page}: the PNG shows nothing")
    with open(pathlib.Path(page).parent / "history.csv", encoding="utf-8", newline="") as file:
        history = {round(float(row[0]), 9): [float(v) for v in row] for row in list(csv.reader(file))[1:]}
    first, last = 0.25 * max(history), 0.75 * max(history)
    chromium.evaluate(f"boughView.plots[0].zoom({first}, {last})")
    name, text = chromium.saved(press % "CSV")
    head, *shown = list(csv.reader(io.StringIO(text.decode("utf-8"))))
    if not name.endswith(".csv") or head[0] != "time [s]" or "[" not in head[1]:
        faults.append(f"{page}: the CSV {name} begins with {head}")
    for row in shown:
        # The page holds single precision and shows eight digits.
        values = history.get(round(float(row[0]), 9), [])
        near = [any(abs(float(v) - w) <= 1e-6 * max(1e-3, abs(w)) for w in values) for v in row[1:]]
        if not first <= float(row[0]) <= last or not all(near):
            return faults + [f"{page}: the CSV has the row {row}, which is not of the history, or not shown"]
    if len(shown) < 0.4 * len(history):
        faults.append(f"{page}: the CSV has {len(shown)} rows, the history {len(history)}")
    return faults + chromium.faults


def check_calm(chromium, page):
    """For a reader who asks for less motion, the picture plays in few steps and not again and again."""
    faults = []
    count = """new Promise(function (done) {
      const times = new Set(), view = boughView;
      view.play(true);
      const timer = setInterval(() => times.add(view.state.time), 10);
      setTimeout(function () { clearInterval(timer); view.play(false); done([times.size, view.state.loop]); }, 2000); })"""
    for calm in (False, True):
        chromium.open(page, calm=calm)
        steps, loops = chromium.evaluate(count)
        if calm != (steps <= 6) or loops == calm:
            faults.append(f"{page}: {steps} instants in 2 s, {'again' if loops else 'once'}, less motion: {calm}")
        faults += chromium.faults
    return faults


def check_far(chromium, page):
    """A structure that travels far beside its size is followed: it fills the picture and stays in its middle."""
    faults = []
    chromium.open(page)
    if not chromium.evaluate("boughView.state.follow"):
        faults.append(f"{page}: a structure that travels far is not followed")
    see = """(function (share) {
      const view = boughView, [run] = view.runs;
      view.setTime(share * run.times.at(-1));
      view.state.moving = -1e9;
      view.draw();
      const at = run.bodies.map((b) => {
        const p = new THREE.Vector3().fromArray(view.scenes[0].poses.x, 3 * b.track).project(view.camera);
        return [p.x, p.y];
      });
      const c = document.createElement("canvas"), k = c.getContext("2d");
      [c.width, c.height] = [view.canvas.width, view.canvas.height];
      k.drawImage(view.canvas, 0, 0);
      const pixels = new Uint32Array(k.getImageData(0, 0, c.width, c.height).data.buffer), ground = pixels[0];
      return [at, pixels.reduce((n, p) => n + (p !== ground), 0) / pixels.length];
    })(%s)"""
    for share in (0, 0.31, 0.77, 1):
        places, filled = chromium.evaluate(see % share)
        if any(abs(x) > 0.9 or abs(y) > 0.9 for x, y in places) or filled < 0.03:
            faults.append(f"{page}: at {share} of the run bodies are at {places}, {100 * filled:.2f} % is drawn")
    chromium.evaluate("boughView.follow(false), boughView.fit()")
    places, _ = chromium.evaluate(see % 1)
    if any(abs(x) > 1 or abs(y) > 1 for x, y in places):
        faults.append(f"{page}: the whole motion does not fit into the picture: {places}")
    return faults + chromium.faults


def check_zero(chromium, page, zeros):
    """Plots of round-off, `zeros` of them, say so and have no scale but zero; none has a scale of round-off."""
    chromium.open(page)
    seen = chromium.evaluate("""Array.from(document.querySelectorAll(".plot")).map((p) =>
      Array.from(p.querySelectorAll("svg text")).map((t) => t.textContent))""")
    zero = [texts for texts in seen if "zero to round-off" in texts]
    if len(zero) != zeros or any(texts[0] != "0" or texts[1] != "zero to round-off" for texts in zero):
        return [f"{page}: plots of round-off: {seen}"]
    if len(zero) == len(seen) or any("e-" in t for texts in seen for t in texts):
        return [f"{page}: scales of plots: {seen}"]
    return chromium.faults


def check_pairs(chromium, page):
    """Of two runs, each plot lays columns of one name over each other, and the next one shows their difference."""
    chromium.open(page)
    plots = chromium.evaluate("boughView.plots.map((p) => [p.title, p.unit, p.series.map((s) => s.label)])")
    faults = [] if plots else [f"{page}: no plots"]
    for (title, unit, labels), (_, unit_of_gap, gaps) in zip(plots[::2], plots[1::2]):
        half = len(labels) // 2
        names = [label.removesuffix(" A") for label in labels[:half]]
        if [n + " B" for n in names] != labels[half:] or [n + " A - B" for n in names] != gaps or unit != unit_of_gap:
            faults.append(f"{page}: {title} [{unit}] lays {labels} over each other, difference {gaps} [{unit_of_gap}]")
    return faults + chromium.faults


def check_still(chromium, page):
    """Of two runs the second of which stored no motion, the picture shows the first, and the page says so."""
    chromium.open(page)
    scenes, drawn, text = chromium.evaluate("[boughView.scenes.length, boughView.drawn > 0, document.body.textContent]")
    seen = scenes == 1 and drawn and "B did not store its motion" in text
    return chromium.faults + ([] if seen else [f"{page}: {scenes} runs are in the picture, drawn: {drawn}"])


def check_signals(chromium, page, runs):
    """The list of signals shows the values of the history at the time of the picture, with units, of all runs."""
    faults = []
    see = """new Promise(function (done) {
      boughView.setTime(%s);
      setTimeout(() => done([document.getElementById("signals-at").textContent,
        Array.from(document.querySelectorAll("#signals p")).map((p) => [p.querySelector("span").textContent,
          Array.from(p.querySelectorAll("output")).map((o) => o.textContent)])]), 300); })"""
    chromium.open(page)
    labels = ["turn [rad]", "twice", "pressure [<i>Pa]"]
    for time in (0.0, 0.25, 0.5):
        line, rows = chromium.evaluate(see % time)
        if line != f"At t = {time:g} s" or [label for label, _ in rows] != labels:
            faults.append(f"{page}: the list of signals says {line}: {rows}")
            continue
        for run, folder in enumerate(runs):
            with open(f"{folder}/history.csv", encoding="utf-8", newline="") as file:
                history = list(csv.DictReader(file))
            row = min(history, key=lambda r: abs(float(r["time"]) - time))
            for label, shown in rows:
                value = row.get(label.split()[0])
                right = shown[run] == "–" if value is None else abs(float(shown[run]) - float(value)) <= 1e-4 * abs(float(value))
                if not right or len(shown) != len(runs):
                    faults.append(f"{page}: {label} at {time} s is shown as {shown}, and is {value} in {folder}")
    return faults + chromium.faults


def check_lengths(chromium, page):
    """Blades that turn keep their lengths in every picture that can be drawn, and there are pictures enough."""
    chromium.open(page)
    worst, pictures = chromium.evaluate((SOURCE / "tests/tools/view_lengths.js").read_text(encoding="utf-8"))
    return [f"{page}: of {pictures} pictures lengths between two differ by {worst}"] if worst > 1e-3 or pictures < 400 else []


def check_maps(chromium, page):
    chromium.open(page)
    return chromium.evaluate((SOURCE / "tests/tools/view_maps.js").read_text(encoding="utf-8"))


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
            print(f"{page}: {len(found)} faults", flush=True)
            faults += found
        saved = [check_saved(chromium, page) for page in ("robot_arm/view.html", "names/view.html")]
        more = {"saved files": sum(saved, []), "less motion": check_calm(chromium, "robot_arm/view.html"),
                "far travel": check_far(chromium, "far/view.html"),
                "zero": check_zero(chromium, "roll_up/view.html", 1) + check_zero(chromium, "swing/view.html", 0),
                "two runs": check_pairs(chromium, "softer/view.html"),
                "motion of one of two runs": check_still(chromium, "moved/view.html"),
                "signals": check_signals(chromium, "signals/view.html", ["signals"]) +
                           check_signals(chromium, "signals/both.html", ["signals", "of_signals"]),
                "lengths": sum((check_lengths(chromium, make_view(f"turning_{v}", rotor(v))) for v in (0, 50)), []),
                "maps of colours": check_maps(chromium, "robot_arm/view.html")}
        for name, found in more.items():
            print(f"{name}: {len(found)} faults")
            faults += found
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
