// Pointer and keys.

/** Distance that a pointer moves before a click becomes a drag, in CSS pixels. */
const SLACK = 4;

function addPointer(canvas, viewer, pickTime) {
  const pointers = new Map();
  const { mesh, facts } = viewer;
  let gesture = null;
  let hoverTimer = 0;
  let wheelHit = null;

  const fractions = ({ clientX, clientY }) => {
    const box = canvas.getBoundingClientRect();
    return [(clientX - box.left) / box.width, (clientY - box.top) / box.height];
  };
  const moved = () => {
    viewer.state.moved = true;
    viewer.changed();
  };

  /** Returns the point at a place of the picture, or else one in the middle of the scene. */
  function pivotAt([x, y]) {
    const hit = viewer.pickAt(x, y);
    if (hit) return hit.point;
    const { camera } = viewer.state;
    const depth = dot(camera.forward, subtract(mesh.middle, camera.eye));
    if (depth > 0.05 * mesh.size) return mesh.middle;
    return add(camera.eye, times(camera.forward, 0.25 * mesh.size));
  }

  function pan(dx, dy, point) {
    const { camera } = viewer.state;
    const depth = Math.max(1e-3 * mesh.size, dot(camera.forward, subtract(point, camera.eye)));
    const scale = (2 * halfHeight(camera, depth)) / canvas.clientHeight;
    camera.eye = add(camera.eye, add(times(rightOf(camera), -dx * scale), times(camera.up, dy * scale)));
    moved();
  }

  /** Changes the distance to a point, or the height of an orthographic view, by a factor. The point stays where it is in the picture. */
  function zoom(factor, point) {
    const { camera } = viewer.state;
    if (camera.height) {
      const offset = subtract(point, camera.eye);
      const aside = subtract(offset, times(camera.forward, dot(offset, camera.forward)));
      camera.eye = add(camera.eye, times(aside, 1 - factor));
      camera.height *= factor;
    } else {
      camera.eye = add(point, times(subtract(camera.eye, point), factor));
    }
    moved();
  }

  function rotateBy(dx, dy) {
    const { state } = viewer;
    const angle = state.walk ? halfAngle(state.camera) / canvas.clientHeight : Math.PI / Math.max(300, canvas.clientHeight);
    const sign = state.walk ? 1 : -1;
    turn(state.camera, facts.up, sign * dx * angle, sign * dy * angle, state.walk ? state.camera.eye : gesture.pivot);
    moved();
  }

  const halfAngle = (camera) => 1.2 * (camera.fov ?? 0.9);

  function beginGesture() {
    const points = [...pointers.values()];
    const middle = { clientX: points.reduce((sum, p) => sum + p.clientX, 0) / points.length, clientY: points.reduce((sum, p) => sum + p.clientY, 0) / points.length };
    const spread = points.length > 1 ? Math.hypot(points[0].clientX - points[1].clientX, points[0].clientY - points[1].clientY) : 0;
    return { middle, spread };
  }

  canvas.addEventListener('pointerdown', (event) => {
    hideReadout();
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
    gesture = { ...beginGesture(), start: event, shifts: event.shiftKey || event.button !== 0, isClick: pointers.size === 1 && event.button === 0, pivot: null };
  });

  canvas.addEventListener('pointermove', (event) => {
    wheelHit = null;
    if (!pointers.has(event.pointerId) || !gesture) return hover(event);
    pointers.set(event.pointerId, event);
    const next = beginGesture();
    const dx = next.middle.clientX - gesture.middle.clientX;
    const dy = next.middle.clientY - gesture.middle.clientY;
    if (gesture.isClick && Math.hypot(dx, dy) < SLACK && pointers.size === 1) return undefined;
    gesture.isClick = false;
    canvas.classList.add('dragging');
    gesture.pivot ??= viewer.state.walk && pointers.size === 1 && !gesture.shifts ? viewer.state.camera.eye : pivotAt(fractions(gesture.middle));
    if (pointers.size > 1 || gesture.shifts) pan(dx, dy, gesture.pivot);
    else rotateBy(dx, dy);
    if (next.spread > 0 && gesture.spread > 0) zoom(clamp(gesture.spread / next.spread, 0.5, 2), gesture.pivot);
    Object.assign(gesture, next);
    return undefined;
  });

  function end(event) {
    if (!pointers.delete(event.pointerId)) return;
    if (gesture?.isClick && event.type === 'pointerup') click(event);
    gesture = pointers.size > 0 ? { ...beginGesture(), shifts: false, isClick: false, pivot: null } : null;
    if (!gesture) canvas.classList.remove('dragging');
  }
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
  canvas.addEventListener('lostpointercapture', end);

  function click(event) {
    const hit = viewer.pickAt(...fractions(event));
    if (!hit) return;
    viewer.picks.add(hit);
    viewer.changed();
  }

  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    hideReadout();
    wheelHit ??= pivotAt(fractions(event));
    const lines = event.deltaMode === 1 ? 30 : event.deltaMode === 2 ? 300 : 1;
    zoom(Math.exp(clamp(event.deltaY * lines, -300, 300) * 0.0012), wheelHit);
  }, { passive: false });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('pointerleave', hideReadout);

  /** Reads the patch under a pointer that rests. It rests longer where reading is slow. */
  function hover(event) {
    clearTimeout(hoverTimer);
    if (event.pointerType === 'touch') return undefined;
    hoverTimer = setTimeout(() => {
      const hit = viewer.pickAt(...fractions(event));
      if (hit) showReadout(hit.side);
      else hideReadout();
    }, clamp(2 * pickTime(), 30, 500));
    return undefined;
  }

  function showReadout(side) {
    const of = viewer.values.ofSide(side);
    const error = of.error > 0 ? ` ± ${digits(of.error, 2)}` : '';
    byId('readout').textContent = `E ${digits(of.e)}${error} ${viewer.values.unitE} · B ${digits(of.b)} ${viewer.values.unitB} · ${cut(of.material, 40)} · ${cut(of.object, 40)}`;
    byId('readout').hidden = false;
  }

  function hideReadout() {
    clearTimeout(hoverTimer);
    byId('readout').hidden = true;
  }
}

