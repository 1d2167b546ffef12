#!/usr/bin/env python3
"""Fails on an include that the table of layers does not allow.

Files of layer X may include bough/Y/... only if Y is in the closure of X in USES, and headers of external libraries
only if LIBRARIES names the layer. Tests, benchmarks and apps may include all layers."""

import pathlib
import re
import sys

# layer: the layers that it uses directly; it may also use those that they use
USES = {
    "lanes": [],
    "blocks": [],
    "motion": ["lanes"],
    "laws": [],
    "scene": ["motion", "laws"],
    "records": ["scene"],
    "elements": ["motion", "scene"],
    "plan": ["records", "elements", "blocks"],
    "io": ["plan"],
    "tree": ["blocks"],
    "solve": ["tree", "lanes"],
    "schedule": ["tree"],
    "step": ["plan", "solve"],
    "results": ["step"],
    "run": ["io", "results", "schedule"],
    "study": ["run"],
    "stress": ["run"],
    "report": ["study", "stress"],
}

# start of an include: the layers that may use it ("apps" may use CLI11 and make the TBB arena)
LIBRARIES = {
    "tbb/": {"schedule", "apps"},
    "oneapi/": {"schedule", "apps"},
    "muParser": {"laws"},
    "nlohmann/": {"io", "report", "apps"},
    "CLI/": {"apps"},
    "metis": {"tree"},
    "klu": {"solve"},
    "suitesparse/": {"solve"},
    "cholmod": {"solve"},
    "umfpack": {"solve"},
    "gtest/": set(),
    "benchmark/": set(),
}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
SUFFIXES = {".hpp", ".cpp", ".h", ".inl", ".ipp"}


def closure(layer):
    seen = {layer}
    stack = [layer]
    while stack:
        for used in USES[stack.pop()]:
            if used not in seen:
                seen.add(used)
                stack.append(used)
    return seen


def layer_of(path, root):
    parts = path.relative_to(root).parts
    if parts[0] == "include" and len(parts) > 3:
        return parts[2]
    if parts[0] == "src" and len(parts) > 2:
        return parts[1]
    return "apps"


def problems_in(path, root):
    layer = layer_of(path, root)
    if layer != "apps" and layer not in USES:
        yield f"{path.relative_to(root)}: '{layer}' is not a layer"
        return
    allowed = set(USES) if layer == "apps" else closure(layer)
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        name = match.group(1)
        where = f"{path.relative_to(root)}:{number}"
        parts = name.split("/")
        if parts[0] == "bough" and len(parts) > 2 and parts[1] not in allowed:
            yield f"{where}: layer '{layer}' may not include <{name}>"
        for start, layers in LIBRARIES.items():
            if name.startswith(start) and layer not in layers:
                yield f"{where}: <{name}> belongs to {sorted(layers) or 'no layer'}, not to '{layer}'"


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    files = [p for folder in ("include", "src", "apps") for p in sorted((root / folder).rglob("*")) if p.suffix in SUFFIXES]
    problems = [text for path in files for text in problems_in(path, root)]
    for text in problems:
        print(text)
    print(f"include arrows: {len(files)} files, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
