// An expression that operates a view as a reader does and lists the faults, as texts: time, views, selection, colours,
// ghosts and traces must change the picture; plots must follow; names must remain plain text.
(async function () {
  "use strict";
  const faults = [],
    wait = function (ms) {
      return new Promise(function (done) {
        setTimeout(done, ms);
      });
    };
  const check = function (holds, words) {
    if (!holds) faults.push(words);
  };
  for (let k = 0; k < 100 && !(window.boughView && window.boughView.draw); ++k) await wait(50);
  const view = window.boughView;
  if (!view || !view.draw) faults.push("the view did not start");
  else {
    const [run] = view.runs,
      times = run.times,
      last = times[times.length - 1];
    const picture = function () {
      view.state.moving = -1e9;
      view.draw();
      return view.canvas.toDataURL();
    };
    const differs = function (act, words) {
      const before = picture();
      act();
      check(picture() !== before, words + " does not change the picture");
    };
    const empty = (function () {
      const c = document.createElement("canvas");
      c.width = view.canvas.width;
      c.height = view.canvas.height;
      return c.toDataURL();
    })();
    check(picture() !== empty, "the picture is empty");
    const again = picture();
    check(picture() === again, "the same instant is drawn in two ways");
    differs(function () {
      view.setTime(0.37 * last);
    }, "another time");
    for (const name of ["x", "y", "z", "iso"]) view.lookFrom(name);
    differs(function () {
      view.lookFrom("z");
    }, "another view");
    differs(function () {
      view.lookFrom("iso");
    }, "another view");
    const box = view.canvas.getBoundingClientRect(),
      middle = [box.left + box.width / 2, box.top + box.height / 2];
    const drag = function (kind, x, y) {
      const event = {bubbles: true, pointerId: 1, pointerType: "mouse", button: 0, buttons: 1, clientX: x, clientY: y};
      view.canvas.dispatchEvent(new PointerEvent(kind, event));
    };
    view.canvas.setPointerCapture = view.canvas.releasePointerCapture = function () {}; // there is no real pointer
    differs(function () {
      drag("pointerdown", middle[0], middle[1]);
      drag("pointermove", middle[0] + 60, middle[1] + 25);
      drag("pointerup", middle[0] + 60, middle[1] + 25);
    }, "dragging");
    differs(function () {
      view.canvas.dispatchEvent(new WheelEvent("wheel", {deltaY: 120, bubbles: true, cancelable: true}));
    }, "the wheel");
    const watched = view.plots.map(function (p) {
      return p.part;
    });
    // Sensors may all measure nodes, which are no parts of the picture.
    const parts = run.curves.concat(run.bodies),
      part = parts.find((p) => watched.includes(p.name)) || parts[0],
      isWatched = watched.includes(part.name);
    differs(
      function () {
        view.select(part.name);
      },
      "selecting " + part.name.slice(0, 40),
    );
    const lit = view.plots.filter(function (p) {
      return p.element.classList.contains("lit");
    });
    const asked = view.plots.filter(function (p) {
      return p.part === part.name;
    });
    check(
      asked.length > 0 === isWatched &&
        asked.every(function (p) {
          return lit.includes(p);
        }),
      "the sensors of the selected part do not light up",
    );
    view.select("");
    asked.length && asked[0].name.click();
    check(!isWatched || view.state.selected === part.name, "the name of a plot does not select its part");
    view.select("");
    for (const q of run.quantities)
      if (q.high > q.low) {
        const before = picture();
        view.setQuantity(q.name);
        if (q.name === "speed") check(picture() !== before, "colours by speed do not change the picture");
      }
    check(document.querySelector(".legend").textContent.length > 0, "there is no legend");
    if (run.quantities.some((q) => q.name === "speed")) {
      view.setQuantity("speed");
      differs(function () {
        view.setMap("cividis");
      }, "another map of colours");
      view.setMap("viridis");
    }
    if (run.quantities.some((q) => q.name === "sub-domain")) {
      view.setQuantity("");
      differs(function () {
        view.setQuantity("sub-domain");
      }, "colours by sub-domain");
      const leaves = new Set(run.curves.flatMap((c) => c.subdomains));
      check(
        document.querySelectorAll(".legend .domains span").length === (leaves.size <= 7 ? leaves.size : 0) &&
          /sub-domain/.test(document.querySelector(".legend").textContent),
        "the legend does not name the sub-domains",
      );
    }
    view.setQuantity("");
    view.setTime(0);
    view.addGhost();
    differs(function () {
      view.setTime(0.8 * last);
    }, "another time");
    view.select(part.name);
    view.state.shapes = false; // a trace may lie within its part, or be shorter than a pixel
    view.state.scale = 50;
    differs(function () {
      view.addTrace();
    }, "a trace");
    view.state.shapes = true;
    view.state.scale = 1;
    view.select("");
    document.dispatchEvent(new KeyboardEvent("keydown", {key: "Home"}));
    check(view.state.time === times[0], "Home does not go to the start");
    document.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowRight"}));
    check(view.state.time === times[1], "the right arrow does not go on by one picture");
    view.play(true);
    for (let k = 0; k < 60 && view.state.time === times[1]; ++k) await wait(50);
    check(view.state.time !== times[1], "play does not go on");
    view.play(false);
    const plot = view.plots[0];
    if (plot) {
      view.setTime(0.5 * last);
      await wait(250); // plots follow the picture ten times a second
      check(plot.cursor.getAttribute("visibility") === "visible", "the cursor of a plot does not follow");
      const before = plot.box.outerHTML;
      plot.zoom(0.2 * last, 0.6 * last);
      check(plot.box.outerHTML !== before && plot.box.outerHTML !== undefined, "zooming does not change a plot");
      const rows = plot.csv().trim().split("\n");
      check(
        rows.length > 2 &&
          rows.slice(1).every(function (r) {
            const t = Number(r.split(",")[0]);
            return t >= 0.2 * last - 1e-12 && t <= 0.6 * last + 1e-12;
          }),
        "the CSV of a plot is not what it shows",
      );
      plot.logButton.click();
      check(!/NaN/.test(plot.box.outerHTML), "a logarithmic plot holds what is no number");
      plot.logButton.click();
      plot.allButton.click();
    }
  }
  check(!window.wasCalled, "text of a name was run");
  return faults;
})()
