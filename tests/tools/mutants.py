#!/usr/bin/env python3
"""Changes one line of a layer's sources at a time and asks whether a test notices.

    python3 tests/tools/mutants.py BUILD [--layers elements,step,run,results,io] [--count 40] [--seed 1]
                                         [--log mutants.jsonl] [--jobs 2] [--skip PATTERN]

BUILD is a configured build folder of this checkout, which has to be clean: each mutant is written into the sources,
built, tested and taken back. Tests whose name has a word of the file's run first, then those of its layer, then whole
scenes, then all others of the labels unit and verification, up to the first that fails; only programs that the change
reaches are built and run. The mutants follow from the seed: an interrupted call continues where its log ends. Mutants
that do not compile are not counted. Each line of the log is a JSON object with the change and the test that failed, or
null where none did; such survivors are to be explained, or to be given a test; those whose line is given an
"equivalent" are not counted. A test has to fail twice. Mutants that only a limit of time ends are counted apart: no
test has said that a result is wrong. Where the machine is busy with other work, tests with limits of
time are to be skipped: --skip ^apps"""
import argparse
import json
import os
import random
import re
import subprocess
import sys
import time

SWAPS = [(r" \+ ", " - "), (r" - ", " + "), (r" \* ", " / "), (r" / ", " * "), (r" < ", " <= "), (r" > ", " >= "),
         (r" <= ", " < "), (r" >= ", " > "), (r" == ", " != "), (r" && ", " || "), (r" \|\| ", " && "),
         (r" \+= ", " -= "), (r"std::max\(", "std::min("), (r"std::min\(", "std::max("), (r"std::sin\(", "std::cos("),
         (r"\b0\.5\b", "0.25"), (r"\b2\.0\b", "1.0"), (r"\b1\.0\b", "2.0"), (r"\(-", "("), (r"= -", "= "),
         (r"return !", "return "), (r"if \(!", "if (")]
STATEMENT = re.compile(r"^\s+[A-Za-z_][\w.\->\[\]()*]*(\([^;]*\)| [+\-*/|]?= [^;]*);$")
EXEMPT = re.compile(r"^\s*(//|#|\*|template|using|namespace|static_assert|case |public:|private:|return;)|constexpr|"
                    r"snprintf|printf|\"")


ARRAYS = re.compile(r"^\s*[\w:]+(<[\w, ]+>)? \w+\[[^\]]*\](, \w+\[[^\]]*\])*;$")


def is_longer_array(old, new):
    """Whether a change makes an array longer and nothing else: no program can see it."""
    return bool(ARRAYS.match(old)) and old.replace(" - ", " + ") == new.replace(" - ", " + ") and \
        old.count(" - ") > new.count(" - ")


def candidates(root, layers):
    """All possible changes: (file, line, new text), in a fixed order; a new text of "" drops the statement."""
    found = []
    for layer in layers:
        folder = os.path.join(root, "src", layer)
        files = sorted(os.path.join(d, f) for d, _, names in os.walk(folder) for f in names if f.endswith(".cpp"))
        for path in files:
            with open(path, encoding="utf-8") as f:
                lines = f.read().split("\n")
            for k, line in enumerate(lines):
                code = line.split("//")[0].rstrip()
                if not code.strip() or EXEMPT.search(line):
                    continue
                for pattern, text in SWAPS:
                    for hit in re.finditer(pattern, code):
                        found.append((layer, path, k, line[:hit.start()] + text + line[hit.end():]))
                if STATEMENT.match(code):
                    found.append((layer, path, k, ""))
    return found


