// Reading the mesh.

/** Share of a value of light below which its difference from another one is rounding of the codes. */
const ROUNDING = 1e-3;

function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i += 1) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  try {
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch {
    throw new Error('Its data are damaged.');
  }
}

/** Splits the container into its header and the bytes of its arrays. */
function openContainer(bytes) {
  const size = new DataView(bytes.buffer, bytes.byteOffset, 4).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + size)));
  return { header, body: bytes.subarray(4 + size) };
}

/** Decodes an array: planes of bytes, zigzag codes, differences. Returns `null` if it is absent. */
function decodeArray({ header, body }, name) {
  const form = header.arrays[name];
  if (!form) return null;
  const { stride, count, bytes: width } = form;
  const values = new ({ 1: Uint8Array, 2: Uint16Array, 4: Uint32Array })[width](stride * count);
  const decode = { 1: decodeBytes, 2: decodeShorts, 4: decodeWords }[width];
  if (form.offset + stride * count * width > body.length) throw new Error(`The array ${name} of the mesh is cut off.`);
  for (let component = 0; component < stride; component += 1) {
    const start = form.offset + component * width * count;
    decode(body.subarray(start, start + width * count), values, component, stride, count, form.plain === true);
  }
  return values;
}

function decodeBytes(planes, values, component, stride, count, isPlain) {
  let sum = 0;
  for (let i = 0, at = component; i < count; i += 1, at += stride) {
    const z = planes[i];
    sum = isPlain ? z : (sum + ((z >>> 1) ^ -(z & 1))) & 0xff;
    values[at] = sum;
  }
}

function decodeShorts(planes, values, component, stride, count, isPlain) {
  let sum = 0;
  for (let i = 0, at = component; i < count; i += 1, at += stride) {
    const z = planes[i] | (planes[count + i] << 8);
    sum = isPlain ? z : (sum + ((z >>> 1) ^ -(z & 1))) & 0xffff;
    values[at] = sum;
  }
}

function decodeWords(planes, values, component, stride, count, isPlain) {
  const [p1, p2, p3] = [count, 2 * count, 3 * count];
  let sum = 0;
  for (let i = 0, at = component; i < count; i += 1, at += stride) {
    const z = planes[i] | (planes[p1 + i] << 8) | (planes[p2 + i] << 16) | (planes[p3 + i] << 24);
    sum = isPlain ? z : (sum + ((z >>> 1) ^ -(z & 1))) | 0;
    values[at] = sum;
  }
}

/** Restores red and blue, which are stored as differences from green: (g, r − g, b − g). */
function restoreColors(codes) {
  if (!codes) return null;
  for (let i = 0; i < codes.length; i += 3) {
    const green = codes[i];
    codes[i] = codes[i + 1] + green;
    codes[i + 1] = green;
    codes[i + 2] += green;
  }
  return codes;
}

/** Restores the numbers of vertices from codes that count back from the next new vertex. */
function restoreIndex(codes, vertices) {
  let next = 0;
  let largest = 0;
  for (let i = 0; i < codes.length; i += 1) {
    const code = codes[i];
    const vertex = next - code;
    if (code === 0) next += 1;
    if (vertex < 0) throw new Error('A triangle of the mesh names a vertex that does not exist.');
    if (vertex > largest) largest = vertex;
    codes[i] = vertex;
  }
  if (codes.length > 0 && largest >= vertices) throw new Error('A triangle of the mesh names a vertex that does not exist.');
  return codes;
}

/** Returns the value of each of the 65,536 codes on a logarithmic scale. */
function logTable(log) {
  const table = new Float32Array(65536);
  if (!log) return table;
  for (let code = 1; code < 65536; code += 1) table[code] = Math.exp(log.low + (code - 1) * log.step);
  return table;
}

/** Reads the mesh from the text of the page. */
async function readMesh(text) {
  const container = openContainer(await inflate(bytesOfBase64(text)));
  const { header } = container;
  await pause();
  const get = (name) => decodeArray(container, name);
  const mesh = {
    header,
    codes: restoreColors(get('vertexIrradiance')),
    index: restoreIndex(get('index'), header.vertices),
    sideTriangles: get('sideTriangles'),
    patch: get('patch'),
    triangle: get('triangle'),
    material: get('material'),
    object: get('object'),
    area: get('area'),
  };
  placeVertices(mesh, get('position'));
  await pause();
  fillSides(mesh, restoreColors(get('sideIrradiance')), get);
  await pause();
  nameTriangles(mesh);
  return mesh;
}

/** Sets positions relative to the middle of the scene, where single precision is best. */
function placeVertices(mesh, grid) {
  const { origin, step } = mesh.header;
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < grid.length; i += 3) {
    for (let k = 0; k < 3; k += 1) {
      const x = grid[i + k];
      if (x < low[k]) low[k] = x;
      if (x > high[k]) high[k] = x;
    }
  }
  const middle = low.map((x, k) => (Number.isFinite(x) ? (x + high[k]) / 2 : 0));
  mesh.middle = middle.map((x, k) => origin[k] + step * x);
  mesh.half = middle.map((x, k) => Math.max(0, (high[k] - x) * step) || 0);
  mesh.size = Math.max(2 * length(mesh.half), 1e-6);
  mesh.position = new Float32Array(grid.length);
  for (let i = 0; i < grid.length; i += 3) {
    for (let k = 0; k < 3; k += 1) mesh.position[i + k] = (grid[i + k] - middle[k]) * step;
  }
}

/** Width of a texture with one texel per side or vertex. */
const TEXTURE_WIDTH = 2048;
const textureRows = (count) => Math.max(1, Math.ceil(count / TEXTURE_WIDTH));

