#pragma once
/// The page's script: a player for the motion and a reading of the histories. `run` is a JSON value in the page:
///   {"frames":[[t,"beams","bodies","springs","joints"],...], "plots":[{"l":px,"r":px,"a":t0,"b":t1,"n":[names],"t":[...],"v":[[...],...]},...]}
#include <string_view>

namespace bough::report {

inline constexpr std::string_view page_script = R"js(
(function () {
  "use strict";
  var run = JSON.parse(document.getElementById("run").textContent), svgNs = "http://www.w3.org/2000/svg";
  function add(parent, name, attributes) {
    var element = document.createElementNS(svgNs, name);
    for (var key in attributes) element.setAttribute(key, attributes[key]);
    parent.appendChild(element);
    return element;
  }
  function number(v) { return typeof v === "number" ? String(Number(v.toPrecision(5))) : String(v); }

  var plots = run.plots.map(function (plot, k) {
    var figure = document.getElementById("plot" + k), svg = figure.querySelector("svg");
    var line = add(svg, "line", {"class": "cursor", y1: 40, y2: 180, visibility: "hidden"});
    var reading = figure.querySelector(".reading");
    function show(time) {
      if (!plot.t.length) return;
      var low = 0, high = plot.t.length - 1;
      while (high - low > 1) { var mid = (low + high) >> 1; if (plot.t[mid] <= time) low = mid; else high = mid; }
      var at = time - plot.t[low] < plot.t[high] - time ? low : high;
      var x = plot.l + (plot.r - plot.l) * (plot.t[at] - plot.a) / (plot.b - plot.a);
      line.setAttribute("x1", x); line.setAttribute("x2", x); line.setAttribute("visibility", "visible");
      reading.textContent = "t = " + number(plot.t[at]) + ":  " + plot.n.map(function (name, c) {
        return (name ? name + " = " : "") + number(plot.v[c][at]);
      }).join(",  ");
    }
    svg.addEventListener("pointermove", function (event) {
      var box = svg.getBoundingClientRect(), x = (event.clientX - box.left) * svg.viewBox.baseVal.width / box.width;
      show(plot.a + (plot.b - plot.a) * Math.min(1, Math.max(0, (x - plot.l) / (plot.r - plot.l))));
    });
    return show;
  });

  var frames = run.frames, player = document.getElementById("player");
  if (!player || frames.length < 2) return;
  player.hidden = false;
  var svg = document.querySelector("#motion svg"), positions = svg.querySelector("#positions");
  var slider = player.querySelector("input"), button = player.querySelector("button"), clock = player.querySelector("output");
  var now = add(svg, "g", {});
  var paths = ["beams", "bodies", "springs", "joints"].map(function (name) { return add(now, "path", {"class": name + " now"}); });
  slider.max = frames.length - 1;
  function show(k) {
    var frame = frames[k];
    positions.setAttribute("opacity", 0.4);
    paths.forEach(function (path, p) { path.setAttribute("d", frame[p + 1]); });
    clock.textContent = "t = " + number(frame[0]);
    plots.forEach(function (plot) { plot(frame[0]); });
  }
  var timer = null, start = 0, seconds = 6;
  function stop() { if (timer !== null) cancelAnimationFrame(timer); timer = null; button.textContent = "Play"; }
  function step(stamp) {
    if (!start) start = stamp - 1000 * seconds * (Number(slider.value) % (frames.length - 1)) / (frames.length - 1);
    var k = Math.min(frames.length - 1, Math.floor((stamp - start) / (1000 * seconds) * (frames.length - 1)));
    slider.value = k;
    show(k);
    if (k === frames.length - 1) return stop();
    timer = requestAnimationFrame(step);
  }
  slider.addEventListener("input", function () { stop(); show(Number(slider.value)); });
  button.addEventListener("click", function () {
    if (timer !== null) return stop();
    start = 0; button.textContent = "Pause"; timer = requestAnimationFrame(step);
  });
})();
)js";

}  // namespace bough::report