class Suite:
    """Tests of a build folder, with the programs that hold them."""

    def __init__(self, build, jobs, skip):
        self.build, self.jobs = build, jobs
        self.left_out = "^lean|consumer|fuzz" + (f"|{skip}" if skip else "")
        listed = subprocess.run(["ctest", "--test-dir", build, "-L", "^(unit|verification)$", "--show-only=json-v1"],
                                capture_output=True, text=True, check=True).stdout
        self.costs = {}
        self.scripts = set()  # beginnings of names of tests that are no program of their own
        self.programs = {}  # of each layer: beginnings of its tests' names, by the path of the program that holds them
        for test in json.loads(listed)["tests"]:
            path = test.get("command", [""])[0]
            if os.path.basename(path).startswith("test_"):
                name = test["name"].split(".")[0]
                self.programs.setdefault(name.split("/")[0], {})[path] = name
            else:
                self.scripts.add(re.split("[_.]", test["name"])[0])

    def make(self, targets):
        command = ["ninja", "-C", self.build, f"-j{self.jobs}", *targets]
        return subprocess.run(command, capture_output=True).returncode == 0

    def first_failure(self, pattern, is_first=True):
        """Name of a test that fails, and how; None if there is none."""
        run = subprocess.run(["ctest", "--test-dir", self.build, "-L", "^(unit|verification)$", "-R", pattern, "-E",
                              self.left_out, "--stop-on-failure", "--timeout", "120", f"-j{self.jobs}"],
                             capture_output=True, text=True)
        failed = re.findall(r"^\s+\d+ - (\S+) \(([^)]*)\)", run.stdout, re.M)
        if not failed:
            return None
        name, how = failed[0]
        again = subprocess.run(["ctest", "--test-dir", self.build, "-R", f"^{re.escape(name)}$", "--timeout", "120"],
                               capture_output=True)
        if again.returncode == 0:  # it was the machine
            return self.first_failure(pattern, False) if is_first else None
        return name if how == "Failed" else f"{name} ({how})"

    def cost_of(self, name):
        """Seconds that the tests of a program took when ctest ran them last."""
        if not self.costs:
            with open(os.path.join(self.build, "Testing", "Temporary", "CTestCostData.txt"), encoding="utf-8") as f:
                for line in f:
                    words = line.rsplit(maxsplit=2)
                    if len(words) == 3:  # name, number of runs, seconds
                        program = words[0].strip('"').split(".")[0]
                        self.costs[program] = self.costs.get(program, 0.0) + float(words[2])
        return self.costs.get(name, 0.0)

    def failure_in(self, path, name):
        """Test of a program that fails, twice; None if there is none."""
        for _ in range(2):
            try:
                run = subprocess.run([path, "--gtest_fail_fast", "--gtest_brief=1"], capture_output=True, text=True,
                                     errors="replace", cwd=self.build, timeout=300.0 + 20.0 * self.cost_of(name))
            except subprocess.TimeoutExpired:
                return f"{name} (Timeout)"
            if run.returncode == 0:
                return None
            failed = re.findall(r"^\[  FAILED  \] (\S+)", run.stdout, re.M)
        return f"{name}.{failed[0].rstrip(',')}" if failed else f"{name} (ends with {run.returncode})"

    def failure_of(self, programs, since):
        """Builds programs and runs those that became others, the quick ones first. Returns (compiles, failing test)."""
        if not programs:
            return True, None
        if not self.make([os.path.relpath(path, self.build) for path in programs]):
            return False, None
        for path in sorted(programs, key=lambda path: self.cost_of(programs[path])):
            if os.path.getmtime(path) < since:
                continue
            failed = self.failure_in(path, programs[path])
            if failed is not None:
                return True, failed
        return True, None

    def try_mutant(self, layer, path, since):
        """Returns (compiles, failing test). The layer's tests come first, then whole scenes, those first whose name has
        a word of the file's, then all others; programs that do not hold the changed line, which was written at `since`,
        are not asked."""
        words = [w.rstrip("s") for w in os.path.basename(path).split(".")[0].split("_") if len(w) > 3]
        scenes = self.programs["run"] if layer != "run" else {}
        own = {**self.programs.get(layer, {}), **scenes}
        named = {p: name for p, name in own.items() if any(w in name for w in words)}
        rest = {p: name for other in self.programs for p, name in self.programs[other].items()
                if other not in (layer, "run")}
        for programs in (named, self.programs.get(layer, {}), scenes, rest):
            compiles, failed = self.failure_of(programs, since)
            if not compiles or failed is not None:
                return compiles, failed
        if not self.make([]):
            return False, None
        return True, self.first_failure("^(" + "|".join(sorted(self.scripts)) + ")[_.]")


def counts(record):
    return record["compiles"] and "equivalent" not in record


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--layers", default="elements,step,run,results,io")
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--log", default="mutants.jsonl")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--skip", default="")
    arguments = parser.parse_args()
    top = subprocess.run(["git", "rev-parse", "--show-toplevel"], capture_output=True, text=True, check=True)
    root = top.stdout.strip()
    if subprocess.run(["git", "diff", "--quiet"], cwd=root).returncode != 0:
        sys.exit("mutants: the checkout has changes of its own; commit or drop them first")
    layers = arguments.layers.split(",")
    by_layer = {layer: candidates(root, [layer]) for layer in layers}
    rng = random.Random(arguments.seed)
    done = []
    if os.path.exists(arguments.log):
        with open(arguments.log, encoding="utf-8") as f:
            done = [json.loads(line) for line in f]

    def keep(record):
        done.append(record)
        with open(arguments.log, "a", encoding="utf-8") as f:
            f.write(json.dumps(record) + "\n")
        print(json.dumps(record), flush=True)

    suite = Suite(os.path.abspath(arguments.build), arguments.jobs, arguments.skip)
    if not suite.make([]):
        sys.exit("mutants: the checkout does not build")
    failed = suite.first_failure(".") if not done else None
    if failed is not None:
        sys.exit(f"mutants: {failed} fails without a mutant")
    counted = sum(counts(r) for r in done)
    for number in range(100 * arguments.count):
        layer = layers[number % len(layers)]
        _, path, k, text = rng.choice(by_layer[layer])
        if number < len(done):
            continue
        if counted >= arguments.count:
            break
        with open(path, encoding="utf-8") as f:
            original = f.read()
        lines = original.split("\n")
        record = {"file": os.path.relpath(path, root), "line": k + 1, "old": lines[k].strip(), "new": text.strip()}
        if is_longer_array(lines[k], text):
            record.update({"compiles": True, "killed_by": None, "equivalent": "a longer array"})
            keep(record)
            continue
        lines[k] = text
        try:
            with open(path, "w", encoding="utf-8") as f:
                f.write("\n".join(lines))
            started = time.time()
            record["compiles"], record["killed_by"] = suite.try_mutant(layer, path, started - 1.0)
            record["seconds"] = round(time.time() - started, 1)
        finally:
            with open(path, "w", encoding="utf-8") as f:
                f.write(original)
        counted += counts(record)
        keep(record)
    suite.make([])
    tried = [r for r in done if counts(r)]
    late = sum((r["killed_by"] or "").endswith("(Timeout)") for r in tried)
    killed = sum(r["killed_by"] is not None for r in tried) - late
    print(f"{killed} of {len(tried)} mutants killed by a test that fails, {late} by a limit of time alone, "
          f"{len(tried) - killed - late} survive; {len(done) - len(tried)} did not compile or change nothing")


if __name__ == "__main__":
    main()
