// Joints as glyphs with their axes, and springs and dampers as coils and dashpots.

// Prisms about axis 3, as the kind of joint says: [sides, radius, half length]; a cube for what has no such kind.
function jointGlyph(prisms) {
  const geometry = new THREE.BufferGeometry(),
    points = [],
    index = [];
  for (const [sides, radius, half] of prisms) {
    const first = points.length / 3;
    for (const z of [-half, half])
      for (let k = 0; k < sides; ++k) {
        const angle = ((k + (sides === 4 ? 0.5 : 0)) * 2 * Math.PI) / sides;
        points.push(radius * Math.cos(angle), radius * Math.sin(angle), z);
      }
    for (let k = 0; k < sides; ++k) {
      const a = first + k,
        b = first + ((k + 1) % sides);
      index.push(a, b, b + sides, a, b + sides, a + sides);
      if (k > 1) index.push(first, a, a - 1, first + sides, a - 1 + sides, a + sides);
    }
  }
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
  geometry.setIndex(index);
  return geometry;
}
const plainGlyph = {axis: false, prisms: [[4, 1, 0.7]]};
function isElastic(link) {
  return ["spring", "damper", "spring and damper"].includes(link.kind);
}

// Places (along, across, other) of a coil and of a dashpot between 0 and 1, pairs of ends of segments.
function coilShape(turns) {
  const points = [];
  const place = function (k) {
    const s = k / turns,
      angle = 16 * Math.PI * s;
    return s < 0.1 || s > 0.9 || turns === 1 ? [s, 0, 0] : [s, Math.cos(angle), Math.sin(angle)];
  };
  for (let k = 0; k < turns; ++k) points.push(place(k), place(k + 1));
  return points;
}
// The piston with its rod, and the open cylinder about it.
const dashpotShape = [
  [[0, 0, 0], [0.5, 0, 0]],
  [[0.5, -0.7, 0], [0.5, 0.7, 0]],
  [[0.5, 0, -0.7], [0.5, 0, 0.7]],
  [[0.38, 1, 0], [0.66, 1, 0]],
  [[0.38, -1, 0], [0.66, -1, 0]],
  [[0.38, 0, 1], [0.66, 0, 1]],
  [[0.38, 0, -1], [0.66, 0, -1]],
  [[0.66, -1, 0], [0.66, 1, 0]],
  [[0.66, 0, -1], [0.66, 0, 1]],
  [[0.66, 0, 0], [1, 0, 0]],
].flat();

class Links {
  constructor(run, paint, size) {
    Object.assign(this, {run, paint, size});
    const kinds = new Map();
    run.links.forEach(function (l, i) {
      if (isElastic(l)) return;
      if (!kinds.has(l.kind)) kinds.set(l.kind, []);
      kinds.get(l.kind).push(i);
    });
    this.joints = [];
    kinds.forEach(function (members, kind) {
      const mesh = new THREE.InstancedMesh(
        jointGlyph((run.glyphs[kind] || plainGlyph).prisms),
        new THREE.MeshLambertMaterial({flatShading: true}),
        members.length,
      );
      mesh.frustumCulled = false;
      mesh.members = members;
      this.joints.push(mesh);
    }, this);
    const elastic = run.links.filter(isElastic),
      coil = coilShape(elastic.length > 2000 ? 1 : 33),
      dashpot = elastic.length > 2000 ? coilShape(1) : dashpotShape,
      half = dashpot.map(function (p) {
        return [p[0], 0.5 * p[1], 0.5 * p[2]];
      });
    this.elastic = elastic.map(function (l) {
      return {link: l, shape: l.kind === "spring" ? coil : l.kind === "damper" ? dashpot : coil.concat(half)};
    });
    const vertices = this.elastic.reduce(function (n, e) {
      return n + e.shape.length;
    }, 0);
    this.coils = lineObject(vertices, true, {});
    const joints = run.links.length - elastic.length;
    this.glyph = 0.011 * size * Math.min(1, Math.max(0.4, Math.sqrt(30 / Math.max(1, joints)))); // many joints are small ones
    this.gaps = lineObject(2 * joints, false, {color: "#8a8a80"}); // what prescribed and open joints bridge
    this.axes = lineObject(2 * joints, false, {color: "#8f7ee6"});
  }

  update({x, q}) {
    this.updateJoints(x, q);
    this.updateElastic(x);
  }
  updateJoints(x, q) {
    const {run, paint} = this,
      matrix = new THREE.Matrix4(),
      turn = new THREE.Quaternion(),
      move = new THREE.Vector3(),
      t4 = [0, 0, 0, 0],
      size = this.glyph,
      scale = new THREE.Vector3(size, size, size),
      gaps = this.gaps.geometry.attributes.position,
      axis = this.axes.geometry.attributes.position;
    let at = 0;
    for (const mesh of this.joints) {
      mesh.members.forEach(function (i, place) {
        const l = run.links[i],
          t = l.first;
        quaternionTimes(q, 4 * t, l.axes, 0, t4);
        matrix.compose(move.fromArray(x, 3 * t), turn.fromArray(t4), scale);
        mesh.setMatrixAt(place, matrix);
        mesh.setColorAt(place, paint.link(l.name));
        const R = axesOf(t4),
          reach = (run.glyphs[l.kind] || plainGlyph).axis ? 8 * size : 0;
        for (let r = 0; r < 3; ++r) {
          gaps.array[at + r] = x[3 * t + r];
          gaps.array[at + 3 + r] = x[3 * l.second + r];
          axis.array[at + r] = x[3 * t + r] - reach * R[6 + r];
          axis.array[at + 3 + r] = x[3 * t + r] + reach * R[6 + r];
        }
        at += 6;
      });
      mesh.instanceMatrix.needsUpdate = true;
      mesh.instanceColor.needsUpdate = true;
    }
    gaps.needsUpdate = axis.needsUpdate = true;
  }
  updateElastic(x) {
    const {position, color} = this.coils.geometry.attributes,
      a = new THREE.Vector3(),
      along = new THREE.Vector3(),
      p = new THREE.Vector3();
    let at = 0;
    for (const {link, shape} of this.elastic) {
      a.fromArray(x, 3 * link.first);
      along.fromArray(x, 3 * link.second).sub(a);
      const length = along.length(),
        [across, other] = acrossOf(along),
        radius = Math.min(0.012 * this.size, 0.2 * length),
        paint = this.paint.link(link.name);
      for (const [s, u, v] of shape) {
        p.copy(a).addScaledVector(along, s).addScaledVector(across, radius * u).addScaledVector(other, radius * v);
        p.toArray(position.array, at);
        this.paint.put(paint, color.array, at);
        at += 3;
      }
    }
    position.needsUpdate = color.needsUpdate = true;
  }
}
