#pragma once
/// The script of batch.html: a table that sorts, filters and selects, and a chart of any column against any. `batch` is a
/// JSON value in the page: {"columns": [names], "numeric": [true, ...], "rows": [[cells], ...]}; a cell is a number, a text
/// or null. All text goes into the page as text nodes.
#include <string_view>

namespace bough::report {

inline constexpr std::string_view batch_script = R"js(
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("batch").textContent), svgNs = "http://www.w3.org/2000/svg";
  var columns = data.columns, numeric = data.numeric, rows = data.rows, order = rows.map(function (r, i) { return i; });
  var selected = {}, sortBy = -1, down = false;
  function el(parent, name, text) {
    var e = document.createElement(name);
    if (text !== undefined) e.textContent = text;
    parent.appendChild(e);
    return e;
  }
  function shown(v) { return v === null ? "" : typeof v === "number" ? String(Number(v.toPrecision(6))) : v; }
  var root = document.getElementById("cases");
  var bar = el(root, "p"), label = el(bar, "label", "Filter: "), filter = el(label, "input");
  filter.type = "search";
  filter.placeholder = "failed, or  k > 2 & tip < -1";
  filter.size = 40;
  var count = el(bar, "span");
  var wide = el(root, "div"), table = el(wide, "table"), head = el(el(table, "thead"), "tr"), body = el(table, "tbody");
  wide.className = "wide";
  var views = el(root, "div");
  columns.forEach(function (name, c) {
    var th = el(head, "th"), button = el(th, "button", name);
    if (numeric[c]) th.className = "number";
    button.addEventListener("click", function () {
      down = sortBy === c ? !down : false;
      sortBy = c;
      draw();
    });
  });
  /// "name < 3 & other >= 2", else a piece of text of any cell.
  function condition(text) {
    var tests = text.split("&").map(function (part) {
      var m = /^\s*(.+?)\s*(<=|>=|=|<|>)\s*(-?[0-9.eE+-]+)\s*$/.exec(part), c = m ? columns.indexOf(m[1]) : -1;
      if (c < 0 || !isFinite(Number(m[3]))) return null;
      var x = Number(m[3]);
      return function (row) {
        var v = row[c];
        if (typeof v !== "number") return false;
        return m[2] === "<" ? v < x : m[2] === ">" ? v > x : m[2] === "<=" ? v <= x : m[2] === ">=" ? v >= x : v === x;
      };
    });
    if (tests.every(function (t) { return t; })) return function (row) { return tests.every(function (t) { return t(row); }); };
    var piece = text.toLowerCase();
    return function (row) { return row.some(function (v) { return shown(v).toLowerCase().indexOf(piece) >= 0; }); };
  }
  function draw() {
    var keep = condition(filter.value), left = order.filter(function (i) { return !filter.value || keep(rows[i]); });
    if (sortBy >= 0) left.sort(function (a, b) {
      var x = rows[a][sortBy], y = rows[b][sortBy];
      if (x === y) return a - b;
      if (x === null) return 1;
      if (y === null) return -1;
      return (x < y ? -1 : 1) * (down ? -1 : 1);
    });
    body.textContent = "";
    left.slice(0, 300).forEach(function (i) {
      var tr = el(body, "tr");
      if (selected[i]) tr.className = "chosen";
      rows[i].forEach(function (v, c) {
        var td = el(tr, "td", shown(v));
        if (numeric[c]) td.className = "number";
      });
      tr.addEventListener("click", function () { selected[i] = !selected[i]; draw(); });
    });
    views.textContent = "";
    order.filter(function (i) { return selected[i]; }).slice(0, 20).forEach(function (i) {
      var p = el(views, "p"), name = String(rows[i][0]), link = el(p, "a", "View of " + name);
      link.href = encodeURIComponent(name) + "/view.html";
      el(p, "span", ", which `bough view DIR --case " + name + "` draws, with the folder of this page as DIR");
    });
    count.textContent = " " + left.length + " of " + rows.length + " rows" + (left.length > 300 ? ", the first 300 shown" : "");
    chart(left);
  }
  var choice = document.getElementById("scatter"), line = el(choice, "p");
  function pick(text, first) {
    var l = el(line, "label", text), s = el(l, "select");
    columns.forEach(function (name, c) { if (numeric[c]) el(s, "option", name).value = c; });
    s.selectedIndex = Math.min(first, s.options.length - 1);
    s.addEventListener("change", draw);
    return s;
  }
  var n = data.inputs, across = pick("Across: ", 0), up = pick(" Up: ", n > 0 ? n : 1);
  var svg = document.createElementNS(svgNs, "svg");
  svg.setAttribute("viewBox", "0 0 960 400");
  choice.appendChild(svg);
  function draw_svg(name, attributes, text) {
    var e = document.createElementNS(svgNs, name);
    for (var k in attributes) e.setAttribute(k, attributes[k]);
    if (text !== undefined) e.textContent = text;
    svg.appendChild(e);
    return e;
  }
  function chart(left) {
    svg.textContent = "";
    draw_svg("rect", {"class": "paper", width: 960, height: 400});
    if (!across.options.length) return;
    var cx = Number(across.value), cy = Number(up.value);
    var points = left.filter(function (i) { return typeof rows[i][cx] === "number" && typeof rows[i][cy] === "number"; });
    if (!points.length) return;
    function span(c) {
      var low = Infinity, high = -Infinity;
      points.forEach(function (i) { low = Math.min(low, rows[i][c]); high = Math.max(high, rows[i][c]); });
      if (!(high > low)) { low -= 0.5 * Math.abs(low) || 0.5; high += 0.5 * Math.abs(high) || 0.5; }
      return [low, high];
    }
    var x = span(cx), y = span(cy);
    function px(v) { return 90 + 840 * (v - x[0]) / (x[1] - x[0]); }
    function py(v) { return 350 - 320 * (v - y[0]) / (y[1] - y[0]); }
    draw_svg("path", {"class": "axis", fill: "none", d: "M90 30V350H930"});
    [0, 0.5, 1].forEach(function (s) {
      var vx = x[0] + s * (x[1] - x[0]), vy = y[0] + s * (y[1] - y[0]);
      draw_svg("text", {"class": "soft tiny", x: px(vx), y: 368, "text-anchor": s === 0 ? "start" : s === 1 ? "end" : "middle"}, shown(vx));
      draw_svg("text", {"class": "soft tiny", x: 84, y: py(vy) + 4, "text-anchor": "end"}, shown(vy));
    });
    draw_svg("text", {"class": "ink tiny", x: 510, y: 390, "text-anchor": "middle"}, columns[cx]);
    draw_svg("text", {"class": "ink tiny", x: 90, y: 18}, columns[cy]);
    points.forEach(function (i) {
      var e = draw_svg("circle", {cx: px(rows[i][cx]), cy: py(rows[i][cy]), r: selected[i] ? 6 : 3, "class": "point solid " + (selected[i] ? "s1" : "s0")});
      var t = document.createElementNS(svgNs, "title");
      t.textContent = shown(rows[i][0]) + ": " + shown(rows[i][cx]) + ", " + shown(rows[i][cy]);
      e.appendChild(t);
      e.addEventListener("click", function () { selected[i] = !selected[i]; draw(); });
    });
  }
  filter.addEventListener("input", draw);
  draw();
})();
)js";

}  // namespace bough::report