function addKeys(canvas, viewer) {
  const { mesh, facts } = viewer;
  const held = new Set();
  let last = 0;
  let isWalking = false;
  const MOVES = {
    KeyW: [0, 0, 1], ArrowUp: [0, 0, 1], KeyS: [0, 0, -1], ArrowDown: [0, 0, -1], KeyA: [-1, 0, 0], ArrowLeft: [-1, 0, 0],
    KeyD: [1, 0, 0], ArrowRight: [1, 0, 0], KeyQ: [0, -1, 0], KeyE: [0, 1, 0],
  };
  const TURNS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

  const moved = () => {
    viewer.state.moved = true;
    viewer.changed();
  };

  /** Moves the eye for as long as keys are held. */
  function walk(now) {
    const seconds = Math.min(0.25, Math.max(0, now - last) / 1000);
    last = now;
    isWalking = viewer.state.walk && [...held].some((key) => key in MOVES);
    if (!isWalking) return;
    const { camera } = viewer.state;
    const ahead = uprightFor(facts.up, Math.abs(dot(camera.forward, facts.up)) > 0.99 ? camera.up : camera.forward);
    const speed = (held.has('Shift') ? 0.3 : 0.1) * mesh.size * seconds;
    for (const key of held) {
      const [right, up, forward] = MOVES[key] ?? [0, 0, 0];
      camera.eye = add(camera.eye, times(add(add(times(rightOf(camera), right), times(facts.up, up)), times(ahead, forward)), speed));
      if (camera.height && forward !== 0) camera.height *= Math.exp(-forward * seconds);
    }
    moved();
    requestAnimationFrame(walk);
  }

  function orbit(code) {
    const [yaw, pitch] = TURNS[code];
    turn(viewer.state.camera, facts.up, yaw * 0.08, pitch * 0.08, mesh.middle);
    moved();
  }

  function nearer(factor) {
    const { camera } = viewer.state;
    if (camera.height) camera.height *= factor;
    else camera.eye = add(camera.eye, times(camera.forward, (factor < 1 ? 0.04 : -0.04) * mesh.size));
    moved();
  }

  function pickMiddle() {
    const hit = viewer.pickAt(0.5, 0.5);
    if (hit) viewer.picks.add(hit);
    viewer.changed();
  }

  function leaveFull() {
    if (!viewer.state.full) return;
    viewer.state.full = false;
    setFull(false);
    viewer.changed();
  }

  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const { state } = viewer;
    const one = { '+': () => nearer(0.85), '=': () => nearer(0.85), '-': () => nearer(1 / 0.85), Enter: pickMiddle, f: viewer.fit, F: viewer.fit, Escape: leaveFull }[event.key];
    if (state.walk && (event.code in MOVES || event.key === 'Shift')) {
      held.add(event.key === 'Shift' ? 'Shift' : event.code);
      if (!isWalking && event.code in MOVES) {
        isWalking = true;
        last = performance.now();
        requestAnimationFrame(walk);
      }
    } else if (event.code in TURNS) {
      orbit(event.code);
    } else if (one) {
      one();
    } else {
      return;
    }
    event.preventDefault();
  });
  canvas.addEventListener('keyup', (event) => held.delete(event.key === 'Shift' ? 'Shift' : event.code));
  canvas.addEventListener('blur', () => held.clear());
  document.addEventListener('keydown', (event) => { if (event.key === 'Escape') leaveFull(); });
}
