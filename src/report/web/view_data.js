// Reads what the page holds of its runs: one JSON value, and the numbers as packed bytes (view_data.cpp says how).
"use strict";

async function unpack(base64) {
  const text = atob(base64),
    bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

// Differences between frames, modulo the width of the type, lowest bytes of all first: what is at rest is a row of zeros.
function undoDifferences(bytes, width, frames, values) {
  const count = bytes.length / width,
    row = count / frames,
    modulus = 2 ** (8 * width);
  for (let k = 0; k < count; ++k) {
    let value = k >= row ? values[k - row] : 0;
    for (let b = 0; b < width; ++b) value += bytes[b * count + k] * 2 ** (8 * b);
    values[k] = value % modulus;
  }
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
    else if (type[0] === "d") {
      const width = Number(type.slice(1)) / 8,
        Values = [Uint8Array, Uint16Array, Uint32Array][width - 1];
      arrays[name] = undoDifferences(new Uint8Array(buffer, offset, count), width, frames, new Values(count / width));
    }
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

// Places and rotations of all tracks at a time, displacements and rotations from the start times `scale`. Between frames
// places are cubics through displacements and velocities, so that what turns keeps its length; where a part turns too far
// for that from one frame to the next, the nearer one is shown.
function posesAt(run, time, scale, poses) {
  const {start, low, step, fastest, displacement, velocity, rotation, turn} = run.data,
    tracks = step.length;
  poses = poses || {x: new Float32Array(3 * tracks), q: new Float32Array(4 * tracks)};
  const place = placeOf(run.times, time),
    last = run.times.length - 1,
    k = place.k,
    next = Math.min(k + 1, last),
    f = turn[next] > run.largestTurn ? Math.round(place.f) : place.f,
    h = run.times[next] - run.times[k],
    bend = f * (1 - f);
  const signed = function (v) {
    return (v > 32767 ? v - 65536 : v) / 32767;
  };
  for (let t = 0; t < tracks; ++t) {
    for (let c = 0; c < 3; ++c) {
      const i = 3 * t + c,
        a = 3 * tracks * k + i,
        b = 3 * tracks * next + i,
        way = step[t] * (displacement[b] - displacement[a]),
        begin = h * fastest[t] * signed(velocity[a]) - way,
        end = h * fastest[t] * signed(velocity[b]) - way;
      const moved = low[i] + step[t] * displacement[a] + f * way + bend * ((1 - f) * begin - f * end);
      poses.x[i] = start[i] + scale * moved;
    }
    turnAt(rotation, 4 * (tracks * k + t), 4 * (tracks * next + t), f, scale, signed, poses.q, 4 * t);
  }
  return poses;
}

// The rotation between two quaternions at a and b of a list, its angle times scale.
function turnAt(rotation, a, b, f, scale, signed, out, at) {
  const q = [0, 0, 0, 0];
  let dot = 0,
    norm = 0;
  for (let c = 0; c < 4; ++c) dot += signed(rotation[a + c]) * signed(rotation[b + c]);
  for (let c = 0; c < 4; ++c) {
    const p = signed(rotation[a + c]);
    q[c] = p + f * ((dot < 0 ? -1 : 1) * signed(rotation[b + c]) - p);
    norm += q[c] * q[c];
  }
  norm = (q[3] < 0 ? -1 : 1) * Math.sqrt(norm) || 1; // of the two that are one rotation that of the smaller angle
  let part = 1 / norm,
    w = q[3] / norm;
  if (scale !== 1) {
    const half = Math.acos(Math.min(1, w)),
      sine = Math.sin(half);
    part = sine > 1e-9 ? Math.sin(scale * half) / sine / norm : scale / norm;
    w = Math.cos(scale * half);
  }
  for (let c = 0; c < 3; ++c) out[at + c] = q[c] * part;
  out[at + 3] = w;
}

function number(v, digits) {
  if (typeof v !== "number" || !Number.isFinite(v)) return String(v);
  const rounded = Number(v.toPrecision(digits || 5));
  return rounded !== 0 && Math.abs(rounded) < 1e-3 ? rounded.toExponential() : String(rounded);
}
function withUnit(text, unit) {
  return unit ? text + " [" + unit + "]" : text;
}
