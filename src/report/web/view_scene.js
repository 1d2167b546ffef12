// One run as objects of three.js, at any time: its parts, ghosts and traces, and which part is where on the screen.
class RunScene {
  constructor(run, size, tint) {
    Object.assign(this, {run, tint, paint: new Paint(run, tint), poses: posesAt(run, run.times[0], 1)});
    for (const group of ["root", "lines", "solids", "glyphs", "frames", "extras", "axes"]) this[group] = new THREE.Group();
    this.root.add(this.lines, this.solids, this.glyphs, this.frames, this.extras, this.axes);
    this.frames.visible = this.axes.visible = false;
    this.hasBare = run.curves.some(function (c) {
      return c.outline < 0;
    });
    this.curves = new Curves(run, this.paint);
    this.bodies = new Bodies(run, this.paint);
    this.links = new Links(run, this.paint, size);
    this.loads = new Loads(run, size);
    this.triads = new Triads(run, size);
    this.lines.add(this.curves.lines);
    for (const mesh of this.bodies.instances) this.solids.add(mesh);
    this.glyphs.add(this.bodies.spokes, this.bodies.centers, ...this.links.joints, this.links.coils, this.links.gaps);
    this.glyphs.add(this.loads.lines);
    this.axes.add(this.links.axes);
    this.frames.add(this.triads.lines);
    this.thin();
  }

  // The second of two runs is seen through, so that the first shows where both are alike.
  thin() {
    if (!this.tint) return;
    this.root.traverse(function (object) {
      if (object.material)
        Object.assign(object.material, {
          transparent: true,
          opacity: 0.45,
          depthWrite: false,
          polygonOffset: true,
          polygonOffsetFactor: 1,
          polygonOffsetUnits: 2,
        });
    });
  }

  // Displacements and rotations from the start times scale. Without solids sections and surfaces are neither moved nor seen.
  update(time, scale, withSolids) {
    const {run, curves} = this;
    posesAt(run, time, scale, this.poses);
    if (withSolids && !curves.isBuilt) {
      curves.buildTubes();
      if (curves.tubes) this.solids.add(curves.tubes);
      this.thin();
    }
    const place = placeOf(run.times, time),
      nearest = Math.min(run.times.length - 1, place.k + (place.f >= 0.5 ? 1 : 0));
    curves.update(this.poses, nearest, withSolids);
    this.bodies.update(this.poses, nearest, withSolids);
    this.links.update(this.poses);
    this.loads.update(this.poses, nearest);
    if (this.frames.visible) this.triads.update(this.poses);
    this.solids.visible = withSolids;
    this.lines.visible = !withSolids || !curves.tubes || this.hasBare;
  }

  // ---- extras ----

  // The track that stands for a part: a body's centre, a joint, the end of a beam.
  trackOf(name) {
    const {run} = this,
      named = function (part) {
        return part.name === name;
      };
    const body = run.bodies.find(named);
    if (body) return body.track;
    const curve = run.curves.find(named);
    if (curve) return run.data.pointTrack[curve.first + curve.points - 1];
    const link = run.links.find(named);
    if (link) return link.first;
    const other = run.frames.concat(run.arrows).find(named);
    return other ? other.track : -1;
  }
  addTrace(track, color, scale) {
    const n = this.run.times.length,
      object = lineObject(2 * Math.max(0, n - 1), false, {color: color}),
      out = object.geometry.attributes.position.array;
    this.run.times.forEach(function (time, k) {
      const place = posesAt(this.run, time, scale).x.subarray(3 * track, 3 * track + 3);
      if (k > 0) out.set(place, 6 * k - 3);
      if (k + 1 < n) out.set(place, 6 * k);
    }, this);
    this.extras.add(object);
  }
  addGhost(color) {
    for (const source of [this.curves.lines, this.bodies.spokes]) {
      const {position} = source.geometry.attributes,
        object = lineObject(position.count, false, {color: color, transparent: true, opacity: 0.55});
      object.geometry.attributes.position.array.set(position.array);
      this.extras.add(object);
    }
  }
  clearExtras() {
    for (const object of this.extras.children) object.geometry.dispose();
    this.extras.clear();
  }

  // Name of the part nearest to a place on the screen; project(x, i) gives pixels.
  partAt(px, py, project) {
    let best = "",
      nearest = 14;
    const {x} = this.poses,
      {run} = this;
    const see = function (name, distance) {
      if (distance < nearest) {
        nearest = distance;
        best = name;
      }
    };
    const seePoint = function (part, track, more) {
      const p = project(x, 3 * track);
      see(part.name, Math.hypot(p[0] - px, p[1] - py) + more);
    };
    const seeSegment = function (part, first, second) {
      see(part.name, segmentDistance(px, py, project(x, 3 * first), project(x, 3 * second)) + 2);
    };
    for (const b of run.bodies) seePoint(b, b.track, -3);
    for (const l of run.links) isElastic(l) ? seeSegment(l, l.first, l.second) : seePoint(l, l.first, 0);
    for (const a of run.arrows.concat(run.frames)) seePoint(a, a.track, 3);
    const tracks = run.data.pointTrack;
    for (const c of run.curves)
      for (let k = 0; k + 1 < c.points; ++k) seeSegment(c, tracks[c.first + k], tracks[c.first + k + 1]);
    return best;
  }
}
