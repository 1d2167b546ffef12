#!/usr/bin/env python3
"""check_gltf.py PROGRAM FOLDER   motion.glb: its structure, and places of bodies, beams and springs against sensors

Reads the file by the specification of glTF 2.0 alone: chunks, bounds of arrays, nodes, skins and the animation. Places of
nodes, of the last ring of a beam's surface and of the ends of a spring, moved as a viewer moves them, are those of the
history."""
import csv
import json
import math
import pathlib
import struct
import subprocess
import sys

program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
scene = {
    "schema_version": 1,
    "gravity": [0, 0, -9.81],
    "materials": [{"name": "m", "young": 1e8, "poisson": 0.3, "density": 1000}],
    "sections": [{"name": "s", "shape": {"kind": "tube", "outer_radius": 0.05, "inner_radius": 0.03}, "material": "m"}],
    "bodies": [{"name": "bob", "mass": 2, "shape": {"kind": "box", "size": [0.2, 0.1, 0.1]}, "position": [1, 0.5, 2]}],
    "nodes": [{"name": "root", "position": [0, 0, 1]}, {"name": "tip", "position": [0, 2, 1]}],
    "beams": [{"name": "rod", "section": "s", "start": "root", "end": "tip", "elements": 3, "order": 2,
               "axis_2": [1, 0, 0]}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "root"},
               {"name": "pin", "kind": "spherical", "first": "ground", "second": "bob", "position": [0.5, 0.5, 2]}],
    "springs": [{"name": "rope", "first": {"to": "ground", "position": [0, 0, 3]}, "second": "bob", "stiffness": 40,
                 "rest_length": 1}],
    "initial_velocities": [{"of": "bob", "angular_velocity": [0, 3, 4], "velocity": [0, 2, -1.5]}],
    "sensors": [{"name": "bob", "kind": "position", "at": "bob"}, {"name": "tip", "kind": "position", "at": "tip"},
                {"name": "turn", "kind": "quaternion", "at": "bob"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01},
    "output": {"formats": ["gltf"]},
}


def run(name, changes=()):
    file, out = folder / f"{name}.json", folder / name
    file.write_text(json.dumps(scene))
    words = [w for change in changes for w in ("--set", change)]
    subprocess.run([program, "run", file, "--out", out, "--replace", "--quiet", *words], check=True)
    data = (out / "motion.glb").read_bytes()
    with (out / "history.csv").open() as lines:
        rows = list(csv.reader(lines))
    return data, [dict(zip(rows[0], map(float, row))) for row in rows[1:]]


def times(q, v):
    """v turned by the quaternion (x, y, z, w)."""
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


