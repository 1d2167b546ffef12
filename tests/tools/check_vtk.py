#!/usr/bin/env python3
"""check_vtk.py PROGRAM SCENE...   runs every scene, and one that has all shapes, and reads motion.pvd and every VTU
file with VTK (Debian: python3-vtk9). Exit status 1: something is not as stated here; 77: there is no VTK.

Of every file: it is read without a word of the reader; its time is that of motion.pvd; cells name points that are
there; all arrays are those of bough/io/write_vtu.hpp, finite, one value a point or a cell; names are those of the
scene; cells are the same in all files of a run. Surfaces of bodies are closed. Sizes are held against the scene:

- area of a section at every point of every beam: that of the shape or outline, of a section without one
  12 sqrt(EI2 EI3)/EA. Round sections are polygons of the same area, so that no facet is allowed for: relative 1e-9 and
  the rounding of coordinates;
- volume of a beam as VTK integrates it, between two points: area times the projected length of the axis of centroids,
  int (centroid' . normal area), sections mixed linearly between the two; within what the plane faces of VTK's
  tetrahedra differ from the twisted sides of cells, which is zero where a beam does not twist or bend;
- length of the axes of straight beams in the first picture, where they are not strained: the distance of their nodes;
- volume of a body: that of its shape, with no facets to allow for; area of its surface: round faces of 24 sides and
  equal volume have sqrt(n/pi tan(pi/n)) = 1.0029 times the area of the round ones, and at most 1.02 where they are
  curved in two directions.
"""

import collections
import concurrent.futures
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

try:
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    # Debian's packages belong to its own interpreter, which need not be the first of the PATH.
    debian = "/usr/bin/python3"
    if os.path.exists(debian) and not os.path.samefile(sys.executable, debian):
        os.execv(debian, [debian, *sys.argv])
    print("no VTK for Python (Debian: python3-vtk9): nothing is checked")
    sys.exit(77)

VECTORS = ["force", "moment", "strain", "curvature", "velocity", "axis_1", "axis_2", "axis_3"]
POLYLINE, TRIANGLE, WEDGE = vtk.VTK_POLY_LINE, vtk.VTK_TRIANGLE, vtk.VTK_WEDGE
BEAM, BODY, LINK, LOAD = range(4)
PI = math.pi


def shoelace(points):
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1]))


def section_area(s):
    """Area of a section's shape by its closed form [m^2]."""
    kind = s["kind"]
    if kind == "rectangle":
        return s["width"] * s["height"]
    if kind == "circle":
        return PI * s["radius"] ** 2
    if kind == "tube":
        return PI * (s["outer_radius"] ** 2 - s["inner_radius"] ** 2)
    if kind == "ellipse":
        return PI / 4 * s["width"] * s["height"]
    if kind == "box":
        return s["width"] * s["height"] - (s["width"] - 2 * s["thickness"]) * (s["height"] - 2 * s["thickness"])
    if kind in ("i", "c"):
        return 2 * s["width"] * s["flange"] + (s["height"] - 2 * s["flange"]) * s["web"]
    if kind == "l":
        return (s["width"] + s["height"] - s["thickness"]) * s["thickness"]
    return shoelace(s["points"]) + sum(map(shoelace, s.get("holes", [])))


def body_sizes(s):
    """Volume, area of plane faces or faces curved in no direction, of those curved in one, of those curved in two."""
    kind = s["kind"]
    if kind == "box":
        a, b, c = s["size"]
        return a * b * c, 2 * (a * b + b * c + c * a), 0, 0
    if kind == "sphere":
        return 4 / 3 * PI * s["radius"] ** 3, 0, 0, 4 * PI * s["radius"] ** 2
    length = s["length"]
    if kind == "cylinder":
        return PI * s["radius"] ** 2 * length, 2 * PI * s["radius"] ** 2, 2 * PI * s["radius"] * length, 0
    if kind == "capsule":
        r = s["radius"]
        return PI * r * r * length + 4 / 3 * PI * r ** 3, 0, 2 * PI * r * length, 4 * PI * r * r
    if kind == "cone":
        r, e = s["radius"], s.get("end_radius", 0)
        volume, side = PI * length / 3 * (r * r + r * e + e * e), PI * (r + e) * math.hypot(length, r - e)
        return volume, PI * (r * r + e * e), side, 0
    if kind == "ring":
        r, i = s["outer_radius"], s["inner_radius"]
        return PI * (r * r - i * i) * length, 2 * PI * (r * r - i * i), 2 * PI * (r + i) * length, 0
    around = sum(math.dist(a, b) for a, b in zip(s["points"], s["points"][1:] + s["points"][:1]))
    area = shoelace(s["points"])
    return area * length, 2 * area + around * length, 0, 0


