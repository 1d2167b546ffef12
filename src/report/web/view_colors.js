// Colours: of parts, of what is selected, and of recorded quantities.
const palette = ["#2a78d6", "#eb6834", "#1baf7a", "#8f7ee6", "#e87ba4", "#c98500", "#4aa3a3", "#8a8a80"];
const viridis = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];
function viridisAt(s) {
  const x = Math.min(1, Math.max(0, s)) * (viridis.length - 1),
    k = Math.min(viridis.length - 2, Math.floor(x)),
    f = x - k;
  return [0, 1, 2].map(function (c) {
    return (viridis[k][c] + f * (viridis[k + 1][c] - viridis[k][c])) / 255;
  });
}
const mapTable = new Float32Array(256 * 3);
for (let k = 0; k < 256; ++k)
  mapTable.set(
    viridisAt(k / 255).map(function (c) {
      return new THREE.Color().setRGB(c, c, c, "srgb").r;
    }),
    3 * k,
  );

class Paint {
  // tint: the second of two runs has one colour
  constructor(run, tint) {
    Object.assign(this, {run, tint, quantity: null, selected: ""});
    this.use(null, "#2a78d6", "#b3261e");
    this.grey = new THREE.Color(tint || "#6f6e68");
    this.pale = new THREE.Color("#8a8a80");
    this.scratch = new THREE.Color();
  }
  // quantity: null, or {name, low, high}; base: colour of what shows none
  use(quantity, base, accent) {
    this.quantity = quantity;
    this.base = new THREE.Color(this.tint || base);
    this.accent = new THREE.Color(accent);
  }
  // What the colours of beams hang on, at picture k.
  key(k) {
    return [
      this.quantity ? this.quantity.name + k : "",
      this.selected,
      this.accent.getHex(),
      this.base.getHex(),
    ].join("|");
  }
  // Colour of point p of a curve at picture k, into out[at..].
  curvePoint(curve, p, k, out, at) {
    if (curve.name === this.selected) return this.put(this.accent, out, at);
    const name = this.quantity ? this.quantity.name : "";
    if (name === "sub-domain" && curve.subdomains.length) {
      const last = curve.subdomains.length - 1,
        leaf = curve.subdomains[Math.min(last, Math.floor((p / (curve.points - 1)) * (last + 1)))];
      return this.put(this.scratch.set(palette[((leaf % 8) + 8) % 8]), out, at);
    }
    const values = name && this.run.data["q." + name];
    if (!values) return this.put(this.base, out, at);
    const v = 3 * values[k * this.run.numPoints + curve.first + p];
    out[at] = mapTable[v];
    out[at + 1] = mapTable[v + 1];
    out[at + 2] = mapTable[v + 2];
  }
  body(i, k) {
    const speeds = this.quantity && this.quantity.name === "speed" && this.run.data["body.speed"];
    if (this.run.bodies[i].name === this.selected) return this.scratch.copy(this.accent);
    if (!speeds) return this.scratch.copy(this.base).lerp(this.pale, this.tint ? 0.3 : 0.75);
    const v = 3 * speeds[k * this.run.bodies.length + i];
    return this.scratch.setRGB(mapTable[v], mapTable[v + 1], mapTable[v + 2]);
  }
  link(name) {
    return name === this.selected ? this.accent : this.grey;
  }
  put(color, out, at) {
    out[at] = color.r;
    out[at + 1] = color.g;
    out[at + 2] = color.b;
  }
}
