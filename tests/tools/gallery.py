#!/usr/bin/env python3
"""gallery.py PROGRAM OUT SCENE...   makes one page with a picture of every scene, OUT/index.html, and for each scene a
folder of results with a view, OUT/<scene>/view.html. Exit status 1: some scene failed."""

import base64
import concurrent.futures
import html
import json
import os
import pathlib
import subprocess
import sys

STYLE = """:root{color-scheme:light dark}body{margin:0 auto;max-width:1240px;padding:20px;font:15px/1.5 system-ui,sans-serif}
main{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,380px),1fr));gap:16px}figure{margin:0}
img{width:100%;height:auto;border-radius:6px}figcaption{font-size:13px;overflow-wrap:anywhere}figure{min-width:0}h1{font-size:22px}
@media print{main{grid-template-columns:1fr 1fr}figure{break-inside:avoid}}"""


def draw(program, out, scene, name):
    """Runs a scene in a folder of its name and draws it. Returns the figure, or the error."""
    folder = out / name
    words = [program, "run", scene, "--out", folder, "--quiet", "--threads", "1", "--set", "/output/motion=true"]
    run = subprocess.run(words, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        return None, f"{scene.name}: {run.stderr.strip()}"
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    with open(folder / "history.csv", encoding="utf-8") as file:
        last = max(float(line.split(",")[0]) for line in file.readlines()[1:])  # load factors may turn back
    # Well into the run, and not at a simple fraction of a period.
    words = [program, "view", folder, "--png", folder / "picture.png", "--time", str(0.737 * last)]
    view = subprocess.run(words, capture_output=True, text=True, check=False)
    if view.returncode != 0:
        return None, f"{scene.name}: {view.stderr.strip()}"
    picture = base64.b64encode((folder / "picture.png").read_bytes()).decode()
    title = html.escape(summary.get("title") or scene.stem)
    return (f'<figure><a href="{html.escape(name)}/view.html"><img alt="{title}" width="1000" height="700" '
            f'src="data:image/png;base64,{picture}"></a>'
            f"<figcaption><b>{html.escape(name)}</b> {title}</figcaption></figure>"), None


def main():
    program, out = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2])
    scenes = sorted((pathlib.Path(s) for s in sys.argv[3:]), key=lambda s: s.stem)
    out.mkdir(parents=True, exist_ok=True)
    stems = [s.stem for s in scenes]  # one that two folders have is told apart by these
    names = [s.stem if stems.count(s.stem) == 1 else f"{s.parent.name}_{s.stem}" for s in scenes]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        drawn = list(pool.map(lambda s, n: draw(program, out, s, n), scenes, names))
    policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
    page = ('<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width,initial-scale=1">'
            f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
            f"<title>Scenes of bough</title><style>{STYLE}</style></head><body><h1>Scenes of bough</h1>"
            "<p>A picture leads to the moving one.</p><main>\n" + "\n".join(f for f, _ in drawn if f) +
            "\n</main></body></html>\n")
    (out / "index.html").write_text(page, encoding="utf-8")
    faults = [fault for _, fault in drawn if fault]
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{out / 'index.html'}: {len(scenes) - len(faults)} of {len(scenes)} scenes")
    return 1 if faults else 0


sys.exit(main())
