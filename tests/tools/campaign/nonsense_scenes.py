"""Scenes that make no sense, each with the required content of the message.

A case is a sensible base scene with one fault. `verb` is the latest command that may report it: faults of the file
alone belong to `check`, faults that follow from the plan to `plan`, and faults that only the computation shows to
`run`. The message must contain every word of `names` and one of `words`; it must not give the advice in `wrong`."""

import copy
from dataclasses import dataclass, field


@dataclass
class Case:
    name: str
    kind: str
    verb: str
    scene: object
    names: list
    words: list = field(default_factory=list)
    wrong: list = field(default_factory=list)


STEPS = ["take smaller steps", "use smaller steps"]  # no cure for what is wrong with a scene itself

BOX = {"mass": 1.0, "inertia": [0.1, 0.2, 0.3]}
BAR = {"name": "bar", "stiffness": {"EA": 1e6, "GA2": 4e5, "GA3": 4e5, "GJ": 50, "EI2": 80, "EI3": 80},
       "mass": {"mass_per_length": 0.8, "rotary": [2e-4, 1e-4, 1e-4]}}
STATIC = {"kind": "static"}
SHORT = {"kind": "dynamic", "end_time": 0.2, "step_size": 0.01}
DOWN = [0, -9.81, 0]


def body(name, position=(0, 0, 0), **more):
    return {"name": name, **BOX, "position": list(position), **more}


def joint(name, kind, first, second, position=(0, 0, 0), axis=None, **more):
    given = {"name": name, "kind": kind, "first": first, "second": second, "position": list(position), **more}
    if axis is not None:
        given["axis"] = list(axis)
    return given


def hinge(name, first, second, position=(0, 0, 0), axis=(0, 0, 1), **more):
    return joint(name, "revolute", first, second, position, axis, **more)


def clamp(name, second, position=(0, 0, 0)):
    return joint(name, "fixed", "ground", second, position)


def cantilever(**more):
    """A beam from `root` to `tip`, clamped by `wall`, pushed by `push`."""
    scene = {"schema_version": 1, "sections": [copy.deepcopy(BAR)],
             "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
             "beams": [{"name": "boom", "section": "bar", "start": "root", "end": "tip", "elements": 4}],
             "joints": [clamp("wall", "root")],
             "loads": [{"name": "push", "at": "tip", "force": [0, 1, 0]}],
             "sensors": [{"name": "tip place", "kind": "position", "at": "tip"}], "analysis": dict(STATIC)}
    scene.update(more)
    return scene


def steel_cantilever(young=2.1e11, density=7850.0, width=0.02, height=0.03, length=1.0):
    scene = cantilever()
    scene["materials"] = [{"name": "steel", "young": young, "poisson": 0.3, "density": density}]
    scene["sections"] = [{"name": "bar", "shape": {"kind": "rectangle", "width": width, "height": height},
                          "material": "steel"}]
    scene["nodes"][1]["position"] = [length, 0, 0]
    return scene


def pendulum(**more):
    """A body `arm` that hangs on `pivot`."""
    scene = {"schema_version": 1, "gravity": DOWN, "bodies": [body("arm", (0.5, 0, 0))],
             "joints": [hinge("pivot", "ground", "arm")],
             "sensors": [{"name": "swing", "kind": "joint_angle", "joint": "pivot"}], "analysis": dict(SHORT)}
    scene.update(more)
    return scene


def four_bar(tilted=None, tilt=(0.0871557, 0, 0.9961947)):
    """Three rigid bars on four hinges; the axis of one of them may be turned by 5 degrees."""
    def axis(name):
        return tilt if name == tilted else (0, 0, 1)
    return {"schema_version": 1, "gravity": DOWN,
            "bodies": [body("crank", (0, 0.5, 0)), body("coupler", (1, 1, 0)), body("rocker", (2, 0.5, 0))],
            "joints": [hinge("A", "ground", "crank", (0, 0, 0), axis("A")),
                       hinge("B", "crank", "coupler", (0, 1, 0), axis("B")),
                       hinge("C", "coupler", "rocker", (2, 1, 0), axis("C")),
                       hinge("D", "ground", "rocker", (2, 0, 0), axis("D"))],
            "analysis": dict(SHORT)}


def falling(**more):
    scene = {"schema_version": 1, "gravity": DOWN, "bodies": [body("stone")], "analysis": dict(SHORT)}
    scene.update(more)
    return scene


def changed(scene, *steps):
    """A copy in which values are set: ("bodies", 0, "mass", -1) sets scene["bodies"][0]["mass"]; None deletes."""
    scene = copy.deepcopy(scene)
    for step in steps:
        at = scene
        for key in step[:-2]:
            at = at[key]
        value = copy.deepcopy(step[-1])
        if value is None:
            del at[step[-2]]
        elif isinstance(at, list) and step[-2] == len(at):
            at.append(value)
        else:
            at[step[-2]] = value
    return scene


