#!/usr/bin/env python3
"""left_out.py PROGRAM SOURCE SCRATCH   holds that what a scene leaves out costs no instruction in its steps.

Runs the program (left_out.cpp) under callgrind, which charges every instruction of some steps to a function, a file and a line of its
source, inlined ones too. Where a scene is without a feature, nothing may be charged to what belongs to it; where a scene has it, something
must be, or the first says nothing.
"""
import collections
import glob
import os
import re
import shutil
import subprocess
import sys


class Feature:
    """What belongs to a feature. functions: names, whatever class or arguments; types: what arguments of a function are made of; files: whole
    files; terms: lines of the kernels of elements, for the products and sums that they call, but for those of `asks`, which ask whether
    there is anything to do."""

    def __init__(self, functions="", types="", files="", terms="", asks=""):
        self.functions = set(functions.split())
        names = [rf"\b(?:{'|'.join(sorted(self.functions))})(?:\[abi:\w+\])?(?:<.*)?\("] if self.functions else []
        self.name = re.compile("|".join(names + ([types] if types else [])) or r"(?!)")
        self.files = tuple(files.split())
        self.terms = re.compile(terms or r"(?!)")
        self.asks = re.compile(asks or r"(?!)")


VIOLATIONS = " constraint_violation constraint_violations relative_violation largest_violation evaluate_constraint_rates "
CHECKS = VIOLATIONS + "check measure measure_beam measure_load measure_coupling eval_energies eval_energies_lanes energies_of add_energies eval_strain_energy"
JOINTS = Feature(
    functions="""eval_row eval_angle eval_axial_angle axial_moment axial_slope cosine_slope eval_coordinate eval_turning_coordinate eval_distance eval_effort
        eval_gradient_slope add_effort_slopes eval_joint_coordinate add_efforts evaluate_constraint_series constraint_series add_multipliers for_each_multiplier
        accept_turns""",
    types=r"\bJointOn<[^<>]*(?:Pack<8> ?)?> const&")
DAMPING = Feature(functions="relative_twist", terms=r"\bdamping\b|\bby_twist\b|\bby_rate\b|\brate = lanes::dot", asks=r"is_present|is_damped|viscous,")
GYROSCOPIC = Feature(functions="gyroscopic spin add_spin_rows", terms=r"subtract_dual_bracket\(f, v|body\.mass, v\)")
POINTS = Feature(terms=r"\(body\.mass,|\(e\.mass,")
# What is left out, what belongs to it, the scene that is without it and the one that has it.
FEATURES = [
    ("joints", JOINTS, "bushings", "links"),
    ("joints in a plane", JOINTS, "planar bushings", "planar"),
    ("damping", DAMPING, "links", "damped"),
    ("damping in lanes", DAMPING, "many", "many damped"),
    ("damping in a plane", DAMPING, "planar", "planar damped"),
    ("damping in a plane, in lanes", DAMPING, "planar many", "planar many damped"),
    ("damping of bushings", DAMPING, "bushings", "damped bushings"),
    ("gyroscopic terms of points", POINTS, "beads", "turning beads"),
    ("gyroscopic terms of translations", GYROSCOPIC, "net", "links"),
    ("gyroscopic terms of statics", GYROSCOPIC, "statics", "links"),
    ("signals", Feature(functions="evaluate_law_slope add_signal_columns note_signal", files="src/step/signals.cpp src/step/signal_series.cpp src/elements/reading.cpp"), "links", "signals"),
    ("sensors", Feature(functions="eval_sensors eval_between", files="src/results/observe.cpp src/results/observe_points.cpp src/run/step_window.cpp"), "links", "sensors"),
    ("pictures", Feature(functions="eval_motion"), "links", "pictures"),
    ("checks", Feature(functions=CHECKS + " look_at_error", files="src/results/balance.cpp src/results/energies.cpp src/elements/energies.cpp src/elements/measure.cpp src/step/local_error.cpp"),
     "links", "checks"),
    ("output of steps without a row", Feature(functions=VIOLATIONS + "check eval_energies eval_energies_lanes eval_sensors eval_motion compare"),
     "rare rows", "rows"),
    ("error estimates", Feature(functions="look_at_error add_error", files="src/step/local_error.cpp src/step/step_control.cpp"), "links",
     "step control"),
    ("moving frames", Feature(functions="set_frames set_frame_series set_turned_laws make_steady eval_frames add_observer_motion see_from_inertial"),
     "links", "moving frame"),
    ("vibration watch", Feature(functions="watch_vibrations judge unresolved", files="src/run/vibration_watch.cpp src/step/variational.cpp"),
     "links", "variational"),
]


