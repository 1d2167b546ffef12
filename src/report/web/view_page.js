// The page: puts picture and plots together, and decides what is drawn when.
async function startView() {
  const runs = await Promise.all(JSON.parse(document.getElementById("run").textContent).map(readRun)),
    [first] = runs;
  const state = {
    time: first.times[0],
    playing: false,
    loop: true,
    mode: 0, // whose shape is played; 0: all of the run
    speed: 1,
    scale: 1,
    moving: 0,
    selected: "",
    follow: false,
    shapes: true,
    quantity: "",
    map: "viridis",
  };
  // A reader who asks for less motion gets it in steps, twice a second, and once.
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
  state.loop = !calm.matches;
  const view = {runs: runs, state: state, calm: calm};
  window.boughView = view;
  startPlots(view);
  startSignals(view);
  if (!hasMotion(first)) return showDrawing("");
  // Edges of many thin parts are not smoothed: in software that takes as long as the lines themselves.
  const canvas = document.createElement("canvas"),
    context = canvas.getContext("webgl2", {antialias: first.numPoints < 8000, alpha: false});
  if (!context) return showDrawing("This browser shows no WebGL: the drawing stands for the moving picture.");
  startPicture(view, canvas, new THREE.WebGLRenderer({canvas: canvas, context: context}));
}

// A run that stored no motion has histories alone.
function hasMotion(run) {
  return run.times.length > 0 && run.data.step !== undefined && run.data.step.length > 0;
}

function startPicture(view, canvas, renderer) {
  const {runs, state} = view,
    [first] = runs,
    holder = document.getElementById("viewer"),
    dark = window.matchMedia("(prefers-color-scheme: dark)");
  document.documentElement.classList.add("has-view");
  holder.hidden = false;
  const stage = make(holder, "div", {class: "stage"});
  stage.appendChild(canvas);
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "The moving structure. Space plays, arrows step, f fits, x y z i turn the view.");

  let wanted = false;
  view.request = function () {
    if (wanted) return;
    wanted = true;
    requestAnimationFrame(function () {
      wanted = false;
      view.draw();
    });
  };
  const seen = new ViewCamera(stage, canvas, first, view.request),
    scene = new THREE.Scene();
  scene.add(new THREE.AmbientLight("#ffffff", 1.6), seen.camera);
  view.scenes = runs.filter(hasMotion).map(function (run) {
    const s = new RunScene(run, first.size, run === first ? "" : "#eb6834");
    s.root.position.set(...run.origin.map((o, c) => o - first.origin[c]));
    scene.add(s.root);
    return s;
  });
  view.camera = seen.camera;
  view.canvas = canvas;
  startViews(view, seen);
  startExtras(view, dark);
  startTime(view, makeBar(view, holder));
  const choices = makeChoices(view, holder);
  makeLooks(view, holder);
  startColors(view, renderer, make(stage, "div", {class: "legend"}), choices, dark);
  startSelection(view, seen, choices);
  startDrawing(view, renderer, scene, seen);
  listenToKeys(view);
  listenToPointer(view, stage, canvas);
  seen.controls.addEventListener("change", function () {
    state.moving = performance.now();
    view.request();
  });
  new ResizeObserver(() => seen.resize(renderer)).observe(stage);
  seen.resize(renderer);
  if (seen.isWide) choices.follow(true);
  view.fit();
  view.setTime(first.times[0]);
}

function startViews(view, seen) {
  const {state} = view;
  // Of a structure that is followed the present alone is fitted.
  const timesSeen = () => (state.follow && !state.selected ? [state.time] : seen.instants());
  view.lookFrom = (name) => seen.lookFrom(name);
  view.look = function (name) {
    seen.lookFrom(name);
    seen.fitZoom(state.scale, timesSeen());
    seen.followed = null;
  };
  view.fit = function () {
    seen.fit(state.scale, timesSeen());
    seen.followed = null;
  };
  view.showFrames = function (on) {
    seen.seesFrames = on;
    for (const s of view.scenes) s.frames.visible = on;
  };
  view.zoomBy = (f) => seen.zoomBy(f);
  view.partAt = (px, py) => view.scenes[0].partAt(px, py, (x, i) => seen.project(x, i));
  view.follow = function (on) {
    state.follow = on;
    seen.followed = null;
  };
}

function startSelection(view, seen, choices) {
  // Returns the first plot of the part.
  view.select = function (name) {
    view.state.selected = name;
    choices.showSelected(name);
    seen.followed = null;
    let near = null;
    for (const p of view.plots) {
      const isOf = name !== "" && (p.part === name || p.part.startsWith(name + "."));
      p.element.classList.toggle("lit", isOf);
      if (isOf && !near) near = p;
    }
    view.request();
    return near;
  };
}

