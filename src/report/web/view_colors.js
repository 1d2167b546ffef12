// Colours: of parts, of what is selected, and of recorded quantities.
const palette = ["#2a78d6", "#eb6834", "#1baf7a", "#8f7ee6", "#e87ba4", "#c98500", "#4aa3a3", "#8a8a80"];
// Maps whose lightness grows steadily, also for readers who tell fewer colours apart: viridis (van der Walt, Smith 2015) and
// cividis (Nunez, Anderton, Renslow, PLoS ONE 13, 2018), which looks alike with and without red-green blindness.
const colorMaps = {
  viridis: ["440154", "472c7a", "3b518b", "2c718e", "21908d", "27ad81", "5cc863", "aadc32", "fde725"],
  cividis: ["00204d", "00336f", "39486b", "575c6d", "707173", "8a8779", "a69d75", "c4b56c", "e4cf5b", "ffea46"],
};
// Red, green, blue from 0 to 1 at s from 0 to 1.
function mapAt(name, s) {
  const stops = colorMaps[name],
    x = Math.min(1, Math.max(0, s)) * (stops.length - 1),
    k = Math.min(stops.length - 2, Math.floor(x)),
    f = x - k;
  return [0, 2, 4].map(function (c) {
    const [a, b] = [stops[k], stops[k + 1]].map((stop) => parseInt(stop.slice(c, c + 2), 16));
    return (a + f * (b - a)) / 255;
  });
}
const mapTables = {};
for (const name of Object.keys(colorMaps)) {
  mapTables[name] = new Float32Array(256 * 3);
  for (let k = 0; k < 256; ++k)
    mapTables[name].set(
      mapAt(name, k / 255).map(function (c) {
        return new THREE.Color().setRGB(c, c, c, "srgb").r;
      }),
      3 * k,
    );
}

// Of sub-domains in turn: colours that all readers tell apart (Okabe, Ito 2008), without their black, which a dark page hides.
const domainPalette = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442"];
function domainColor(leaf) {
  const count = domainPalette.length;
  return domainPalette[((leaf % count) + count) % count];
}

class Paint {
  // tint: the second of two runs has one colour
  constructor(run, tint) {
    Object.assign(this, {run, tint, quantity: null, selected: ""});
    this.use(null, "viridis", "#2a78d6", "#b3261e");
    this.grey = new THREE.Color(tint || "#6f6e68");
    this.pale = new THREE.Color("#8a8a80");
    this.scratch = new THREE.Color();
  }
  // quantity: null, or {name, low, high}; map: a name of colorMaps; base: colour of what shows none
  use(quantity, map, base, accent) {
    this.quantity = quantity;
    this.map = map;
    this.table = mapTables[map];
    this.base = new THREE.Color(this.tint || base);
    this.accent = new THREE.Color(accent);
  }
  // What the colours of beams hang on, at picture k.
  key(k) {
    return [
      this.quantity ? this.map + this.quantity.name + k : "",
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
      return this.put(this.scratch.set(domainColor(leaf)), out, at);
    }
    const values = name && this.run.data["q." + name];
    if (!values) return this.put(this.base, out, at);
    const v = 3 * values[k * this.run.numPoints + curve.first + p];
    out[at] = this.table[v];
    out[at + 1] = this.table[v + 1];
    out[at + 2] = this.table[v + 2];
  }
  body(i, k) {
    const speeds = this.quantity && this.quantity.name === "speed" && this.run.data["body.speed"];
    if (this.run.bodies[i].name === this.selected) return this.scratch.copy(this.accent);
    if (!speeds) return this.scratch.copy(this.base).lerp(this.pale, this.tint ? 0.3 : 0.75);
    const v = 3 * speeds[k * this.run.bodies.length + i];
    return this.scratch.setRGB(this.table[v], this.table[v + 1], this.table[v + 2]);
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
