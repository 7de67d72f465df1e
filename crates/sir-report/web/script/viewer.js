// Viewer.

/** Largest number of pixels of the canvas per CSS pixel. */
const FINEST = 2;
/** Number of triangles above which edges are not smoothed if the processor draws. */
const SLOW_TRIANGLES = 500000;

/** Shows a message in place of the view. */
function showMessage(text, action) {
  byId('message').hidden = text === null;
  byId('message-text').textContent = text ?? '';
  byId('message').querySelector('button')?.remove();
  if (action) byId('message').append(element('button', { type: 'button', on: { click: action.run } }, action.label));
}

/** Starts the viewer, or says why it cannot be used. */
async function startViewer(facts) {
  const graphics = probeGraphics();
  if (!graphics) return refuse('This browser has no WebGL 2, which the view of the scene needs.');
  if (typeof DecompressionStream === 'undefined') return refuse('This browser cannot decompress the scene (DecompressionStream), which the view needs.');
  await pause();
  try {
    const mesh = await readMesh(byId('mesh').textContent);
    await pause();
    const canvas = byId('canvas');
    const antialias = !(graphics.isSlow && mesh.header.triangles > SLOW_TRIANGLES);
    const gl = canvas.getContext('webgl2', { antialias, alpha: false, powerPreference: 'high-performance' });
    if (!gl) throw new Error('WebGL 2 does not start.');
    canvas.addEventListener('webglcontextlost', sayLost);
    const viewer = makeViewer(canvas, gl, mesh, facts);
    showMessage(null);
    viewer.start();
    return viewer;
  } catch (error) {
    return refuse(`The scene cannot be shown: ${error?.message ?? error}`);
  }
}

function sayLost(event) {
  event.preventDefault();
  showMessage('The graphics system has dropped the view.', { label: 'Reload the page', run: () => location.reload() });
}

/** Tells whether there is WebGL 2, and whether it is done by the processor, which is slow. */
function probeGraphics() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return null;
  let name = String(gl.getParameter(gl.RENDERER));
  if (name.startsWith('WebKit')) {
    const detail = gl.getExtension('WEBGL_debug_renderer_info');
    if (detail) name = String(gl.getParameter(detail.UNMASKED_RENDERER_WEBGL));
  }
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return { isSlow: /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name) };
}

function refuse(text) {
  fail(text);
  showMessage(cut(text, 500));
  byId('panel').hidden = true;
  byId('panel-toggle').hidden = true;
  byId('viewer').classList.add('refused');
  byId('picks').hidden = true;
  return null;
}

