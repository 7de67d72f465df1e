// Controls.

function makeControls(viewer, picks) {
  const { values, facts, mesh } = viewer;
  const on = (id, event, action) => byId(id).addEventListener(event, action);
  /** Adds an action that changes the state. */
  const set = (id, event, change) => on(id, event, () => {
    change(viewer.state, byId(id));
    viewer.changed();
  });

  for (const mode of MODES) {
    const kind = values.kinds[mode];
    const text = kind.absent ? `${kind.label} (not known)` : kind.label;
    byId('mode').append(element('option', { value: mode, disabled: kind.absent ? '' : null }, text));
  }
  facts.cameras.forEach((camera, i) => byId('camera').append(element('option', { value: i }, cut(camera.name || `Camera ${i + 1}`, 60))));

  byId('panel').addEventListener('submit', (event) => event.preventDefault());
  set('mode', 'change', (state, input) => { state.mode = input.value; });
  set('exposure', 'input', (state, input) => { state.exposure = Number(input.value); });
  set('exposure-reset', 'click', (state) => { state.exposure = 0; });
  set('scale', 'change', (state, input) => { state.logarithmic = input.value === 'log'; });
  set('flat', 'change', (state, input) => { state.flat = input.value === '1'; });
  set('mesh-lines', 'change', (state, input) => { state.lines = input.checked; });
  set('section-axis', 'change', (state, input) => { state.axis = input.value; });
  set('section-at', 'input', (state, input) => { state.at = Number(input.value); });
  set('section-flip', 'click', (state) => { state.flipped = !state.flipped; });
  set('motion', 'change', (state, input) => { state.walk = input.value === 'walk'; });
  set('full', 'click', (state) => { state.full = true; setFull(true); });
  on('limits-reset', 'click', () => viewer.setLimits(null));
  on('low', 'change', typeLimits);
  on('high', 'change', typeLimits);
  on('camera', 'change', () => viewer.showCamera(Number(byId('camera').value)));
  on('camera-reset', 'click', () => viewer.showCamera(viewer.state.chosen));
  on('fit', 'click', viewer.fit);
  on('picks-clear', 'click', () => { picks.clear(); viewer.changed(); });
  on('picks-copy', 'click', () => copyText(picks.csv(), byId('picks-copy'), byId('picks')));
  on('panel-toggle', 'click', () => {
    const closed = byId('viewer').classList.toggle('closed');
    byId('panel-toggle').setAttribute('aria-expanded', String(!closed));
    byId('panel-toggle').textContent = closed ? 'Show controls' : 'Hide controls';
  });

  /** Takes typed limits if they are in order, and shows the old ones if not. */
  function typeLimits() {
    const [low, high] = ['low', 'high'].map((id) => byId(id).valueAsNumber);
    if (low >= 0 && high > low && (low > 0 || !viewer.state.logarithmic)) viewer.setLimits([low, high]);
    else update();
  }

  function update() {
    const { state } = viewer;
    const kind = values.kinds[state.mode];
    const isLit = state.mode === 'lit';
    byId('mode').value = state.mode;
    byId('exposure-group').hidden = !isLit;
    byId('color-group').hidden = isLit;
    byId('flat-row').hidden = !['illuminance', 'radiosity'].includes(state.mode);
    byId('exposure').value = state.exposure;
    byId('exposure-text').textContent = `${state.exposure > 0 ? '+' : ''}${state.exposure.toFixed(1).replace('-', '−')} stops`;
    byId('scale').value = state.logarithmic ? 'log' : 'linear';
    byId('flat').value = state.flat ? '1' : '0';
    byId('mesh-lines').checked = state.lines;
    byId('section-axis').value = state.axis;
    byId('section-group').hidden = state.axis === '';
    byId('section-at').value = state.at;
    byId('section-flip').setAttribute('aria-pressed', String(state.flipped));
    const k = Math.max(0, 'xyz'.indexOf(state.axis));
    byId('section-text').textContent = `${state.axis} = ${meters(mesh.middle[k] + mesh.half[k] * (2 * state.at - 1))} m`;
    byId('camera').value = state.chosen;
    byId('motion').value = state.walk ? 'walk' : 'orbit';
    document.querySelectorAll('[data-unit]').forEach((node) => { node.textContent = kind.unit; });
    if (!isLit) viewer.limitsOf().forEach((limit, i) => { byId(['low', 'high'][i]).value = plain(limit, 4); });
    byId('canvas').setAttribute('aria-label', `${kind.title} of ${cut(facts.title)}, camera ${cut(facts.cameras[state.chosen].name || state.chosen + 1)}`);
  }

  return { update };
}