def units():
    c = []

    def add(name, scene, names, words):
        c.append(Case(name, "units", "check", scene, names, words))
    add("E of steel in MPa", steel_cantilever(young=210000.0), ["steel", "young"], ["Pa"])
    add("E of steel in GPa", steel_cantilever(young=210.0), ["steel", "young"], ["Pa"])
    add("E of aluminium in MPa", steel_cantilever(young=70000.0, density=2700.0), ["steel", "young"], ["Pa"])
    add("density in g/cm^3", steel_cantilever(density=7.85), ["steel", "density"], ["kg/m^3"])
    add("density of aluminium in g/cm^3", steel_cantilever(density=2.7), ["steel", "density"], ["kg/m^3"])
    add("density in t/mm^3", steel_cantilever(density=7.85e-9), ["steel", "density"], ["kg/m^3"])
    add("lengths in mm", steel_cantilever(width=20, height=30, length=1000), ["bar"], ["mm", "metres"])
    add("section in mm on a beam in m", steel_cantilever(width=20, height=30), ["bar"], ["mm", "metres"])
    add("body turned by degrees", changed(pendulum(), ("bodies", 0, "rotation", {"axis": [0, 0, 1], "angle": 45})),
        ["/bodies/0/rotation"], ["rad"])
    add("twist in degrees", changed(cantilever(), ("beams", 0, "twist", 90), ("beams", 0, "elements", 60)),
        ["boom", "twist"], ["rad"])
    add("spring at rest at 45 degrees",
        changed(pendulum(), ("joints", 0, "forces", [{"stiffness": 10, "rest": 45}])), ["rest"], ["rad"])
    add("drive to 90 degrees", changed(pendulum(), ("joints", 0, "drives", [{"law": 90}])), ["/joints/0/drives/0"],
        ["rad"])
    add("prescribed turn to 30 degrees",
        cantilever(motions=[{"name": "turn", "at": "tip",
                             "rotation": {"axis": [0, 0, 1], "angle": {"expression": "30*t"}}}]), ["rotation"],
        ["rad"])
    add("gravity in mm/s^2", changed(pendulum(), ("gravity", [0, -9810, 0])), ["gravity"], ["m/s^2"])
    add("inertia in kg mm^2", changed(pendulum(), ("bodies", 0, "inertia", [2e5, 2e5, 3e5])), ["arm", "inertia"],
        ["kg m^2", "gyration"])
    add("size of a body in mm", changed(pendulum(), ("bodies", 0, {
        "name": "arm", "shape": {"kind": "box", "size": [200, 50, 40]}, "density": 7850, "position": [0.5, 0, 0]})),
        ["arm"], ["mm", "metres"])
    add("density of a body in g/cm^3", changed(pendulum(), ("bodies", 0, {
        "name": "arm", "shape": {"kind": "box", "size": [0.2, 0.05, 0.04]}, "density": 7.85,
        "position": [0.5, 0, 0]})), ["arm", "density"], ["kg/m^3"])
    return c


def geometry():
    c = []

    def add(name, scene, names, words=(), verb="check", wrong=()):
        c.append(Case(name, "geometry", verb, scene, list(names), list(words), list(wrong)))
    add("beam of no length", changed(cantilever(), ("nodes", 1, "position", [0, 0, 0])), ["boom"], ["length 0"])
    add("beam from a node to itself", changed(cantilever(), ("beams", 0, "end", "root")), ["boom"],
        ["length 0", "same"])
    add("axis 2 along the beam", changed(cantilever(), ("beams", 0, "axis_2", [2, 0, 0])), ["axis_2"], ["along"])
    add("arc that ends elsewhere", changed(cantilever(), ("beams", 0, "curve", {
        "curvature": [0, 0, 1], "length": 1, "tangent": [1, 0, 0]})), ["tip"], ["away"])
    add("arc without direction", changed(cantilever(), ("beams", 0, "curve", {
        "curvature": [0, 0, 0], "length": 1, "tangent": [0, 0, 0]})), ["tangent"], ["other than 0"])
    turns, radius, pitch = 3, 0.5, 0.3
    length = turns * ((2 * 3.141592653589793 * radius) ** 2 + pitch ** 2) ** 0.5
    k = 4 * 3.141592653589793 ** 2 / (length / turns) ** 2
    coil = changed(cantilever(), ("nodes", 1, "position", [0, 0, turns * pitch]), ("beams", 0, {
        "name": "coil", "section": "bar", "start": "root", "end": "tip", "elements": 5,
        "curve": {"curvature": [k * pitch / (2 * 3.141592653589793), 0, k * radius], "length": length,
                  "tangent": [0, 2 * 3.141592653589793 * radius, pitch]}, "axis_2": [-1, 0, 0]}))
    add("helix of half-turn elements", coil, ["coil"], ["element"], wrong=STEPS)
    add("ring of one element", changed(cantilever(), ("nodes", 1, "position", [0, 0.63661977236758, 0]),
        ("beams", 0, "elements", 1), ("beams", 0, "curve", {"curvature": [0, 0, 3.141592653589793], "length": 1,
                                                          "tangent": [1, 0, 0]})), ["boom"], ["element"])
    add("twist of half a turn in one element", changed(cantilever(), ("beams", 0, "twist", 3.2),
        ("beams", 0, "elements", 1)), ["boom"], ["element"])
    add("axis of no length", changed(pendulum(), ("joints", 0, "axis", [0, 0, 0])), ["/joints/0/axis"],
        ["other than 0"])
    add("quaternion of length 3", changed(pendulum(), ("bodies", 0, "rotation", {"quaternion": [3, 0, 0, 0]})),
        ["/bodies/0/rotation"], ["unit", "length"])
    add("rotation by parallel axes", changed(pendulum(), ("bodies", 0, "rotation",
        {"axes": {"1": [1, 0, 0], "2": [2, 0, 0]}})), ["/bodies/0/rotation"], ["parallel", "along", "perpendicular"])
    add("rotation about nothing", changed(pendulum(), ("bodies", 0, "rotation", {"axis": [0, 0, 0], "angle": 1})),
        ["/bodies/0/rotation"], ["other than 0"])
    gap = changed(pendulum(), ("joints", 0, {"name": "pivot", "kind": "revolute",
        "first": {"to": "ground", "position": [0, 0, 0]}, "second": {"to": "arm", "position": [-0.495, 0, 0]},
        "axis": [0, 0, 1]}))
    add("hinge with a gap", gap, ["pivot"], ["apart"])
    far = {"name": "moon", "mass": 1, "inertia": [1, 1, 1], "position": [1e4, 0, 0]}
    add("hinge with a gap and a body 10 km away", changed(gap, ("bodies", 1, far)), ["pivot"], ["apart"])
    add("gap of 500 m and a body far away", changed(pendulum(), ("joints", 0, {"name": "pivot", "kind": "revolute",
        "first": {"to": "ground", "position": [0, 0, 0]}, "second": {"to": "arm", "position": [500, 0, 0]},
        "axis": [0, 0, 1]}),
        ("bodies", 1, {**far, "position": [1e9, 0, 0]})), ["pivot"], ["apart"])
    add("gap in a slider far from the rest", changed(pendulum(), ("sensors", []), ("joints", 0, {"name": "pivot",
        "kind": "prismatic", "axis": [1, 0, 0],
        "first": {"to": "ground", "position": [0, 0.01, 0]}, "second": {"to": "arm", "position": [-0.5, 0, 0]}}),
        ("bodies", 1, {**far, "position": [1e5, 0, 0]})), ["pivot"], ["apart"])
    add("weld of turned frames", changed(pendulum(), ("sensors", []), ("joints", 0, {"name": "pivot", "kind": "fixed",
        "first": {"to": "ground", "position": [0, 0, 0], "rotation": {"axis": [1, 0, 0], "angle": 0.1}},
        "second": {"to": "arm", "position": [-0.5, 0, 0], "rotation": {"axis": [1, 0, 0], "angle": 0}}})), ["pivot"], ["turned"])
    add("universal joint of skew axes", changed(pendulum(), ("joints", 0, joint("pivot", "universal", "ground", "arm",
        (0, 0, 0), (1, 0, 0), second_axis=[1, 1, 0]))), ["/joints/0"], ["perpendicular"])
    add("beam that ends within a beam", changed(cantilever(), ("nodes", 2, {"name": "side", "position": [0.5, 1, 0]}),
        ("beams", 1, {"name": "branch", "section": "bar", "start": "boom.2", "end": "side"})),
        ["branch"], ["inner node"])
    add("spring of no length", falling(springs=[{"name": "rope", "first": "ground", "second": "stone",
        "stiffness": 10, "rest_length": 1}]), ["rope"], ["coincide"])
    add("tube inside out", changed(steel_cantilever(), ("sections", 0, "shape",
        {"kind": "tube", "outer_radius": 0.01, "inner_radius": 0.02})), ["inner_radius"], ["outer"])
    add("negative radius", changed(steel_cantilever(), ("sections", 0, "shape", {"kind": "circle", "radius": -0.01})),
        ["radius"], ["above 0"])
    add("body at the edge of numbers", falling(bodies=[body("stone", (1e308, 0, 0))]), ["stone"],
        ["far", "large", "position"], wrong=STEPS)
    add("position beyond all numbers", '{"schema_version": 1, "bodies": [{"name": "stone", "mass": 1, "inertia": '
        '[1, 1, 1], "position": [1e400, 0, 0]}], "analysis": {"kind": "dynamic", "end_time": 1}}',
        ["/bodies/0/position/0"], ["1e400"])
    add("position that is no number", '{"schema_version": 1, "bodies": [{"name": "stone", "mass": 1, "inertia": '
        '[1, 1, 1], "position": [NaN, 0, 0]}], "analysis": {"kind": "dynamic", "end_time": 1}}', ["line 1"], ["NaN"])
    add("axis of a subnormal length", changed(pendulum(), ("joints", 0, "axis", [0, 0, 5e-324])), ["/joints/0/axis"],
        ["length", "short", "small", "0"])
    return c