def area_of_sections(scene):
    areas = {}
    for s in scene.get("sections", []):
        shape = s.get("outline") or s.get("shape")
        if shape and not ("file" in shape):
            areas[s["name"]] = section_area(shape)
        elif not shape and isinstance(s["stiffness"], dict):
            k = s["stiffness"]
            areas[s["name"]] = 12 * math.sqrt(k["EI2"] * k["EI3"]) / k["EA"]
    return areas


def straight_length(scene, beam):
    """Distance of the ends of a beam between two nodes of the ground; None of others."""
    nodes = {n["name"]: n for n in scene.get("nodes", [])}
    ends = [nodes.get(beam[e]) if isinstance(beam[e], str) else None for e in ("start", "end")]
    if "curve" in beam or "frame" in beam or None in ends or any("frame" in n for n in ends):
        return None
    return math.dist(*(n.get("position", [0, 0, 0]) for n in ends))


class File:
    """One VTU file as VTK reads it."""

    def __init__(self, path, faults):
        words = []
        reader = vtk.vtkXMLUnstructuredGridReader()
        for event in ("ErrorEvent", "WarningEvent"):
            reader.AddObserver(event, lambda *_: words.append(event))
        reader.SetFileName(str(path))
        reader.Update()
        self.grid = reader.GetOutput()
        if words:
            faults.append(f"{path.name}: VTK says {', '.join(words)}")
        self.points = vtk_to_numpy(self.grid.GetPoints().GetData()).astype(float)
        self.is_single = self.grid.GetPoints().GetDataType() == vtk.VTK_FLOAT
        cells = self.grid.GetCells()
        self.offsets = vtk_to_numpy(cells.GetOffsetsArray()).astype(np.int64)
        self.connectivity = vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)
        self.types = vtk_to_numpy(self.grid.GetCellTypesArray())
        data = self.grid.GetPointData()
        self.vectors = {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}
        data = self.grid.GetCellData()
        self.cells = {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}

    def names(self, kind):
        array = self.grid.GetFieldData().GetAbstractArray(f"{kind}_names")
        return [array.GetValue(k) for k in range(array.GetNumberOfValues())] if array else []

    def corners(self, of, count):
        """Points of cells of one type with `count` corners, one row a cell."""
        return self.connectivity[self.offsets[:-1][of][:, None] + np.arange(count)]


def check_arrays(f, time, scene, faults):
    n, cells = f.grid.GetNumberOfPoints(), f.grid.GetNumberOfCells()
    if not np.isfinite(f.points).all() or not n or not cells:
        faults.append("no points, no cells, or points that are not finite")
    if sorted(f.vectors) != sorted(VECTORS):
        faults.append(f"arrays of points: {sorted(f.vectors)}")
    for name, values in f.vectors.items():
        if values.shape != (n, 3) or not np.isfinite(values).all():
            faults.append(f"{name}: shape {values.shape}, or values that are not finite")
    if sorted(f.cells) != ["kind", "part", "subdomain"] or any(v.shape != (cells,) for v in f.cells.values()):
        faults.append(f"arrays of cells: { {k: v.shape for k, v in f.cells.items()} }")
    if f.connectivity.size and not 0 <= f.connectivity.min() <= f.connectivity.max() < n:
        faults.append("cells name points that are not there")
    told = f.grid.GetFieldData().GetArray("TimeValue")
    # Along a path, load factors need not grow: motion.pvd then lists pictures by number.
    if told is None or (told.GetValue(0) != time and "arc_length" not in scene["analysis"]):
        faults.append(f"time {told and told.GetValue(0)}, in motion.pvd {time}")
    for kind, key, number in [("beam", "beams", BEAM), ("body", "bodies", BODY)]:
        names = f.names(kind)
        if sorted(names) != sorted(p["name"] for p in scene.get(key, [])):
            faults.append(f"names of {key}: {names[:5]}")
        parts = np.unique(f.cells["part"][f.cells["kind"] == number])
        if list(parts) != list(range(len(names))):
            faults.append(f"cells of {len(names)} {key} name {len(parts)} parts")
    for kind, number in [("link", LINK), ("load", LOAD)]:
        parts = f.cells["part"][f.cells["kind"] == number]
        if parts.size and parts.max() >= len(f.names(kind)):
            faults.append(f"{kind} {parts.max()} has no name")
    if (f.cells["subdomain"][f.types == WEDGE] < 0).any():
        faults.append("a beam has a part without a sub-domain")


