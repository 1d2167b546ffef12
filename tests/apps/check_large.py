"""check_large.py PROGRAM SOURCE   the lattice of 10 512 bars: 101 pictures, what they take is at most the 200 MB that are
promised and not much less, the summary says how many are VTU files, and the page of the run is smaller than 20 MB."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])


def main():
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "out"
        subprocess.run([PROGRAM, "run", SOURCE / "data/gallery/lattice.json", "--out", out, "--quiet"], check=True)
        files = [f for f in out.rglob("*") if f.is_file()]
        size = sum(f.stat().st_size for f in files if f.name.startswith(("motion", "frame_")))
        assert 150e6 < size <= 200e6, size
        notes = json.loads((out / "summary.json").read_text(encoding="utf-8"))["notes"]
        found = [re.search(r"of the motion (\d+) pictures are kept, and every (\d+)th one", n) for n in notes]
        kept, every = next(map(int, m.groups()) for m in found if m)
        vtu = sum(f.suffix == ".vtu" for f in files)
        assert kept == 101 and vtu == -(-100 // every) + 1, (kept, every, vtu)
        subprocess.run([PROGRAM, "view", out], check=True, stdout=subprocess.DEVNULL)
        page = (out / "view.html").read_text(encoding="utf-8")
        assert len(page) < 20e6, len(page)
        data = page[page.index('<script type="application/json" id="run">'):]
        times = json.loads(re.search(r'"times":(\[[^]]*\])', data).group(1))
        assert len(times) == 101, len(times)
        print(f"101 pictures, {vtu} VTU files, {size / 1e6:.0f} MB, a page of {len(page) / 1e6:.1f} MB")


main()