class File:
    """A file, read as the specification says."""
    SIZES = {5126: ("f", 4), 5125: ("I", 4), 5123: ("H", 2)}
    COMPONENTS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}

    def __init__(self, data):
        magic, version, length = struct.unpack_from("<III", data)
        assert magic == 0x46546C67 and version == 2 and length == len(data), "head"
        size, kind = struct.unpack_from("<II", data, 12)
        assert kind == 0x4E4F534A and size % 4 == 0, "JSON chunk"
        self.json = json.loads(data[20:20 + size])
        count, kind = struct.unpack_from("<II", data, 20 + size)
        assert kind == 0x004E4942 and count % 4 == 0 and 28 + size + count == len(data), "binary chunk"
        self.bytes = data[28 + size:]
        assert self.json["asset"]["version"] == "2.0"
        assert self.json["buffers"] == [{"byteLength": count}]
        self.arrays = [self.read(a) for a in self.json["accessors"]]
        self.check()

    def read(self, a):
        view = self.json["bufferViews"][a["bufferView"]]
        letter, width = self.SIZES[a["componentType"]]
        components = self.COMPONENTS[a["type"]]
        assert view["byteOffset"] % 4 == 0 and a["count"] > 0
        assert view["byteLength"] == a["count"] * components * width
        assert view["byteOffset"] + view["byteLength"] <= len(self.bytes)
        flat = struct.unpack_from(f"<{a['count'] * components}{letter}", self.bytes, view["byteOffset"])
        rows = [flat[k:k + components] for k in range(0, len(flat), components)]
        for c in range(components if "min" in a else 0):
            assert a["min"][c] == min(r[c] for r in rows) and a["max"][c] == max(r[c] for r in rows), "bounds"
        return rows

    def check(self):
        nodes = self.json["nodes"]
        parents = [child for n in nodes for child in n.get("children", [])]
        assert len(parents) == len(set(parents)), "a node has two parents"
        assert set(parents) | set(self.json["scenes"][0]["nodes"]) == set(range(len(nodes)))
        for mesh in self.json["meshes"]:
            for p in mesh["primitives"]:
                points = self.arrays[p["attributes"]["POSITION"]]
                assert "min" in self.json["accessors"][p["attributes"]["POSITION"]]
                assert max(i[0] for i in self.arrays[p["indices"]]) < len(points), "index"
                assert len(self.arrays[p["indices"]]) % (3 if p["mode"] == 4 else 2) == 0
                if p["mode"] == 4 and "JOINTS_0" in p["attributes"]:
                    self.check_closed([i[0] for i in self.arrays[p["indices"]]])
        for n in nodes:
            if "skin" in n:
                skin = self.json["skins"][n["skin"]]
                joints = self.arrays[self.json["meshes"][n["mesh"]]["primitives"][0]["attributes"]["JOINTS_0"]]
                assert max(j[0] for j in joints) < len(skin["joints"])
                assert len(self.arrays[skin["inverseBindMatrices"]]) == len(skin["joints"])
        seen = set()
        for channel in self.json["animations"][0]["channels"]:
            sampler = self.json["animations"][0]["samplers"][channel["sampler"]]
            at, values = self.arrays[sampler["input"]], self.arrays[sampler["output"]]
            assert len(at) == len(values) and all(a[0] < b[0] for a, b in zip(at, at[1:])) and at[0][0] >= 0
            key = channel["target"]["node"], channel["target"]["path"]
            assert key not in seen, "two channels for one target"
            seen.add(key)
            if channel["target"]["path"] == "rotation":
                assert all(abs(sum(x * x for x in q) - 1) < 1e-5 for q in values), "rotation"
                assert all(sum(x * y for x, y in zip(p, q)) > 0 for p, q in zip(values, values[1:])), "a jump"

    @staticmethod
    def check_closed(indices):
        """Every edge of a closed surface that is turned outwards is passed once in each direction."""
        edges = {}
        for k in range(0, len(indices), 3):
            t = indices[k:k + 3]
            for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0])):
                edges[(a, b)] = edges.get((a, b), 0) + 1
        assert all(count == edges.get((b, a)) for (a, b), count in edges.items()), "the surface is open"

    def times(self):
        return [t[0] for t in self.arrays[self.json["animations"][0]["samplers"][0]["input"]]]

    def node(self, name):
        return next(k for k, n in enumerate(self.json["nodes"]) if n["name"] == name)

    def pose(self, node, k):
        """Place, rotation and scale of a node in the world, y upwards, in picture k."""
        own = {p: self.json["nodes"][node].get(p, d)
               for p, d in (("translation", [0, 0, 0]), ("rotation", [0, 0, 0, 1]), ("scale", [1, 1, 1]))}
        for channel in self.json["animations"][0]["channels"]:
            if channel["target"]["node"] == node:
                sampler = self.json["animations"][0]["samplers"][channel["sampler"]]
                own[channel["target"]["path"]] = self.arrays[sampler["output"]][k]
        return own

    def place(self, node, k, own=(0, 0, 0)):
        """A point of a node in the axes of the scene: as a viewer moves it, turned back from y upwards."""
        pose = self.pose(node, k)
        local = [a * s for a, s in zip(own, pose["scale"])]
        x = [a + b for a, b in zip(pose["translation"], times(pose["rotation"], local))]
        root = self.json["nodes"][0]
        x = times(root["rotation"], x)
        origin = root.get("extras", {}).get("origin", [0, 0, 0])
        return [x[0] + origin[0], -x[2] + origin[1], x[1] + origin[2]]

    def surface_place(self, mesh_node, k, points):
        """Mean of points of a skinned mesh, each moved by the node that it follows."""
        n = self.json["nodes"][mesh_node]
        skin = self.json["skins"][n["skin"]]
        attributes = self.json["meshes"][n["mesh"]]["primitives"][0]["attributes"]
        place, carrier = self.arrays[attributes["POSITION"]], self.arrays[attributes["JOINTS_0"]]
        mean = [0.0, 0.0, 0.0]
        for p in points:
            j = carrier[p][0]
            m = self.arrays[skin["inverseBindMatrices"]][j]
            own = [sum(m[4 * c + r] * place[p][c] for c in range(3)) + m[12 + r] for r in range(3)]
            x = self.place(skin["joints"][j], k, own)
            mean = [a + b / len(points) for a, b in zip(mean, x)]
        return mean


def distance(a, b):
    return math.dist(a, b)


def compare(file, rows, tolerance):
    by_time = {round(row["time"], 9): row for row in rows}
    at = [by_time[min(by_time, key=lambda t: abs(t - time))] for time in file.times()]
    assert len(at) > 50
    bob, rope = file.node("bob"), file.node("rope")
    surface = file.node("rod, surface")
    points = len(file.arrays[file.json["meshes"][file.json["nodes"][surface]["mesh"]]["primitives"][0]["attributes"]
                             ["POSITION"]])
    rings = 3 * 4 + 1
    last = range(points - points // rings, points)
    far = {"bob": 0.0, "turn": 0.0, "tip": 0.0, "rope": 0.0}
    for k, row in enumerate(at):
        body = [row[f"bob.{c}"] for c in "xyz"]
        q = [row[f"turn.q{i}"] for i in (1, 2, 3, 0)]
        arm = times(q, [0.1, 0.05, -0.05])
        far["bob"] = max(far["bob"], distance(file.place(bob, k), body))
        far["turn"] = max(far["turn"], distance(file.place(bob, k, (0.1, 0.05, -0.05)),
                                                [a + b for a, b in zip(body, arm)]))
        far["tip"] = max(far["tip"], distance(file.surface_place(surface, k, last), [row[f"tip.{c}"] for c in "xyz"]))
        far["rope"] = max(far["rope"], distance(file.place(rope, k, (1, 0, 0)), body))
    moved = max(distance([row[f"tip.{c}"] for c in "xyz"], [0, 2, 1]) for row in at)
    assert moved > 0.1, "the beam bends"
    for what, value in far.items():
        assert value < tolerance, f"{what} is off by {value}"
    print(", ".join(f"{what} {value:.1e}" for what, value in far.items()))


data, rows = run("near")
near = File(data)
compare(near, rows, 1e-5)
assert "extras" not in near.json["nodes"][0]

# Far from the origin of the scene the structure keeps its digits.
offset = [3e6, -2e6, 5e5]
for part in scene["bodies"] + scene["nodes"]:
    part["position"] = [a + b for a, b in zip(part["position"], offset)]
scene["joints"][1]["position"] = [a + b for a, b in zip(scene["joints"][1]["position"], offset)]
scene["springs"][0]["first"]["position"] = [a + b for a, b in zip([0, 0, 3], offset)]
data, rows = run("far")
compare(File(data), rows, 2e-5)

print("motion.glb holds the motion")