def topology():
    c = []

    def add(name, scene, names, words=(), verb="check", wrong=()):
        c.append(Case(name, "topology", verb, scene, list(names), list(words), list(wrong)))
    add("name taken twice", changed(pendulum(), ("bodies", 1, body("arm", (2, 0, 0)))), ["arm"], ["taken"])
    add("section misspelt", changed(cantilever(), ("beams", 0, "section", "baar")), ["baar"], ['did you mean "bar"'])
    add("node misspelt", changed(cantilever(), ("joints", 0, "second", "rot")), ["rot"], ['did you mean "root"'])
    add("inner node too many", changed(cantilever(), ("loads", 0, "at", "boom.9")), ["boom.9"], ["0 to 4"])
    add("key misspelt", changed(cantilever(), ("beams", 0, "elemnts", 4)), ["elemnts"], ['did you mean "elements"'])
    add("key left out", changed(cantilever(), ("beams", 0, "end", None)), ["/beams/0"], ["end"])
    add("position of two numbers", changed(pendulum(), ("bodies", 0, "position", [1, 2])), ["/bodies/0/position"],
        ["3", "three"])
    add("no elements", changed(cantilever(), ("beams", 0, "elements", 0)), ["elements"], ["1"])
    add("half an element", changed(cantilever(), ("beams", 0, "elements", 2.5)), ["elements"], ["whole", "integer"])
    add("elements of order 4", changed(cantilever(), ("beams", 0, "order", 4)), ["order"], ["3"])
    add("node that nothing takes", changed(cantilever(), ("nodes", 2, {"name": "lonely", "position": [5, 0, 0]})),
        ["lonely"], ["nothing holds", "no beam"])
    add("frame that stands in itself", pendulum(frames=[{"name": "f", "frame": "g"}, {"name": "g", "frame": "f"}]),
        ["/frames/0"], ["itself"])
    add("joint of a thing with itself", changed(pendulum(), ("joints", 0, "first", "arm")), ["pivot"], ["same"])
    add("joint of the ground with the ground", changed(pendulum(), ("joints", 1, hinge("idle", "ground", "ground"))),
        ["idle"], ["same"])
    add("empty scene", {"schema_version": 1, "analysis": dict(SHORT)}, ["the file"], ["nothing here can move"])
    add("no analysis", changed(pendulum(), ("analysis", None)), ["the file"], ["analysis"])
    add("two welds of one pair", changed(pendulum(), ("bodies", 1, body("hand", (1, 0, 0))),
        ("joints", 1, joint("first weld", "fixed", "arm", "hand", (1, 0, 0))),
        ("joints", 2, joint("second weld", "fixed", "arm", "hand", (0.8, 0, 0)))), ["first weld", "second weld"],
        ["depend", "redundant", "same"], verb="run")
    ladder = four_bar()
    for i in range(1, 12):
        ladder["bodies"] += [body(f"coupler {i}", (2 * i + 1, 1, 0)), body(f"rocker {i}", (2 * i + 2, 0.5, 0))]
        left = "rocker" if i == 1 else f"rocker {i - 1}"
        ladder["joints"] += [hinge(f"B {i}", left, f"coupler {i}", (2 * i, 1, 0)),
                             hinge(f"C {i}", f"coupler {i}", f"rocker {i}", (2 * i + 2, 1, 0)),
                             hinge(f"D {i}", "ground", f"rocker {i}", (2 * i + 2, 0, 0))]
    ladder["without"] = ["planar"]
    add("row of redundant four-bars", ladder, ["depend"], ["others of", "loop"], verb="run")
    return c


