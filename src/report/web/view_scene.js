// One run as objects of three.js: beams with their sections, bodies, joints, springs, loads, frames; traces and ghosts.
const palette = ["#2a78d6", "#eb6834", "#1baf7a", "#8f7ee6", "#e87ba4", "#c98500", "#4aa3a3", "#8a8a80"];
const viridis = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];
function viridisAt(s) {
  const x = Math.min(1, Math.max(0, s)) * (viridis.length - 1),
    k = Math.min(viridis.length - 2, Math.floor(x)),
    f = x - k;
  return [0, 1, 2].map(function (c) {
    return (viridis[k][c] + f * (viridis[k + 1][c] - viridis[k][c])) / 255;
  });
}
const mapTable = new Float32Array(256 * 3);
for (let k = 0; k < 256; ++k)
  mapTable.set(
    viridisAt(k / 255).map(function (c) {
      return new THREE.Color().setRGB(c, c, c, "srgb").r;
    }),
    3 * k,
  );

function quaternionTimes(a, i, b, j, out) {
  // out = a[i..] b[j..], all (x, y, z, w)
  const ax = a[i],
    ay = a[i + 1],
    az = a[i + 2],
    aw = a[i + 3],
    bx = b[j],
    by = b[j + 1],
    bz = b[j + 2],
    bw = b[j + 3];
  out[0] = aw * bx + ax * bw + ay * bz - az * by;
  out[1] = aw * by - ax * bz + ay * bw + az * bx;
  out[2] = aw * bz + ax * by - ay * bx + az * bw;
  out[3] = aw * bw - ax * bx - ay * by - az * bz;
}
function axesOf(q) {
  // columns of the rotation, one after the other
  const [x, y, z, w] = q;
  return [
    1 - 2 * (y * y + z * z),
    2 * (x * y + z * w),
    2 * (x * z - y * w),
    2 * (x * y - z * w),
    1 - 2 * (x * x + z * z),
    2 * (y * z + x * w),
    2 * (x * z + y * w),
    2 * (y * z - x * w),
    1 - 2 * (x * x + y * y),
  ];
}

class RunScene {
  constructor(run, size, tint) {
    this.run = run;
    this.size = size;
    this.tint = tint; // the second of two runs: one colour
    this.root = new THREE.Group();
    this.lines = new THREE.Group();
    this.solids = new THREE.Group();
    this.glyphs = new THREE.Group();
    this.frames = new THREE.Group();
    this.extras = new THREE.Group();
    this.axes = new THREE.Group();
    this.root.add(this.lines, this.solids, this.glyphs, this.frames, this.extras, this.axes);
    this.frames.visible = this.axes.visible = false;
    this.poses = posesAt(run, run.times[0], 1);
    this.selected = "";
    this.hasBare = run.curves.some(function (c) {
      return c.outline < 0;
    });
    this.buildCurves();
    this.buildBodies();
    this.buildLinks();
    this.buildArrows();
    this.buildFrames();
    this.thin();
  }

  // The second of two runs is seen through, so that the first shows where both are alike.
  thin() {
    if (!this.tint) return;
    this.root.traverse(function (object) {
      if (object.material) Object.assign(object.material, {
          transparent: true,
          opacity: 0.45,
          depthWrite: false,
          polygonOffset: true,
          polygonOffsetFactor: 1,
          polygonOffsetUnits: 2,
        });
    });
  }

