#!/usr/bin/env python3
"""Shows that check_manual.py finds what it looks for: a page without faults passes, and each fault is told.

    python3 test_check_manual.py PROGRAM
"""

import pathlib
import subprocess
import sys
import tempfile

CHECK = pathlib.Path(__file__).parent / "check_manual.py"
SCENE = ('{"schema_version": 1, "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}],\n'
         ' "analysis": {"kind": "dynamic", "end_time": 0.1}}\n')
GOOD = f"""# Title

[below](#a-heading)

## A heading

<!-- file: scene.json -->
```json
{SCENE}```

<!-- into: scene.json -->
```json
"sensors": [{{"name": "place", "kind": "position", "at": "a"}}]
```

```sh
bough run scene.json
```

```text
scene: done
  ... steps accepted, ...
```

```sh
printf drawn > made.svg
```

<!-- picture: made.svg -->
![A picture](kept.svg)
"""
FAULTS = [  # what is changed, into what, and what has to be told
    ('"mass": 1', '"mass": -1', "/bodies/0/mass"),
    ('"at": "a"', '"at": "b"', "bough check scene.json"),
    ("<!-- file: scene.json -->\n", "", "does not say which file"),
    ("bough run scene.json", "bough run other.json", "status 2"),
    ("```sh\nbough", "```\nbough", "nothing can be checked"),
    ("scene: done", "scene: over", "is not printed: scene: over"),
    ("printf drawn", "printf other", "kept.svg is not the made.svg"),
    ("## A heading", "## Another", "no such heading"),
    ("(#a-heading)", "(elsewhere.md)", "no such file"),
    ("(#a-heading)", "(../../README.md)", "leads out of the manual"),
]


def told(program, source):
    """Whether both checks pass, and all that they print."""
    runs = [subprocess.run([sys.executable, CHECK, *words], stdout=subprocess.PIPE, text=True)
            for words in ([program, source], ["--links", source])]
    return all(run.returncode == 0 for run in runs), "".join(run.stdout for run in runs)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder)
        page = source / "data" / "manual" / "page.md"
        page.parent.mkdir(parents=True)
        (source / "README.md").write_text("[the manual](data/manual/page.md#a-heading)\n", encoding="utf-8")
        (page.parent / "kept.svg").write_text("drawn", encoding="utf-8")
        for old, new, words in [("", "", ""), *FAULTS]:
            text = GOOD.replace(old, new, 1) if old else GOOD
            page.write_text(text, encoding="utf-8")
            passed, printed = told(program, source)
            if passed != (not old) or words not in printed:
                failed += 1
                print(f"{old!r} -> {new!r}: passed {passed}, printed\n{printed}")
    print(f"{len(FAULTS)} faults, {failed} not found")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