/**
 * Fills three arrays with four numbers per side, as the textures have them: `light` (E of the bands, error of E), `surface`
 * (reflectance of the bands, direct E) and `source` (exitance of the bands).
 */
function fillSides(mesh, irradiance, get) {
  const { sides, logs } = mesh.header;
  const room = 4 * TEXTURE_WIDTH * textureRows(sides);
  const light = new Float32Array(room);
  const surface = new Float32Array(room);
  const source = new Float32Array(room);
  const [tableE, tableError, tableDirect] = [logs.irradiance, logs.error, logs.direct].map(logTable);
  const [tableRho, tableM] = [logs.reflectance, logs.exitance].map(logTable);
  const [error, direct, reflectance, exitance] = ['sideError', 'sideDirect', 'reflectance', 'exitance'].map(get);
  [reflectance, exitance].forEach(restoreColors);
  for (let s = 0, i = 0, j = 0; s < sides; s += 1, i += 4, j += 3) {
    for (let k = 0; k < 3; k += 1) {
      light[i + k] = tableE[irradiance[j + k]];
      surface[i + k] = tableRho[reflectance[j + k]];
      source[i + k] = tableM[exitance[j + k]];
    }
    if (error) light[i + 3] = tableError[error[s]];
    if (direct) surface[i + 3] = tableDirect[direct[s]];
  }
  Object.assign(mesh, { light, surface, source, hasError: error !== null && error.some((code) => code > 0), hasDirect: direct !== null });
}

/**
 * Gives each side vertices that carry its number, one as the last of each of its triangles. Triangles are turned where this
 * helps. Otherwise the vertex is duplicated.
 */
function nameTriangles(mesh) {
  const { index, sideTriangles } = mesh;
  const { vertices, sides, triangles } = mesh.header;
  const FREE = 0xffffffff;
  const owner = new Uint32Array(vertices).fill(FREE);
  const copies = [];
  const copyOwners = [];
  let at = 0;
  for (let side = 0; side < sides; side += 1) {
    for (const end = at + 3 * sideTriangles[side]; at < end; at += 3) {
      const a = index[at];
      const b = index[at + 1];
      const c = index[at + 2];
      const ownerA = owner[a];
      const ownerB = owner[b];
      const ownerC = owner[c];
      if (ownerC === side) continue;
      if (ownerA === side || (ownerC !== FREE && ownerB !== side && ownerA === FREE)) {
        owner[a] = side;
        index[at] = b; index[at + 1] = c; index[at + 2] = a;
      } else if (ownerB === side || (ownerC !== FREE && ownerB === FREE)) {
        owner[b] = side;
        index[at] = c; index[at + 1] = a; index[at + 2] = b;
      } else if (ownerC === FREE) {
        owner[c] = side;
      } else {
        index[at + 2] = vertices + copies.length;
        copies.push(c);
        copyOwners.push(side);
      }
    }
  }
  if (at !== 3 * triangles || at !== index.length) throw new Error('The triangles of the mesh do not fit its sides.');
  mesh.copies = copies;
  mesh.owner = joined(Uint32Array, owner, copyOwners);
  mesh.position = withCopies(Float32Array, mesh.position, copies);
  mesh.codes = withCopies(Uint16Array, mesh.codes, copies);
}

/** Appends copies of the given vertices, of three numbers each. */
function withCopies(Type, data, copies) {
  const added = new Type(3 * copies.length);
  copies.forEach((vertex, i) => added.set(data.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
  return joined(Type, data, added);
}

function joined(Type, first, second) {
  if (second.length === 0) return first;
  const all = new Type(first.length + second.length);
  all.set(first);
  all.set(second, first.length);
  return all;
}

/**
 * Returns the edges on the outlines of all sides: two ends, and the third vertex of the triangle, which tells where the edge
 * is seen from.
 */
function findOutlines(mesh) {
  const { index, sideTriangles, copies } = mesh;
  const { vertices, sides } = mesh.header;
  const original = (i) => (index[i] < vertices ? index[i] : copies[index[i] - vertices]);
  let edges = new Uint32Array(3 * 4 * sides + 300);
  let used = 0;
  let at = 0;
  const from = [];
  const to = [];
  for (let side = 0; side < sides; side += 1) {
    const count = 3 * sideTriangles[side];
    for (let i = 0; i < count; i += 1) {
      from[i] = original(at + i);
      to[i] = original(at + (i % 3 === 2 ? i - 2 : i + 1));
    }
    const shared = count > 60 ? new Set(from.slice(0, count).map((a, i) => a * vertices + to[i])) : null;
    for (let i = 0; i < count; i += 1) {
      if (shared ? shared.has(to[i] * vertices + from[i]) : hasEdge(from, to, count, to[i], from[i])) continue;
      if (used + 3 > edges.length) edges = joined(Uint32Array, edges, new Uint32Array(edges.length));
      // Neighbors draw their common edge alike.
      edges[used] = Math.min(from[i], to[i]);
      edges[used + 1] = Math.max(from[i], to[i]);
      const third = i % 3 === 0 ? to[i + 1] : from[i - 1];
      // The highest bit tells that the two ends are exchanged.
      edges[used + 2] = from[i] < to[i] ? third : (third | 0x80000000) >>> 0;
      used += 3;
    }
    at += count;
  }
  return edges.subarray(0, used);
}

function hasEdge(from, to, count, a, b) {
  for (let i = 0; i < count; i += 1) if (from[i] === a && to[i] === b) return true;
  return false;
}
