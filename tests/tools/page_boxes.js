// An expression that lists the faults of a page as laid out, as texts: texts that overlap, in drawings and outside, or
// lie on lines of a drawing; columns that are cut; drawings that are enlarged; pages wider than the window; words with
// less contrast than 4.5 to 1.
(function () {
  "use strict";
  const faults = new Set(),
    words = (text) => JSON.stringify(text.trim().slice(0, 40)),
    overlap = (a, b) =>
      Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1.5 &&
      Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1.5,
    isSeen = (element) => element.checkVisibility({visibilityProperty: true, contentVisibilityAuto: true});

  // ---- drawings ----
  for (const drawing of document.querySelectorAll("svg")) {
    const frame = drawing.getBoundingClientRect(),
      {width} = drawing.viewBox.baseVal || {};
    if (!frame.width || !width || !isSeen(drawing)) continue;
    if (frame.width > 1.35 * width) faults.add(`a drawing is blown up ${(frame.width / width).toFixed(2)} times`);
    const texts = Array.from(drawing.querySelectorAll("text")).filter((t) => isSeen(t) && t.getBoundingClientRect().width > 0),
      boxes = texts.map((t) => t.getBoundingClientRect());
    const size = Math.min(...texts.map((t) => (parseFloat(getComputedStyle(t).fontSize) * frame.width) / width));
    if (size < 7) faults.add(`texts of a drawing are ${size.toFixed(1)} px high: ${words(texts[0].textContent)}`);
    // Labels of one axis that read alike tell nothing.
    const labels = texts.filter((t) => t.getAttribute("text-anchor") === "end").map((t) => t.getAttribute("x") + " " + t.textContent);
    for (const label of labels)
      if (labels.filter((l) => l === label).length > 1) faults.add(`labels of an axis read alike: ${words(label)}`);
    if (texts.length > 300) continue; // drawings of many small parts hide texts that do not fit
    boxes.forEach(function (box, i) {
      for (let j = i + 1; j < boxes.length; ++j)
        if (overlap(box, boxes[j])) faults.add(`texts overlap: ${words(texts[i].textContent)} and ${words(texts[j].textContent)}`);
      if (box.right > frame.right + 1 || box.left < frame.left - 1) faults.add(`a text is cut: ${words(texts[i].textContent)}`);
    });
    for (const path of drawing.querySelectorAll("path.curve, path.point, #positions path")) {
      const length = path.getTotalLength(),
        matrix = path.getScreenCTM(),
        count = Math.min(400, Math.ceil(length / 3));
      for (let k = 0; k <= count; ++k) {
        const p = path.getPointAtLength((length * k) / Math.max(1, count)).matrixTransform(matrix),
          hit = boxes.findIndex((b) => p.x > b.left + 1 && p.x < b.right - 1 && p.y > b.top + 3 && p.y < b.bottom - 3);
        if (hit < 0) continue;
        faults.add(`a text lies on what is drawn: ${words(texts[hit].textContent)}`);
        break;
      }
    }
  }

  // ---- text around them ----
  // Each line of each text, cut to what its ancestors show.
  const lines = [],
    walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    if (!node.textContent.trim() || /^(SCRIPT|STYLE|OPTION|NOSCRIPT)$/.test(element.tagName)) continue;
    if (element.closest("svg") || !isSeen(element)) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const r of range.getClientRects()) {
      const box = {left: r.left, right: r.right, top: r.top, bottom: r.bottom, element: element, text: node.textContent};
      for (let a = element; a; a = a.parentElement)
        if (getComputedStyle(a).overflowX !== "visible") {
          const clip = a.getBoundingClientRect();
          box.left = Math.max(box.left, clip.left);
          box.right = Math.min(box.right, clip.right);
        }
      if (box.right - box.left > 1) lines.push(box);
    }
  }
  lines.sort((a, b) => a.top - b.top);
  lines.forEach(function (a, i) {
    for (let j = i + 1; j < lines.length && lines[j].top < a.bottom; ++j)
      if (a.element !== lines[j].element && overlap(a, lines[j]))
        faults.add(`texts overlap: ${words(a.text)} and ${words(lines[j].text)}`);
  });
  for (const box of document.querySelectorAll(".wide")) {
    const table = box.querySelector("table");
    if (!table || !isSeen(table)) continue;
    if (table.getBoundingClientRect().right > Math.min(box.getBoundingClientRect().right, window.innerWidth) + 1)
      faults.add(`columns are cut: ${words(table.textContent)}`);
  }
  // A column is a letter wide where its words break into letters.
  for (const cell of document.querySelectorAll("td, th, caption, figcaption, p, li, summary, h1, h2, h3")) {
    const text = cell.textContent.trim(),
      box = cell.getBoundingClientRect();
    if (text.length > 3 && isSeen(cell) && box.width < 30 && box.height > 60) faults.add(`a column is a letter wide: ${words(text)}`);
  }
  if (document.documentElement.scrollWidth > window.innerWidth + 1)
    faults.add(`the page is wider than the window: ${document.documentElement.scrollWidth} of ${window.innerWidth}`);

  // ---- contrast ----
  const rgba = function (text) {
    const n = (text.match(/[\d.]+/g) || []).map(Number);
    return n.length < 3 ? null : [n[0], n[1], n[2], n.length > 3 ? n[3] : 1];
  };
  const over = (top, under) => [0, 1, 2].map((c) => top[3] * top[c] + (1 - top[3]) * under[c]).concat(1);
  const luminance = function (color) {
    const [r, g, b] = color.map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : Math.pow((v / 255 + 0.055) / 1.055, 2.4)));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ground = matchMedia("(prefers-color-scheme: dark)").matches && !matchMedia("print").matches ? [18, 18, 18, 1] : [255, 255, 255, 1];
  const behind = function (element) {
    const layers = [];
    for (let a = element; a; a = a.parentElement) layers.push(rgba(getComputedStyle(a).backgroundColor) || [0, 0, 0, 0]);
    return layers.reverse().reduce((under, top) => over(top, under), ground);
  };
  // The filled areas of a drawing under the middle of the text, in the order of painting.
  const behindText = function (text) {
    const box = text.getBoundingClientRect(),
      drawing = text.closest("svg");
    let color = behind(drawing);
    for (const shape of drawing.querySelectorAll("rect, path, circle, ellipse, polygon")) {
      if (shape.compareDocumentPosition(text) & Node.DOCUMENT_POSITION_PRECEDING) break;
      const style = getComputedStyle(shape),
        fill = style.fill === "none" || !isSeen(shape) ? null : rgba(style.fill),
        matrix = shape.getScreenCTM();
      if (!fill || !matrix) continue;
      const middle = new DOMPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2).matrixTransform(matrix.inverse());
      if (!shape.isPointInFill(middle)) continue;
      fill[3] *= Number(style.fillOpacity) * Number(style.opacity);
      color = over(fill, color);
    }
    return color;
  };
  const judge = function (text, color, under) {
    const [a, b] = [luminance(over(color, under).slice(0, 3)), luminance(under.slice(0, 3))].sort((x, y) => y - x),
      ratio = (a + 0.05) / (b + 0.05);
    if (ratio < 4.5) faults.add(`contrast ${ratio.toFixed(2)} to 1: ${words(text)}`);
  };
  for (const line of lines) {
    const style = getComputedStyle(line.element),
      color = rgba(style.color);
    if (color && !line.element.matches(":disabled")) judge(line.text, color, behind(line.element));
  }
  for (const text of Array.from(document.querySelectorAll("svg text")).slice(0, 600)) {
    const style = getComputedStyle(text),
      color = rgba(style.fill);
    if (!color || !isSeen(text) || !text.getBoundingClientRect().width) continue;
    color[3] *= Number(style.fillOpacity) * Number(style.opacity);
    judge(text.textContent, color, behindText(text));
  }
  return Array.from(faults);
})()
