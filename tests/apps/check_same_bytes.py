"""check_same_bytes.py PROGRAM SOURCE   the same input gives the same bytes of pages and pictures: of one run, of a copy
of its folder elsewhere, seen later, from another folder, with other words in the environment, and of a second run.
Nothing of them tells a path, a host, a user or a date."""

import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time

PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
SCENES = ["gallery/gyroscope", "scenarios/four_bar_misaligned", "scenarios/bend_45"]


def call(*words, folder=None, **environment):
    subprocess.run([PROGRAM, *map(str, words)], check=True, stdout=subprocess.DEVNULL, cwd=folder,
                   env={**os.environ, **environment})


def made(results, other=None, folder=None, **environment):
    """Bytes of the page, the drawing and the picture of a run, or of the page of two."""
    call("view", results, *([other] if other else []), folder=folder, **environment)
    place = pathlib.Path(folder or ".") / results
    files = [(place / "view.html").read_bytes()]
    if other is None:
        words = ["--svg", "drawing.svg", "--png", "picture.png", "--time", "0.01"]
        call("view", results, *words, folder=folder, **environment)
        for name in ("drawing.svg", "picture.png"):
            path = pathlib.Path(folder or ".") / name
            files.append(path.read_bytes())
            path.unlink()
    return files


def check_silent(pages, first):
    """No word of where, when and by whom a page was made."""
    words = [str(first), str(SOURCE), socket.gethostname(), os.environ.get("HOME", "")]
    for page in pages:
        text = page.decode("utf-8", "replace")
        found = [w for w in words if len(w) > 2 and w in text]
        # Packed numbers are base64 and may hold anything.
        readable = re.sub(r'"packed":"[^"]*"', "", text)
        found += re.findall(r"\b20[2-9]\d-[01]\d-[0-3]\d\b|\b[0-2]\d:[0-5]\d:[0-5]\d\b", readable)
        assert not found, found


def main():
    with tempfile.TemporaryDirectory() as scratch:
        first, second = pathlib.Path(scratch) / "here", pathlib.Path(scratch) / "elsewhere"
        first.mkdir()
        second.mkdir()
        os.chdir(first)
        for name in SCENES:
            scene, results = SOURCE / f"data/{name}.json", name.rpartition("/")[2]
            words = ["--quiet", "--set", "/output/motion=true"]
            words += [] if name.endswith("bend_45") else ["--set", "/analysis/end_time=0.05"]
            call("run", scene, "--out", results, *words)
            call("run", scene, "--out", "B", *words, "--threads", 1)
            one = made(results)
            pair = made(results, "B")
            check_silent(one[:2] + pair, first)
            time.sleep(1.1)
            shutil.copytree(results, second / results, copy_function=shutil.copyfile)
            shutil.copytree("B", second / "B", copy_function=shutil.copyfile)
            other = {"TZ": "Asia/Tokyo", "LC_ALL": "de_DE.UTF-8", "HOME": str(second), "USER": "another"}
            assert made(results, folder=second, **other) == one, f"{name}: another folder, time and environment"
            assert made(results, "B", folder=second, **other) == pair, f"{name}: two runs elsewhere"
            call("run", scene, "--out", results, *words, folder=second)
            again = made(results, folder=second)
            assert again == one, f"{name}: a second run"
            for folder in (first, second):
                shutil.rmtree(folder / results)
                shutil.rmtree(folder / "B")
    print(f"pages, drawings, pictures of {len(SCENES)} scenes are the same bytes wherever and whenever they are made")


main()
