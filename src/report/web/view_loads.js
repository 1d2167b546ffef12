// Loads as arrows, as long as they are large against others of their kind; moving frames as triads.
const arrowVertices = 10;

class Loads {
  constructor(run, size) {
    Object.assign(this, {run, size});
    this.lines = lineObject(arrowVertices * run.arrows.length, false, {color: "#d03b3b"});
    // The largest of each kind over the run: forces, moments, and those per length.
    this.most = new Map();
    const {force, moment} = run.data,
      n = run.arrows.length;
    for (let i = 0; n && force && 3 * i < force.length; ++i) {
      const kind = run.arrows[i % n].kind;
      for (const [key, of] of [
        [kind, force],
        [kind + " moment", moment],
      ])
        this.most.set(key, Math.max(this.most.get(key) || 0, Math.hypot(of[3 * i], of[3 * i + 1], of[3 * i + 2])));
    }
  }

  // An arrow of each force, else of the moment, with its tip where it acts.
  update({x}, k) {
    const {run} = this,
      out = this.lines.geometry.attributes.position,
      n = run.arrows.length,
      {force, moment} = run.data,
      v = new THREE.Vector3(),
      tip = new THREE.Vector3(),
      p = new THREE.Vector3();
    run.arrows.forEach(function (arrow, i) {
      const f = 3 * (k * n + i),
        isForce = v.fromArray(force, f).lengthSq() > 0;
      if (!isForce) v.fromArray(moment, f);
      const longest = arrow.kind === "line load" ? 0.08 : 0.16;
      v.multiplyScalar((longest * this.size) / (this.most.get(isForce ? arrow.kind : arrow.kind + " moment") || 1));
      tip.fromArray(x, 3 * arrow.track);
      const length = v.length(),
        sides = length > 0 ? acrossOf(v) : [v, v];
      let at = 3 * arrowVertices * i;
      p.copy(tip).sub(v).toArray(out.array, at);
      tip.toArray(out.array, at + 3);
      for (const side of sides)
        for (const sign of [1, -1]) {
          at += 6;
          tip.toArray(out.array, at);
          p.copy(tip).addScaledVector(v, -0.22).addScaledVector(side, length > 0 ? 0.09 * sign * length : 0);
          p.toArray(out.array, at + 3);
        }
    }, this);
    out.needsUpdate = true;
  }
}

class Triads {
  constructor(run, size) {
    Object.assign(this, {run, size});
    this.lines = lineObject(6 * (run.frames.length + 1), true, {});
    const colors = [
        [0.8, 0.2, 0.2],
        [0.1, 0.6, 0.2],
        [0.2, 0.35, 0.9],
      ],
      out = this.lines.geometry.attributes.color.array;
    for (let v = 0; 3 * v < out.length; ++v) out.set(colors[Math.floor(v / 2) % 3], 3 * v);
  }
  // Those of the scene, and that of the ground.
  update({x, q}) {
    const {position} = this.lines.geometry.attributes,
      length = 0.08 * this.size,
      t4 = [0, 0, 0, 0];
    for (let i = 0; i <= this.run.frames.length; ++i) {
      const f = this.run.frames[i];
      let origin = this.run.origin.map(function (o) {
          return -o;
        }),
        R = [1, 0, 0, 0, 1, 0, 0, 0, 1];
      if (f) {
        quaternionTimes(q, 4 * f.track, f.axes, 0, t4);
        origin = [x[3 * f.track], x[3 * f.track + 1], x[3 * f.track + 2]];
        R = axesOf(t4);
      }
      for (let a = 0; a < 3; ++a)
        for (let e = 0; e < 2; ++e)
          for (let r = 0; r < 3; ++r)
            position.array[18 * i + 6 * a + 3 * e + r] = origin[r] + e * length * R[3 * a + r];
    }
    position.needsUpdate = true;
  }
}