def cell_volumes(f):
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(f.grid)
    sizes.ComputeVertexCountOff()
    sizes.ComputeLengthOff()
    sizes.ComputeAreaOff()
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))


class Beams:
    """Sections and volumes of all beams of one file. A ring is the section at a point."""

    def __init__(self, f):
        lines = np.flatnonzero((f.types == POLYLINE) & (f.cells["kind"] == BEAM))
        order = f.cells["part"][lines]
        self.intervals = np.zeros(len(order), np.int64)
        self.intervals[order] = f.offsets[lines + 1] - f.offsets[lines] - 1
        self.axes = {p: f.connectivity[f.offsets[c]:f.offsets[c + 1]] for p, c in zip(order, lines)}
        wedges = np.flatnonzero(f.types == WEDGE)
        self.part = f.cells["part"][wedges]
        counts = np.bincount(self.part, minlength=len(order))
        local = np.arange(len(wedges)) - (np.cumsum(counts) - counts)[self.part]
        self.triangles = counts // np.maximum(1, self.intervals)
        first = np.cumsum(self.intervals) - self.intervals
        self.interval = first[self.part] + local // np.maximum(1, self.triangles)[self.part]
        self.of_part = np.repeat(np.arange(len(order)), self.intervals)  # of each interval
        x = f.points[f.corners(wedges, 6)]
        total = int(self.intervals.sum())

        def summed(values):
            return np.stack([np.bincount(self.interval, values[:, c], total) for c in range(values.shape[1])], 1)

        def ring(a, b, c):
            normal = 0.5 * np.cross(b - a, c - a)
            size = np.linalg.norm(normal, axis=1)[:, None]
            area = summed(size)
            with np.errstate(invalid="ignore", divide="ignore"):
                return summed(normal), area[:, 0], summed(size * (a + b + c) / 3) / area

        low = ring(x[:, 0], x[:, 2], x[:, 1])
        high = ring(x[:, 3], x[:, 5], x[:, 4])
        b0, c0, b1, c1 = x[:, 2] - x[:, 0], x[:, 1] - x[:, 0], x[:, 5] - x[:, 3], x[:, 4] - x[:, 3]
        mixed = summed(0.25 * (np.cross(b0, c1) + np.cross(b1, c0)))
        self.areas = np.stack([low[1], high[1]])
        # VTK cuts a cell into tetrahedra. Each of its three sides that is twisted then has plane faces on either of its
        # diagonals, which differ from the straight-line surface between them by half the tetrahedron of its corners.
        cut = np.zeros(len(wedges))
        for i, j in [(0, 1), (1, 2), (2, 0)]:
            p = x[:, i]
            cut += np.abs(np.einsum("ij,ij->i", x[:, j] - p, np.cross(x[:, i + 3] - p, x[:, j + 3] - p))) / 12
        self.cut = np.bincount(self.interval, cut, total)
        # int over the interval of (centroid' . normal area): the section between two rings is mixed linearly.
        self.swept = np.einsum("ij,ij->i", high[2] - low[2], (low[0] + high[0] + mixed) / 3)
        self.volumes = np.bincount(self.interval, cell_volumes(f)[wedges], total)
        self.edge = np.zeros(total)
        np.maximum.at(self.edge, self.interval, np.linalg.norm(b0, axis=1))
        self.chord = np.linalg.norm(high[2] - low[2], axis=1)


