#!/usr/bin/env python3
"""Compares the time of a step that `bough plan` predicts with the time that a run takes.

    python3 benchmarks/plan_cost.py BOUGH [SCENE ...] [--rounds 5] [--seconds 1]

Without scenes: all of data/gallery and data/scenarios, rod_chain with 8 to 2048 links, the lattice of the gallery with
4 to 32 nodes a side. Measured is the CPU time of a run on one thread without its preparation, sensors and files,
over its accepted steps. The plan is made and the scene is run in every round; of both the least time counts. Runs that
are predicted to take longer than --seconds end earlier. Two predictions are compared: the time that the plan measures
in trial steps, and the time of its model alone, which has the costs of one machine. The ratios of each are divided by
one common factor, with which most of them are within 1.3. Printed are the ratios of predicted and measured times,
sorted, and how many are within 1.3.
"""
import argparse
import glob
import json
import math
import os
import subprocess
import sys
import tempfile

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data")
QUIET = ["/output/motion=false", "/output/stride=1000000"]


def all_scenes():
    """Files, and what is set in them."""
    scenes = [(file, []) for folder in ("gallery", "scenarios")
              for file in sorted(glob.glob(os.path.join(DATA, folder, "*.json")))]
    chain, lattice = os.path.join(DATA, "scenarios", "rod_chain.json"), os.path.join(DATA, "gallery", "lattice.json")
    scenes += [(chain, [f"/parameters/N={n}"]) for n in (8, 32, 128, 512, 2048)]
    return scenes + [(lattice, [f"/parameters/n={n}"]) for n in (4, 8, 16, 32)]


def call(arguments, settings):
    for setting in settings:
        arguments += ["--set", setting]
    done = subprocess.run(arguments, capture_output=True, text=True)
    return None if done.returncode == 0 else done.stderr.strip()[:200]


class Case:
    """A scene with what is predicted for it and measured."""

    def __init__(self, bough, scene, settings, seconds, folder):
        self.name = " ".join([os.path.relpath(scene, DATA).removesuffix(".json")] + settings)
        self.command = [bough, "run", scene, "--threads", "1", "--quiet", "--out", folder]
        self.settings, self.folder = settings + QUIET, folder
        self.plan_command = [bough, "plan", scene, "--json", folder + ".json"]
        self.plan_settings = list(self.settings)
        plan = self.look_ahead()
        if self.trouble:
            return
        self.step = plan["step"]
        with open(scene) as file:
            analysis = json.load(file)["analysis"]
        run = plan["steps"] * self.step["step_s"]
        if "end_time" in analysis and run > seconds:
            self.settings.append("/analysis/end_time=%.17g" % (analysis["end_time"] * seconds / run))
        self.whole = self.upward = self.downward = math.inf

    def look_ahead(self):
        self.trouble = call(list(self.plan_command), self.plan_settings)
        if self.trouble:
            return None
        with open(self.folder + ".json") as file:
            return json.load(file)

    def measure(self):
        if self.trouble:
            return
        again = self.look_ahead()["step"]["step_s"]
        self.step["step_s"] = min(self.step["step_s"], again)
        self.trouble = call(list(self.command), self.settings)
        if self.trouble:
            return
        with open(os.path.join(self.folder, "summary.json")) as file:
            summary = json.load(file)
        times, count = summary["time_s"], summary["steps"]["accepted"]
        self.whole = min(self.whole, (times["cpu"] - times["output"]) / count)
        self.upward = min(self.upward, (times["assemble"] + times["factor"]) / count)
        self.downward = min(self.downward, (times["solve"] + times["update"]) / count)
        self.iterations = summary["steps"]["newton_iterations"] / count
        self.factorizations = summary["steps"]["factorizations"] / count

    def ratio(self, of="step_s"):
        return self.step[of] / self.whole


def common_factor(ratios):
    """The factor with which most of these ascending ratios are within 1.3, and how many."""
    windows = [[r for r in ratios if first <= r <= first * 1.3**2] for first in ratios]
    most = max(windows, key=len, default=[])
    return math.sqrt(most[0] * most[-1]) if most else math.nan, len(most)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bough")
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=1.0)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        scenes = [(s, []) for s in asked.scenes] or all_scenes()
        cases = [Case(asked.bough, *scene, asked.seconds, os.path.join(folder, str(k))) for k, scene in
                 enumerate(scenes)]
        for case in cases * asked.rounds:
            case.measure()
    for case in [c for c in cases if c.trouble]:
        print(f"{case.name}: {case.trouble}", file=sys.stderr)
    cases = sorted([c for c in cases if not c.trouble], key=Case.ratio)
    trial, near = common_factor(sorted(c.ratio() for c in cases))
    machine, inside = common_factor(sorted(c.ratio("model_step_s") for c in cases))
    print(f"step predicted over measured, by trial steps divided by {trial:.2f}, by the model by {machine:.2f};\n"
          "microseconds, predicted and measured, of that upward and downward;\n"
          "iterations and factorizations a step, predicted and measured; trial steps")
    for c in cases:
        step, modelled = c.step, c.ratio("model_step_s") / machine
        print(f"{c.name:42s} {c.ratio() / trial:5.2f} {modelled:5.2f}  {1e6 * step['step_s']:9.2f} "
              f"{1e6 * c.whole:9.2f} {1e6 * c.upward:9.2f} {1e6 * c.downward:9.2f}  "
              f"{step['iterations']:5.2f} {c.iterations:5.2f}  {step['factorizations']:5.2f} {c.factorizations:5.2f}  "
              f"{step['trial_steps']:3d}")
    print(f"within 1.3: by trial steps {near}, by the model {inside} of {len(cases)}")


main()
