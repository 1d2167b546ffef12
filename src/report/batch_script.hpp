#pragma once
/// The script of batch.html: sorts, filters and selects the rows of the table of cases, which stands in the page, and
/// draws any column against any. `batch` is a JSON value in the page, with the rows and columns of the table:
/// {"columns": [names], "headings": [names with units], "numeric": [true, ...], "rows": [[cells], ...]}; a cell is a
/// number, a text or null. All text goes into the page as text nodes.
#include <string_view>

namespace bough::report {

inline constexpr std::string_view batch_script = R"js(
(function () {
  "use strict";
  var data = JSON.parse(document.getElementById("batch").textContent), svgNs = "http://www.w3.org/2000/svg";
  var columns = data.columns, headings = data.headings, numeric = data.numeric, rows = data.rows, order = rows.map(function (r, i) { return i; });
  var selected = {}, sortBy = -1, down = false;
  function el(parent, name, text) {
    var e = document.createElement(name);
    if (text !== undefined) e.textContent = text;
    parent.appendChild(e);
    return e;
  }
  function shown(v) { return v === null ? "" : typeof v === "number" ? String(Number(v.toPrecision(6))) : v; }
  var root = document.getElementById("cases"), bar = document.createElement("p"), label = el(bar, "label", "Filter: ");
  root.insertBefore(bar, root.firstChild);
  var filter = el(label, "input"), count = el(bar, "span"), sorting = el(el(bar, "label", " Sort by: "), "select");
  filter.type = "search";
  filter.placeholder = "failed, or  k > 2 & tip < -1";
  filter.size = 28;
  el(sorting, "option", "number of the case").value = -1;
  columns.forEach(function (name, c) { el(sorting, "option", name).value = c; });
  sorting.addEventListener("change", function () { sortBy = Number(sorting.value); down = false; draw(); });
  var views = el(root, "div");
  // A table too wide for the page stands in parts, each with the first column again.
  var next = 1;
  var parts = Array.from(root.querySelectorAll("table")).map(function (table, p) {
    Array.from(table.tHead.rows[0].cells).forEach(function (th, k) {
      var c = k === 0 ? 0 : next++, name = th.textContent;
      th.textContent = "";
      el(th, "button", name).addEventListener("click", function () {
        down = sortBy === c ? !down : false;
        sortBy = c;
        sorting.value = c;
        draw();
      });
    });
    var body = table.tBodies[0], trs = Array.from(body.rows);
    trs.forEach(function (tr, i) { tr.addEventListener("click", function () { selected[i] = !selected[i]; draw(); }); });
    return {body: body, rows: trs};
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
    parts.forEach(function (part) {
      part.body.textContent = "";
      left.slice(0, 300).forEach(function (i) {
        part.rows[i].className = selected[i] ? "chosen" : "";
        part.body.appendChild(part.rows[i]);
      });
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
    draw_svg("text", {"class": "ink tiny", x: 510, y: 390, "text-anchor": "middle"}, headings[cx]);
    draw_svg("text", {"class": "ink tiny", x: 90, y: 18}, headings[cy]);
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