def masses():
    c = []

    def add(name, scene, names, words=(), verb="check", wrong=STEPS):
        c.append(Case(name, "masses", verb, scene, list(names), list(words), list(wrong)))
    add("negative mass", changed(pendulum(), ("bodies", 0, "mass", -1)), ["/bodies/0/mass"], ["0"])
    add("massless body that flies", falling(bodies=[{"name": "ghost", "mass": 0, "inertia": [0, 0, 0]}]), ["ghost"],
        ["mass"])
    add("massless body beside one with mass", falling(bodies=[body("stone"), {
        "name": "ghost", "mass": 0, "inertia": [0, 0, 0], "position": [1, 0, 0]}]), ["ghost"], ["mass", "inertia"],
        verb="plan")
    add("massless body on a hinge, at rest", changed(pendulum(), ("gravity", None), ("bodies", 1, {
        "name": "ghost", "mass": 0, "inertia": [0, 0, 0], "position": [3, 0, 0]}),
        ("joints", 1, hinge("pin", "ground", "ghost", (3, 0, 0)))), ["ghost"], ["inertia", "mass"], verb="plan")
    add("rotor without inertia about its axis", pendulum(gravity=[0, 0, 0], bodies=[
        body("arm", (0.5, 0, 0)), {"name": "rotor", "mass": 1, "inertia": [0.1, 0.1, 0], "position": [1, 0, 0]}],
        joints=[hinge("pivot", "ground", "arm"), hinge("shaft", "arm", "rotor", (1, 0, 0))]), ["rotor"],
        ["inertia"], verb="check")
    add("rotor without inertia, driven by a torque", pendulum(bodies=[{
        "name": "rotor", "mass": 1, "inertia": [0.1, 0.1, 0], "position": [0, 0, 0]}],
        joints=[hinge("shaft", "ground", "rotor")], sensors=[],
        loads=[{"name": "torque", "at": "rotor", "moment": [0, 0, 1]}]), ["rotor"], ["inertia"], verb="plan")
    add("massless rod on two balls", pendulum(without=["planar"], nodes=[{"name": "link", "position": [0.5, 0, 0]}],
        bodies=[body("arm", (1, 0, 0))], sensors=[], joints=[
            joint("left", "spherical", "ground", "link"), joint("right", "spherical", "link", "arm", (1, 0, 0))]),
        ["link"], ["inertia"], verb="plan")
    add("inertia of no body", changed(pendulum(), ("bodies", 0, "inertia", [1, 1, 5])), ["/bodies/0/inertia"],
        ["sum of the others"])
    add("inertia that is not symmetric", changed(pendulum(), ("bodies", 0, "inertia",
        [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]])), ["/bodies/0/inertia"], ["symmetric"])
    add("negative principal inertia", changed(pendulum(), ("bodies", 0, "inertia",
        [[1, 2, 0], [2, 1, 0], [0, 0, 2]])), ["/bodies/0/inertia"], ["negative"])
    add("body without inertia and shape", changed(pendulum(), ("bodies", 0, {"name": "arm", "mass": 1})), ["arm"],
        ["inertia", "shape"])
    add("mass and density", changed(pendulum(), ("bodies", 0, {"name": "arm", "mass": 1, "density": 1000,
        "shape": {"kind": "sphere", "radius": 0.1}})), ["/bodies/0"], ["density"])
    add("beams without mass in time", changed(cantilever(), ("sections", 0, "mass", None),
        ("analysis", dict(SHORT))), ["mass"], ["mass"])
    add("one beam without mass in time", changed(cantilever(), ("sections", 0, "mass", None),
        ("analysis", dict(SHORT)), ("bodies", [body("stone", (3, 0, 0))])), ["boom"], ["no mass"])
    add("material without density in time", changed(steel_cantilever(), ("materials", 0, "density", None),
        ("analysis", dict(SHORT))), ["mass"], ["density"])
    add("point mass of nothing", falling(bodies=[body("stone"), {
        "name": "dot", "kind": "point_mass", "mass": 0, "position": [1, 0, 0]}]), ["dot"], ["nothing", "mass"])
    add("moment on a point mass", falling(bodies=[{"name": "dot", "kind": "point_mass", "mass": 1}],
        loads=[{"name": "twist", "at": "dot", "moment": [0, 0, 1]}]), ["twist"], ["moment"])
    add("spinning point mass", falling(bodies=[{"name": "dot", "kind": "point_mass", "mass": 1}],
        initial_velocities=[{"of": "dot", "angular_velocity": [0, 0, 1]}]), ["angular_velocity"], ["does not turn"])
    add("mass per length of no section", changed(cantilever(), ("sections", 0, "mass",
        [[1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 9], [0, 0, 0, 0.01, 0, 0], [0, 0, 0, 0, 0.01, 0],
         [0, 0, 9, 0, 0, 0.01]])), ["bar"], ["definite"])
    return c