def check_beams(f, scene, areas, is_first, faults):
    beams, names = Beams(f), f.names("beam")
    by_name = {b["name"]: b for b in scene.get("beams", [])}
    rounding = (2.0 ** -24 if f.is_single else 2.0 ** -53) * np.abs(f.points).max()
    known = np.array([areas.get(by_name[n]["section"], np.nan) for n in names] or [0.0])
    expected = known[beams.of_part] if len(beams.of_part) else np.zeros(0)
    drawn = np.isfinite(beams.swept)
    with np.errstate(invalid="ignore", divide="ignore"):
        # Of coordinates that are rounded by r, the area changes by about r times the perimeter.
        allowed = 1e-9 * expected + 40 * rounding * beams.edge
        wrong = drawn & np.isfinite(expected) & (np.abs(beams.areas - expected) > allowed).any(0)
        volume = np.where(np.isfinite(expected), expected / beams.areas[0], 1.0) * beams.swept
        allowed = 40 * rounding * (beams.edge * beams.chord + beams.areas[0])
        allowed += 1e-6 * np.abs(volume) + beams.cut
        off = drawn & (np.abs(beams.volumes - volume) > allowed)
    for which, words in [(wrong, "area of the section"), (off, "volume")]:
        if which.any():
            k = int(np.flatnonzero(which)[0])
            faults.append(f"{words} of beam {names[beams.of_part[k]]!r}: areas {beams.areas[:, k]}, volume "
                          f"{beams.volumes[k]:.9g}, expected {expected[k]:.9g} and {volume[k]:.9g} within "
                          f"{allowed[k]:.2g}; {which.sum()} in all")
    if len(names) and len(drawn) and not drawn.all():
        faults.append(f"{(~drawn).sum()} intervals of beams have no section")
    if is_first:
        for part, name in enumerate(names):
            length, axis = straight_length(scene, by_name[name]), beams.axes[part]
            strain = np.abs(f.vectors["strain"][axis]).max()
            if length is None or strain > 1e-6 or np.abs(f.vectors["curvature"][axis]).max() * length > 1e-3:
                continue
            along = np.linalg.norm(np.diff(f.points[axis], axis=0), axis=1).sum()
            if abs(along - length) > (2 * strain + 1e-7) * length + 4 * len(axis) * rounding:
                faults.append(f"length of beam {name!r}: {along:.9g}, of the scene {length:.9g}")
    return len(drawn)


def check_bodies(f, scene, faults):
    by_name, count = {b["name"]: b for b in scene.get("bodies", [])}, 0
    rounding = (2.0 ** -24 if f.is_single else 2.0 ** -53) * np.abs(f.points).max()
    for part, name in enumerate(f.names("body")):
        of = np.flatnonzero((f.types == TRIANGLE) & (f.cells["kind"] == BODY) & (f.cells["part"] == part))
        shape, has_looks = by_name[name].get("shape"), "looks" in by_name[name]
        if not of.size:
            if shape or has_looks:
                faults.append(f"body {name!r} has no surface")
            continue
        corners = f.corners(of, 3)
        sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
        edges = collections.Counter(map(tuple, sides))
        if not has_looks and any(count != 1 or (b, a) not in edges for (a, b), count in edges.items()):
            faults.append(f"the surface of body {name!r} is not closed")
        used, index = np.unique(corners, return_inverse=True)
        surface = vtk.vtkPolyData()
        points = vtk.vtkPoints()
        points.SetDataTypeToDouble()
        for x in f.points[used]:
            points.InsertNextPoint(x - f.points[used].mean(0))
        faces = vtk.vtkCellArray()
        for t in index.reshape(corners.shape):
            faces.InsertNextCell(3, [int(k) for k in t])
        surface.SetPoints(points)
        surface.SetPolys(faces)
        sizes = vtk.vtkMassProperties()
        sizes.SetInputData(surface)
        sizes.Update()
        volume, area = sizes.GetVolume(), sizes.GetSurfaceArea()
        a, b, c = (f.points[corners[:, k]] - f.points[used].mean(0) for k in range(3))
        signed = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
        if not has_looks and signed <= 0:
            faults.append(f"the surface of body {name!r} is inside out")
        if not shape or has_looks or shape["kind"] == "rod" or "file" in shape:
            continue
        count += 1
        true_volume, plane, bent, ball = body_sizes(shape)
        ratio = math.sqrt(24 / PI * math.tan(PI / 24))
        allowed = 40 * rounding * area
        # A cone's tip is a ring of a millionth of its radius; its facets lie at another slope than the cone.
        slope = 1e-2 if shape["kind"] == "cone" else 1e-6
        if abs(volume - true_volume) > 2e-6 * true_volume + allowed or abs(signed - volume) > 1e-6 * volume + allowed:
            faults.append(f"volume of body {name!r}: {volume:.9g}, of the scene {true_volume:.9g}")
        least = plane + ratio * bent + ball
        most = plane + ratio * bent + 1.02 * ball
        allowed = 40 * rounding * math.sqrt(area)
        if not least * (1 - slope) - allowed <= area <= most * (1 + slope) + allowed:
            faults.append(f"area of body {name!r}: {area:.9g}, of the scene {least:.9g} to {most:.9g}")
    return count


