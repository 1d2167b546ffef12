"""Limits of the system, at several sizes over all verbs, and budgets of `bough check` for heavy inputs.

Under a limit a run may fail, but only with a message and exit status 0, 1 or 2, never by a signal. A limit under which
even `bough --version` does not start is skipped. A check must take less than 2 s of processor time and 512 MB for any
input.
"""
import json
import pathlib
import resource
import tempfile

import fuzz
import process

KB, MB = 1024, 1024 * 1024
LIMITS = {
    "stack": (resource.RLIMIT_STACK, [64 * KB, 128 * KB, 192 * KB, 256 * KB, 512 * KB, MB]),
    "address space": (resource.RLIMIT_AS, [24 * MB, 32 * MB, 40 * MB, 48 * MB, 64 * MB, 96 * MB, 128 * MB, 256 * MB,
                                           512 * MB]),
    "file size": (resource.RLIMIT_FSIZE, [0, 1, 100, KB, 10 * KB, 100 * KB]),
    "open files": (resource.RLIMIT_NOFILE, [3, 4, 5, 6, 8, 12, 20]),
    "processes": (resource.RLIMIT_NPROC, [1, 2, 4, 16]),
}


def add_arguments(parser):
    pass


def verbs(folder, source):
    """Arguments of every verb that ends within seconds. The scene records its motion; out is a run of it."""
    scene, out = folder / "scene.json", folder / "out"
    (folder / "scenes").mkdir()
    small = json.dumps(fuzz.SMALL[0])
    scene.write_text(small)
    for name in ("one", "two"):
        (folder / "scenes" / f"{name}.json").write_text(small)
    chain = source / "data/scenarios/chain.json"
    return {
        "run": ["run", scene, "--out", folder / "again", "--set", "/output/motion=true"],
        "run of two threads": ["run", chain, "--threads", "2", "--out", folder / "chain", "--set",
                               "/analysis/end_time=0.01"],
        "check": ["check", scene],
        "plan": ["plan", scene],
        "batch": ["batch", folder / "scenes", "--out", folder / "batch", "--replace"],
        "view": ["view", out],
        "compare": ["compare", out, out],
        "profile": ["profile", scene, "--out", folder / "profile", "--steps", "20"],
        "tune": ["tune", scene, "--steps", "3", "--seconds", "0.5"],
        "export-matrix": ["export-matrix", scene, "--out", folder / "m.mtx"],
        "kinematics razi": ["kinematics", "razi", "--svg", folder / "razi.svg"],
        "schema": ["schema"],
    }


def under_limits(options, outcome, folder):
    commands = verbs(folder, options.source)
    first = process.run([options.program, "run", folder / "scene.json", "--out", folder / "out", "--set",
                         "/output/motion=true"], 60, cwd=folder)
    if first.status != 0:
        outcome.failures.append(f"without limits: {process.faults_of(first)}")
        return
    count = 0
    for name, (which, sizes) in LIMITS.items():
        for size in sizes[:: 1 if options.scale >= 1 else 3]:
            limits = {which: size}
            if which != resource.RLIMIT_FSIZE and process.run([options.program, "--version"], 20,
                                                              limits=limits).status != 0:
                continue
            for verb, words in commands.items():
                result = process.run([options.program] + words, 60, cwd=folder, limits=limits)
                faults = process.faults_of(result)
                # Messages go to files here, which the limit of their size cuts.
                if which == resource.RLIMIT_FSIZE:
                    faults = [fault for fault in faults if fault != "a failure without a word"]
                if faults:
                    outcome.failures.append(f"{verb} with {name} of {size}: {'; '.join(faults)}: {result.err[-200:]}")
                count += 1
    outcome.counts["runs under a limit"] = count


def nested(count):
    scene = dict(fuzz.SMALL[0])
    scene["frames"] = [{"name": f"f{i}", "position": [0.1, 0, 0], **({"frame": f"f{i - 1}"} if i else {})}
                       for i in range(count)]
    return scene


def row(count, **more):
    scene = dict(fuzz.SMALL[0])
    scene["nodes"] = [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}] + [{"name": f"n{i}", "position": [i, 1, 0]}
                                                                              for i in range(count + 1)]
    scene["beams"] = [{"name": f"b{i}", "section": "s", "start": f"n{i}", "end": f"n{i + 1}", "elements": 1}
                      for i in range(count)]
    scene["beams"] += fuzz.SMALL[0]["beams"]
    scene["loads"] = [{"beam": f"b{i}", "force": [0, 1, 0]} for i in range(count)]
    return {**scene, **more}


def with_law(expression):
    scene = json.loads(json.dumps(fuzz.SMALL[0]))
    scene["loads"][0]["law"] = {"expression": expression}
    scene["frames"] = [{"name": "table", "turns": [{"axis": [0, 0, 1], "rate": True,
                                                    "angle": {"expression": expression}}]}]
    scene["analysis"]["end_time"] = 100
    return scene


def heavy(scale):
    """Name and text of inputs that once took minutes or gigabytes."""
    n = int(4_000_000 * min(1.0, scale))
    yield "12 MB of {},", '{"nodes":[' + "{}," * n + "{}]}"
    yield "12 MB of numbers", '{"nodes":[' + "1," * n + "1]}"
    yield "12 MB of keys", '{"nodes":{' + ",".join(f'"{i}":1' for i in range(n // 4)) + "}}"
    yield "deep arrays", "[" * n + "]" * n
    yield "one long string", '{"title":"' + "x" * (3 * n) + '"}'
    yield "one long name", json.dumps({**fuzz.SMALL[0], "nodes": [{"name": "x" * n}]})
    yield "nested frames", json.dumps(nested(n // 200))
    yield "beams with loads", json.dumps(row(n // 400))
    yield "beams with wrong sections", json.dumps(row(n // 400, sections=[]))
    yield "a million elements", json.dumps({**fuzz.SMALL[0], "beams": [{**fuzz.SMALL[0]["beams"][0],
                                                                        "elements": 10**6}]})
    yield "the most elements", json.dumps({**fuzz.SMALL[0], "beams": [{**fuzz.SMALL[0]["beams"][0],
                                                                       "elements": 2**31 - 1}]})
    for law in ("abs(sin(1e7*t))", "step(sin(1e9*t))", "sin(1e9*t*t)", "abs(1.0000001+sin(1e9*t))",
                "+".join(["abs(sin(1e5*t))"] * 2000)):
        yield "the law " + law[:30], json.dumps(with_law(law))


def budgets(options, outcome, folder):
    file, count = folder / "heavy.json", 0
    for name, text in heavy(options.scale):
        file.write_text(text)
        result = process.run([options.program, "check", file], 60, cwd=folder)
        faults = process.faults_of(result)
        if result.cpu_seconds > fuzz.SECONDS:
            faults.append(f"{result.cpu_seconds:.1f} s of processor time")
        if result.megabytes > fuzz.MEGABYTES:
            faults.append(f"{result.megabytes:.0f} MB")
        if faults:
            outcome.failures.append(f"check of {name}: {'; '.join(faults)}: {result.err[-200:]}")
        count += 1
    outcome.counts["heavy inputs"] = count


def run(options):
    outcome = process.Outcome()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        under_limits(options, outcome, folder)
        budgets(options, outcome, folder)
    return outcome