def stiffnesses():
    c = []

    def add(name, scene, names, words=(), verb="check", wrong=STEPS):
        c.append(Case(name, "stiffnesses", verb, scene, list(names), list(words), list(wrong)))
    add("negative EA", changed(cantilever(), ("sections", 0, "stiffness", "EA", -1e6)), ["EA"], ["above 0"])
    add("no bending stiffness", changed(cantilever(), ("sections", 0, "stiffness", "EI2", 0)), ["EI2"], ["above 0"])
    matrix = [[1e6 if i == j else 0 for j in range(6)] for i in range(6)]
    add("stiffness that is not symmetric", changed(cantilever(), ("sections", 0, "stiffness", matrix),
        ("sections", 0, "stiffness", 0, 3, 5e5)), ["bar"], ["symmetric"])
    add("stiffness that is not definite", changed(cantilever(), ("sections", 0, "stiffness", matrix),
        ("sections", 0, "stiffness", 0, 1, 2e6), ("sections", 0, "stiffness", 1, 0, 2e6)), ["bar"], ["definite"])
    add("EA of 1e30", changed(cantilever(), ("sections", 0, "stiffness", "EA", 1e30)), ["bar"], ["stiff"])
    add("all stiffnesses 1e30", changed(cantilever(), ("sections", 0, "stiffness", [1e30] * 6)), ["bar"], ["stiff"])
    add("bending 1e-30", changed(cantilever(), ("sections", 0, "stiffness", "EI2", 1e-30)), ["bar"],
        ["stiff", "soft"])
    add("spring of 1e30", falling(springs=[{"name": "rope", "first": {"to": "ground", "position": [0, 1, 0]},
        "second": "stone", "stiffness": 1e30}]), ["rope"], ["stiff"])
    add("damper of 1e30", falling(springs=[{"name": "rope", "first": {"to": "ground", "position": [0, 1, 0]},
        "second": "stone", "damping": 1e30}]), ["rope"], ["damp"])
    add("joint spring of 1e30", changed(pendulum(), ("joints", 0, "forces", [{"stiffness": 1e30, "rest": 0.1}])),
        ["pivot"], ["stiff"])
    add("bushing of 1e30", falling(bushings=[{"name": "mount", "first": "ground", "second": "stone",
        "stiffness": [1e30] * 6}]), ["mount"], ["stiff"])
    add("negative spring", falling(springs=[{"name": "rope", "first": {"to": "ground", "position": [0, 1, 0]},
        "second": "stone", "stiffness": -10}]), ["stiffness"], ["0"])
    add("spring that does nothing", falling(springs=[{"name": "rope", "first": {"to": "ground",
        "position": [0, 1, 0]}, "second": "stone"}]), ["rope"], ["does nothing"])
    add("bushing that does nothing", falling(bushings=[{"name": "mount", "first": "ground", "second": "stone"}]),
        ["mount"], ["does nothing"])
    add("bushing that is not symmetric", falling(bushings=[{"name": "mount", "first": "ground", "second": "stone",
        "stiffness": [[1 if i <= j else 0 for j in range(6)] for i in range(6)]}]), ["mount"], ["symmetric"])
    add("Poisson's ratio of 0.6", changed(steel_cantilever(), ("materials", 0, "poisson", 0.6)), ["poisson"],
        ["0.5"])
    add("shear modulus and Poisson's ratio", changed(steel_cantilever(), ("materials", 0, "shear", 8e10)),
        ["/materials/0"], ["poisson"])
    add("section without a beam", changed(cantilever(), ("sections", 1, {**BAR, "name": "spare"})), ["spare"],
        ["no beam uses"])
    add("spring pressed through its anchor", falling(gravity=[0, 0, 0], bodies=[
        {"name": "dot", "kind": "point_mass", "mass": 1, "position": [0, -0.1, 0]}], springs=[
            {"name": "rope", "first": "ground", "second": "dot", "stiffness": 1, "rest_length": 0.1}],
        initial_velocities=[{"of": "dot", "velocity": [0, 2, 0]}]), ["rope"], ["length 0", "no length", "zero length"],
        verb="run")
    add("spring that falls through its anchor", falling(bodies=[
        {"name": "dot", "kind": "point_mass", "mass": 1, "position": [0, 0.1, 0]}], springs=[
            {"name": "rope", "first": "ground", "second": "dot", "stiffness": 1, "rest_length": 0.3}]), ["rope"],
        ["length 0", "no length", "zero length"], verb="run")
    return c


def joints():
    c = []

    def add(name, scene, names, words=(), verb="check", wrong=STEPS):
        c.append(Case(name, "joints", verb, scene, list(names), list(words), list(wrong)))
    add("screw without pitch", changed(pendulum(), ("joints", 0, "kind", "screw")), ["pivot"], ["pitch"])
    add("hinge with a pitch", changed(pendulum(), ("joints", 0, "pitch", 0.1)), ["pitch"], ["screw"])
    add("universal joint with one axis", changed(pendulum(), ("joints", 0, "kind", "universal")), ["/joints/0"],
        ["second_axis"])
    add("hinge without axis", changed(pendulum(), ("joints", 0, "axis", None)), ["/joints/0"], ["axis"])
    add("unknown kind of joint", changed(pendulum(), ("joints", 0, "kind", "ball")), ["/joints/0/kind"],
        ["spherical"])
    add("drive along a hinge", changed(pendulum(), ("joints", 0, "drives", [
        {"coordinate": "displacement", "law": 1}])), ["/joints/0/drives/0"], ["angle"])
    add("drive of a ball", changed(pendulum(), ("joints", 0, joint("pivot", "spherical", "ground", "arm",
        drives=[{"law": 1}])), ("sensors", [])), ["/joints/0/drives/0"], ["no coordinate"])
    add("drive of a cylinder without coordinate", changed(pendulum(), ("joints", 0, "kind", "cylindrical"),
        ("joints", 0, "drives", [{"law": 0}])), ["/joints/0/drives/0"], ["which coordinate"])
    add("drive of both coordinates of a screw", changed(pendulum(), ("joints", 0, "kind", "screw"),
        ("joints", 0, "pitch", 0.1), ("joints", 0, "drives", [{"coordinate": "angle", "law": 0},
                                                            {"coordinate": "displacement", "law": 0}])),
        ["/joints/0/drives/1"], ["depend"])
    add("coordinate driven twice", changed(pendulum(), ("joints", 0, "drives", [{"law": 0}, {"law": 0}])),
        ["/joints/0/drives/1"], ["twice"])
    for name in "ABCD":
        # an axis turned in the plane of the bars: nothing can move any more
        add(f"four-bar locked by a turned axis of {name}", four_bar(tilted=name), [f"'{name}'"],
            ["cannot move", "locked", "no degree of freedom", "0 degrees of freedom"], verb="plan")
    add("four-bar locked by an axis turned the other way", four_bar("C", (0, -0.0871557, 0.9961947)), ["'C'"],
        ["cannot move", "locked", "no degree of freedom", "0 degrees of freedom"], verb="plan")
    add("two drives that contradict each other", pendulum(bodies=[body("door", (0.5, 0, 0))], sensors=[], joints=[
        hinge("upper", "ground", "door", (0, 0, 1), drives=[{"law": 1, "rate": True}]),
        hinge("lower", "ground", "door", (0, 0, -1), drives=[{"law": 2, "rate": True}])]), ["upper", "lower"],
        ["contradict"], verb="run")
    triangle = pendulum(sensors=[], bodies=[body("AB", (0.5, 0, 0)), body("BC", (0.5, 0.5, 0)),
                                            body("CA", (0, 0.5, 0))], joints=[
        hinge("A", "ground", "AB"), hinge("B", "AB", "BC", (1, 0, 0)), hinge("C", "BC", "CA", (0, 1, 0)),
        hinge("A2", "AB", "CA")])
    add("drive within a rigid triangle", changed(triangle, ("joints", 1, "drives", [{"law": 1, "rate": True}])),
        ["'B'"], ["cannot move", "contradict"], verb="run")
    add("prescribed motion against a weld", changed(cantilever(), ("motions", [
        {"name": "shove", "at": "root", "x": {"expression": "0.1*t"}}])), ["wall", "shove"], [], verb="run")
    add("motion prescribed twice", changed(cantilever(), ("motions", [
        {"name": "left", "at": "tip", "y": 0}, {"name": "right", "at": "tip", "y": {"expression": "t"}}])),
        ["/motions/1"], ["twice"])
    add("motion of nothing", changed(cantilever(), ("motions", [{"name": "shove", "at": "tip"}])), ["/motions/0"],
        ["prescribes nothing"])
    add("drive that jumps at the start", changed(pendulum(), ("joints", 0, "drives", [{"law": 1}])),
        ["/joints/0/drives/0"], ["jumps"])
    add("drive that jumps on the way", changed(pendulum(), ("joints", 0, "drives", [
        {"law": {"expression": "step(t - 0.1)*1"}}])), ["pivot", "0.1"], ["jump"], verb="run")
    add("undamped constraint forces", changed(pendulum(), ("analysis", "spectral_radius", 1.0)),
        ["spectral_radius"], ["below 1"])
    return c


