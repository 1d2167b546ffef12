// Reads what the page holds of its runs: one JSON value, and the numbers as packed bytes (view_data.cpp says how).
"use strict";

async function unpack(base64) {
  const text = atob(base64),
    bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

// Differences between frames, modulo the width of the type, low and high bytes apart: what is at rest is a row of zeros.
function undoDifferences16(bytes, frames) {
  const count = bytes.length / 2,
    values = new Uint16Array(count),
    row = count / frames;
  for (let k = 0; k < count; ++k) {
    const before = k >= row ? values[k - row] : 0;
    values[k] = before + bytes[k] + (bytes[count + k] << 8);
  }
  return values;
}
function undoDifferences8(bytes, frames) {
  const values = new Uint8Array(bytes.length),
    row = bytes.length / frames;
  for (let k = 0; k < bytes.length; ++k) values[k] = (k >= row ? values[k - row] : 0) + bytes[k];
  return values;
}

async function readRun(run) {
  const buffer = await unpack(run.packed);
  delete run.packed;
  const frames = run.times.length,
    arrays = {};
  for (const [name, [type, offset, count]] of Object.entries(run.arrays)) {
    if (type === "f64") arrays[name] = new Float64Array(buffer, offset, count);
    else if (type === "f32") arrays[name] = new Float32Array(buffer, offset, count);
    else if (type === "u32") arrays[name] = new Uint32Array(buffer, offset, count);
    else if (type === "d16") arrays[name] = undoDifferences16(new Uint8Array(buffer, offset, count), frames);
    else if (type === "d8") arrays[name] = undoDifferences8(new Uint8Array(buffer, offset, count), frames);
  }
  run.data = arrays;
  return run;
}

// The place between recorded frames: {k, f}, time = (1 - f) times[k] + f times[k + 1].
function placeOf(times, time) {
  let low = 0,
    high = times.length - 1;
  if (high < 1 || time <= times[0]) return {k: 0, f: 0};
  if (time >= times[high]) return {k: high - 1, f: 1};
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return {k: low, f: (time - times[low]) / (times[low + 1] - times[low])};
}

// Places and rotations of all tracks at a time, displacements and rotations from the start times `scale`.
function posesAt(run, time, scale, poses) {
  const {start, low, step, displacement, rotation} = run.data,
    tracks = step.length;
  poses = poses || {x: new Float32Array(3 * tracks), q: new Float32Array(4 * tracks)};
  const {k, f} = placeOf(run.times, time),
    last = run.times.length - 1;
  const a = 3 * tracks * k,
    b = 3 * tracks * Math.min(k + 1, last),
    unit = 1 / 32767;
  const signed = function (v) {
    return (v > 32767 ? v - 65536 : v) * unit;
  };
  for (let t = 0; t < tracks; ++t) {
    let dot = 0;
    const p = [0, 0, 0, 0],
      r = [0, 0, 0, 0];
    for (let c = 0; c < 3; ++c) {
      const i = 3 * t + c,
        u = displacement[a + i],
        v = displacement[b + i];
      poses.x[i] = start[i] + scale * (low[i] + step[t] * (u + f * (v - u)));
      p[c] = signed(rotation[a + i]);
      r[c] = signed(rotation[b + i]);
      dot += p[c] * r[c];
    }
    p[3] = Math.sqrt(Math.max(0, 1 - p[0] * p[0] - p[1] * p[1] - p[2] * p[2]));
    r[3] = Math.sqrt(Math.max(0, 1 - r[0] * r[0] - r[1] * r[1] - r[2] * r[2]));
    const sign = dot + p[3] * r[3] < 0 ? -1 : 1;
    const q = [0, 0, 0, 0];
    let norm = 0;
    for (let c = 0; c < 4; ++c) {
      q[c] = p[c] + f * (sign * r[c] - p[c]);
      norm += q[c] * q[c];
    }
    norm = Math.sqrt(norm) || 1;
    let turn = 1 / norm,
      w = q[3] / norm;
    if (scale !== 1) {
      const half = Math.acos(Math.min(1, Math.max(-1, w))),
        sine = Math.sin(half);
      turn = sine > 1e-9 ? Math.sin(scale * half) / sine / norm : scale / norm;
      w = Math.cos(scale * half);
    }
    poses.q[4 * t] = q[0] * turn;
    poses.q[4 * t + 1] = q[1] * turn;
    poses.q[4 * t + 2] = q[2] * turn;
    poses.q[4 * t + 3] = w;
  }
  return poses;
}

function number(v, digits) {
  if (typeof v !== "number" || !Number.isFinite(v)) return String(v);
  const rounded = Number(v.toPrecision(digits || 5));
  return rounded !== 0 && Math.abs(rounded) < 1e-3 ? rounded.toExponential() : String(rounded);
}
function withUnit(text, unit) {
  return unit ? text + " [" + unit + "]" : text;
}