  lineObject(vertices, colored, options) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
    if (colored) geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
    const object = new THREE.LineSegments(
      geometry,
      new THREE.LineBasicMaterial(Object.assign({vertexColors: colored}, options)),
    );
    object.frustumCulled = false;
    return object;
  }

  buildCurves() {
    let segments = 0;
    for (const c of this.run.curves) segments += Math.max(0, c.points - 1);
    this.curveLines = this.lineObject(2 * segments, true, {});
    this.lines.add(this.curveLines);
  }
  // Sections are built when they are first drawn. Of many beams the outsides alone, without the faces of the ends.
  buildTubes() {
    const curves = this.run.curves,
      isCoarse = curves.length > 2000;
    let vertices = 0,
      triangles = 0;
    const caps = this.run.outlines.map(function (outline) {
      const loops = (isCoarse ? outline.slice(0, 1) : outline).map(function (l) {
        const points = [];
        for (let k = 0; k < l.length; k += 2) points.push(new THREE.Vector2(l[k], l[k + 1]));
        return points;
      });
      return {
        loops: loops,
        count: loops.reduce(function (n, l) {
          return n + l.length;
        }, 0),
        faces: loops.length && !isCoarse ? THREE.ShapeUtils.triangulateShape(loops[0], loops.slice(1)) : [],
      };
    });
    const rings = isCoarse ? 0 : 2;
    this.endRings = rings;
    for (const c of curves) {
      if (c.outline < 0 || c.points < 2) continue;
      vertices += (c.points + rings) * caps[c.outline].count;
      triangles += 2 * (c.points - 1) * caps[c.outline].count + 2 * caps[c.outline].faces.length;
    }
    this.caps = caps;
    this.hasTubes = vertices > 0;
    if (!vertices) return;
    const geometry = new THREE.BufferGeometry(),
      index = new Uint32Array(3 * triangles);
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
    let at = 0,
      first = 0;
    for (const c of curves) {
      if (c.outline < 0 || c.points < 2) continue;
      const cap = caps[c.outline],
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
      first += (c.points + rings) * m;
    }
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    const mesh = new THREE.Mesh(
      geometry,
      new THREE.MeshLambertMaterial({vertexColors: true, flatShading: true, side: THREE.DoubleSide}),
    );
    mesh.frustumCulled = false;
    this.tubes = mesh;
    this.solids.add(mesh);
    this.thin();
  }

  buildBodies() {
    const bodies = this.run.bodies;
    this.instances = [];
    this.run.meshes.forEach(function (m, k) {
      const members = [];
      bodies.forEach(function (b, i) {
        if (b.mesh === k) members.push(i);
      });
      if (!members.length) return;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(m.points), 3));
      geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(m.triangles), 1));
      const mesh = new THREE.InstancedMesh(
        geometry,
        new THREE.MeshLambertMaterial({flatShading: true, side: THREE.DoubleSide}),
        members.length,
      );
      mesh.frustumCulled = false;
      mesh.members = members;
      this.instances.push(mesh);
      this.solids.add(mesh);
    }, this);
    const spokes = bodies.reduce(function (n, b) {
      return n + b.arms.length / 3;
    }, 0);
    this.spokes = this.lineObject(2 * spokes, true, {});
    this.glyphs.add(this.spokes);
    const points = new THREE.BufferGeometry();
    points.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * bodies.length), 3));
    points.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * bodies.length), 3));
    this.centers = new THREE.Points(
      points,
      new THREE.PointsMaterial({size: 7, sizeAttenuation: false, vertexColors: true}),
    );
    this.centers.frustumCulled = false;
    this.glyphs.add(this.centers);
  }

  // Glyphs: a pin along the axis for what turns about it, a bar for what slides along it, a ball, a cube for what is fixed.
  glyphGeometry(kind) {
    const geometry = new THREE.BufferGeometry(),
      points = [],
      index = [];
    const prism = function (sides, radius, half, spin) {
      const first = points.length / 3;
      for (const z of [-half, half])
        for (let k = 0; k < sides; ++k) {
          const angle = spin + (2 * Math.PI * k) / sides;
          points.push(radius * Math.cos(angle), radius * Math.sin(angle), z);
        }
      for (let k = 0; k < sides; ++k) {
        const a = first + k,
          b = first + ((k + 1) % sides);
        index.push(a, b, b + sides, a, b + sides, a + sides);
        if (k > 1) index.push(first, a, a - 1, first + sides, a - 1 + sides, a + sides);
      }
    };
    if (kind === "revolute" || kind === "screw") prism(12, 0.7, 1.4, 0);
    else if (kind === "prismatic") prism(4, 0.6, 2.4, Math.PI / 4);
    else if (kind === "cylindrical") prism(12, 0.6, 2.4, 0);
    else if (kind === "planar") prism(4, 2, 0.2, Math.PI / 4);
    else if (kind === "spherical") {
      prism(12, 1, 0.4, 0);
      prism(12, 0.8, 0.75, 0);
      prism(12, 0.45, 1, 0);
    } else if (kind === "universal") {
      prism(4, 1, 0.5, 0);
      prism(8, 0.5, 1.2, 0);
    } else prism(4, 1, 0.7, Math.PI / 4);
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
    geometry.setIndex(index);
    return geometry;
  }

  buildLinks() {
    this.joints = [];
    const kinds = new Map();
    this.run.links.forEach(function (l, i) {
      if (l.kind === "spring") return;
      if (!kinds.has(l.kind)) kinds.set(l.kind, []);
      kinds.get(l.kind).push(i);
    });
    kinds.forEach(function (members, kind) {
      const mesh = new THREE.InstancedMesh(
        this.glyphGeometry(kind),
        new THREE.MeshLambertMaterial({flatShading: true}),
        members.length,
      );
      mesh.frustumCulled = false;
      mesh.members = members;
      this.joints.push(mesh);
      this.glyphs.add(mesh);
    }, this);
    this.springs = this.run.links
      .map(function (l, i) {
        return i;
      })
      .filter(function (i) {
        return this.run.links[i].kind === "spring";
      }, this);
    this.coilPoints = this.springs.length > 2000 ? 1 : 33;
    this.coils = this.lineObject(2 * this.coilPoints * this.springs.length, true, {});
    this.glyphs.add(this.coils);
    this.gaps = this.lineObject(2 * this.run.links.length, false, {color: "#8a8a80"}); // what prescribed and open joints bridge
    this.glyphs.add(this.gaps);
    this.jointAxes = this.lineObject(2 * this.run.links.length, false, {color: "#8f7ee6"});
    this.axes.add(this.jointAxes);
  }
  buildArrows() {
    this.arrows = this.lineObject(10 * this.run.arrows.length, false, {color: "#d03b3b"});
    this.glyphs.add(this.arrows);
    let most = 0,
      twist = 0;
    const {force, moment} = this.run.data;
    for (let k = 0; k < (force ? force.length : 0); k += 3) {
      most = Math.max(most, Math.hypot(force[k], force[k + 1], force[k + 2]));
      twist = Math.max(twist, Math.hypot(moment[k], moment[k + 1], moment[k + 2]));
    }
    this.mostForce = most || 1;
    this.mostMoment = twist || 1;
  }
  buildFrames() {
    this.triads = this.lineObject(6 * (this.run.frames.length + 1), true, {});
    this.frames.add(this.triads);
  }

  // ---- colours ----

  // quantity: null, or {name, kind, low, high}; base: colour of what shows none
  color(quantity, base, accent) {
    this.quantity = quantity;
    this.base = new THREE.Color(this.tint || base);
    this.accent = new THREE.Color(accent);
    this.stale = true;
  }
  pointColor(point, k, out, at) {
    const values = this.quantity && this.run.data["q." + this.quantity.name],
      points = this.run.numPoints;
    if (!values || !points) {
      out[at] = this.base.r;
      out[at + 1] = this.base.g;
      out[at + 2] = this.base.b;
      return;
    }
    const v = 3 * values[k * points + point];
    out[at] = mapTable[v];
    out[at + 1] = mapTable[v + 1];
    out[at + 2] = mapTable[v + 2];
  }
  speedOf(body, k) {
    const values = this.run.data["body.speed"];
    return values ? values[k * this.run.bodies.length + body] : 0;
  }
  partColor(name, out, at, own) {
    const c = name === this.selected ? this.accent : own || this.base;
    out[at] = c.r;
    out[at + 1] = c.g;
    out[at + 2] = c.b;
  }

  // ---- a time ----

  update(time, scale, withSolids) {
    const run = this.run,
      d = run.data;
    this.time = time;
    posesAt(run, time, scale, this.poses);
    const {x, q} = this.poses,
      place = placeOf(run.times, time),
      nearest = Math.min(run.times.length - 1, place.k + (place.f >= 0.5 ? 1 : 0));
    this.updateCurves(nearest, withSolids);
    const matrix = new THREE.Matrix4(),
      turn = new THREE.Quaternion(),
      move = new THREE.Vector3(),
      one = new THREE.Vector3(1, 1, 1),
      t4 = [0, 0, 0, 0];
    const color = new THREE.Color(),
      isSpeed = this.quantity && this.quantity.name === "speed";
    const bodyColor = function (i, name) {
      if (name === this.selected) return color.copy(this.accent);
      if (!isSpeed || !d["body.speed"])
        return color.copy(this.base).lerp(new THREE.Color("#8a8a80"), this.tint ? 0.3 : 0.75);
      const v = 3 * this.speedOf(i, nearest);
      return color.setRGB(mapTable[v], mapTable[v + 1], mapTable[v + 2]);
    }.bind(this);
    for (const mesh of this.instances) {
      mesh.members.forEach(function (i, place) {
        const b = run.bodies[i],
          t = b.track;
        quaternionTimes(q, 4 * t, b.axes, 0, t4);
        matrix.compose(move.fromArray(x, 3 * t), turn.fromArray(t4), one);
        mesh.setMatrixAt(place, matrix);
        mesh.setColorAt(place, bodyColor(i, b.name));
      });
      mesh.instanceMatrix.needsUpdate = true;
      mesh.instanceColor.needsUpdate = true;
    }
    let at = 0;
    const spoke = this.spokes.geometry.attributes,
      center = this.centers.geometry.attributes;
    run.bodies.forEach(function (b, i) {
      const t = b.track,
        R = axesOf([q[4 * t], q[4 * t + 1], q[4 * t + 2], q[4 * t + 3]]),
        c = bodyColor(i, b.name);
      center.position.array.set([x[3 * t], x[3 * t + 1], x[3 * t + 2]], 3 * i);
      center.color.array.set([c.r, c.g, c.b], 3 * i);
      for (let k = 0; k < b.arms.length; k += 3) {
        for (let e = 0; e < 2; ++e) {
          for (let r = 0; r < 3; ++r)
            spoke.position.array[at + r] =
              x[3 * t + r] + (e ? R[r] * b.arms[k] + R[3 + r] * b.arms[k + 1] + R[6 + r] * b.arms[k + 2] : 0);
          spoke.color.array.set([c.r, c.g, c.b], at);
          at += 3;
        }
      }
    });
    for (const a of [spoke.position, spoke.color, center.position, center.color]) a.needsUpdate = true;
    this.updateLinks(x, q);
    this.updateArrows(x, nearest);
    this.updateFrames(x, q);
  }

  updateCurves(k, withSolids) {
    if (withSolids && this.hasTubes === undefined) this.buildTubes();
    const run = this.run,
      {x, q} = this.poses,
      tracks = run.data.pointTrack,
      axes = run.data.pointAxes;
    const line = this.curveLines.geometry.attributes,
      lp = line.position.array,
      lc = line.color.array;
    const tube = withSolids && this.tubes ? this.tubes.geometry.attributes : null,
      isDomain = this.quantity && this.quantity.name === "sub-domain";
    const q4 = [0, 0, 0, 0],
      rgb = new Float32Array(3),
      domain = new THREE.Color();
    // Colours change with the quantity, its time and what is selected, and else stay.
    const key = [
      this.quantity ? this.quantity.name + k : "",
      this.selected,
      this.accent.getHex(),
      this.base.getHex(),
    ].join("|");
    const paintLines = key !== this.lineKey,
      paintTubes = tube && key !== this.tubeKey;
    this.lineKey = key;
    if (tube) this.tubeKey = key;
    let at = 0,
      v = 0;
    for (const c of run.curves) {
      const cap = tube && c.outline >= 0 ? this.caps[c.outline] : null;
      const put = function (p, target, place) {
        if (c.name === this.selected) target.set([this.accent.r, this.accent.g, this.accent.b], place);
        else if (isDomain && c.subdomains.length) {
          const e = Math.min(c.subdomains.length - 1, Math.floor((p / (c.points - 1)) * c.subdomains.length));
          domain.set(palette[((c.subdomains[e] % 8) + 8) % 8]);
          target[place] = domain.r;
          target[place + 1] = domain.g;
          target[place + 2] = domain.b;
        } else this.pointColor(c.first + p, k, target, place);
      }.bind(this);
      for (let p = 0; p + 1 < c.points; ++p)
        for (let e = 0; e < 2; ++e) {
          const t = 3 * tracks[c.first + p + e];
          lp[at] = x[t];
          lp[at + 1] = x[t + 1];
          lp[at + 2] = x[t + 2];
          if (paintLines) put(p + e, lc, at);
          at += 3;
        }
      if (!tube || !cap || c.points < 2) continue;
      for (let p = 0; p < c.points + this.endRings; ++p) {
        // all rings, then the corners of the two ends
        const ring = p < c.points ? p : p === c.points ? 0 : c.points - 1,
          point = c.first + ring,
          t = tracks[point];
        quaternionTimes(q, 4 * t, axes, 4 * point, q4);
        const R = axesOf(q4);
        if (paintTubes) put(ring, rgb, 0);
        for (const loop of cap.loops)
          for (const o of loop) {
            for (let r = 0; r < 3; ++r) tube.position.array[v + r] = x[3 * t + r] + R[3 + r] * o.x + R[6 + r] * o.y;
            if (paintTubes) {
              tube.color.array[v] = rgb[0];
              tube.color.array[v + 1] = rgb[1];
              tube.color.array[v + 2] = rgb[2];
            }
            v += 3;
          }
      }
    }
    line.position.needsUpdate = true;
    line.color.needsUpdate = paintLines;
    if (!tube) return;
    tube.position.needsUpdate = true;
    tube.color.needsUpdate = paintTubes;
  }

  updateLinks(x, q) {
    const run = this.run,
      matrix = new THREE.Matrix4(),
      turn = new THREE.Quaternion(),
      move = new THREE.Vector3(),
      t4 = [0, 0, 0, 0];
    const size = 0.011 * this.size,
      scale = new THREE.Vector3(size, size, size),
      color = new THREE.Color();
    const grey = new THREE.Color(this.tint || "#6f6e68"),
      gaps = this.gaps.geometry.attributes.position,
      axis = this.jointAxes.geometry.attributes.position;
    let at = 0;
    for (const mesh of this.joints) {
      mesh.members.forEach(function (i, place) {
        const l = run.links[i],
          t = l.first;
        quaternionTimes(q, 4 * t, l.axes, 0, t4);
        matrix.compose(move.fromArray(x, 3 * t), turn.fromArray(t4), scale);
        mesh.setMatrixAt(place, matrix);
        mesh.setColorAt(place, color.copy(l.name === this.selected ? this.accent : grey));
        const R = axesOf(t4);
        for (let r = 0; r < 3; ++r) {
          gaps.array[at + r] = x[3 * t + r];
          gaps.array[at + 3 + r] = x[3 * l.second + r];
          const reach =
            l.kind === "fixed" || l.kind === "bushing" || l.kind === "spherical" || l.kind === "prescribed motion"
              ? 0
              : 8 * size;
          axis.array[at + r] = x[3 * t + r] - reach * R[6 + r];
          axis.array[at + 3 + r] = x[3 * t + r] + reach * R[6 + r];
        }
        at += 6;
      }, this);
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    gaps.needsUpdate = axis.needsUpdate = true;
    const coil = this.coils.geometry.attributes,
      n = this.coilPoints;
    at = 0;
    for (const i of this.springs) {
      const l = run.links[i],
        a = new THREE.Vector3().fromArray(x, 3 * l.first),
        b = new THREE.Vector3().fromArray(x, 3 * l.second);
      const along = b.clone().sub(a),
        length = along.length();
      const across = new THREE.Vector3(
        Math.abs(along.z) < 0.9 * length ? 0 : 1,
        0,
        Math.abs(along.z) < 0.9 * length ? 1 : 0,
      )
        .cross(along)
        .normalize();
      const other = across.clone().cross(along).normalize(),
        radius = Math.min(0.012 * this.size, 0.2 * length);
      const point = function (k) {
        const s = k / n,
          p = a.clone().addScaledVector(along, s);
        if (s < 0.1 || s > 0.9 || n === 1) return p;
        const angle = 2 * Math.PI * 8 * s;
        return p.addScaledVector(across, radius * Math.cos(angle)).addScaledVector(other, radius * Math.sin(angle));
      };
      for (let k = 0; k < n; ++k)
        for (let e = 0; e < 2; ++e) {
          point(k + e).toArray(coil.position.array, at);
          this.partColor(l.name, coil.color.array, at, grey);
          at += 3;
        }
    }
    coil.position.needsUpdate = coil.color.needsUpdate = true;
  }

  updateArrows(x, k) {
    const run = this.run,
      out = this.arrows.geometry.attributes.position,
      n = run.arrows.length,
      {force, moment} = run.data;
    run.arrows.forEach(function (arrow, i) {
      const f = 3 * (k * n + i),
        F = new THREE.Vector3().fromArray(force, f),
        M = new THREE.Vector3().fromArray(moment, f);
      const isForce = F.length() > 0,
        v = isForce
          ? F.multiplyScalar((0.16 * this.size) / this.mostForce)
          : M.multiplyScalar((0.16 * this.size) / this.mostMoment);
      const tip = new THREE.Vector3().fromArray(x, 3 * arrow.track),
        tail = tip.clone().sub(v),
        back = v.clone().multiplyScalar(-0.22);
      const across = new THREE.Vector3(
        Math.abs(v.z) < 0.9 * v.length() ? 0 : 1,
        0,
        Math.abs(v.z) < 0.9 * v.length() ? 1 : 0,
      )
        .cross(v)
        .normalize()
        .multiplyScalar(0.09 * v.length());
      const other = across.clone().cross(v).normalize().multiplyScalar(across.length());
      const pairs = [[tail, tip]];
      for (const side of [across, across.clone().negate(), other, other.clone().negate()])
        pairs.push([tip, tip.clone().add(back).add(side)]);
      pairs.forEach(function (pair, p) {
        pair[0].toArray(out.array, 30 * i + 6 * p);
        pair[1].toArray(out.array, 30 * i + 6 * p + 3);
      });
    }, this);
    out.needsUpdate = true;
  }

  updateFrames(x, q) {
    const out = this.triads.geometry.attributes,
      length = 0.08 * this.size,
      colors = [
        [0.8, 0.2, 0.2],
        [0.1, 0.6, 0.2],
        [0.2, 0.35, 0.9],
      ];
    const t4 = [0, 0, 0, 0];
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
        for (let e = 0; e < 2; ++e) {
          const at = 18 * i + 6 * a + 3 * e;
          for (let r = 0; r < 3; ++r) out.position.array[at + r] = origin[r] + e * length * R[3 * a + r];
          out.color.array.set(colors[a], at);
        }
    }
    out.position.needsUpdate = out.color.needsUpdate = true;
  }

  // ---- extras ----

  // The track that stands for a part: a body's centre, a joint, the end of a beam.
  trackOf(name) {
    const run = this.run,
      body = run.bodies.find(function (b) {
        return b.name === name;
      });
    if (body) return body.track;
    const curve = run.curves.find(function (c) {
      return c.name === name;
    });
    if (curve) return run.data.pointTrack[curve.first + curve.points - 1];
    const link = run.links.find(function (l) {
      return l.name === name;
    });
    if (link) return link.first;
    const other = run.frames.concat(run.arrows).find(function (f) {
      return f.name === name;
    });
    return other ? other.track : -1;
  }
  addTrace(track, color, scale) {
    const n = this.run.times.length,
      object = this.lineObject(2 * Math.max(0, n - 1), false, {color: color});
    const points = this.run.times.map(function (t) {
      return Array.from(posesAt(this.run, t, scale).x.slice(3 * track, 3 * track + 3));
    }, this);
    const out = object.geometry.attributes.position.array;
    for (let k = 0; k + 1 < n; ++k) {
      out.set(points[k], 6 * k);
      out.set(points[k + 1], 6 * k + 3);
    }
    this.extras.add(object);
  }
  addGhost(color) {
    for (const source of [this.curveLines, this.spokes]) {
      const object = this.lineObject(source.geometry.attributes.position.count, false, {
        color: color,
        transparent: true,
        opacity: 0.55,
      });
      object.geometry.attributes.position.array.set(source.geometry.attributes.position.array);
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
      run = this.run;
    const see = function (name, distance) {
      if (distance < nearest) {
        nearest = distance;
        best = name;
      }
    };
    for (const b of run.bodies) {
      const p = project(x, 3 * b.track);
      see(b.name, Math.hypot(p[0] - px, p[1] - py) - 3);
    }
    for (const l of run.links) {
      const p = project(x, 3 * l.first);
      if (l.kind !== "spring") see(l.name, Math.hypot(p[0] - px, p[1] - py));
      else see(l.name, segmentDistance(px, py, p, project(x, 3 * l.second)) + 2);
    }
    for (const a of run.arrows.concat(run.frames)) {
      const p = project(x, 3 * a.track);
      see(a.name, Math.hypot(p[0] - px, p[1] - py) + 3);
    }
    const tracks = run.data.pointTrack;
    for (const c of run.curves)
      for (let k = 0; k + 1 < c.points; ++k)
        see(
          c.name,
          segmentDistance(px, py, project(x, 3 * tracks[c.first + k]), project(x, 3 * tracks[c.first + k + 1])) + 2,
        );
    return best;
  }
}
function segmentDistance(px, py, a, b) {
  const dx = b[0] - a[0],
    dy = b[1] - a[1],
    l = dx * dx + dy * dy;
  const s = l > 0 ? Math.min(1, Math.max(0, ((px - a[0]) * dx + (py - a[1]) * dy) / l)) : 0;
  return Math.hypot(a[0] + s * dx - px, a[1] + s * dy - py);
}