def loads():
    c = []

    def add(name, scene, names, words=(), verb="check", wrong=STEPS):
        c.append(Case(name, "loads", verb, scene, list(names), list(words), list(wrong)))
    add("force of 1e300 in statics", changed(cantilever(), ("loads", 0, "force", [0, 1e300, 0])), ["push"],
        ["large", "N"])
    add("moment of 1e300 in statics", changed(cantilever(), ("loads", 0, "moment", [0, 0, 1e300])), ["push"],
        ["large"])
    add("force of 1e300 in time", pendulum(loads=[{"name": "push", "at": "arm", "force": [1e300, 0, 0]}]), ["push"],
        ["large"])
    add("force of 1e300 by its law", changed(cantilever(), ("loads", 0, "law", {"expression": "1e300*t"})), ["push"],
        ["large"])
    add("line load of 1e200", cantilever(loads=[{"name": "wind", "beam": "boom", "force": [0, 1e200, 0]}]), ["wind"],
        ["large"])
    add("gravity of 1e30", changed(pendulum(), ("gravity", [0, -1e30, 0])), ["gravity"], ["large", "m/s^2"])
    add("torque in a hinge of 1e200", changed(pendulum(), ("joints", 0, "forces", [{"effort": 1e200}])), ["pivot"],
        ["large"])
    add("load on the ground", changed(cantilever(), ("loads", 0, "at", "ground")), ["/loads/0"], ["not the ground"])
    add("load of nothing", changed(cantilever(), ("loads", 0, "force", [0, 0, 0])), ["push"],
        ["neither force nor moment"])
    add("load at a point along a beam", changed(cantilever(), ("loads", 0, "beam", "boom")), ["/loads/0"],
        ["beam", "at"])
    add("follower in a frame", cantilever(frames=[{"name": "f"}], loads=[
        {"name": "push", "at": "tip", "force": [0, 1, 0], "axes": "body", "frame": "f"}]), ["/loads/0/frame"],
        ["follower"])
    add("load that is soon no number", changed(cantilever(), ("loads", 0, "law", {"expression": "sqrt(0.5 - t)*1"})),
        ["/loads/0/law"], ["not finite"])
    add("load that is no number for a moment", pendulum(loads=[{"name": "push", "at": "arm", "force": [1, 0, 0],
        "law": {"expression": "sqrt(abs(t - 0.1) - 0.001)*1"}}]), ["push"], ["not finite"], verb="run")
    add("line load on no beam", cantilever(loads=[{"name": "wind", "beam": "bom", "force": [0, 1, 0]}]), ["bom"],
        ['did you mean "boom"'])
    add("expression that is none", changed(cantilever(), ("loads", 0, "law", {"expression": "sin(t"})),
        ["/loads/0/law"], [")", "parenthes", "expected"])
    add("unknown function", changed(cantilever(), ("loads", 0, "law", {"expression": "sinus(t)"})),
        ["/loads/0/law"], ["sinus"])
    add("column far beyond its critical load", changed(cantilever(), ("loads", 0, "force", [-1e9, 1, 0])), ["push"],
        ["large", "no equilibrium"], verb="run")
    return c


