#!/usr/bin/env python3
"""check_words.py PROGRAM SOURCE   checks `bough explain`, `bough help`, `bough new` and `bough check --fix` from outside."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
FAULTS = []


def run(*arguments, text=None):
    done = subprocess.run([PROGRAM, *arguments], input=text, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=120)
    return done.returncode, done.stdout


def expect(condition, what, told=""):
    if not condition:
        FAULTS.append(f"{what}\n{told}")


def explains():
    codes = re.findall(r"^## ([a-z-]+)$", (SOURCE / "data/manual/guides/messages.md").read_text(), re.MULTILINE)
    expect(len(codes) > 20, "the manual has no codes")
    schema = run("schema")[1]
    kinds = ["prismatic", "joint_reaction", "inverse_dynamics", "smooth_ramp", "tube", "point_mass"]
    keys = ["step_size", "spectral_radius", "axis_2", "young", "stiffness", "gravity"]
    doubts = ["condition", "linear solutions", "round-off"]
    words = ["load factor", "station", "Modes of vibration"]
    verbs = ["run", "sweep", "check"]
    for word in codes + kinds + keys + doubts + words + verbs:
        status, told = run("explain", word)
        expect(status == 0 and len(told) > 40, f"explain {word}", told)
    for word in kinds + keys:
        expect(f'"{word}"' in schema, f"{word} is no word of the schema")
        expect("scene: " in run("explain", word)[1], f"explain {word} does not say where it stands")
    for word in verbs:
        expect("--help" in run("explain", word)[1], f"explain {word} has no options")
    for word in ("step_size", "unknown-name"):
        expect(run("help", word) == run("explain", word), f"help {word} differs from explain {word}")
    expect(run("help") == run("--help"), "help of no word")
    expect(run("explain", "")[0] == 2, "explain of an empty word")
    for place in ("/springs/0/damping", "springs[].damping"):
        expect(run("explain", place)[1].count("scene: springs[].damping\n") == 1, f"explain {place}", run("explain", place)[1])
    status, told = run("explain", "Lanczos")
    expect(status == 0 and "stands in" in told and "modes.md" in told, "a word of the text alone", told)
    status, told = run("explain", "stifness")
    expect(status == 2 and "'stiffness'" in told, "no near word", told)
    status, told = run("explain", "qqqqqqqq")
    expect(status == 2 and "no entry" in told, "a word of no meaning", told)
    status, told = run("explain", "\x1b[31m" + "x" * 100000)
    expect(status == 2 and "\x1b" not in told and len(told) < 1000, "a word that would act on the terminal")


def codes():
    """Every problem and warning of the scenes that make no sense has a code of the manual, and not the one that is left."""
    sys.path.insert(0, str(SOURCE / "tests" / "tools" / "campaign"))
    import nonsense_scenes

    listed = re.findall(r"^## ([a-z-]+)$", (SOURCE / "data/manual/guides/messages.md").read_text(), re.MULTILINE)
    met = set()
    for case in nonsense_scenes.all_cases():
        text = case.scene if isinstance(case.scene, str) else json.dumps(case.scene)
        pathlib.Path("nonsense.json").write_text(text)
        for line in run("check", "nonsense.json")[1].splitlines():
            if line.startswith("nonsense.json: "):
                code = re.search(r" \[([a-z-]+)\]$", line)
                expect(code and code.group(1) in listed and code.group(1) != "contradiction", "no code", line)
                met.add(code.group(1) if code else "")
    expect(len(met) >= 20, f"only {met} were met")


def writes_scenes():
    listed = [line.split()[0] for line in run("new")[1].splitlines()]
    files = sorted(path.stem for path in (SOURCE / "data" / "new").glob("*.json"))
    expect(sorted(listed) == files and len(files) >= 8, f"{listed} are listed, {files} are there")
    asked = set()
    for kind in listed:
        status, told = run("new", kind)
        expect(status == 0, f"new {kind}", told)
        file = f"{kind}.json"
        scene = json.loads(pathlib.Path(file).read_text())
        asked.add(scene["analysis"]["kind"] + (" path" if "arc_length" in scene["analysis"] else ""))
        expect(pathlib.Path(file).read_text().count('"comment"') >= 2, f"{kind} has no comments")
        status, told = run("check", file)
        expect(status == 0 and "warning" not in told, f"check {file}", told)
        status, told = run("run", file, "--strict")
        expect(status == 0, f"run {file}", told)
        status, told = run("new", kind)
        expect(status == 2 and "there already" in told, f"{file} is written over", told)
        expect(run("new", kind, "--out", "-")[1] == pathlib.Path(file).read_text(), f"new {kind} --out -")
    expect(asked >= {"static", "static path", "dynamic", "modes", "inverse_dynamics", "campbell", "buckling", "response",
                     "linear_model"}, f"only {asked} are shown")
    status, told = run("new", "pendulm")
    expect(status == 2 and "'pendulum'" in told, "a misspelt kind", told)


def fixes():
    good = (SOURCE / "data/scenarios/slider_crank.json").read_bytes().replace(b"\n", b"\r\n")
    good = good.replace(b'"title": "', '"title": "\u00e4\u20ac '.encode(), 1)
    names = re.findall(rb'"(?:first|second)": "((?!ground)[a-z ]{4,})"', good)
    expect(names, "the scene has no names to be misspelt")
    bad = good.replace(b'"analysis"', b'"anaylsis"', 1)
    bad = bad.replace(b'"second": "' + names[-1] + b'"', b'"second": "' + names[-1][:2] + names[-1][1:] + b'"', 1)
    file = pathlib.Path("crank.json")
    file.write_bytes(bad)
    os.chmod(file, 0o640)
    status, told = run("check", "crank.json", "--fix", "--dry-run")
    expect(status == 0 and file.read_bytes() == bad, "--dry-run writes", told)
    if shutil.which("patch"):  # of lines that end in LF: the program prints no other control characters
        pathlib.Path("plain.json").write_bytes(bad.replace(b"\r", b""))
        told = run("check", "plain.json", "--fix", "--dry-run")[1]
        done = subprocess.run(["patch", "plain.json"], input=told, stdout=subprocess.PIPE, text=True)
        expect(done.returncode == 0 and pathlib.Path("plain.json").read_bytes() == good.replace(b"\r", b""),
               "patch does not read it", told)
    os.symlink("crank.json", "link.json")
    status, told = run("check", "link.json", "--fix")
    expect(status == 0 and told.count("changed to") == 2 and "ok:" in told, "--fix", told)
    expect(file.read_bytes() == good, "--fix changes more than what is wrong")
    expect(os.path.islink("link.json"), "a link is replaced")
    expect(file.stat().st_mode & 0o777 == 0o640, "the rights of the file are changed")
    before = file.stat()
    status, told = run("check", "crank.json", "--fix")
    after = file.stat()
    expect(status == 0 and (before.st_ino, before.st_mtime_ns) == (after.st_ino, after.st_mtime_ns),
           "a right file is written", told)
    status, told = run("check", "-", "--fix", text=bad.decode())
    expect(status == 2 and "standard input" in told, "standard input is fixed", told)
    status, told = run("check", "crank.json", "--fix", "--set", "/title=x")
    expect(status == 2, "--fix with --set", told)
    file.write_bytes(good.replace(b'"analysis"', b'"anaylsis"', 1).replace(b'"kind": "revolute"', b'"kind": "hinge"', 1))
    status, told = run("check", "crank.json", "--fix")
    expect(status == 2 and "changed to" in told and "[unknown-word]" in told, "what is left is told", told)
    expect(not list(pathlib.Path(".").glob("*.partial")), "a partial file is left")


def main():
    folder = tempfile.mkdtemp(prefix="bough-words-")
    os.chdir(folder)
    try:
        explains()
        codes()
        writes_scenes()
        fixes()
    finally:
        os.chdir("/")
        shutil.rmtree(folder, ignore_errors=True)
    print("\n".join(FAULTS))
    print(f"{len(FAULTS)} faults")
    return bool(FAULTS)


sys.exit(main())