def check_run(folder, scene):
    """Faults, and what was read: files, rings of beams, bodies with a shape."""
    faults, seen = [], collections.Counter()
    entries = xml.etree.ElementTree.parse(folder / "motion.pvd").getroot().findall("Collection/DataSet")
    times = [float(e.get("timestep")) for e in entries]
    if not entries or times != sorted(times):
        faults.append(f"motion.pvd: {len(entries)} pictures, or times that do not grow")
    listed = {(folder / e.get("file")).resolve() for e in entries}
    if listed != {p.resolve() for p in folder.rglob("*.vtu")}:
        faults.append("motion.pvd does not list the files that are there")
    areas, same = area_of_sections(scene), None
    for k, (time, entry) in enumerate(zip(times, entries)):
        of_file = []
        f = File(folder / entry.get("file"), of_file)
        if not of_file:
            check_arrays(f, time, scene, of_file)
        if not of_file:
            topology = (f.types.tobytes(), f.offsets.tobytes(), f.connectivity.tobytes())
            if same is not None and topology != same:
                of_file.append("its cells are not those of the first file")
            same = topology
            seen["intervals"] += check_beams(f, scene, areas, k == 0, of_file)
            seen["bodies"] += check_bodies(f, scene, of_file)
        seen["files"] += 1
        faults += [f"{entry.get('file')}: {fault}" for fault in of_file]
    return faults, seen