def times():
    c = []

    def add(name, scene, names, words=(), verb="check", wrong=()):
        c.append(Case(name, "times", verb, scene, list(names), list(words), list(wrong)))
    def analysis(base, **more):
        return changed(base, *[("analysis", key, value) for key, value in more.items()])
    add("no time", analysis(pendulum(), end_time=0), ["end_time"], ["above 0"])
    add("negative step", analysis(pendulum(), step_size=-0.01), ["step_size"], ["above 0"])
    add("step longer than the analysis", analysis(pendulum(), step_size=10), ["step_size"], ["longer"])
    add("1e15 steps", analysis(pendulum(), end_time=1, step_size=1e-15), ["step_size"], ["steps"])
    add("kind misspelt", analysis(pendulum(), kind="dynamics"), ["/analysis/kind"], ["dynamic"])
    add("load steps in time", analysis(pendulum(), load_steps=10), ["load_steps"], ["static", "not", "no such"])
    add("time in statics", analysis(cantilever(), end_time=1), ["end_time"], ["dynamic", "not", "no such"])
    add("load steps beside an arc length", analysis(cantilever(), load_steps=20, arc_length={"step": 0.1}),
        ["load_steps"], ["arc_length"])
    add("spectral radius of backward differences", analysis(pendulum(), integrator="bdf", spectral_radius=0.5),
        ["spectral_radius"], ["bdf"])
    add("spectral radius of the variational integrator",
        analysis(pendulum(), integrator="variational", spectral_radius=0.5), ["spectral_radius"], ["variational"])
    add("order of backward differences without them", analysis(pendulum(), bdf_order=2), ["bdf_order"], ["bdf"])
    add("Newmark's beta without its integrator", analysis(pendulum(), newmark_beta=0.5), ["newmark_beta"],
        ["variational"])
    add("step control of backward differences", analysis(pendulum(), integrator="bdf", step_control={}),
        ["step_control"], ["bdf"])
    add("tolerance of 1", analysis(pendulum(), tolerance=1), ["tolerance"], ["0.01"])
    add("velocity in statics", cantilever(initial_velocities=[{"of": "tip", "velocity": [0, 1, 0]}]),
        ["/initial_velocities/0"], ["static"])
    add("velocity of what is clamped", changed(cantilever(), ("analysis", dict(SHORT)), ("initial_velocities", [
        {"of": "root", "velocity": [0, 3, 0]}])), ["wall", "3"], ["velocit"])
    add("velocity along the axis of a hinge", pendulum(initial_velocities=[{"of": "arm", "velocity": [0, 0, 2]}]),
        ["pivot", "2"], ["velocit"])
    add("velocity of a pendulum without its turning",
        pendulum(initial_velocities=[{"of": "arm", "velocity": [0, 3, 0]}]), ["pivot", "3"], ["velocit"])
    add("two velocities of one rigid part", falling(bodies=[body("stone"), body("twin", (1, 0, 0))],
        joints=[joint("glue", "fixed", "stone", "twin", (1, 0, 0))], initial_velocities=[
            {"of": "stone", "velocity": [1, 0, 0]}, {"of": "twin", "velocity": [-1, 0, 0]}]), ["stone", "twin"],
        ["contradict"])
    add("velocity given twice", falling(initial_velocities=[{"of": "stone", "velocity": [1, 0, 0]},
                                                            {"of": "stone", "velocity": [2, 0, 0]}]),
        ["/initial_velocities/1"], ["already"])
    add("velocity of 1e300", falling(initial_velocities=[{"of": "stone", "velocity": [1e300, 0, 0]}]), ["stone"],
        ["large", "speed", "light"])
    return c


def statics():
    c = []

    def add(name, scene, names, words=(), verb="plan", wrong=("'tip'", "'boom.4'")):
        c.append(Case(name, "statics", verb, scene, list(names), list(words), list(wrong)))
    free = ["free", "nothing holds", "mechanism", "can turn", "can move", "not held"]
    add("beam that nothing holds", cantilever(joints=[]), ["boom"], free + ["nothing joins"], wrong=())
    add("beam on one hinge", cantilever(joints=[hinge("pin", "ground", "root")]), ["'pin'"], free)
    add("beam on a ball", cantilever(joints=[joint("ball", "spherical", "ground", "root")]), ["'ball'"], free)
    add("beam on a slider", cantilever(joints=[joint("slide", "prismatic", "ground", "root", (0, 0, 0), (1, 0, 0))]),
        ["'slide'"], free)
    add("beam on a universal joint", cantilever(joints=[joint("cross", "universal", "ground", "root", (0, 0, 0),
        (0, 1, 0), second_axis=[0, 0, 1])]), ["'cross'"], free)
    two = cantilever(nodes=[{"name": "root"}, {"name": "right", "position": [1, 0, 0]},
                            {"name": "start", "position": [1, 0, 0]}, {"name": "tip", "position": [2, 0, 0]}],
                     beams=[{"name": "first", "section": "bar", "start": "root", "end": "right", "elements": 2},
                            {"name": "second", "section": "bar", "start": "start", "end": "tip", "elements": 2}],
                     joints=[clamp("wall", "root"), hinge("cut", "right", "start", (1, 0, 0))])
    add("beam cut by a hinge", two, ["'cut'"], free)
    add("beam on two balls spins about its axis", cantilever(joints=[
        joint("left", "spherical", "ground", "root"), joint("right", "spherical", "ground", "tip", (1, 0, 0))]),
        ["boom"], ["rotation about", "turn about", "spin"], wrong=())
    add("second structure that is loose", changed(cantilever(), ("nodes", 2, {"name": "a", "position": [0, 1, 0]}),
        ("nodes", 3, {"name": "b", "position": [1, 1, 0]}),
        ("beams", 1, {"name": "loose", "section": "bar", "start": "a", "end": "b"})), ["loose"],
        free + ["nothing joins"], verb="check", wrong=())
    add("body without support", falling(analysis=dict(STATIC)), ["stone"], free + ["nothing joins"], verb="check")
    add("arm on a hinge without friction", pendulum(analysis=dict(STATIC)), ["'pivot'"], free, wrong=())
    add("mass on one spring", falling(analysis=dict(STATIC), bodies=[
        {"name": "dot", "kind": "point_mass", "mass": 1, "position": [1, 0, 0]}], springs=[
            {"name": "rope", "first": "ground", "second": "dot", "stiffness": 100}]), ["dot"], free, wrong=())
    add("rod between balls that spins", pendulum(analysis=dict(STATIC), gravity=[0, 0, 0],
        bodies=[body("rod", (0.5, 0, 0))], sensors=[], joints=[
            joint("left", "spherical", "ground", "rod"), joint("right", "spherical", "ground", "rod", (1, 0, 0))]),
        ["rod"], ["rotation about", "turn about", "spin"], wrong=())
    add("planar joint that holds one direction", pendulum(analysis=dict(STATIC), sensors=[], joints=[
        joint("table", "planar", "ground", "arm", (0, 0, 0), (0, 0, 1))]), ["'table'"], free, wrong=())
    add("four-bar in statics", changed(four_bar(), ("analysis", dict(STATIC))), ["crank"], free, wrong=())
    add("two hinges in a row", pendulum(analysis=dict(STATIC), bodies=[body("arm", (0.5, 0, 0)),
                                                                       body("hand", (1.5, 0, 0))],
        joints=[clamp("wall", "arm"), hinge("wrist", "arm", "hand", (1, 0, 0))], sensors=[]), ["'wrist'"], free,
        wrong=("'pivot'",))
    add("bushing that lets one rotation free", falling(analysis=dict(STATIC), bushings=[
        {"name": "mount", "first": "ground", "second": "stone", "stiffness": [1e3, 1e3, 1e3, 0, 10, 10]}]),
        ["stone"], ["rotation about", "turn about", "spin"], wrong=())
    add("path of a mechanism by arc length", cantilever(joints=[hinge("pin", "ground", "root")],
        analysis={"kind": "static", "arc_length": {"step": 0.1}}), ["'pin'"], free)
    return c


