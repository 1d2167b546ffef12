// What the reader handles: buttons, choices, keys. They call `view`, which knows nothing of them but the few that show its state.
function makeBar(view, holder) {
  const bar = make(holder, "div", {class: "bar"});
  const button = function (text, title, act, label) {
    const b = make(bar, "button", {type: "button", title: title}, text);
    if (label) b.setAttribute("aria-label", label);
    b.addEventListener("click", act);
    return b;
  };
  const play = button("Play", "space", () => view.play(!view.state.playing));
  button("◀", "one picture back (left; shift: one row of the history)", () => view.stepPicture(-1), "one picture back");
  button("▶", "one picture on (right; shift: one row of the history)", () => view.stepPicture(1), "one picture on");
  const slider = make(bar, "input", {type: "range", min: 0, max: 1000, value: 0, step: "any", "aria-label": "time"}),
    clock = make(bar, "output"),
    [run] = view.runs,
    begin = run.times[0],
    span = run.times[run.times.length - 1] - begin;
  slider.addEventListener("input", function () {
    view.play(false);
    view.setTime(begin + (span * slider.value) / 1000);
  });
  return {
    showPlaying: function (on) {
      play.textContent = on ? "Pause" : "Play";
    },
    showTime: function (time) {
      slider.value = span > 0 ? (1000 * (time - begin)) / span : 0;
      clock.textContent = (run.isStatic ? run.timeLabel + " " : "t = ") + number(time, 5) + (run.isStatic ? "" : " s");
    },
  };
}

// Names of parts, each once and not more than a list can show.
function namesOf(run) {
  const names = new Set();
  for (const kind of ["curves", "bodies", "links", "arrows", "frames"])
    for (const part of run[kind]) if (names.size < 3000) names.add(part.name);
  return Array.from(names);
}

function makeChoices(view, holder) {
  const more = make(holder, "div", {class: "bar choices"}),
    {state} = view,
    [run] = view.runs;
  const check = function (text, value, act) {
    const label = make(more, "label"),
      box = make(label, "input", {type: "checkbox"});
    box.checked = value;
    label.append(" " + text);
    box.addEventListener("change", function () {
      act(box.checked);
      view.request();
    });
    return box;
  };
  const select = function (text, options, act) {
    const label = make(more, "label", {}, text + " "),
      list = make(label, "select"),
      items = document.createDocumentFragment();
    for (const [value, name] of options) make(items, "option", {value: value}, name);
    list.appendChild(items);
    list.addEventListener("change", function () {
      act(list.value);
      view.request();
    });
    return list;
  };
  if (run.modes.length)
    select("mode", [[0, "all in turn"]].concat(run.modes.map((text, k) => [k + 1, text])), (v) => view.setMode(Number(v)));
  // Real time where that takes 2 to 20 seconds, else so that the run takes about six.
  const span = run.times[run.times.length - 1] - run.times[0],
    speeds = [0.001, 0.01, 0.1, 0.25, 0.5, 1, 2, 5, 10, 100, 1000];
  state.speed = run.modes.length ? 0.5 : span >= 2 && span <= 20 ? 1 : span / 6;
  if (!speeds.includes(state.speed)) speeds.push(state.speed);
  speeds.sort((a, b) => a - b);
  const speedList = select(
    run.modes.length ? "periods a second" : run.isStatic ? "speed [1/s]" : "times real time",
    speeds.map((s) => [s, number(s, 2)]),
    (v) => (state.speed = Number(v)),
  );
  speedList.value = String(state.speed);
  const looped = check("loop", state.loop, (v) => (state.loop = v));
  view.calm.addEventListener("change", function () {
    looped.checked = state.loop = !view.calm.matches;
  });
  const quantities = run.quantities.map((q) => [q.name, withUnit(q.label, q.unit)]),
    quantityList = select("colour", [["", "none"]].concat(quantities), (v) => view.setQuantity(v));
  const mapList = select("map", Object.keys(colorMaps).map((n) => [n, n]), (v) => view.setMap(v));
  mapList.parentElement.hidden = true; // until a quantity is shown
  select(
    "displacements times",
    [1, 2, 5, 10, 20, 50, 100, 1000].map((s) => [s, s]),
    function (v) {
      state.scale = Number(v);
      view.redrawExtras();
    },
  );
  const names = namesOf(run),
    partList = select("part", [["", "none"]].concat(names.map((n) => [n, n])), (v) => view.select(v));
  const followed = check("follow", false, (v) => view.follow(v));
  check("shapes", true, (v) => (state.shapes = v));
  check("frames", false, (v) => view.showFrames(v));
  check("joint axes", false, (v) => view.scenes.forEach((s) => (s.axes.visible = v)));
  const listed = new Set(names);
  return {
    follow: function (on) {
      followed.checked = on;
      view.follow(on);
    },
    showQuantity: function (name) {
      quantityList.value = name;
      mapList.parentElement.hidden = name === "" || name === "sub-domain";
    },
    showMap: (name) => (mapList.value = name),
    showSelected: (name) => (partList.value = listed.has(name) ? name : ""),
  };
}

