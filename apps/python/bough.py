"""Results of bough as NumPy arrays with names and units, and runs from Python. Needs NumPy alone.

    import bough
    run = bough.run("data/scenarios/four_bar_misaligned.json", "out", set={"/output/motion": True})
    run["C.x"], run.unit("C.x"), run.time
    run.plot("C")                          # where matplotlib is installed
    motion = bough.read_motion("out")        # positions of beams and bodies, picture by picture

`run` and `batch` call the program `bough` of the PATH, or that of the environment variable BOUGH.
"""

import csv
import difflib
import json
import os
import pathlib
import struct
import subprocess
import zlib

import numpy

__all__ = ["BoughError", "Motion", "Run", "batch", "read", "read_motion", "read_npy", "run"]


class BoughError(RuntimeError):
    """The program refused its input or failed; the text is what it said. `status` is its exit status."""

    def __init__(self, text, status):
        super().__init__(text)
        self.status = status


class Run:
    """One directory of results. run[column] is an array of one value a row; columns are named as in history.csv."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        self.columns, table = _read_table(self.directory)
        self._index = {name: k for k, name in enumerate(self.columns)}
        self._table = table
        self._errors = None
        self._about = {}
        about = self.directory / "columns.json"
        if about.exists():
            self._about = {c["name"]: c for c in json.loads(about.read_text(encoding="utf-8"))["columns"]}
        summary = self.directory / "summary.json"
        self.summary = json.loads(summary.read_text(encoding="utf-8")) if summary.exists() else {}

    @property
    def time(self):
        """Times [s] of the rows; in statics load factors."""
        return self["time"]

    @property
    def status(self):
        return self.summary.get("status", "unfinished")

    @property
    def doubts(self):
        """Why the run should not be trusted without a closer look: {"about": ..., "text": ...} for each reason."""
        return self.summary.get("trust", {}).get("doubts", [])

    @property
    def trusted(self):
        """Whether the run is complete and nothing in it speaks against its results."""
        return self.status == "ok" and not self.doubts

    @property
    def tables(self):
        """Results that are no history, {table: {column: array}}: tables["modes"]["frequency"] [Hz]. Numbers are arrays of one
        value a row, texts lists; what a table shows stands in summary["tables"][table]["about"], with the units."""
        tables = {}
        for name, table in self.summary.get("tables", {}).items():
            tables[name] = {}
            for column in (c["name"] for c in table["columns"]):
                cells = [row[column] for row in table["rows"]]
                is_text = any(isinstance(cell, str) and cell not in ("nan", "inf", "-inf") for cell in cells)
                tables[name][column] = cells if is_text else numpy.array(cells, dtype=float)
        return tables

    @property
    def linear_model(self):
        """The minimal form of a linear model, x' = A x + B u, y = C x + D u: {"A": array, "B", "C", "D", "T", "inputs": names,
        "outputs": names, "states": names}; None where there is none, of which summary["tables"] tells why. The sparse form is
        in linear_model.npz."""
        file = self.directory / "linear_model.json"
        told = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
        if "minimal" not in told:
            return None
        arrays = numpy.load(self.directory / "linear_model.npz")
        model = {name: arrays[name] for name in "ABCDT"}
        model["states"] = [x["name"] for x in told["minimal"]["states"]]
        for ports in ("inputs", "outputs"):
            model[ports] = [x["name"] for x in told[ports]]
        return model

    @property
    def errors(self):
        """Measured errors of the columns, {column: {"extrapolated": ..., "error_in_time": ..., "error_of_mesh": ...}} with
        arrays of one value a row, limit minus value and NaN where it is not known; {} where none were measured. What is
        known of them in words and numbers stands in summary["errors"]."""
        if self._errors is None:
            table = self.directory / "errors.csv"
            self._errors = {}
            if table.exists():
                names, rows = _read_csv(table)
                for name, values in zip(names[3:], rows.T[3:]):
                    column, _, kind = name.rpartition(".")
                    self._errors.setdefault(column, {})[kind] = values
        return self._errors

    def __getitem__(self, column):
        """The column of this name, or all columns of the sensor of this name, one array column each."""
        if column in self._index:
            return self._table[:, self._index[column]]
        return self._table[:, [self._index[c] for c in self._of_sensor(column)]]

    def __contains__(self, column):
        return column in self._index or bool(self.columns_of(column))

    def __len__(self):
        return len(self._table)

    def columns_of(self, sensor):
        return [c for c in self.columns if c.rpartition(".")[0] == sensor]

    def _of_sensor(self, sensor):
        """The columns of a sensor; a KeyError that tells which names are near where there is none."""
        of_sensor = self.columns_of(sensor)
        if not of_sensor:
            known = [*self.columns, *dict.fromkeys(c.rpartition(".")[0] for c in self.columns if "." in c)]
            near = difflib.get_close_matches(str(sensor), known, 3, 0.5)
            meant = f"did you mean {' or '.join(repr(name) for name in near)}? " if near else ""
            raise KeyError(f"no column or sensor {sensor!r}; {meant}there are {', '.join(self.columns)}")
        return of_sensor

    def unit(self, column):
        """Unit of a column, "" for a pure number and for a signal whose unit is not known."""
        if column not in self._index:
            self._of_sensor(column)
        return self._about.get(column, {}).get("unit", "")

    def label(self, column):
        """Name with its unit, for axes."""
        unit = self.unit(column)
        return f"{column} [{unit}]" if unit else column

    def plot(self, *columns, axes=None):
        """Draws columns, or all of a sensor, over time, with bands of their known errors; returns the axes of matplotlib."""
        from matplotlib import pyplot

        axes = axes if axes is not None else pyplot.gca()
        for name in columns:
            for column in [name] if name in self._index else self._of_sensor(name):
                (line,) = axes.plot(self.time, self[column], label=self.label(column))
                if column in self.errors:
                    kinds = [self.errors[column][kind] for kind in ("error_in_time", "error_of_mesh")]
                    half = numpy.nansum(numpy.abs(kinds), axis=0)
                    axes.fill_between(self.time, self[column] - half, self[column] + half, color=line.get_color(), alpha=0.3)
        axes.set_xlabel(self.label("time"))
        axes.legend()
        return axes


class Motion:
    """Pictures of a run.

    times: (n,); curves: {name: (n, points, 3)} places along beams [m], bodies: {name: (n, 3)} centres of mass [m];
    forces, strains: {name: (n, points, 6)} along beams, (N, Q2, Q3, T, M2, M3) and (e1, g2, g3, k1, k2, k3);
    velocities: {name: (n, points, 3) or (n, 3)}; rotations: the same of rotation vectors from the start, in space;
    links: {name: (n, 2, 3)} both sides of joints and springs; signals: {name: (n,)} that change with the motion;
    signal_units: {name: unit}, empty for a pure number and where it is not known.
    """

    def __init__(self, path):
        raw = pathlib.Path(path).read_bytes()
        end = raw.find(b"\n") + 1
        header = json.loads(raw[:end])
        if header.get("format") != "bough motion 4":
            raise BoughError(f"{path}: not a file of the format 'bough motion 4'", None)
        start, at = {}, end
        shapes = [("curves", c["name"], c["points"] * 12) for c in header["curves"]]
        shapes += [("bodies", b["name"], 15 + 3 * b["attachments"]) for b in header["bodies"]]
        shapes += [("links", link["name"], 15) for link in header["links"]]
        shapes += [("frames", name, 12) for name in header["frames"]]
        shapes += [("arrows", arrow["name"], 3) for arrow in header["arrows"]]
        for kind, name, count in shapes:
            start[kind, name] = numpy.frombuffer(raw, "<f8", count, at)
            at += 8 * count
        times, frames = [], []
        head = struct.Struct("<ddQ")
        while at + head.size <= len(raw):  # of a run that was killed: those that are whole
            time, _, size = head.unpack_from(raw, at)
            at += head.size
            if size > len(raw) - at:
                break
            planes = numpy.frombuffer(zlib.decompress(raw[at:at + size]), numpy.uint8)
            frames.append(planes.reshape(4, -1).T.copy().view("<f4")[:, 0])
            times.append(time)
            at += size
        count = len(times)
        self.times = numpy.array(times)
        values = numpy.array(frames, dtype=float).reshape(count, header["frame_floats"])
        self.curves, self.bodies, self.links = {}, {}, {}
        self.forces, self.strains, self.velocities, self.rotations = {}, {}, {}, {}
        at = 0
        for curve in header["curves"]:
            name, points = curve["name"], curve["points"]
            block = values[:, at:at + 21 * points].reshape(count, points, 21)
            at += 21 * points
            self.curves[name] = block[:, :, 0:3] + start["curves", name].reshape(points, 12)[:, :3]
            self.rotations[name], self.velocities[name] = block[:, :, 3:6], block[:, :, 6:9]
            self.forces[name], self.strains[name] = block[:, :, 9:15], block[:, :, 15:21]
        for body in header["bodies"]:
            name, block = body["name"], values[:, at:at + 9]
            at += 9
            self.bodies[name] = block[:, 0:3] + start["bodies", name][:3]
            self.rotations[name], self.velocities[name] = block[:, 3:6], block[:, 6:9]
        for link in header["links"]:
            block = values[:, at:at + 15]
            at += 15
            self.links[link["name"]] = block[:, :6].reshape(count, 2, 3) + start["links", link["name"]][:6].reshape(2, 3)
        at += 9 * len(header["frames"]) + 12 * len(header["arrows"])
        names = header.get("signals", [])
        self.signals = {name: values[:, at + k] for k, name in enumerate(names)}
        self.signal_units = dict(zip(names, header.get("signal_units", [])))


def read_npy(path, columns=None):
    """The rows of history.npy, also of one that a crash left unfinished (history.npy.partial): its size tells how many."""
    with open(path, "rb") as file:
        version = numpy.lib.format.read_magic(file)
        if version != (1, 0):
            raise BoughError(f"{path}: not a file of the format .npy, version 1.0", None)
        shape, _, kind = numpy.lib.format.read_array_header_1_0(file)
        begin = file.tell()
    if len(shape) != 2 or kind != numpy.dtype("<f8") or columns not in (None, shape[1]):
        raise BoughError(f"{path}: not the rows of a history", None)
    rows = (os.path.getsize(path) - begin) // (8 * shape[1])
    return numpy.memmap(path, "<f8", "r", begin, (rows, shape[1])) if rows else numpy.empty((0, shape[1]))


def read(directory):
    """The results of a run: of its folder, or of the hidden one beside it, .NAME.bough-new, which a run fills until it is
    done and which a run that was killed leaves behind; that one has no units."""
    return Run(directory)


def read_motion(directory):
    """The pictures of a run with "output": {"motion": true}."""
    return Motion(pathlib.Path(directory) / "motion.bin")


def run(scene, out, set=None, threads=None, check=True, replace=False,  # noqa: A002  named as options of the program
        start=None, start_time=None):
    """Runs a scene into the directory `out` and reads it. `set`: {"/pointer": value}. A run that fails is a BoughError
    unless check is False; input that is refused always is, and so is a directory with results of another scene unless
    replace is True. `start`: directory of a run from whose last state this one starts, or from that of `start_time`."""
    words = ["run", os.fspath(scene), "--out", os.fspath(out), "--quiet", *(["--replace"] if replace else [])]
    words += [] if start is None else ["--from", os.fspath(start)]
    words += [] if start_time is None else ["--time", repr(float(start_time))]
    status, text = _call(words + _settings(set) + ([] if threads is None else ["--threads", str(threads)]))
    if status == 2 or (check and status != 0):
        raise BoughError(text.strip(), status)
    return Run(out if status == 0 or not pathlib.Path(f"{out}.failed").exists() else f"{out}.failed")


def batch(folder, out, set=None, threads=None):  # noqa: A002
    """Runs all scenes of a folder, but for those that are done there and have not changed; returns the rows of batch.csv
    as a list of dictionaries, numbers as floats."""
    words = ["batch", os.fspath(folder), "--out", os.fspath(out), "--quiet", "--resume"]
    status, text = _call(words + _settings(set) + ([] if threads is None else ["--threads", str(threads)]))
    if status not in (0, 1):
        raise BoughError(text.strip(), status)
    with open(pathlib.Path(out) / "batch.csv", encoding="utf-8", newline="") as file:
        return [{key: _number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def _settings(values):
    words = []
    for pointer, value in (values or {}).items():
        words += ["--set", f"{pointer}={json.dumps(value)}"]
    return words


def _call(words):
    done = subprocess.run([os.environ.get("BOUGH", "bough"), *words], capture_output=True, text=True, check=False)
    return done.returncode, done.stderr + done.stdout


def _plain(text):
    """A text of a table, without the apostrophe that keeps a spreadsheet from taking it for a formula."""
    return text[1:] if text.startswith("'") and text.lstrip("'")[:1] in tuple("=+-@\t\r") else text


def _number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return text


def _read_table(directory):
    """Names of the columns, and all rows: those of history.npy where the history is long, else of history.csv, of which
    rows that a crash cut off are left out. While a run goes on, and after it was killed, both end with .partial."""
    table, twin = directory / "history.csv", directory / "history.npy"
    if not table.exists():
        table, twin = directory / "history.csv.partial", directory / "history.npy.partial"
    if twin.exists():
        with open(table, encoding="utf-8", newline="") as file:
            names = [_plain(name) for name in next(csv.reader(file))]
        return names, read_npy(twin, len(names))
    return _read_csv(table)


def _read_csv(table):
    """Names of the columns and all whole rows of a table of numbers."""
    with open(table, encoding="utf-8", newline="") as file:
        names = [_plain(name) for name in next(csv.reader(file))]
        rows = [row.split(",") for row in file.read().split("\n")]
    whole = [row for row in rows if len(row) == len(names)]
    return names, numpy.array(whole, dtype=float).reshape(len(whole), len(names))