function makeViewer(canvas, gl, mesh, facts) {
  const renderer = makeRenderer(gl, mesh);
  const values = makeValues(mesh, facts);
  const link = readLink(location.hash, facts);
  let { state } = link;
  let frame = 0;
  let version = 0;
  let linkTimer = 0;
  let lastHit = null;
  let pickTime = 0;
  let printing = false;

  const aspect = () => canvas.clientWidth / Math.max(1, canvas.clientHeight);
  const viewer = { values, mesh, facts, get state() { return state; }, aspect, changed, pickAt, limitsOf, setLimits, showCamera, fit, replaceLight, redraw: requestDraw };
  const picks = makePicks(viewer);
  const legend = makeLegend(viewer);
  const controls = makeControls(viewer, picks);
  viewer.picks = picks;

  // Limits of the colors.

  /** Returns the limits of the present mode. A logarithmic scale begins above 0. */
  function limitsOf() {
    const usual = values.usualLimits(state.mode);
    let [low, high] = state.limits[state.mode] ?? usual;
    high ??= Math.max(usual[1], 2 * low);
    low ??= Math.min(usual[0], high / 2);
    if (state.logarithmic && !(low > 0)) low = Math.min(usual[0] || high / 1000, high / 10);
    return [low, high];
  }

  function setLimits(limits) {
    if (limits === null) delete state.limits[state.mode];
    else state.limits[state.mode] = limits;
    changed();
  }

  // Drawing.

  function view() {
    const { camera } = state;
    const eye = camera.height ? [...camera.forward, 0] : [...subtract(camera.eye, mesh.middle), 1];
    return { clip: clipMatrix(camera, mesh, aspect()), sectioned: state.axis !== '', section: sectionPlane(), eye: new Float32Array(eye) };
  }

  /** Returns the plane beyond which nothing is drawn, relative to the middle of the scene. */
  function sectionPlane() {
    const k = 'xyz'.indexOf(state.axis);
    if (state.axis === '') return new Float32Array([0, 0, 0, 1]);
    const at = mesh.half[k] * (2 * state.at - 1);
    const sign = state.flipped ? -1 : 1;
    // At the ends of the slider, sides in the plane are drawn.
    const plane = [0, 0, 0, sign * at + 1e-5 * mesh.size];
    plane[k] = sign;
    return new Float32Array(plane);
  }

  /** Returns the factor from radiance to screen values. */
  function exposure() {
    return facts.cameras[state.chosen].exposure * 2 ** state.exposure;
  }

  function look() {
    const mode = MODES.indexOf(state.mode);
    const number = mode === 0 ? [0, 1] : limitsOf().map((x) => (state.logarithmic ? Math.log(x) : x));
    return {
      mode, flat: mode !== 0 && state.flat, logarithmic: state.logarithmic, exposure: exposure(),
      limits: [number[0], 1 / Math.max(1e-30, number[1] - number[0])], background: background(mode),
      lines: state.lines, ink: [0, 0, 0, 0.6],
    };
  }

  function background(mode) {
    if (mode === 0 && facts.sky) return screenColor(times(facts.sky, exposure()));
    if (mode === 0) return state.full ? [0, 0, 0] : [0.07, 0.08, 0.09];
    if (printing) return [1, 1, 1];
    return root.dataset.theme === 'dark' ? [0.125, 0.149, 0.173] : [0.894, 0.910, 0.925];
  }

  function draw() {
    cancelAnimationFrame(frame);
    frame = 0;
    const scale = Math.min(FINEST, window.devicePixelRatio || 1);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((x) => Math.max(1, Math.round(x * scale)));
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
      version += 1;
    }
    if (gl.isContextLost()) return;
    renderer.draw(view(), look());
    picks.place();
    legend.update();
  }

  function requestDraw() {
    if (frame === 0) frame = requestAnimationFrame(draw);
  }

  /** Draws anew and writes the link a moment later. */
  function changed() {
    version += 1;
    requestDraw();
    controls.update();
    clearTimeout(linkTimer);
    linkTimer = setTimeout(saveLink, 250);
  }

  function saveLink() {
    const hash = writeLink(state, picks.list, facts, mesh.size);
    if (hash === location.hash) return;
    try {
      history.replaceState(null, '', hash);
    } catch {
      // A browser may refuse this for local files. The view works without it.
    }
  }

  // Picking.

  /** Finds the side at a place of the picture, as fractions from the left and the top. */
  function pickAt(x, y) {
    const [column, row] = [clamp(Math.floor(x * canvas.width), 0, canvas.width - 1), clamp(Math.floor(y * canvas.height), 0, canvas.height - 1)];
    const isSame = lastHit && lastHit.column === column && lastHit.row === row && lastHit.version === version;
    if (!isSame) {
      const start = performance.now();
      lastHit = { column, row, version, hit: gl.isContextLost() ? null : renderer.pick(view(), column, row) };
      pickTime = performance.now() - start;
    }
    return lastHit.hit;
  }

  // Newer light of the same patches.

  function replaceLight(next) {
    if (next.header.sides !== mesh.header.sides || next.codes.length !== mesh.codes.length) return location.reload();
    for (const name of ['light', 'surface', 'source', 'codes']) mesh[name].set(next[name]);
    Object.assign(mesh.header.logs, next.header.logs);
    renderer.updateLight();
    const marks = picks.list.map(({ side, point }) => ({ side, point }));
    picks.clear();
    marks.forEach((mark) => picks.add(mark));
    requestDraw();
  }

  // Cameras.

  function showCamera(chosen) {
    state.chosen = chosen;
    state.camera = copyCamera(facts.cameras[chosen]);
    state.moved = false;
    changed();
  }

  function fit() {
    fitCamera(state.camera, mesh, aspect());
    state.moved = true;
    changed();
  }

  // Printing: the picture of the view replaces the canvas.

  function beforePrint() {
    printing = true;
    draw();
    byId('stage').querySelector('.print-view')?.remove();
    const picture = element('img', { class: 'print-view', alt: canvas.getAttribute('aria-label'), src: pictureWithMarkers(canvas, picks.list, state.camera) });
    byId('stage').prepend(picture);
  }

  function afterPrint() {
    printing = false;
    byId('stage').querySelector('.print-view')?.remove();
    requestDraw();
  }

  // Links.

  function follow() {
    const next = readLink(location.hash, facts);
    state = next.state;
    applyTheme(state.theme);
    setFull(state.full);
    restorePicks(next);
    version += 1;
    controls.update();
    requestDraw();
  }

  function restorePicks({ picks: places, marks }) {
    picks.clear();
    marks.filter(({ side }) => side < mesh.header.sides).forEach((mark) => picks.add(mark));
    places.map(([x, y]) => pickAt(x, y)).filter((hit) => hit !== null).forEach((hit) => picks.add(hit));
  }

  function start() {
    applyTheme(state.theme);
    setFull(state.full);
    if (values.kinds[state.mode].absent) state.mode = 'lit';
    controls.update();
    draw();
    restorePicks(link);
    picks.place();
    addPointer(canvas, viewer, () => pickTime);
    addKeys(canvas, viewer);
    // A picture of the new size is drawn before the browser shows it.
    new ResizeObserver(draw).observe(canvas);
    window.addEventListener('hashchange', follow);
    window.addEventListener('beforeprint', beforePrint);
    window.addEventListener('afterprint', afterPrint);
    requestAnimationFrame(() => { root.dataset.ready = '1'; });
  }

  viewer.start = start;
  return viewer;
}

