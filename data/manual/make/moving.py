#!/usr/bin/env python3
"""Makes a moving picture (GIF) of a scene from pictures that `bough view --png` draws, with the standard library alone.

    python3 moving.py PROGRAM SCENE OUT.gif BEGIN END FRAMES

Runs SCENE with its motion, draws FRAMES instants from BEGIN [s] up to, but without, END, halves their size, and writes
them as one picture that repeats in the time of the run. Two runs write the same bytes.
"""

import collections
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib


def read_png(path):
    """Width, height and the bytes of a PNG of eight bits a channel, RGB, as `bough view` writes it."""
    data = path.read_bytes()
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    if (depth, kind) != (8, 2):
        raise SystemExit(f"{path}: not RGB of eight bits")
    packed, at = b"", 8
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if name == b"IDAT" else b""
        at += 12 + size
    raw, stride = zlib.decompress(packed), 3 * width
    rows, last = [], bytes(stride)
    for y in range(height):
        how, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        if how:
            for x in range(stride):
                left, up, corner = (row[x - 3], last[x], last[x - 3]) if x >= 3 else (0, last[x], 0)
                near = min((left, up, corner), key=lambda v: abs(left + up - corner - v))  # of equals the first: Paeth
                row[x] = (row[x] + (0, left, up, (left + up) // 2, near)[how]) & 255
        last = bytes(row)
        rows.append(last)
    return width, height, rows


def halved(width, height, rows):
    """Pixels of half the width and height: means of four, in steps of eight so that few colours remain."""
    pixels = []
    for y in range(0, height - 1, 2):
        a, b = rows[y], rows[y + 1]
        for x in range(0, 3 * (width - 1), 6):
            pixels.append(tuple(min(255, ((a[x + c] + a[x + 3 + c] + b[x + c] + b[x + 3 + c]) // 4 + 2) // 8 * 8)
                                for c in range(3)))
    return pixels


def compressed(indices):
    """LZW of GIF with eight bits a pixel, in blocks."""
    out, bits, count = bytearray(), 0, 0
    table, width, word = {bytes([k]): k for k in range(256)}, 9, b""

    def put(code):
        nonlocal bits, count
        bits |= code << count
        count += width
        while count >= 8:
            out.append(bits & 255)
            bits >>= 8
            count -= 8

    put(256)
    for index in indices:
        longer = word + bytes([index])
        if longer in table:
            word = longer
            continue
        put(table[word])
        table[longer] = len(table) + 2
        if len(table) + 2 > (1 << width) and width < 12:
            width += 1
        if len(table) + 2 >= 4096:
            put(256)
            table, width = {bytes([k]): k for k in range(256)}, 9
        word = bytes([index])
    put(table[word])
    put(257)
    out.append(bits & 255)
    return b"".join(bytes([len(out[k:k + 255])]) + out[k:k + 255] for k in range(0, len(out), 255)) + b"\0"


def gif(width, height, frames, hundredths):
    """A GIF that repeats. What does not change from one frame to the next is transparent, colour 255."""
    counts = collections.Counter(pixel for frame in frames for pixel in frame)
    palette = [colour for colour, _ in sorted(counts.items(), key=lambda item: (-item[1], item[0]))[:255]]
    nearest = {colour: k for k, colour in enumerate(palette)}
    for colour in counts.keys() - nearest.keys():
        distances = [sum((a - b)**2 for a, b in zip(other, colour)) for other in palette]
        nearest[colour] = distances.index(min(distances))
    table = b"".join(bytes(colour) for colour in palette).ljust(768, b"\0")
    text = b"GIF89a" + struct.pack("<HHBBB", width, height, 0xF7, 0, 0) + table + b"!\xff\x0bNETSCAPE2.0\x03\x01\0\0\0"
    last = None
    for frame in frames:
        shown = [nearest[pixel] for pixel in frame]
        indices = shown if last is None else [255 if a == b else a for a, b in zip(shown, last)]
        last = shown
        text += struct.pack("<BBBBHBB", 0x21, 0xF9, 4, 0x05, hundredths, 255, 0)
        text += struct.pack("<BHHHHB", 0x2C, 0, 0, width, height, 0) + b"\x08" + compressed(indices)
    return text + b";"


def main():
    program, scene, out = sys.argv[1:4]
    begin, end, number = float(sys.argv[4]), float(sys.argv[5]), int(sys.argv[6])
    frames = []
    with tempfile.TemporaryDirectory() as folder:
        results, picture = pathlib.Path(folder) / "out", pathlib.Path(folder) / "picture.png"
        quiet = {"check": True, "stdout": subprocess.DEVNULL}
        subprocess.run([program, "run", scene, "--out", results, "--quiet", "--set", "/output/motion=true"], **quiet)
        for k in range(number):
            time = begin + (end - begin) * k / number
            words = [program, "view", results, "--view", "iso", "--png", picture, "--time", f"{time:g}"]
            subprocess.run(words, **quiet)
            width, height, rows = read_png(picture)
            frames.append(halved(width, height, rows))
            picture.unlink()
    hundredths = max(2, round(100 * (end - begin) / number))
    pathlib.Path(out).write_bytes(gif(width // 2, height // 2, frames, hundredths))


if __name__ == "__main__":
    if len(sys.argv) != 7:
        sys.exit(__doc__)
    main()
