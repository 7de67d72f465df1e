// Legend of false colors.

function makeLegend(viewer) {
  const track = byId('legend-track');
  const handles = [byId('handle-low'), byId('handle-high')];
  let axis = null;
  let dragged = -1;
  let shown = '';

  const onAxis = (value) => (viewer.state.logarithmic ? Math.log(value) : value);
  const fromAxis = (x) => (viewer.state.logarithmic ? Math.exp(x) : x);

  /** Returns the ends of the axis: it is somewhat longer than the range of the colors. */
  function ends() {
    const [low, high] = viewer.limitsOf().map(onAxis);
    const more = 0.15 * (high - low);
    return [viewer.state.logarithmic ? low - more : Math.max(0, low - more), high + more];
  }

  function move(which, x) {
    const limits = viewer.limitsOf();
    const other = onAxis(limits[1 - which]);
    const least = 0.01 * (axis[1] - axis[0]);
    const place = which === 0 ? Math.min(x, other - least) : Math.max(x, other + least);
    limits[which] = Number(Math.max(0, fromAxis(place)).toPrecision(4));
    viewer.setLimits(limits);
  }

  function drag(which, event) {
    const box = track.getBoundingClientRect();
    const share = clamp((event.clientX - box.left) / box.width, 0, 1);
    move(which, axis[0] + share * (axis[1] - axis[0]));
  }

  function press(which, event) {
    const small = 0.02 * (axis[1] - axis[0]);
    const steps = { ArrowLeft: -small, ArrowDown: -small, ArrowRight: small, ArrowUp: small, PageDown: -5 * small, PageUp: 5 * small };
    if (event.key in steps) move(which, onAxis(viewer.limitsOf()[which]) + steps[event.key]);
    else if (event.key === 'Home' || event.key === 'End') viewer.setLimits(null);
    else return;
    event.preventDefault();
  }

  handles.forEach((handle, which) => {
    handle.addEventListener('pointerdown', (event) => {
      dragged = which;
      handle.setPointerCapture(event.pointerId);
      handle.focus();
      event.preventDefault();
    });
    handle.addEventListener('pointermove', (event) => { if (dragged === which) drag(which, event); });
    for (const name of ['pointerup', 'pointercancel']) {
      handle.addEventListener(name, () => {
        dragged = -1;
        viewer.redraw();
      });
    }
    handle.addEventListener('keydown', (event) => press(which, event));
  });

  /** Shows the present limits. The axis stays while a handle is dragged. */
  function update() {
    const { state } = viewer;
    byId('legend').hidden = state.mode === 'lit';
    if (state.mode === 'lit') return;
    const kind = viewer.values.kinds[state.mode];
    const limits = viewer.limitsOf();
    const key = [state.mode, state.logarithmic, dragged, track.clientWidth, ...limits].join();
    if (key === shown) return;
    shown = key;
    if (dragged < 0) axis = ends();
    const share = (value) => (onAxis(value) - axis[0]) / (axis[1] - axis[0]);
    byId('legend-title').textContent = `${kind.title}, ${kind.unit}${state.mode === 'error' ? '. Gray: not known' : ''}`;
    drawBar(limits.map(share));
    limits.forEach((limit, which) => {
      const text = `${limitSign(which, limit)}${digits(limit)}`;
      handles[which].style.left = `${100 * clamp(share(limit), 0, 1)}%`;
      fill(handles[which], {
        'aria-valuemin': plain(fromAxis(axis[0]), 4), 'aria-valuemax': plain(fromAxis(axis[1]), 4), 'aria-valuenow': plain(limit, 4), 'aria-valuetext': `${text} ${kind.unit}`,
      }, []);
    });
    drawTicks(limits, share);
  }

  const limitSign = (which, limit) => (which === 1 ? '≥ ' : limit > 0 ? '≤ ' : '');

  function drawBar([low, high]) {
    const bar = byId('legend-bar');
    const context = bar.getContext('2d');
    const pixels = context.createImageData(bar.width, 1);
    for (let x = 0; x < bar.width; x += 1) {
      const t = ((x + 0.5) / bar.width - low) / Math.max(1e-9, high - low);
      pixels.data.set([...viridis(t), 255], 4 * x);
    }
    context.putImageData(pixels, 0, 0);
  }

  function drawTicks(limits, share) {
    const room = track.clientWidth / 58;
    const [low, high] = axis.map(fromAxis);
    const ticks = viewer.state.logarithmic ? logTicks(low, high, room) : linearTicks(low, high, room);
    const at = (value) => ({ left: `${100 * clamp(share(value), 0, 1)}%` });
    // The numbers of the limits stay inside of the legend.
    const inside = (value) => ({ ...at(value), transform: `translateX(${-clamp(100 * share(value), 12, 88)}%)` });
    byId('legend-ticks').replaceChildren(
      ...ticks.flatMap((tick) => [element('i', { style: at(tick) }), element('span', { style: at(tick) }, tickText(tick))]),
      ...limits.map((limit, which) => element('span', { class: 'limit', style: inside(limit) }, `${limitSign(which, limit)}${digits(limit)}`)),
    );
  }

  return { update };
}