/** Returns the screen color of a radiance after exposure, as the shader does. */
function screenColor(color) {
  const peak = Math.min(Math.max(...color), 1e30);
  let mapped = color;
  if (peak > 0.5) {
    const compressed = 1 - 0.25 / peak;
    const kept = 1 / (1 + 0.1 * (peak - compressed));
    mapped = color.map((x) => compressed + (x * (compressed / peak) - compressed) * kept);
  }
  return mapped.map((x) => clamp(x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055, 0, 1));
}

/** Returns the picture of the view with the markers of the picks, as a data URL. */
function pictureWithMarkers(canvas, list, camera) {
  const picture = element('canvas', { width: canvas.width, height: canvas.height });
  const context = picture.getContext('2d');
  context.drawImage(canvas, 0, 0);
  const size = Math.max(1, canvas.width / 900);
  context.font = `600 ${13 * size}px sans-serif`;
  context.textBaseline = 'middle';
  for (const { number, point } of list) {
    const place = project(camera, canvas.width / canvas.height, point);
    if (!isVisible(place)) continue;
    const [x, y] = [place.x * canvas.width, place.y * canvas.height];
    const width = context.measureText(String(number)).width;
    context.fillStyle = '#c22a1f';
    context.strokeStyle = '#ffffff';
    context.lineWidth = 2 * size;
    context.beginPath();
    context.arc(x, y, 5 * size, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
    context.fillRect(x + 6 * size, y - 22 * size, width + 10 * size, 17 * size);
    context.fillStyle = '#ffffff';
    context.fillText(String(number), x + 11 * size, y - 13 * size);
  }
  return picture.toDataURL('image/png');
}

const isVisible = ({ x, y, depth }) => depth > 0 && x >= 0 && x <= 1 && y >= 0 && y <= 1;

function setFull(on) {
  root.classList.toggle('full', on);
  if (on) byId('canvas').focus({ preventScroll: true });
}
