// From where the structure is seen: views along axes, fitting, following a part, and the triad and the rule on the picture.
class ViewCamera {
  // stage: holds the canvas; run: the one that is fitted; request(): asks for a picture
  constructor(stage, canvas, run, request) {
    const {size} = run;
    Object.assign(this, {stage, canvas, run, request, size, followed: null, shown: ""});
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -50 * size, 50 * size);
    this.camera.up.set(0, 0, 1);
    const lamp = new THREE.DirectionalLight("#ffffff", 1.9);
    this.camera.add(lamp);
    lamp.position.set(-0.4, 0.8, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.radii = run.meshes.map(function (m) {
      let r = 0;
      for (let k = 0; k < m.points.length; k += 3)
        r = Math.max(r, Math.hypot(m.points[k], m.points[k + 1], m.points[k + 2]));
      return r;
    });
    this.projected = new THREE.Vector3();
    // Where parts are in the places of all tracks. Frames are fitted only while they are shown: they may travel far away.
    const tracks = new Set(run.data.pointTrack);
    for (const b of run.bodies) tracks.add(b.track);
    for (const l of run.links) tracks.add(l.first).add(l.second);
    for (const a of run.arrows) tracks.add(a.track);
    this.seesFrames = !tracks.size;
    this.partPlaces = Uint32Array.from(tracks, (t) => 3 * t);
    this.buildTriad();
    // Where an instant is so small beside the motion that nothing would be seen of it, the structure is followed.
    const {elements} = new THREE.Matrix4(),
      extentOf = (times) => {
        const [low, high] = this.extent(elements, 1, times);
        return Math.max(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
      },
      atStart = extentOf(run.times.slice(0, 1));
    this.isWide = atStart > 0 && atStart < 0.02 * extentOf(this.instants());
    if (this.isWide) Object.assign(this.camera, {near: -3 * size, far: 9 * size}); // depths of small parts stay apart
  }
  // At most 25 instants of the run.
  instants() {
    const {times} = this.run,
      count = Math.min(times.length, 25);
    return Array.from({length: count}, (_, k) => times[Math.round((k * (times.length - 1)) / Math.max(1, count - 1))]);
  }

  resize(renderer) {
    const width = this.stage.clientWidth,
      height = Math.max(240, Math.min(0.7 * window.innerHeight, 0.7 * width));
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    renderer.setSize(width, height, false);
    this.canvas.style.height = height + "px";
    const half = (0.62 * this.size) / Math.min(1, width / height);
    this.camera.left = (-half * width) / height;
    this.camera.right = (half * width) / height;
    this.camera.top = half;
    this.camera.bottom = -half;
    this.changed();
  }
  changed() {
    this.camera.updateProjectionMatrix();
    this.request();
  }
  // From the side on which axes keep their sense: x to the right and z (or y) up.
  lookFrom(name) {
    const {camera, controls} = this,
      d = new THREE.Vector3(...{x: [1, 0, 0], y: [0, -1, 0], z: [0, 0, 1], iso: [1, -1, 0.8]}[name]);
    camera.up.set(0, name === "z" ? 1 : 0, name === "z" ? 0 : 1);
    camera.position.copy(controls.target).addScaledVector(d.normalize(), 3 * this.size);
    camera.lookAt(controls.target);
    controls.update();
    this.request();
  }
  // times: those that are to be seen
  fit(scale, times) {
    this.controls.target.fromArray(this.run.middle);
    this.camera.zoom = 1;
    this.camera.updateProjectionMatrix();
    this.lookFrom(this.run.look);
    this.fitZoom(scale, times);
  }
  // What is to be seen at these times, displacements times scale, from where it is looked at now: its middle into the
  // middle of the picture, its extent to the rims.
  fitZoom(scale, times) {
    const {camera, run} = this;
    camera.updateMatrixWorld();
    const [low, high] = this.extent(camera.matrixWorld.clone().invert().elements, scale, times);
    if (!(high[0] >= low[0])) return;
    const least = 1e-6 * run.size,
      width = camera.right - camera.left,
      height = camera.top - camera.bottom;
    camera.zoom =
      0.88 *
      Math.min(
        width / Math.max(high[0] - low[0], least),
        height / Math.max(high[1] - low[1], least),
        times.length > 1 ? (4 * height) / run.size : Infinity,
      );
    this.move(
      new THREE.Vector3((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0).applyQuaternion(camera.quaternion),
    );
    this.changed();
  }
  // Smallest and largest coordinates (across, up, toward) in the axes of a view at times.
  extent(m, scale, times) {
    const {run} = this;
    let poses = null;
    const bounds = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (const time of times) {
      poses = posesAt(run, time, scale, poses);
      this.take(bounds, m, poses.x);
    }
    return bounds;
  }
  take([low, high], m, x) {
    const {run} = this;
    const see = function (i, r) {
      for (let c = 0; c < 3; ++c) {
        const u = m[c] * x[i] + m[4 + c] * x[i + 1] + m[8 + c] * x[i + 2] + m[12 + c];
        if (u - r < low[c]) low[c] = u - r;
        if (u + r > high[c]) high[c] = u + r;
      }
    };
    if (this.seesFrames) for (let i = 0; i < x.length; i += 3) see(i, 0);
    else for (const i of this.partPlaces) see(i, 0);
    for (const b of run.bodies) if (b.mesh >= 0) see(3 * b.track, this.radii[b.mesh]);
  }
  zoomBy(f) {
    this.camera.zoom *= f;
    this.changed();
  }
  move(by) {
    this.camera.position.add(by);
    this.controls.target.add(by);
    this.controls.update();
  }
  // Keeps a track where it is on the screen, or without one the middle of the structure; begins with it in the middle.
  follow(x, track) {
    const now = new THREE.Vector3();
    if (track >= 0) now.fromArray(x, 3 * track);
    else {
      const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
      this.take([low, high], new THREE.Matrix4().elements, x);
      now.set(...low.map((l, c) => (l + high[c]) / 2));
    }
    this.move(now.clone().sub(this.followed || this.controls.target));
    this.followed = now;
  }
  // Pixels of a place.
  project(x, i) {
    const p = this.projected.set(x[i], x[i + 1], x[i + 2]).project(this.camera);
    return [((p.x + 1) / 2) * this.canvas.clientWidth, ((1 - p.y) / 2) * this.canvas.clientHeight];
  }

  buildTriad() {
    const box = svg(make(this.stage, "div", {class: "triad"}), "svg", {
      viewBox: "-30 -30 60 60",
      width: 60,
      height: 60,
      "aria-hidden": "true",
    });
    this.triad = ["x", "y", "z"].map(function (n, k) {
      return [
        svg(box, "line", {x1: 0, y1: 0, stroke: ["#cc3333", "#1a9933", "#3a66e6"][k], "stroke-width": 2}),
        svg(box, "text", {class: "tiny soft", "text-anchor": "middle"}, n),
      ];
    });
    const rule = make(this.stage, "div", {class: "rule"});
    this.rule = make(rule, "i");
    this.ruleText = make(rule, "span");
  }
  // Written anew where the view has changed: what lies over the picture costs more than its lines.
  drawTriad() {
    const {camera, canvas} = this,
      key = camera.quaternion.toArray().concat(camera.zoom, camera.right, canvas.clientWidth).join();
    if (key === this.shown) return;
    this.shown = key;
    const inverse = camera.quaternion.clone().invert();
    this.triad.forEach(function ([line, text], k) {
      const v = new THREE.Vector3(k === 0 ? 1 : 0, k === 1 ? 1 : 0, k === 2 ? 1 : 0).applyQuaternion(inverse);
      line.setAttribute("x2", 18 * v.x);
      line.setAttribute("y2", -18 * v.y);
      text.setAttribute("x", 25 * v.x);
      text.setAttribute("y", -25 * v.y + 4);
      text.setAttribute("visibility", Math.hypot(v.x, v.y) < 0.15 ? "hidden" : "visible");
    });
    const scale = (camera.right - camera.left) / camera.zoom / canvas.clientWidth,
      raw = 120 * scale,
      power = Math.pow(10, Math.floor(Math.log10(raw))),
      length = [5, 2, 1].find((f) => f * power <= raw) * power;
    this.rule.style.width = length / scale + "px";
    this.ruleText.textContent = number(length, 3) + " m";
  }
}