// Ghosts of instants and ways of parts.
function startExtras(view, dark) {
  const ghosts = [],
    traces = [],
    {state} = view;
  view.redrawExtras = function () {
    view.scenes.forEach(function (s) {
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
    view.request();
  };
  view.addGhost = function () {
    ghosts.push(state.time);
    view.redrawExtras();
  };
  view.addTrace = function () {
    if (!state.selected) return;
    traces.push(state.selected);
    view.redrawExtras();
  };
  view.clearExtras = function () {
    ghosts.length = traces.length = 0;
    view.redrawExtras();
  };
}

function startColors(view, renderer, legend, choices, dark) {
  const [first] = view.runs;
  const use = function () {
    renderer.setClearColor(dark.matches ? "#1a1a19" : "#fcfcfb");
    const {state} = view,
      quantity = first.quantities.find((q) => q.name === state.quantity) || null;
    for (const s of view.scenes)
      s.paint.use(quantity, state.map, dark.matches ? "#6da7ec" : "#2a78d6", dark.matches ? "#f2b632" : "#b3261e");
    legend.replaceChildren();
    view.request();
    if (!quantity) return;
    make(legend, "div", {}, withUnit(quantity.label, quantity.unit));
    if (quantity.name === "sub-domain") return showDomains(legend, first);
    const ramp = make(legend, "div", {class: "ramp"}),
      ends = make(legend, "div", {class: "ends"});
    for (let k = 0; k < 24; ++k) {
      const c = mapAt(state.map, k / 23).map((v) => Math.round(255 * v));
      make(ramp, "i").style.background = "rgb(" + c.join(",") + ")";
    }
    for (const s of [0, 0.5, 1]) make(ends, "span", {}, number(quantity.low + s * (quantity.high - quantity.low), 3));
  };
  view.setQuantity = function (name) {
    view.state.quantity = name;
    choices.showQuantity(name);
    use();
  };
  view.setMap = function (name) {
    view.state.map = name;
    choices.showMap(name);
    use();
  };
  dark.addEventListener("change", use);
  use();
}

// Which sub-domain has which colour, or where there are more than colours, how many there are.
function showDomains(legend, run) {
  const leaves = Array.from(new Set(run.curves.flatMap((c) => c.subdomains))).sort((a, b) => a - b);
  if (leaves.length > domainPalette.length) {
    make(legend, "div", {}, leaves.length + " of them, " + domainPalette.length + " colours in turn");
    return;
  }
  const row = make(legend, "div", {class: "domains"});
  for (const leaf of leaves) {
    make(row, "i").style.background = domainColor(leaf);
    make(row, "span", {}, String(leaf));
  }
}

// Pictures: while something moves and shapes take too long, lines; the shapes a moment after.
function startDrawing(view, renderer, scene, seen) {
  const {state, runs} = view;
  // What has many parts begins as lines, and its shapes follow.
  let slow = runs[0].numPoints + 200 * runs[0].bodies.length > 20000,
    timer = 0;
  view.draw = function () {
    const isMoving = state.playing || performance.now() - state.moving < 200,
      solids = state.shapes && !(isMoving && slow),
      begin = performance.now();
    for (const s of view.scenes) {
      s.paint.selected = state.selected;
      s.update(state.time, state.scale, solids);
    }
    if (state.follow)
      seen.follow(view.scenes[0].poses.x, state.selected ? view.scenes[0].trackOf(state.selected) : -1);
    renderer.render(scene, seen.camera);
    if (solids) {
      const gl = renderer.getContext();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
      view.shapesTook = performance.now() - begin;
      slow = view.shapesTook > 30;
    }
    view.drawn = (view.drawn || 0) + 1;
    seen.drawTriad();
    if (!solids && state.shapes && !state.playing) {
      clearTimeout(timer);
      timer = setTimeout(view.request, 260);
    }
  };
  view.savePicture = function () {
    view.draw();
    view.canvas.toBlob((blob) => save(blob, fileName(document.title) + ".png"));
  };
}

// The drawing of three instants instead of the picture; until now it is hidden, for painting it may take seconds.
function showDrawing(words) {
  document.documentElement.classList.add("no-view");
  const told = document.getElementById("no-webgl");
  if (!told || !words) return;
  told.hidden = false;
  told.textContent = words;
}

startView().catch(function (error) {
  showDrawing("The moving picture cannot be shown: " + error.message);
  throw error;
});
