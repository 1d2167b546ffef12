"""Asks an independent validator whether the published schemas, of scenes, chains of frames and studies, agree with the readers.

usage: check_schema.py cases-directory scenarios-directory
The base scene, every scene of the gallery and every standing study have to be valid, every broken one invalid. Exit status 77: the validator is not there.
"""
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed: skipped")
    sys.exit(77)



def failures_in(cases, good):
    schema = json.loads((cases / "schema.json").read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    failures = 0
    for file in good:
        for error in validator.iter_errors(json.loads(file.read_text())):
            print(f"{file}: refused: /{'/'.join(map(str, error.absolute_path))}: {error.message[:200]}")
            failures += 1
    bad = sorted((cases / "bad").glob("*.json"), key=lambda f: int(f.stem))
    for file in bad:
        if validator.is_valid(json.loads(file.read_text())):
            print(f"{file}: accepted, but broken: {file.read_text()[:60]!r}")
            failures += 1
    print(f"{len(good)} good and {len(bad)} broken files, {failures} disagreements")
    return failures if bad else failures + 1


cases, scenarios = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
scenes = [cases / "base.json", *sorted(scenarios.glob("*.json"))]
failures = failures_in(cases, scenes) + failures_in(cases / "chain", [cases / "chain" / "base.json"])
studies = [cases / "study" / "base.json", *sorted((scenarios.parent / "studies").glob("*.json"))]
failures += failures_in(cases / "study", studies)
sweeps = [cases / "sweep" / "base.json", *sorted((scenarios.parent / "sweeps").glob("*.json"))]
failures += failures_in(cases / "sweep", sweeps)
sys.exit(1 if failures or len(scenes) < 2 else 0)
