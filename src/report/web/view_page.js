// The page: picture, time bar, choices, keyboard; what is drawn when.
async function startView() {
  const runs = await Promise.all(JSON.parse(document.getElementById("run").textContent).map(readRun));
  const holder = document.getElementById("viewer"),
    [first] = runs;
  const state = {
    time: first.times[0],
    playing: false,
    loop: true,
    speed: 1,
    scale: 1,
    moving: 0,
    selected: "",
    follow: false,
    shapes: true,
  };
  const view = {runs: runs, state: state};
  window.boughView = view;
  startPlots(view);
  if (!first.times.length || !first.data.step || !first.data.step.length) return;
  const canvas = document.createElement("canvas"),
    context = canvas.getContext("webgl2", {antialias: true});
  if (!context) {
    document.getElementById("no-webgl").hidden = false;
    return;
  }
  startPicture(view, holder, canvas, new THREE.WebGLRenderer({canvas: canvas, context: context}));
}

function startPlots(view) {
  const place = document.getElementById("plots"),
    {runs} = view,
    [a, b] = runs;
  view.plots = [];
  if (!place || !a.plots.length) return;
  place.replaceChildren();
  const seriesOf = function (run, plot, dashed, mark) {
    const times = run.data[plot.times];
    return plot.columns.map(function (c, k) {
      return {label: c.label + mark, times: times, values: run.data[c.values], dashed: dashed, color: k % 6};
    });
  };
  const onTime = function (time, isHover) {
    if (view.setTime && !isHover) view.setTime(time);
    else for (const p of view.plots) p.show(time);
  };
  a.plots.forEach(function (plot) {
    const other =
      b &&
      b.plots.find(function (p) {
        return p.title === plot.title && p.columns.length === plot.columns.length;
      });
    const series = seriesOf(a, plot, false, b ? " A" : "").concat(other ? seriesOf(b, other, true, " B") : []);
    const own = new Plot(place, plot.title, plot.unit, a.timeLabel, series, onTime);
    own.part = plot.part;
    view.plots.push(own);
    if (!other) return;
    const times = a.data[plot.times];
    const difference = plot.columns.map(function (c, k) {
      const theirs = b.data[other.columns[k].values],
        t2 = b.data[other.times],
        mine = a.data[c.values];
      return {
        label: c.label + " A - B",
        times: times,
        color: k % 6,
        values: mine.map(function (v, r) {
          return v - valueAt(t2, theirs, times[r]);
        }),
      };
    });
    const gap = new Plot(place, plot.title + ", difference", plot.unit, a.timeLabel, difference, onTime);
    gap.part = plot.part;
    view.plots.push(gap);
  });
  for (const p of view.plots)
    p.name.addEventListener("click", function () {
      if (view.select) view.select(p.part);
    });
}

