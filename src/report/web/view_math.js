// Small mathematics and objects that all drawn parts use. Quaternions are (x, y, z, w).
// out = a[i..] b[j..]
function quaternionTimes(a, i, b, j, out) {
  const ax = a[i],
    ay = a[i + 1],
    az = a[i + 2],
    aw = a[i + 3],
    bx = b[j],
    by = b[j + 1],
    bz = b[j + 2],
    bw = b[j + 3];
  out[0] = aw * bx + ax * bw + ay * bz - az * by;
  out[1] = aw * by - ax * bz + ay * bw + az * bx;
  out[2] = aw * bz + ax * by - ay * bx + az * bw;
  out[3] = aw * bw - ax * bx - ay * by - az * bz;
}

// Columns of the rotation, one after the other.
function axesOf(q) {
  const [x, y, z, w] = q;
  return [
    1 - 2 * (y * y + z * z),
    2 * (x * y + z * w),
    2 * (x * z - y * w),
    2 * (x * y - z * w),
    1 - 2 * (x * x + z * z),
    2 * (y * z + x * w),
    2 * (x * z + y * w),
    2 * (y * z - x * w),
    1 - 2 * (x * x + y * y),
  ];
}

// Two unit vectors across a vector that is not zero.
function acrossOf(along) {
  const isUpright = Math.abs(along.z) >= 0.9 * along.length();
  const first = new THREE.Vector3(isUpright ? 1 : 0, 0, isUpright ? 0 : 1).cross(along).normalize();
  return [first, first.clone().cross(along).normalize()];
}

// Pixels from a place to a segment of the screen.
function segmentDistance(px, py, a, b) {
  const dx = b[0] - a[0],
    dy = b[1] - a[1],
    l = dx * dx + dy * dy;
  const s = l > 0 ? Math.min(1, Math.max(0, ((px - a[0]) * dx + (py - a[1]) * dy) / l)) : 0;
  return Math.hypot(a[0] + s * dx - px, a[1] + s * dy - py);
}

// Segments between pairs of vertices, whose numbers are written in place.
function lineObject(vertices, colored, options) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
  if (colored) geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
  const object = new THREE.LineSegments(
    geometry,
    new THREE.LineBasicMaterial(Object.assign({vertexColors: colored}, options)),
  );
  object.frustumCulled = false;
  return object;
}
