// Cameras.

const copyCamera = ({ eye, forward, up, fov, height }) => ({
  eye: [...eye], forward: unit(forward), up: uprightFor(unit(forward), up), fov: height ? null : fov ?? 0.9, height: height ?? null,
});

const rightOf = (camera) => cross(camera.forward, camera.up);

/** Returns half of the height of the picture at the given depth. */
const halfHeight = (camera, depth) => (camera.height ? camera.height / 2 : Math.tan(camera.fov / 2) * depth);

/** Returns the range of depths that contains the scene. */
function depthRange(camera, mesh) {
  const middle = dot(camera.forward, subtract(mesh.middle, camera.eye));
  const half = dot(camera.forward.map(Math.abs), mesh.half) + 1e-4 * mesh.size;
  const far = Math.max(middle + half, 1e-3 * mesh.size);
  return [Math.max(middle - half, camera.height ? 0 : 3e-4 * far), far];
}

/** Returns the matrix from positions relative to the middle of the scene to clip coordinates, column by column. */
function clipMatrix(camera, mesh, aspect) {
  const [near, far] = depthRange(camera, mesh);
  const eye = subtract(camera.eye, mesh.middle);
  const scale = 1 / halfHeight(camera, 1);
  const row = (axis, factor, shift = 0) => [...times(axis, factor), shift - factor * dot(axis, eye)];
  const rows = [row(rightOf(camera), scale / aspect), row(camera.up, scale)];
  if (camera.height) rows.push(row(camera.forward, 2 / (far - near), -(far + near) / (far - near)), [0, 0, 0, 1]);
  else rows.push(row(camera.forward, (far + near) / (far - near), (-2 * far * near) / (far - near)), row(camera.forward, 1));
  return new Float32Array([0, 1, 2, 3].flatMap((column) => rows.map((r) => r[column])));
}

/** Returns the place of a point in the picture, as fractions from the left and the top, and its depth. */
function project(camera, aspect, point) {
  const offset = subtract(point, camera.eye);
  const depth = dot(camera.forward, offset);
  const half = halfHeight(camera, depth);
  return { x: 0.5 + dot(rightOf(camera), offset) / (2 * half * aspect), y: 0.5 - dot(camera.up, offset) / (2 * half), depth };
}

/** Returns the ray through a place of the picture. */
function rayThrough(camera, aspect, x, y) {
  const half = halfHeight(camera, 1);
  const offset = add(times(rightOf(camera), (2 * x - 1) * half * aspect), times(camera.up, (1 - 2 * y) * half));
  if (camera.height) return { origin: add(camera.eye, offset), direction: camera.forward };
  return { origin: camera.eye, direction: unit(add(camera.forward, offset)) };
}

/** Turns the camera by angles about the scene's up direction and its own horizontal. Both go through the pivot. */
function turn(camera, worldUp, yaw, pitch, pivot) {
  const steps = [[worldUp, yaw]];
  const right = rightOf(camera);
  const next = dot(rotate(camera.forward, right, pitch), worldUp);
  // The view does not tilt over the poles.
  if (Math.abs(next) < 0.9995 || Math.abs(next) < Math.abs(dot(camera.forward, worldUp))) steps.unshift([right, pitch]);
  for (const [axis, angle] of steps) {
    camera.eye = add(pivot, rotate(subtract(camera.eye, pivot), axis, angle));
    camera.forward = unit(rotate(camera.forward, axis, angle));
    camera.up = uprightFor(camera.forward, rotate(camera.up, axis, angle));
  }
}

/** Moves the camera along its direction until the whole scene is in the picture. */
function fitCamera(camera, mesh, aspect) {
  const axes = [rightOf(camera), camera.up, camera.forward];
  let distance = 0;
  let half = 0;
  for (let corner = 0; corner < 8; corner += 1) {
    const offset = mesh.half.map((x, k) => ((corner >> k) & 1 ? x : -x));
    const [x, y, z] = axes.map((axis) => dot(axis, offset));
    const extent = Math.max(Math.abs(x) / aspect, Math.abs(y));
    half = Math.max(half, extent);
    if (!camera.height) distance = Math.max(distance, extent / halfHeight(camera, 1) - z);
  }
  if (camera.height) {
    camera.height = 2.1 * half;
    distance = mesh.size;
  }
  camera.eye = subtract(mesh.middle, times(camera.forward, 1.04 * distance));
}
