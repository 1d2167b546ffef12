// Looks at a page as it is laid out and writes what is wrong with it into an element of its own, for check_html.sh: texts of a drawing that
// overlap, texts on curves, columns that are cut, drawings blown up, pages wider than the window.
(function () {
  "use strict";
  var faults = [], narrow = window.innerWidth < 700;
  function words(element) { return JSON.stringify(element.textContent.slice(0, 40)); }
  function overlap(a, b) {
    return Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1.5 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1.5;
  }
  document.querySelectorAll("svg").forEach(function (svg) {
    var frame = svg.getBoundingClientRect();
    if (!frame.width || !svg.viewBox.baseVal || !svg.viewBox.baseVal.width) return;
    if (frame.width > 1.35 * svg.viewBox.baseVal.width) faults.push("a drawing is blown up " + (frame.width / svg.viewBox.baseVal.width).toFixed(2) + " times");
    var texts = Array.from(svg.querySelectorAll("text")).filter(function (t) { return t.getBoundingClientRect().width > 0; });
    var boxes = texts.map(function (t) { return t.getBoundingClientRect(); });
    if (texts.length > 300) return; // drawings of many small parts hide what does not fit
    for (var i = 0; i < texts.length; ++i) {
      for (var j = i + 1; j < texts.length; ++j)
        if (overlap(boxes[i], boxes[j])) faults.push("texts overlap: " + words(texts[i]) + " and " + words(texts[j]));
      if (boxes[i].right > frame.right + 1 || boxes[i].left < frame.left - 1) faults.push("a text is cut: " + words(texts[i]));
    }
    svg.querySelectorAll("path.curve, path.point, #positions path").forEach(function (path) {
      var length = path.getTotalLength(), matrix = path.getScreenCTM(), count = Math.min(400, Math.ceil(length / 3));
      for (var k = 0; k <= count; ++k) {
        var p = path.getPointAtLength(length * k / Math.max(1, count)).matrixTransform(matrix);
        for (var i = 0; i < texts.length; ++i) {
          var b = boxes[i];
          if (p.x > b.left + 1 && p.x < b.right - 1 && p.y > b.top + 3 && p.y < b.bottom - 3) {
            faults.push("a text lies on what is drawn: " + words(texts[i]));
            return;
          }
        }
      }
    });
  });
  if (!narrow) // on a telephone tables are pushed aside with the finger
    document.querySelectorAll(".wide").forEach(function (box) {
      var table = box.querySelector("table");
      if (table && table.getBoundingClientRect().right > Math.min(box.getBoundingClientRect().right, window.innerWidth) + 1)
        faults.push("columns are cut: " + words(table));
    });
  if (document.documentElement.scrollWidth > window.innerWidth + 1) faults.push("the page is wider than the window");
  var told = document.createElement("pre");
  told.textContent = Array.from(new Set(faults)).map(function (f) { return "BOXES" + ": " + f; }).join("\n") + "\nBOXES" + " END";
  document.body.appendChild(told);
})();