function startPicture(view, holder, canvas, renderer) {
  const {runs, state} = view,
    [first] = runs;
  document.documentElement.classList.add("has-view");
  holder.hidden = false;
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const stage = make(holder, "div", {class: "stage"});
  stage.appendChild(canvas);
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The moving structure. Space plays, arrows step, f fits, x y z i turn the view.");
  const tip = make(stage, "div", {class: "tip", hidden: ""}),
    legend = make(stage, "div", {class: "legend"});
  const axesBox = make(stage, "div", {class: "triad"});

  // ---- controls ----
  const bar = make(holder, "div", {class: "bar"});
  const button = function (parent, text, title, act) {
    const b = make(parent, "button", {type: "button", title: title}, text);
    b.addEventListener("click", act);
    return b;
  };
  const play = button(bar, "Play", "space", () => setPlaying(!state.playing));
  button(bar, "◀", "one picture back (left; shift: one row of the history)", () => stepPicture(-1)).setAttribute(
    "aria-label",
    "one picture back",
  );
  button(bar, "▶", "one picture on (right; shift: one row of the history)", () => stepPicture(1)).setAttribute(
    "aria-label",
    "one picture on",
  );
  const slider = make(bar, "input", {type: "range", min: 0, max: 1000, value: 0, step: "any", "aria-label": "time"});
  const clock = make(bar, "output");
  const more = make(holder, "div", {class: "bar choices"});
  const check = function (text, value, act) {
    const label = make(more, "label"),
      box = make(label, "input", {type: "checkbox"});
    box.checked = value;
    label.append(" " + text);
    box.addEventListener("change", function () {
      act(box.checked);
      request();
    });
    return box;
  };
  const select = function (text, options, act) {
    const label = make(more, "label", {}, text + " "),
      list = make(label, "select");
    for (const [value, name] of options) make(list, "option", {value: value}, name);
    list.addEventListener("change", function () {
      act(list.value);
      request();
    });
    return list;
  };
  const span = first.times[first.times.length - 1] - first.times[0];
  const speeds = [0.001, 0.01, 0.1, 0.25, 0.5, 1, 2, 5, 10, 100, 1000];
  // Real time where that takes 2 to 20 seconds, else so that the run takes about six.
  state.speed = span >= 2 && span <= 20 ? 1 : span / 6;
  if (!speeds.includes(state.speed)) speeds.push(state.speed);
  const speedList = select(
    first.isStatic ? "speed [1/s]" : "times real time",
    speeds
      .sort(function (a, b) {
        return a - b;
      })
      .map(function (s) {
        return [s, number(s, 2)];
      }),
    function (v) {
      state.speed = Number(v);
    },
  );
  speedList.value = String(state.speed);
  check("loop", true, function (v) {
    state.loop = v;
  });
  const quantities = [["", "none"]].concat(
    first.quantities.map(function (q) {
      return [q.name, withUnit(q.label, q.unit)];
    }),
  );
  const quantityList = select("colour", quantities, function (v) {
    setQuantity(v);
  });
  const scaleList = select(
    "displacements times",
    [1, 2, 5, 10, 20, 50, 100, 1000].map(function (s) {
      return [s, s];
    }),
    function (v) {
      state.scale = Number(v);
      redrawExtras();
    },
  );
  const names = [];
  for (const kind of ["curves", "bodies", "links", "arrows", "frames"])
    for (const part of first[kind]) if (names.length < 3000 && !names.includes(part.name)) names.push(part.name);
  const partList = select(
    "part",
    [["", "none"]].concat(
      names.map(function (n) {
        return [n, n];
      }),
    ),
    function (v) {
      view.select(v);
    },
  );
  const follow = check("follow", false, function (v) {
    state.follow = v;
    lastFollowed = null;
  });
  check("shapes", true, function (v) {
    state.shapes = v;
  });
  check("frames", false, function (v) {
    scenes.forEach(function (s) {
      s.frames.visible = v;
    });
  });
  check("joint axes", false, function (v) {
    scenes.forEach(function (s) {
      s.axes.visible = v;
    });
  });
  const looks = make(holder, "div", {class: "bar choices"});
  for (const [name, title] of [
    ["x", "from x"],
    ["y", "from y"],
    ["z", "from z"],
    ["iso", "from the side (i)"],
  ])
    button(looks, name, "view " + title, () => {
      lookFrom(name);
      fitZoom();
    });
  button(looks, "fit", "f", () => fit());
  button(looks, "ghost", "keeps the picture of this instant (g)", () => addGhost());
  button(looks, "trace", "the way of the selected part (t)", () => addTrace());
  button(looks, "clear", "removes ghosts and traces (c)", () => {
    ghosts.length = traces.length = 0;
    redrawExtras();
  });
  button(looks, "PNG", "saves the picture", () => {
    draw();
    canvas.toBlob(function (blob) {
      save(blob, fileName(document.title) + ".png");
    });
  });

  // ---- scene ----
  const size = first.size,
    scene = new THREE.Scene(),
    camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -50 * size, 50 * size);
  scene.add(new THREE.AmbientLight("#ffffff", 1.6));
  const lamp = new THREE.DirectionalLight("#ffffff", 1.9);
  camera.add(lamp);
  lamp.position.set(-0.4, 0.8, 1);
  scene.add(camera);
  const scenes = runs.map(function (run, k) {
    const s = new RunScene(run, size, k > 0 ? "#eb6834" : "");
    s.root.position.set(
      run.origin[0] - first.origin[0],
      run.origin[1] - first.origin[1],
      run.origin[2] - first.origin[2],
    );
    scene.add(s.root);
    return s;
  });
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = false;
  controls.listenToKeyEvents = function () {};
  const ghosts = [],
    traces = [];
  // What has many parts begins as lines, and its shapes follow.
  let lastFollowed = null,
    wanted = false,
    timer = 0,
    slow = first.numPoints + 200 * first.bodies.length > 20000;

  function setColors() {
    renderer.setClearColor(dark.matches ? "#1a1a19" : "#fcfcfb");
    const quantity =
      first.quantities.find(function (q) {
        return q.name === state.quantity;
      }) || null;
    scenes.forEach(function (s) {
      s.color(quantity, dark.matches ? "#6da7ec" : "#2a78d6", dark.matches ? "#f2b632" : "#b3261e");
    });
    legend.replaceChildren();
    if (!quantity) return;
    make(legend, "div", {}, withUnit(quantity.label, quantity.unit));
    if (quantity.name === "sub-domain") return;
    const ramp = make(legend, "div", {class: "ramp"}),
      ends = make(legend, "div", {class: "ends"});
    for (let k = 0; k < 24; ++k) {
      const c = viridisAt(k / 23).map(function (v) {
        return Math.round(255 * v);
      });
      make(ramp, "i").style.background = "rgb(" + c.join(",") + ")";
    }
    for (const s of [0, 0.5, 1]) make(ends, "span", {}, number(quantity.low + s * (quantity.high - quantity.low), 3));
  }
  function setQuantity(name) {
    state.quantity = name;
    quantityList.value = name;
    setColors();
    request();
  }
  view.setQuantity = setQuantity;

  function resize() {
    const width = stage.clientWidth,
      height = Math.max(240, Math.min(0.7 * window.innerHeight, 0.7 * width));
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    renderer.setSize(width, height, false);
    canvas.style.height = height + "px";
    const half = (0.62 * size) / Math.min(1, width / height);
    camera.left = (-half * width) / height;
    camera.right = (half * width) / height;
    camera.top = half;
    camera.bottom = -half;
    camera.updateProjectionMatrix();
    request();
  }
  // From the side on which axes keep their sense: x to the right and z (or y) up.
  function lookFrom(name) {
    const d = {x: [1, 0, 0], y: [0, -1, 0], z: [0, 0, 1], iso: [1, -1, 0.8]}[name];
    camera.up.set(0, name === "z" ? 1 : 0, name === "z" ? 0 : 1);
    const distance = 3 * size,
      l = Math.hypot(d[0], d[1], d[2]);
    camera.position.set(
      controls.target.x + (distance * d[0]) / l,
      controls.target.y + (distance * d[1]) / l,
      controls.target.z + (distance * d[2]) / l,
    );
    camera.lookAt(controls.target);
    controls.update();
    request();
  }
  function fit() {
    controls.target.set(first.middle[0], first.middle[1], first.middle[2]);
    camera.zoom = 1;
    camera.updateProjectionMatrix();
    lookFrom(first.look);
    fitZoom();
  }
  // The whole motion, seen from where it is looked at now: its middle into the middle of the picture, its extent to the rims.
  const radii = first.meshes.map(function (m) {
    let r = 0;
    for (let k = 0; k < m.points.length; k += 3)
      r = Math.max(r, Math.hypot(m.points[k], m.points[k + 1], m.points[k + 2]));
    return r;
  });
  function fitZoom() {
    camera.updateMatrixWorld();
    const inverse = camera.matrixWorld.clone().invert(),
      v = new THREE.Vector3(),
      low = [Infinity, Infinity],
      high = [-Infinity, -Infinity];
    const n = first.times.length,
      poses = {x: new Float32Array(scenes[0].poses.x.length), q: new Float32Array(scenes[0].poses.q.length)};
    const take = function (x, i, r) {
      v.set(x[i], x[i + 1], x[i + 2]).applyMatrix4(inverse);
      low[0] = Math.min(low[0], v.x - r);
      high[0] = Math.max(high[0], v.x + r);
      low[1] = Math.min(low[1], v.y - r);
      high[1] = Math.max(high[1], v.y + r);
    };
    for (let s = 0; s < Math.min(n, 25); ++s) {
      const {x} = posesAt(
        first,
        first.times[Math.round((s * (n - 1)) / Math.max(1, Math.min(n, 25) - 1))],
        state.scale,
        poses,
      );
      for (let i = 0; i < x.length; i += 3) take(x, i, 0);
      for (const b of first.bodies) if (b.mesh >= 0) take(x, 3 * b.track, radii[b.mesh]);
    }
    if (!(high[0] >= low[0])) return;
    const width = Math.max(high[0] - low[0], 1e-6 * size),
      height = Math.max(high[1] - low[1], 1e-6 * size);
    camera.zoom =
      0.88 *
      Math.min(
        (camera.right - camera.left) / width,
        (camera.top - camera.bottom) / height,
        (4 * (camera.top - camera.bottom)) / size,
      );
    const move = new THREE.Vector3((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0).applyQuaternion(
      camera.quaternion,
    );
    camera.position.add(move);
    controls.target.add(move);
    camera.updateProjectionMatrix();
    controls.update();
    request();
  }
  const projected = new THREE.Vector3();
  function project(x, i) {
    projected.set(x[i], x[i + 1], x[i + 2]).project(camera);
    return [((projected.x + 1) / 2) * canvas.clientWidth, ((1 - projected.y) / 2) * canvas.clientHeight];
  }

  // ---- drawing: while something moves and shapes take too long, lines; the shapes a moment after ----
  function draw() {
    const isMoving = state.playing || performance.now() - state.moving < 200;
    const solids = state.shapes && !(isMoving && slow);
    const begin = performance.now();
    scenes.forEach(function (s) {
      s.selected = state.selected;
      s.update(state.time, state.scale, solids);
      s.solids.visible = solids;
      s.lines.visible = !solids || !s.tubes || s.hasBare;
    });
    if (state.follow && state.selected) followPart();
    renderer.render(scene, camera);
    if (solids) {
      const gl = renderer.getContext();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
      const took = performance.now() - begin;
      slow = took > 30;
      view.shapesTook = took;
    }
    view.drawn = (view.drawn || 0) + 1;
    drawTriad();
    if (!solids && state.shapes && !state.playing) {
      clearTimeout(timer);
      timer = setTimeout(request, 260);
    }
  }
  function request() {
    if (wanted) return;
    wanted = true;
    requestAnimationFrame(function () {
      wanted = false;
      draw();
    });
  }
  function followPart() {
    const track = scenes[0].trackOf(state.selected),
      {x} = scenes[0].poses;
    if (track < 0) return;
    const now = new THREE.Vector3().fromArray(x, 3 * track);
    if (lastFollowed) {
      const move = now.clone().sub(lastFollowed);
      camera.position.add(move);
      controls.target.add(move);
      controls.update();
    } else {
      const move = now.clone().sub(controls.target);
      camera.position.add(move);
      controls.target.add(move);
      controls.update();
    }
    lastFollowed = now;
  }
  const triadNames = ["x", "y", "z"];
  const triadBox = svg(axesBox, "svg", {viewBox: "-30 -30 60 60", width: 60, height: 60, "aria-hidden": "true"});
  const triadParts = triadNames.map(function (n, k) {
    return [
      svg(triadBox, "line", {x1: 0, y1: 0, stroke: ["#cc3333", "#1a9933", "#3a66e6"][k], "stroke-width": 2}),
      svg(triadBox, "text", {class: "tiny soft", "text-anchor": "middle"}, n),
    ];
  });
  function drawTriad() {
    const inverse = camera.quaternion.clone().invert();
    triadParts.forEach(function (part, k) {
      const v = new THREE.Vector3(k === 0 ? 1 : 0, k === 1 ? 1 : 0, k === 2 ? 1 : 0).applyQuaternion(inverse);
      part[0].setAttribute("x2", 18 * v.x);
      part[0].setAttribute("y2", -18 * v.y);
      part[1].setAttribute("x", 25 * v.x);
      part[1].setAttribute("y", -25 * v.y + 4);
      part[1].setAttribute("visibility", Math.hypot(v.x, v.y) < 0.15 ? "hidden" : "visible");
    });
    const scale = (camera.right - camera.left) / camera.zoom / canvas.clientWidth,
      raw = 120 * scale;
    const power = Math.pow(10, Math.floor(Math.log10(raw))),
      length = [5, 2, 1]
        .map(function (f) {
          return f * power;
        })
        .find(function (l) {
          return l <= raw;
        });
    rule.style.width = length / scale + "px";
    ruleText.textContent = number(length, 3) + " m";
  }
  const ruleBox = make(stage, "div", {class: "rule"}),
    rule = make(ruleBox, "i"),
    ruleText = make(ruleBox, "span");

  // ---- time ----
  view.setTime = function (time) {
    const t = first.times;
    state.time = Math.min(t[t.length - 1], Math.max(t[0], time));
    slider.value = span > 0 ? (1000 * (state.time - t[0])) / span : 0;
    clock.textContent =
      (first.isStatic ? "load factor " : "t = ") + number(state.time, 5) + (first.isStatic ? "" : " s");
    for (const p of view.plots) p.show(state.time);
    state.moving = performance.now();
    request();
  };
  function stepPicture(n) {
    setPlaying(false);
    const t = first.times,
      k = rowAt(t, state.time);
    view.setTime(t[Math.min(t.length - 1, Math.max(0, k + n))]);
  }
  function stepRow(n) {
    setPlaying(false);
    const t = first.plots.length ? first.data[first.plots[0].times] : first.times;
    view.setTime(t[Math.min(t.length - 1, Math.max(0, rowAt(t, state.time) + n))]);
  }
  let lastStamp = 0;
  function tick(stamp) {
    if (!state.playing) return;
    const t = first.times,
      end = t[t.length - 1];
    let time = state.time + (lastStamp ? Math.min(0.25, (stamp - lastStamp) / 1000) * state.speed : 0);
    lastStamp = stamp;
    if (time >= end) {
      if (!state.loop) {
        view.setTime(end);
        setPlaying(false);
        return;
      }
      time = state.time >= end ? t[0] : end; // the last picture is seen before the first follows
    }
    view.setTime(time);
    requestAnimationFrame(tick);
  }
  function setPlaying(on) {
    if (on === state.playing) return;
    state.playing = on;
    play.textContent = on ? "Pause" : "Play";
    lastStamp = 0;
    if (on) {
      if (!state.loop && state.time >= first.times[first.times.length - 1]) view.setTime(first.times[0]);
      requestAnimationFrame(tick);
    } else request();
  }
  view.play = setPlaying;
  slider.addEventListener("input", function () {
    setPlaying(false);
    view.setTime(first.times[0] + (span * slider.value) / 1000);
  });

  // ---- parts ----
  view.select = function (name) {
    state.selected = name;
    partList.value = names.includes(name) ? name : "";
    lastFollowed = null;
    let near = null;
    for (const p of view.plots) {
      const isOf = name !== "" && (p.part === name || p.part.startsWith(name + "."));
      p.element.classList.toggle("lit", isOf);
      if (isOf && !near) near = p;
    }
    request();
    return near;
  };
  function addGhost() {
    ghosts.push(state.time);
    redrawExtras();
  }
  function addTrace() {
    if (state.selected) {
      traces.push(state.selected);
      redrawExtras();
    }
  }
  view.addGhost = addGhost;
  view.addTrace = addTrace;
  function redrawExtras() {
    scenes.forEach(function (s) {
      s.clearExtras();
      for (const t of ghosts) {
        s.update(t, state.scale, false);
        s.addGhost(dark.matches ? "#c3c2b7" : "#6f6e68");
      }
      traces.forEach(function (name, k) {
        const track = s.trackOf(name);
        if (track >= 0) s.addTrace(track, palette[(k + 1) % 8], state.scale);
      });
    });
    request();
  }
  let hovering = false;
  canvas.addEventListener("pointermove", function (event) {
    if (event.buttons || hovering) return;
    hovering = true;
    requestAnimationFrame(function () {
      hovering = false;
      const box = canvas.getBoundingClientRect(),
        px = event.clientX - box.left,
        py = event.clientY - box.top;
      const name = scenes[0].partAt(px, py, project);
      tip.hidden = !name;
      tip.textContent = name;
      tip.style.left = Math.min(px + 12, Math.max(0, box.width - 180)) + "px";
      tip.style.top = py + 14 + "px";
    });
  });
  canvas.addEventListener("pointerleave", function () {
    tip.hidden = true;
  });
  let down = null;
  canvas.addEventListener("pointerdown", function (event) {
    down = [event.clientX, event.clientY];
    canvas.focus({preventScroll: true});
  });
  canvas.addEventListener("pointerup", function (event) {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    const box = canvas.getBoundingClientRect();
    view.select(scenes[0].partAt(event.clientX - box.left, event.clientY - box.top, project));
  });
  controls.addEventListener("change", function () {
    state.moving = performance.now();
    request();
  });
  document.addEventListener("keydown", function (event) {
    if (
      event.ctrlKey ||
      event.metaKey ||
      event.altKey ||
      /^(SELECT|TEXTAREA)$/.test(event.target.tagName) ||
      (event.target.tagName === "INPUT" && event.target.type !== "checkbox")
    )
      return;
    const t = first.times,
      act = {
        " ": () => setPlaying(!state.playing),
        ArrowLeft: () => (event.shiftKey ? stepRow(-1) : stepPicture(-1)),
        ArrowRight: () => (event.shiftKey ? stepRow(1) : stepPicture(1)),
        Home: () => view.setTime(t[0]),
        End: () => view.setTime(t[t.length - 1]),
        f: fit,
        x: () => {
          lookFrom("x");
          fitZoom();
        },
        y: () => {
          lookFrom("y");
          fitZoom();
        },
        z: () => {
          lookFrom("z");
          fitZoom();
        },
        i: () => {
          lookFrom("iso");
          fitZoom();
        },
        g: addGhost,
        t: addTrace,
        c: () => {
          ghosts.length = traces.length = 0;
          redrawExtras();
        },
        "+": () => zoomBy(1.25),
        "-": () => zoomBy(0.8),
        Escape: () => view.select(""),
      }[event.key];
    if (!act || (event.target.tagName === "BUTTON" && event.key === " ")) return;
    event.preventDefault();
    act();
  });
  function zoomBy(f) {
    camera.zoom *= f;
    camera.updateProjectionMatrix();
    request();
  }
  view.lookFrom = lookFrom;
  view.draw = draw;
  view.camera = camera;
  view.canvas = canvas;
  dark.addEventListener("change", function () {
    setColors();
    request();
  });
  new ResizeObserver(resize).observe(stage);
  setColors();
  resize();
  fit();
  view.setTime(first.times[0]);
}

startView().catch(function (error) {
  const told = document.getElementById("no-webgl");
  if (told) {
    told.hidden = false;
    told.textContent = "The moving picture cannot be shown: " + error.message;
  }
  throw error;
});
