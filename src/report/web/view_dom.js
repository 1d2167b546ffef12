// Elements of the page, and files that the reader saves.
const svgNs = "http://www.w3.org/2000/svg";
function svg(parent, name, attributes, text) {
  const element = document.createElementNS(svgNs, name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.appendChild(element);
  return element;
}
function make(parent, name, attributes, text) {
  const element = document.createElement(name);
  for (const key in attributes || {}) element.setAttribute(key, attributes[key]);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.appendChild(element);
  return element;
}
function fileName(text) {
  return text.replace(/[^A-Za-z0-9._-]+/g, "_").slice(0, 60) || "view";
}
function save(blob, name) {
  const link = make(document.body, "a", {download: name, hidden: ""});
  link.href = URL.createObjectURL(blob);
  link.click();
  setTimeout(function () {
    URL.revokeObjectURL(link.href);
    link.remove();
  }, 1000);
}
