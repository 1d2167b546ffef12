#!/usr/bin/env python3
"""check_html.py [--shots FOLDER] PAGE...   opens each page in a headless browser without network: light and dark at
1300, 800 and 400 px, on paper, and without scripts. Exit status 1: an error on the console, a request, texts that
overlap other texts or drawings, cut columns, enlarged drawings, words of little contrast (page_boxes.js), or an
empty page. 77: there is no browser."""

import pathlib
import sys

import browser

MODES = [(f"{width} px{', dark' if dark else ''}", {"width": width, "dark": dark})
         for width in (1300, 800, 400) for dark in (False, True)]
MODES += [("on paper", {"width": 718, "media": "print"}), ("without scripts", {"width": 1000, "scripts": False})]
BOXES = (pathlib.Path(__file__).parent / "page_boxes.js").read_text(encoding="utf-8")


def look(chromium, page, shots):
    faults = []
    for name, how in MODES:
        chromium.open(page, **how)
        seen = chromium.evaluate(BOXES) + chromium.faults
        if not chromium.evaluate("document.querySelectorAll('svg, canvas, table, img').length"):
            seen.append("no drawing, no picture and no table")
        faults += [f"{page}, {name}: {fault}" for fault in seen]
        if shots:
            chromium.screenshot(shots / f"{page.parent.name}-{page.stem}-{name.replace(', ', '-').replace(' ', '_')}.png")
    return faults


def main():
    words = sys.argv[1:]
    shots = None
    if words[0] == "--shots":
        shots = pathlib.Path(words[1])
        shots.mkdir(parents=True, exist_ok=True)
        words = words[2:]
    if not browser.find():
        print("check_html: no chromium found")
        return 77
    faults = []
    with browser.Browser() as chromium:
        for page in map(pathlib.Path, words):
            found = look(chromium, page, shots)
            faults += found
            print(f"{page}: looked at in {len(MODES)} ways, {len(found)} faults")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