def read_profile(path):
    """Title, and instructions by (function, file, line): its own ones, and those of what it calls."""
    title, cost, called = None, collections.Counter(), collections.Counter()
    function = file = ""
    skip = False
    for row in open(path, errors="replace"):
        if row.startswith("desc: Trigger: Client Request: "):
            title = row.split(": ", 3)[3].strip()
        elif row.startswith("fn="):
            function = row[3:].strip()
        elif row[:3] in ("fl=", "fi=", "fe="):
            file = row[3:].strip()
        elif row.startswith("calls="):
            skip = True  # the next line tells what the callee cost
        elif row[:1].isdigit():
            line, count = row.split()[:2]
            (called if skip else cost)[function, file, int(line)] += int(count)
            skip = False
    return title, (cost, called)


class Source:
    """Lines of the library's sources, and the function that each belongs to where that is one of those asked for."""

    def __init__(self, root):
        self.root = os.path.realpath(root)
        self.texts, self.owners, self.paths = {}, {}, {}

    def relative(self, file):
        """Path below the root, or None for files of others. A compiler cache makes names relative to the folder of the compilation, and
        gives objects to other trees too: what follows the last "../" of a name is then the path below any of these roots."""
        if file not in self.paths:
            path = os.path.realpath(file)
            if not path.startswith(self.root + "/"):
                path = os.path.join(self.root, file.rpartition("../")[2])
            own = path.startswith(self.root + "/") and os.path.isfile(path)
            self.paths[file] = os.path.relpath(path, self.root) if own else None
        return self.paths[file]

    def line(self, path, number):
        if path not in self.texts:
            self.texts[path] = open(os.path.join(self.root, path)).read().split("\n")
            self.owners[path] = self.find_owners(self.texts[path])
        text = self.texts[path]
        return text[number - 1] if 0 < number <= len(text) else ""

    def owner(self, path, number):
        self.line(path, number)
        return self.owners[path].get(number)

    @staticmethod
    def find_owners(text):
        """Functions as clang-format writes them: a head at no indentation, or that of a class, to the brace that closes it there."""
        owners, name, indent, start = {}, None, "", 0
        for number, row in enumerate(text, 1):
            if name is None:
                head = re.match(r"( {0,2})(?!return|if|for|else|while|namespace|using|#|//)[\w:<>,&*~\[\] ]*?\b(\w+)\(", row)
                if head:
                    name, indent, start = head[2], head[1], number
            if name is None:
                continue
            if re.match(rf"{indent}\}}", row) or (row.rstrip().endswith("}") and number == start):
                owners.update((k, name) for k in range(start, number + 1))
                name = None
            elif row.rstrip().endswith(";") and "{" not in "".join(text[start - 1:number]):
                name = None  # a declaration
        return owners


def charged(feature, profile, source):
    """Instructions charged to the feature, by what they were charged to."""
    found = collections.Counter()
    cost, called = profile
    for (function, file, number), count in cost.items():
        path = source.relative(file)
        if path is None or path.startswith("tests/"):
            continue
        owner = source.owner(path, number)
        if feature.name.search(function):
            found[function[:140]] += count
        elif owner in feature.functions or path in feature.files:
            found[f"{path}: {owner}"] += count
    for (_, file, number), count in called.items():
        path = source.relative(file)
        if path is None or "/elements/" not in path:
            continue
        text = source.line(path, number).strip()
        if feature.terms.search(text) and not feature.asks.search(text):
            found[f"{path}:{number}: {text}"] += count
    return found


def run(program, scratch):
    shutil.rmtree(scratch, ignore_errors=True)
    os.makedirs(scratch)
    command = ["valgrind", "--tool=callgrind", "--instr-atstart=no", "--dump-instr=no", "--compress-strings=no",
               "--compress-pos=no", f"--callgrind-out-file={scratch}/profile", program]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout[-4000:], done.stderr[-4000:])
        sys.exit("the program failed under callgrind")


def main():
    program, root, scratch = sys.argv[1:]
    run(program, scratch)
    source = Source(root)
    profiles = dict(filter(lambda p: p[0], map(read_profile, glob.glob(f"{scratch}/profile*"))))
    failed = 0
    for name, feature, without, with_it in FEATURES:
        if without not in profiles or with_it not in profiles:
            failed += 1
            print(f"FAILED {name}: no profile of '{without}' or '{with_it}'")
            continue
        extra, there = charged(feature, profiles[without], source), charged(feature, profiles[with_it], source)
        ok = not extra and there
        own = profiles[without][0]
        if name.endswith("in lanes") and not any("evaluate_lanes" in function for function, _, _ in own):
            ok = False
            print(f"       {name}: no element is evaluated in lanes")
        failed += not ok
        print(f"{'ok    ' if ok else 'FAILED'} {name}: {sum(extra.values())} of {sum(own.values())} instructions where left out, "
              f"{sum(there.values())} where not")
        for what, count in extra.most_common(12):
            print(f"         {count:9d} {what}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
