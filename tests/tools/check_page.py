#!/usr/bin/env python3
"""check_page.py DOM DATA [SCREENSHOT...]   compares a page with its data file.

Every number of the page that names its place in DATA (data-source, a JSON pointer) must be the number there, rounded to
the digits shown; marks of charts contain it in full (data-y). The page must contain every error that DATA contains. A
screenshot must have several colours, and its background must not cover nearly all of it.
"""

import html.parser
import json
import struct
import sys
import zlib


class Page(html.parser.HTMLParser):
    """Texts and full values by the pointers that they name."""

    def __init__(self):
        super().__init__()
        self.texts = []
        self.values = []
        self.file = None
        self.open_cell = None

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "main":
            self.file = attributes.get("data-file")
        source = attributes.get("data-source")
        if source is None:
            return
        if "data-y" in attributes:
            self.values.append((source, attributes["data-y"]))
        elif tag == "td":
            self.open_cell = [source, ""]

    def handle_data(self, data):
        if self.open_cell is not None:
            self.open_cell[1] += data

    def handle_endtag(self, tag):
        if tag == "td" and self.open_cell is not None:
            self.texts.append(tuple(self.open_cell))
            self.open_cell = None


def at(data, pointer):
    for token in pointer.split("/")[1:]:
        token = token.replace("~1", "/").replace("~0", "~")
        data = data[int(token)] if isinstance(data, list) else data[token]
    return data


def same_rounded(text, value):
    if value is None or isinstance(value, str):
        return text == "-" or text == value
    try:
        shown = float(text)
    except ValueError:
        return False
    return any(float(f"{value:.{digits}g}") == shown for digits in range(2, 18))


def colours_of(file):
    """Colours of an 8-bit PNG and the share of the most frequent one."""
    with open(file, "rb") as f:
        blob = f.read()
    assert blob[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG"
    position, packed, channels, width = 8, b"", 0, 0
    while position < len(blob):
        length, kind = struct.unpack(">I4s", blob[position:position + 8])
        chunk = blob[position + 8:position + 8 + length]
        if kind == b"IHDR":
            width, _, depth, colour_type = struct.unpack(">IIBB", chunk[:10])
            assert depth == 8 and colour_type in (2, 6), "another kind of PNG"
            channels = 3 if colour_type == 2 else 4
        elif kind == b"IDAT":
            packed += chunk
        position += 12 + length
    raw, stride, before, counts = zlib.decompress(packed), width * channels, None, {}
    for start in range(0, len(raw), stride + 1):
        filter_type, line = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        above = before or bytes(stride)
        for i in range(stride):
            left = line[i - channels] if i >= channels else 0
            up, corner = above[i], above[i - channels] if i >= channels else 0
            if filter_type == 1:
                line[i] = (line[i] + left) & 255
            elif filter_type == 2:
                line[i] = (line[i] + up) & 255
            elif filter_type == 3:
                line[i] = (line[i] + (left + up) // 2) & 255
            elif filter_type == 4:
                guess = left + up - corner
                line[i] = (line[i] + min((left, up, corner), key=lambda c: abs(guess - c))) & 255
        before = bytes(line)
        for i in range(0, stride, channels):
            colour = before[i:i + 3]
            counts[colour] = counts.get(colour, 0) + 1
    return len(counts), max(counts.values()) / sum(counts.values())


def main():
    dom, data_file, *screenshots = sys.argv[1:]
    page = Page()
    with open(dom, encoding="utf-8") as f:
        page.feed(f.read())
    with open(data_file, encoding="utf-8") as f:
        data = json.load(f)
    problems = []
    if page.file != data_file.replace("\\", "/").rsplit("/", 1)[-1]:
        problems.append(f"the page names {page.file}, not {data_file}")
    for source, text in page.texts:
        value = at(data, source)
        if not same_rounded(text, value):
            problems.append(f"{source}: the page shows {text}, the file holds {value}")
    for source, text in page.values:
        if float(text) != at(data, source):
            problems.append(f"{source}: the page draws {text}, the file holds {at(data, source)}")
    shown, drawn = {s for s, _ in page.texts}, {s for s, _ in page.values}
    for r, run in enumerate(data.get("runs", [])):
        for q, errors in enumerate(run["errors"]):
            pointer = f"/runs/{r}/errors/{q}/max"
            if errors["max"] is not None and (pointer not in shown or pointer not in drawn):
                problems.append(f"{pointer} is missing in the page's tables or charts")
    if not page.texts or not page.values:
        problems.append("the page shows no numbers that name their source")
    for file in screenshots:
        colours, share = colours_of(file)
        if colours < 20 or share > 0.99:
            problems.append(f"{file}: {colours} colours, {100 * share:.1f} % of it one of them: nothing to see")
    for problem in problems[:20]:
        print(problem)
    print(f"{len(page.texts)} numbers and {len(page.values)} marks, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
