// Vectors.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => times(a, 1 / (length(a) || 1));

/** Rotates a vector about a unit axis. */
function rotate(v, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return add(add(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1 - c)));
}

/** Returns a unit vector perpendicular to `forward`, as near to `up` as possible. */
function uprightFor(forward, up) {
  const rest = subtract(up, times(forward, dot(up, forward)));
  if (length(rest) > 1e-4) return unit(rest);
  return uprightFor(forward, Math.abs(forward[0]) < 0.7 ? [1, 0, 0] : [0, 1, 0]);
}