function makeLooks(view, holder) {
  const looks = make(holder, "div", {class: "bar choices"});
  const button = function (text, title, act) {
    make(looks, "button", {type: "button", title: title}, text).addEventListener("click", act);
  };
  for (const [name, title] of [
    ["x", "from x"],
    ["y", "from y"],
    ["z", "from z"],
    ["iso", "from the side (i)"],
  ])
    button(name, "view " + title, () => view.look(name));
  button("fit", "f", view.fit);
  button("ghost", "keeps the picture of this instant (g)", view.addGhost);
  button("trace", "the way of the selected part (t)", view.addTrace);
  button("clear", "removes ghosts and traces (c)", view.clearExtras);
  button("PNG", "saves the picture", () => view.savePicture());
}

function listenToKeys(view) {
  const {times} = view.runs[0],
    acts = {
      " ": () => view.play(!view.state.playing),
      ArrowLeft: (event) => (event.shiftKey ? view.stepRow(-1) : view.stepPicture(-1)),
      ArrowRight: (event) => (event.shiftKey ? view.stepRow(1) : view.stepPicture(1)),
      Home: () => view.setTime(times[0]),
      End: () => view.setTime(times[times.length - 1]),
      f: view.fit,
      x: () => view.look("x"),
      y: () => view.look("y"),
      z: () => view.look("z"),
      i: () => view.look("iso"),
      g: view.addGhost,
      t: view.addTrace,
      c: view.clearExtras,
      "+": () => view.zoomBy(1.25),
      "-": () => view.zoomBy(0.8),
      Escape: () => view.select(""),
    };
  document.addEventListener("keydown", function (event) {
    const {tagName, type} = event.target,
      isText = /^(SELECT|TEXTAREA)$/.test(tagName) || (tagName === "INPUT" && type !== "checkbox");
    if (event.ctrlKey || event.metaKey || event.altKey || isText || !Object.hasOwn(acts, event.key)) return;
    if (tagName === "BUTTON" && event.key === " ") return;
    event.preventDefault();
    acts[event.key](event);
  });
}

// Names under the pointer, and what a click selects.
function listenToPointer(view, stage, canvas) {
  const tip = make(stage, "div", {class: "tip", hidden: ""});
  const placeOf = function (event) {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  let hovering = false,
    down = null;
  canvas.addEventListener("pointermove", function (event) {
    if (event.buttons || hovering) return;
    hovering = true;
    requestAnimationFrame(function () {
      hovering = false;
      const [px, py] = placeOf(event),
        name = view.partAt(px, py);
      tip.hidden = !name;
      tip.textContent = name;
      tip.style.left = Math.min(px + 12, Math.max(0, canvas.clientWidth - 180)) + "px";
      tip.style.top = py + 14 + "px";
    });
  });
  canvas.addEventListener("pointerleave", function () {
    tip.hidden = true;
  });
  canvas.addEventListener("pointerdown", function (event) {
    down = [event.clientX, event.clientY];
    canvas.focus({preventScroll: true});
  });
  canvas.addEventListener("pointerup", function (event) {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    const [px, py] = placeOf(event);
    view.select(view.partAt(px, py));
  });
}