def all_shapes(folder):
    """A scene with every kind of section and body, names that XML and VTK must not read as their own, and far from the
    origin so that coordinates need double precision."""
    ring = [[0, 0], [0.06, 0], [0.06, 0.03], [0.04, 0.05], [0, 0.05]]
    numbers = {"EA": 1e6, "GA2": 1e6, "GA3": 1e6, "GJ": 300, "EI2": 300, "EI3": 500}
    mass = {"mass_per_length": 1, "rotary": [1e-3, 5e-4, 5e-4]}
    outlines = [
        {"kind": "rectangle", "width": 0.05, "height": 0.03}, {"kind": "circle", "radius": 0.03},
        {"kind": "tube", "outer_radius": 0.03, "inner_radius": 0.025},
        {"kind": "ellipse", "width": 0.06, "height": 0.03},
        {"kind": "box", "width": 0.05, "height": 0.04, "thickness": 0.003},
        {"kind": "i", "width": 0.05, "height": 0.06, "web": 0.004, "flange": 0.006},
        {"kind": "c", "width": 0.04, "height": 0.06, "web": 0.004, "flange": 0.006},
        {"kind": "l", "width": 0.05, "height": 0.04, "thickness": 0.004},
        {"kind": "polygon", "points": ring, "holes": [[[0.02, 0.01], [0.02, 0.03], [0.04, 0.03]]]},
        None,
    ]
    bodies = [
        {"kind": "box", "size": [0.1, 0.2, 0.3]}, {"kind": "cylinder", "radius": 0.1, "length": 0.3, "axis": 2},
        {"kind": "sphere", "radius": 0.1}, {"kind": "rod", "length": 0.3, "axis": 3},
        {"kind": "capsule", "radius": 0.05, "length": 0.2}, {"kind": "cone", "radius": 0.1, "length": 0.2, "axis": 3},
        {"kind": "cone", "radius": 0.1, "end_radius": 0.05, "length": 0.2},
        {"kind": "ring", "outer_radius": 0.1, "inner_radius": 0.08, "length": 0.05, "axis": 2},
        {"kind": "extrusion", "points": ring, "length": 0.1, "axis": 3},
    ]
    names = ["<beam> & \"b\"", "]]>", "Träger ß", "שלום", "n" * 100]
    sections, nodes, beams, parts, joints = [], [], [], [], []
    for k, outline in enumerate(outlines):
        shown = {"outline": outline} if outline else {}
        sections.append({"name": f"s{k}", "stiffness": numbers, "mass": mass, **shown})
        nodes += [{"name": f"a{k}", "position": [0, k, 0]}, {"name": f"b{k}", "position": [1, k, 0.2]}]
        beams.append({"name": names[k] if k < len(names) else f"beam {k}", "section": f"s{k}", "start": f"a{k}",
                      "end": f"b{k}", "elements": 2, "twist": 0.3})
        joints.append({"name": f"wall {k}", "kind": "fixed", "first": "ground", "second": f"a{k}",
                       "position": [0, k, 0]})
    for k, shape in enumerate(bodies):
        parts.append({"name": f"<Piece> {k}", "mass": 1, "shape": shape, "position": [3, k, 0],
                      "rotation": {"axis": [1, 2, 3], "angle": 0.7}})
    joints.append({"name": "rod", "kind": "fixed", "first": "ground", "second": "<Piece> 3",
                   "position": [3, 3, 0]})  # which has no inertia about its axis
    parts.append({"name": "no shape", "mass": 1, "inertia": [1, 2, 2.5], "position": [4, 0, 0]})
    parts.append({"name": "point", "kind": "point_mass", "mass": 1, "position": [4, 1, 0]})
    scenes = []
    for name, shift in [("all_shapes", 0.0), ("all_shapes_far", 1e5)]:
        def moved(items):
            return [{**p, "position": [p["position"][0] + shift, *p["position"][1:]]} for p in items]
        scenes.append(folder / f"{name}.json")
        scenes[-1].write_text(json.dumps({
            "schema_version": 1, "gravity": [0, 0, -9.81], "sections": sections, "nodes": moved(nodes), "beams": beams,
            "bodies": moved(parts), "joints": moved(joints),
            "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 1e-3}}), encoding="utf-8")
    return scenes


def main():
    program, scenes = os.path.abspath(sys.argv[1]), [pathlib.Path(s).resolve() for s in sys.argv[2:]]
    vtk.vtkObject.GlobalWarningDisplayOff()
    faults = []
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        scenes = all_shapes(scratch) + scenes

        def simulate(scene):
            """Results of a scene and the scene itself with numbers for formulas and copies."""
            out = scratch / f"{scene.parent.name}_{scene.stem}"
            words = [program, "run", scene, "--out", out, "--quiet", "--threads", "1", "--set", "/output/motion=true"]
            run = subprocess.run(words, capture_output=True, text=True, check=False)
            expanded = subprocess.run([program, "expand", scene], capture_output=True, text=True, check=False)
            if run.returncode or expanded.returncode:
                sys.exit(f"{scene}: {run.stderr}{expanded.stderr}")
            return out, json.loads(expanded.stdout)

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for scene, made in zip(scenes, pool.map(simulate, scenes)):
                found, seen = check_run(*made)
                shutil.rmtree(made[0])
                print(f"{scene.parent.name}/{scene.name}: {seen['files']} files, {seen['intervals']} pieces of beams, "
                      f"{seen['bodies']} bodies, {len(found)} faults", flush=True)
                faults += [f"{scene.name}: {fault}" for fault in found[:6]]
    for fault in faults[:60]:
        print(fault)
    return 1 if faults else 0


sys.exit(main())
