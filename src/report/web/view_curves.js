// Beams: their axes as lines, and their sections as tubes, which are built when they are first drawn.
class Curves {
  constructor(run, paint) {
    Object.assign(this, {run, paint});
    const tracks = run.data.pointTrack;
    let segments = 0;
    for (const c of run.curves) segments += Math.max(0, c.points - 1);
    this.lines = lineObject(2 * segments, true, {});
    this.tracks = new Uint32Array(2 * segments); // of the vertices of lines
    let at = 0;
    for (const c of run.curves)
      for (let p = 0; p + 1 < c.points; ++p) {
        this.tracks[at++] = 3 * tracks[c.first + p];
        this.tracks[at++] = 3 * tracks[c.first + p + 1];
      }
    this.tubes = null;
    this.isBuilt = false;
  }

  // Of many beams the outsides alone, without the faces of the ends.
  buildTubes() {
    this.isBuilt = true;
    const isCoarse = this.run.curves.length > 2000;
    this.endRings = isCoarse ? 0 : 2;
    this.caps = this.run.outlines.map(function (outline) {
      const loops = (isCoarse ? outline.slice(0, 1) : outline).map(function (l) {
        const points = [];
        for (let k = 0; k < l.length; k += 2) points.push(new THREE.Vector2(l[k], l[k + 1]));
        return points;
      });
      const count = loops.reduce(function (n, l) {
        return n + l.length;
      }, 0);
      const faces = loops.length && !isCoarse ? THREE.ShapeUtils.triangulateShape(loops[0], loops.slice(1)) : [];
      return {loops: loops, count: count, faces: faces};
    });
    this.solid = this.run.curves.filter(function (c) {
      return c.outline >= 0 && c.points > 1;
    });
    let vertices = 0,
      triangles = 0;
    for (const c of this.solid) {
      const cap = this.caps[c.outline];
      vertices += (c.points + this.endRings) * cap.count;
      triangles += 2 * (c.points - 1) * cap.count + 2 * cap.faces.length;
    }
    if (!vertices) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
    geometry.setIndex(new THREE.BufferAttribute(this.tubeIndex(3 * triangles), 1));
    this.tubes = new THREE.Mesh(
      geometry,
      new THREE.MeshLambertMaterial({vertexColors: true, flatShading: true, side: THREE.DoubleSide}),
    );
    this.tubes.frustumCulled = false;
  }
  tubeIndex(size) {
    const index = new Uint32Array(size);
    let at = 0,
      first = 0;
    for (const c of this.solid) {
      const cap = this.caps[c.outline],
        m = cap.count;
      for (let p = 0; p + 1 < c.points; ++p) {
        let begin = 0;
        for (const loop of cap.loops) {
          for (let k = 0; k < loop.length; ++k) {
            const a = first + p * m + begin + k,
              b = first + p * m + begin + ((k + 1) % loop.length);
            index.set([a, b, b + m, a, b + m, a + m], at);
            at += 6;
          }
          begin += loop.length;
        }
      }
      const low = first + c.points * m,
        high = low + m; // the ends have corners of their own
      for (const f of cap.faces) {
        index.set([low + f[0], low + f[2], low + f[1], high + f[0], high + f[1], high + f[2]], at);
        at += 6;
      }
      first += (c.points + this.endRings) * m;
    }
    return index;
  }

  update(poses, k, withSolids) {
    // Colours change with the quantity, its time and what is selected, and else stay.
    const key = this.paint.key(k);
    this.updateLines(poses.x, k, key);
    if (withSolids && this.tubes) this.updateTubes(poses, k, key);
  }
  updateLines(x, k, key) {
    const {position, color} = this.lines.geometry.attributes,
      tracks = this.tracks,
      out = position.array;
    for (let v = 0, at = 0; v < tracks.length; ++v, at += 3) {
      const t = tracks[v];
      out[at] = x[t];
      out[at + 1] = x[t + 1];
      out[at + 2] = x[t + 2];
    }
    position.needsUpdate = true;
    if (key === this.lineKey) return;
    this.lineKey = key;
    let at = 0;
    for (const c of this.run.curves)
      for (let p = 0; p + 1 < c.points; ++p, at += 6) {
        this.paint.curvePoint(c, p, k, color.array, at);
        this.paint.curvePoint(c, p + 1, k, color.array, at + 3);
      }
    color.needsUpdate = true;
  }
  updateTubes({x, q}, k, key) {
    const {pointTrack, pointAxes} = this.run.data,
      {position, color} = this.tubes.geometry.attributes,
      out = position.array,
      painted = key !== this.tubeKey ? color.array : null;
    const q4 = [0, 0, 0, 0],
      rgb = [0, 0, 0];
    this.tubeKey = key;
    let v = 0;
    for (const c of this.solid) {
      const cap = this.caps[c.outline];
      for (let p = 0; p < c.points + this.endRings; ++p) {
        // all rings, then the corners of the two ends
        const ring = p < c.points ? p : p === c.points ? 0 : c.points - 1,
          point = c.first + ring,
          t = pointTrack[point];
        quaternionTimes(q, 4 * t, pointAxes, 4 * point, q4);
        const R = axesOf(q4);
        if (painted) this.paint.curvePoint(c, ring, k, rgb, 0);
        for (const loop of cap.loops)
          for (const o of loop) {
            for (let r = 0; r < 3; ++r) out[v + r] = x[3 * t + r] + R[3 + r] * o.x + R[6 + r] * o.y;
            if (painted) {
              painted[v] = rgb[0];
              painted[v + 1] = rgb[1];
              painted[v + 2] = rgb[2];
            }
            v += 3;
          }
      }
    }
    position.needsUpdate = true;
    color.needsUpdate = Boolean(painted);
  }
}