def frames():
    c = []

    def add(name, scene, names, words=(), verb="check"):
        c.append(Case(name, "frames", verb, scene, list(names), list(words)))
    speeding = {"name": "table", "turns": [{"axis": [0, 0, 1], "angle": {"expression": "t^2"}}]}
    add("statics in a frame that speeds up", cantilever(frames=[speeding], analysis={"kind": "static",
        "frame": "table"}), ["table"], ["steady"])
    add("turn about nothing", pendulum(frames=[{"name": "table", "turns": [{"axis": [0, 0, 0], "angle": 1}]}]),
        ["/frames/0/turns/0/axis"], ["0"])
    add("turn about an axis of subnormal length", pendulum(frames=[
        {"name": "table", "turns": [{"axis": [0, 0, 5e-324], "angle": 1}]}]), ["/frames/0/turns/0/axis"],
        ["length", "short", "small"])
    add("frame that jumps", pendulum(frames=[{"name": "table", "position": [
        {"expression": "sqrt(0.1 - t)*1"}, 0, 0]}]), ["/frames/0/position/0"], ["not finite"])
    add("joint between two frames", pendulum(frames=[{"name": "table"}, {"name": "chair"}], joints=[
        hinge("pivot", "ground", "arm"), hinge("glue", "table", "chair")]), ["glue"], ["prescribed"])
    add("path in a frame that turns", cantilever(frames=[speeding], analysis={"kind": "static",
        "arc_length": {"step": 0.1}}), ["arc_length"], ["frames that move"])
    add("frame misspelt", pendulum(frames=[{"name": "table"}], analysis={**SHORT, "frame": "tabel"}), ["tabel"],
        ['did you mean "table"'])
    add("angle of a frame of 1e300", pendulum(frames=[{"name": "table", "turns": [
        {"axis": [0, 0, 1], "angle": 1e300}]}], analysis={**SHORT, "frame": "table"}), ["/frames/0"],
        ["large", "rad"])
    add("variational integrator in a moving frame", pendulum(frames=[speeding], analysis={
        **SHORT, "integrator": "variational", "frame": "table"}), ["integrator"], ["frames that move"])
    return c


def results():
    c = []

    def add(name, scene, names, words=(), verb="check"):
        c.append(Case(name, "results", verb, scene, list(names), list(words)))
    def sensor(base, **more):
        return changed(base, ("sensors", [{"name": "eye", **more}]))
    add("station beyond the beam", sensor(cantilever(), kind="section_force", beam="boom", station=1.5), ["station"],
        ["1"])
    add("sensor on no joint", sensor(pendulum(), kind="joint_angle", joint="pivto"), ["pivto"],
        ['did you mean "pivot"'])
    add("angle of a slider", sensor(changed(pendulum(), ("joints", 0, "kind", "prismatic")), kind="joint_angle",
        joint="pivot"), ["pivot"], ["no angle"])
    add("rate of a cylinder", sensor(changed(pendulum(), ("joints", 0, "kind", "cylindrical")), kind="joint_rate",
        joint="pivot"), ["/sensors/0"], ["coordinate"])
    add("rate of a screw", sensor(changed(pendulum(), ("joints", 0, "kind", "screw"), ("joints", 0, "pitch", 0.1)),
        kind="joint_rate", joint="pivot"), ["/sensors/0"], ["coordinate"])
    add("rate of a coordinate that is not there", sensor(pendulum(), kind="joint_rate", joint="pivot",
        coordinate="displacement"), ["/sensors/0"], ["angle"])
    add("rate of a ball", sensor(changed(pendulum(), ("joints", 0, joint("pivot", "spherical", "ground", "arm"))),
        kind="joint_rate", joint="pivot"), ["/sensors/0"], ["no coordinate"])
    add("sensor kind misspelt", sensor(pendulum(), kind="positon", at="arm"), ["/sensors/0/kind"], ["position"])
    add("sensor without place", sensor(pendulum(), kind="position"), ["/sensors/0"], ["at"])
    def figure(**more):
        return pendulum(expected=[{"value": 1, "tolerance": 0.1, **more}])
    add("figure of no sensor", figure(quantity="swnig"), ["swnig"], ['did you mean "swing"'])
    add("figure of a component that is none", cantilever(expected=[
        {"quantity": "tip place.w", "value": 1, "tolerance": 0.1}]), ["tip place.w"], ["components x, y, z"])
    add("figure without component", cantilever(expected=[
        {"quantity": "tip place", "value": 1, "tolerance": 0.1}]), ["tip place"], ["components x, y, z"])
    add("figure beyond the last load", cantilever(expected=[
        {"quantity": "tip place.x", "time": 2, "value": 1, "tolerance": 0.1}]), ["/expected/0/time"], ["ends at 1"])
    add("figure beyond the end time", figure(quantity="swing", time=5), ["5"], ["not reached", "end"], verb="run")
    add("figure without tolerance", figure(quantity="swing", tolerance=0), ["tolerance"], ["above 0"])
    return c


def all_cases():
    return (units() + geometry() + topology() + masses() + stiffnesses() + joints() + loads() + times() + statics() +
            frames() + results())
