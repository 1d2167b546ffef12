// An expression that lists, as texts, where colours of a view look alike to readers who lack one kind of cones. The colours
// that they see: Machado, Oliveira, Fernandes, IEEE Trans. Vis. Comput. Graph. 15 (2009), severity 1.
(function () {
  "use strict";
  const sights = {
    "all cones": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    protanopia: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    deuteranopia: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
    tritanopia: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
  };
  const linear = (v) => (v <= 0.04045 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4)),
    root = (v) => (v > 0.008856 ? Math.cbrt(v) : 7.787 * v + 16 / 116),
    times = (m, v) => m.map((r) => r[0] * v[0] + r[1] * v[1] + r[2] * v[2]);
  // CIE L*, a*, b* of a colour as it is seen, white D65.
  const lab = function (rgb, sight) {
    const seen = times(sight, rgb.map(linear)).map((v) => Math.min(1, Math.max(0, v))),
      xyz = times([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]], seen),
      [x, y, z] = [root(xyz[0] / 0.9505), root(xyz[1]), root(xyz[2] / 1.089)];
    return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
  };
  const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]),
    faults = [];
  for (const name of Object.keys(colorMaps))
    for (const [sight, matrix] of Object.entries(sights)) {
      const steps = Array.from({length: 256}, (_, k) => lab(mapAt(name, k / 255), matrix));
      for (let k = 1; k < 256; ++k)
        if (steps[k][0] <= steps[k - 1][0]) faults.push(`${name}, ${sight}: lightness falls at ${k}`);
      if (steps[255][0] - steps[0][0] < 70) faults.push(`${name}, ${sight}: lightness grows by too little`);
      // A just noticeable difference is 2.3; a sixteenth of the range has to be more.
      for (let k = 0; k + 16 < 256; ++k)
        if (apart(steps[k], steps[k + 16]) < 3.4) faults.push(`${name}, ${sight}: ${k} and ${k + 16} look alike`);
    }
  for (const [sight, matrix] of Object.entries(sights)) {
    const colors = domainPalette.map((c) => lab([1, 3, 5].map((k) => parseInt(c.slice(k, k + 2), 16) / 255), matrix));
    for (let i = 0; i < colors.length; ++i)
      for (let j = 0; j < i; ++j)
        if (apart(colors[i], colors[j]) < 15) faults.push(`sub-domains ${j} and ${i} look alike, ${sight}`);
  }
  return faults;
})()
