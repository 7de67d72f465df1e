// State of the view and its link.

/** Returns the state of a page without a link. Cameras in it count from 0, in the link from 1. */
function freshState(facts) {
  return {
    mode: 'lit', logarithmic: false, limits: {}, flat: false, lines: false, exposure: 0,
    axis: '', at: 0.5, flipped: false, chosen: 0, camera: copyCamera(facts.cameras[0]), moved: false, walk: false, full: false, theme: null,
  };
}

const numbers = (text) => String(text ?? '').split(',').map(Number);
const isPoint = (list) => list.length === 3 && list.every(Number.isFinite);
const clamp = (x, low, high) => Math.min(high, Math.max(low, x));

/** Reads a state from the link. What is not understood is ignored. */
function readLink(hash, facts) {
  const given = new URLSearchParams(hash.replace(/^#/, ''));
  const state = freshState(facts);
  const mode = given.get('mode') === 'irradiance' ? 'illuminance' : given.get('mode');
  if (MODES.includes(mode)) state.mode = mode;
  state.logarithmic = given.get('scale') === 'log';
  const [low, high] = ['min', 'max'].map((name) => (given.has(name) ? Number(given.get(name)) : NaN));
  if (low >= 0 && high > low && Number.isFinite(high)) state.limits[state.mode] = [low, high];
  else if (!(low >= 0 && high >= 0) && (low >= 0 || high > 0)) state.limits[state.mode] = [low >= 0 ? low : null, high > 0 ? high : null];
  for (const [name, key] of [['flat', 'flat'], ['mesh', 'lines'], ['full', 'full'], ['walk', 'walk']]) state[key] = given.get(name) === '1';
  if (Number.isFinite(Number(given.get('exposure')))) state.exposure = clamp(Number(given.get('exposure')), -6, 6);
  const [axis, at, flip] = (given.get('section') ?? '').split(':');
  if (['x', 'y', 'z'].includes(axis)) Object.assign(state, { axis, at: clamp(Number(at ?? 0.5) || 0, 0, 1), flipped: flip === 'flip' });
  if (['light', 'dark'].includes(given.get('theme'))) state.theme = given.get('theme');
  const chosen = Number(given.get('camera') ?? 1) - 1;
  if (facts.cameras[chosen]) state.chosen = chosen;
  state.camera = copyCamera(facts.cameras[state.chosen]);
  readCamera(given, state, facts);
  return { state, picks: readPicks(given.get('pick')), marks: readMarks(given.get('marks')) };
}

function readCamera(given, state, facts) {
  const [eye, target, up] = ['eye', 'target', 'up'].map((name) => numbers(given.get(name)));
  if (!isPoint(eye) || !isPoint(target) || !(length(subtract(target, eye)) > 0)) return;
  const { camera } = state;
  camera.eye = eye;
  camera.forward = unit(subtract(target, eye));
  camera.up = uprightFor(camera.forward, isPoint(up) ? up : facts.up);
  const height = Number(given.get('height'));
  if (camera.height && height > 0) camera.height = height;
  state.moved = true;
}

/** Reads places to pick, as fractions of the picture. */
function readPicks(text) {
  return (text ?? '').split(';').map(numbers).filter((pair) => pair.length === 2 && pair.every((x) => x >= 0 && x <= 1)).slice(0, 100);
}

/** Reads picks of an earlier page: the side and the position. */
function readMarks(text) {
  return (text ?? '').split(';').map((item) => {
    const [side, place] = item.split(':');
    return { side: Number(side), point: numbers(place) };
  }).filter(({ side, point }) => Number.isInteger(side) && side >= 0 && isPoint(point)).slice(0, 100);
}

/** Writes the state as a link. */
function writeLink(state, picks, facts, size) {
  const items = [];
  const put = (name, value) => items.push(`${name}=${value}`);
  const point = (p) => p.map((x) => plain(x)).join(',');
  put('mode', state.mode);
  if (state.mode === 'lit' && state.exposure !== 0) put('exposure', plain(state.exposure, 3));
  if (state.mode !== 'lit') {
    if (state.logarithmic) put('scale', 'log');
    const [low, high] = state.limits[state.mode] ?? [];
    if (Number.isFinite(low)) put('min', plain(low, 5));
    if (Number.isFinite(high)) put('max', plain(high, 5));
    if (state.flat) put('flat', 1);
  }
  put('camera', state.chosen + 1);
  if (state.moved) {
    const { camera } = state;
    put('eye', point(camera.eye));
    put('target', point(add(camera.eye, times(camera.forward, size / 4))));
    if (dot(camera.up, uprightFor(camera.forward, facts.up)) < 1 - 1e-6) put('up', point(camera.up));
    if (camera.height) put('height', plain(camera.height));
  }
  if (state.walk) put('walk', 1);
  if (state.lines) put('mesh', 1);
  if (state.axis) put('section', `${state.axis}:${plain(state.at, 4)}${state.flipped ? ':flip' : ''}`);
  if (picks.length) put('marks', picks.map(({ side, point: p }) => `${side}:${point(p)}`).join(';'));
  if (state.theme) put('theme', state.theme);
  if (state.full) put('full', 1);
  return `#${items.join('&')}`;
}
