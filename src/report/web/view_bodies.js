// Bodies: their surfaces, many alike as instances of one; spokes from the centre of mass to what holds them.
class Bodies {
  constructor(run, paint) {
    Object.assign(this, {run, paint});
    const {bodies} = run;
    this.instances = [];
    run.meshes.forEach(function (m, k) {
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
    }, this);
    const spokes = bodies.reduce(function (n, b) {
      return n + b.arms.length / 3;
    }, 0);
    this.spokes = lineObject(2 * spokes, true, {});
    const points = new THREE.BufferGeometry();
    points.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * bodies.length), 3));
    points.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * bodies.length), 3));
    this.centers = new THREE.Points(
      points,
      new THREE.PointsMaterial({size: 7, sizeAttenuation: false, vertexColors: true}),
    );
    this.centers.frustumCulled = false;
  }

  update({x, q}, k, withSolids) {
    if (withSolids) this.updateSurfaces(x, q, k);
    const spoke = this.spokes.geometry.attributes,
      center = this.centers.geometry.attributes;
    let at = 0;
    this.run.bodies.forEach(function (b, i) {
      const t = b.track,
        R = axesOf([q[4 * t], q[4 * t + 1], q[4 * t + 2], q[4 * t + 3]]),
        color = this.paint.body(i, k);
      for (let r = 0; r < 3; ++r) center.position.array[3 * i + r] = x[3 * t + r];
      this.paint.put(color, center.color.array, 3 * i);
      for (let a = 0; a < b.arms.length; a += 3)
        for (let e = 0; e < 2; ++e, at += 3) {
          for (let r = 0; r < 3; ++r)
            spoke.position.array[at + r] =
              x[3 * t + r] + (e ? R[r] * b.arms[a] + R[3 + r] * b.arms[a + 1] + R[6 + r] * b.arms[a + 2] : 0);
          this.paint.put(color, spoke.color.array, at);
        }
    }, this);
    for (const a of [spoke.position, spoke.color, center.position, center.color]) a.needsUpdate = true;
  }
  updateSurfaces(x, q, k) {
    const matrix = new THREE.Matrix4(),
      turn = new THREE.Quaternion(),
      move = new THREE.Vector3(),
      one = new THREE.Vector3(1, 1, 1),
      t4 = [0, 0, 0, 0];
    for (const mesh of this.instances) {
      mesh.members.forEach(function (i, place) {
        const b = this.run.bodies[i];
        quaternionTimes(q, 4 * b.track, b.axes, 0, t4);
        matrix.compose(move.fromArray(x, 3 * b.track), turn.fromArray(t4), one);
        mesh.setMatrixAt(place, matrix);
        mesh.setColorAt(place, this.paint.body(i, k));
      }, this);
      mesh.instanceMatrix.needsUpdate = true;
      mesh.instanceColor.needsUpdate = true;
    }
  }
}
