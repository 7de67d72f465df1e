// Sensors.

/** Number of rows that a table of sensors shows at first. */
const FIRST_ROWS = 50;
/** Largest number of cells of a map that is drawn with numbers. */
const CELLS_WITH_NUMBERS = 400;

function writeSensors(facts) {
  const sensors = facts.sensors ?? [];
  if (sensors.length === 0) return;
  sensors.forEach((sensor) => attempt(writeSensor, sensor, facts));
  byId('sensors').hidden = false;
}

function writeSensor(sensor, facts) {
  const { points = [] } = sensor;
  const unitE = facts.units.irradiance;
  const copy = element('button', { type: 'button' }, 'Copy as CSV');
  const part = element('div', { class: 'sensor' },
    element('div', { class: 'heading' }, element('h3', { class: 'name' }, cut(sensor.name)), element('span', { class: 'tools' }, copy)),
    element('p', {}, cut(sensor.summary, 1000)));
  const requirements = sensor.report?.requirements ?? [];
  if (requirements.length > 0) part.append(requirementTable(requirements, unitE, sensor.name));
  copy.addEventListener('click', () => copyText(sensorCsv(sensor), copy, part));
  const pair = element('div', { class: 'pair' });
  if (sensor.map) pair.append(attempt(sensorMap, sensor, unitE, facts.units.name) ?? '');
  if (points.length > 0) pair.append(sensorTable(sensor, unitE));
  part.append(pair);
  byId('sensors').append(part);
}

/** Makes a table of what is required and what was measured. */
function requirementTable(requirements, unitE, name) {
  const names = { mean: 'Mean', minimum: 'Minimum', uniformity: 'Uniformity U₀', diversity: 'Diversity U_d', 'daylight factor': 'Mean daylight factor (%)', UGR: 'Largest UGR (at most)' };
  const hasUnit = (quantity) => quantity === 'mean' || quantity === 'minimum';
  const head = ['Quantity', 'Limit', 'Measured', '± σ', 'Verdict'].map((label, k) => element('th', { scope: 'col', class: k === 0 || k === 4 ? 'text' : '' }, label));
  const rows = requirements.map(({ quantity, required, measured, error, margin, verdict }) => {
    const label = `${names[quantity] ?? cut(quantity, 60)}${hasUnit(quantity) ? ` (${unitE})` : ''}`;
    const by = Number.isFinite(margin) ? `${verdict === 'undecided' ? ', ' : ' by '}${Math.abs(margin).toFixed(1)} standard errors` : '';
    const side = verdict !== 'undecided' ? '' : measured < required ? ' below' : ' above';
    return element('tr', {}, element('td', { class: 'text' }, label), ...[digits(required, 4), digits(measured, 4), digits(error, 2)].map((text) => element('td', {}, text)), element('td', { class: verdict === 'passes' ? 'text' : 'text doubtful' }, `${cut(verdict, 20)}${by}${side}`));
  });
  return element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `Requirements on ${cut(name)}` },
    element('table', {}, element('caption', { class: 'aside' }, `Requirements on ${cut(name)}`), element('thead', {}, element('tr', {}, ...head)), element('tbody', {}, ...rows)));
}

/** Writes all sensors as CSV. Where nothing glares, the fields of the rating are empty. */
function sensorCsv({ points, ratings }) {
  const head = ['x', 'y', 'z', 'dx', 'dy', 'dz', 'E', 'E_direct', 'se'];
  if (!ratings) return toCsv([head, ...points]);
  return toCsv([[...head, 'UGR', 'se_UGR'], ...points.map((point, i) => [...point, ...(ratings[i] ?? ['', ''])])]);
}

/** Returns the ends of the scale of a map. It begins at 0 unless the values differ by no more than half of the largest. */
function mapRange(list) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of list) {
    if (!Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  if (high > 0 && low >= 0 && low < 0.5 * high) return [0, high];
  if (high - low <= 1e-9 * Math.abs(high)) return [low - 0.5 * Math.max(1e-9, Math.abs(low)), high + 0.5 * Math.max(1e-9, Math.abs(high))];
  return [low, high];
}

/** Draws the map of a sensor: rows from the bottom, axes in meters, a scale. */
function sensorMap(sensor, unitE, quantity) {
  const { columns, rows, size, cells } = sensor.map;
  const values = new Array(columns * rows).fill(null);
  const pointOf = new Array(columns * rows).fill(null);
  cells.forEach((cell, i) => {
    if (!sensor.points[i]) return;
    values[cell] = sensor.points[i][6];
    pointOf[cell] = sensor.points[i];
  });
  const range = mapRange(values.filter((value) => value !== null));
  const color = (value) => (value === null ? [225, 225, 225] : viridis((value - range[0]) / (range[1] - range[0])));
  const scale = Math.min(860 / (columns * size[0]), 520 / (rows * size[1]));
  const [width, height] = [Math.max(40, columns * size[0] * scale), Math.max(40, rows * size[1] * scale)];
  const frame = { left: 46, top: 8, width, height };
  const total = [frame.left + width + 96, frame.top + Math.max(height, 120) + 44];
  const picture = shape('svg', { viewBox: `0 0 ${total[0]} ${total[1]}`, role: 'img', 'aria-label': `Map of ${quantity} of ${cut(sensor.name)}: ${cut(sensor.summary, 300)}`, style: { 'max-width': `${total[0]}px` } });
  const reading = element('p', { class: 'map-value' }, 'Values appear here under the pointer.');
  drawCells(picture, frame, columns, rows, values, color, range[1]);
  drawMapAxes(picture, frame, columns * size[0], rows * size[1]);
  drawMapScale(picture, frame, range, unitE);
  picture.addEventListener('pointermove', (event) => {
    const box = picture.getBoundingClientRect();
    const zoom = box.width / total[0];
    const column = Math.floor((((event.clientX - box.left) / zoom - frame.left) / width) * columns);
    const row = Math.floor((1 - ((event.clientY - box.top) / zoom - frame.top) / height) * rows);
    if (column < 0 || row < 0 || column >= columns || row >= rows) return;
    const p = pointOf[row * columns + column];
    reading.textContent = p ? `(${p.slice(0, 3).map(meters).join(', ')}) m: E ${digits(p[6])}${p[8] > 0 ? ` ± ${digits(p[8], 2)}` : ''} ${unitE}, direct ${digits(p[7])} ${unitE}` : 'No sensor here.';
  });
  return element('div', { class: 'map', style: { flex: `0 1 ${total[0]}px` } }, picture, reading);
}

function drawCells(picture, { left, top, width, height }, columns, rows, values, color, most) {
  const [w, h] = [width / columns, height / rows];
  if (values.length > CELLS_WITH_NUMBERS) {
    const href = mapImage(columns, rows, values, color);
    picture.append(shape('image', { href, x: left, y: top, width, height, preserveAspectRatio: 'none', style: { 'image-rendering': 'pixelated' } }));
  } else {
    // All numbers have the decimals of the largest one, with two digits.
    const decimals = clamp(1 - Math.floor(Math.log10(Math.max(most, 1e-6))), 0, 6);
    const text = (value) => value.toFixed(decimals);
    const font = Math.min(12, h * 0.55, (w * 1.75) / Math.max(1, ...values.map((value) => (value === null ? 0 : text(value).length))));
    values.forEach((value, cell) => {
      const [x, y] = [left + (cell % columns) * w, top + (rows - 1 - Math.floor(cell / columns)) * h];
      picture.append(shape('rect', { x, y, width: w, height: h, fill: rgb(color(value)), 'shape-rendering': 'crispEdges' }));
    });
    if (font >= 5) values.forEach((value, cell) => {
      if (value === null) return;
      const [x, y] = [left + ((cell % columns) + 0.5) * w, top + (rows - 0.5 - Math.floor(cell / columns)) * h + font * 0.36];
      const isLight = luminance(...color(value)) > 120;
      picture.append(shape('text', { x, y, 'text-anchor': 'middle', 'font-size': font.toFixed(1), style: { fill: isLight ? '#101418' : '#ffffff' } }, text(value)));
    });
  }
  picture.append(shape('rect', { class: 'frame', x: left, y: top, width, height }));
}

/** Returns the cells of a map as an image, one pixel each. */
function mapImage(columns, rows, values, color) {
  const canvas = element('canvas', { width: columns, height: rows });
  const context = canvas.getContext('2d');
  const pixels = context.createImageData(columns, rows);
  values.forEach((value, cell) => {
    const at = (rows - 1 - Math.floor(cell / columns)) * columns + (cell % columns);
    pixels.data.set([...color(value), 255], 4 * at);
  });
  context.putImageData(pixels, 0, 0);
  return canvas.toDataURL('image/png');
}

function drawMapAxes(picture, { left, top, width, height }, wide, high) {
  for (const tick of linearTicks(0, wide, width / 60)) {
    const x = left + (tick / wide) * width;
    picture.append(shape('line', { class: 'frame', x1: x, x2: x, y1: top + height, y2: top + height + 4 }), shape('text', { class: 'soft', x, y: top + height + 17, 'text-anchor': 'middle' }, tickText(tick)));
  }
  for (const tick of linearTicks(0, high, height / 50)) {
    const y = top + height - (tick / high) * height;
    picture.append(shape('line', { class: 'frame', x1: left - 4, x2: left, y1: y, y2: y }), shape('text', { class: 'soft', x: left - 8, y: y + 4, 'text-anchor': 'end' }, tickText(tick)));
  }
  picture.append(shape('text', { class: 'soft', x: left + width / 2, y: top + height + 35, 'text-anchor': 'middle' }, 'm'));
}

function drawMapScale(picture, { left, top, width, height }, [low, high], unitE) {
  const [x, bar, start] = [left + width + 20, 16, top + 18];
  const tall = Math.max(100, height - 18);
  const steps = 64;
  for (let i = 0; i < steps; i += 1) {
    picture.append(shape('rect', { x, y: start + (i / steps) * tall, width: bar, height: tall / steps + 0.2, fill: rgb(viridis(1 - (i + 0.5) / steps)), 'shape-rendering': 'crispEdges' }));
  }
  picture.append(shape('text', { class: 'soft', x, y: start - 7 }, unitE));
  for (const tick of linearTicks(low, high, tall / 45)) {
    const y = start + ((high - tick) / (high - low)) * tall;
    picture.append(shape('line', { class: 'frame', x1: x + bar, x2: x + bar + 4, y1: y, y2: y }), shape('text', { class: 'soft', x: x + bar + 8, y: y + 4 }, tickText(tick)));
  }
}

/** Returns the columns of the unified glare rating. Ratings above the limit are marked. */
function ratingColumns({ ratings, report }) {
  const limit = (report?.requirements ?? []).find(({ quantity }) => quantity === 'UGR')?.required;
  const of = (k) => (_, i) => ratings[i]?.[k] ?? -Infinity;
  const isOver = (i) => limit !== undefined && (ratings[i]?.[0] ?? -Infinity) > limit;
  return [
    { label: limit === undefined ? 'UGR' : `UGR (at most ${tickText(limit)})`, of: of(0), text: (x) => (Number.isFinite(x) ? x.toFixed(1).replace('-', '−') : 'none'), isOver },
    { label: '± σ of UGR', of: of(1), text: (x) => (Number.isFinite(x) ? digits(x, 2) : '') },
  ];
}

/** Makes a table that is sorted by a click on the head of a column. */
function sensorTable(sensor, unitE) {
  const columns = [
    { label: 'No.', of: (_, i) => i + 1, text: String },
    ...['x (m)', 'y (m)', 'z (m)'].map((label, k) => ({ label, of: (p) => p[k], text: meters })),
    { label: `E (${unitE})`, of: (p) => p[6], text: digits },
    { label: 'Direct', of: (p) => p[7], text: digits },
    { label: '± σ', of: (p) => p[8], text: (x) => digits(x, 2) },
    ...(sensor.ratings ? ratingColumns(sensor) : []),
  ];
  const order = sensor.points.map((_, i) => i);
  const sorting = { column: 0, sign: 1 };
  let shown = Math.min(FIRST_ROWS, order.length);
  const body = element('tbody');
  const heads = columns.map(({ label }, k) => element('th', { scope: 'col' }, element('button', { type: 'button', on: { click: () => sortBy(k) } }, label)));
  const table = element('table', {}, element('caption', { class: 'aside' }, `Sensors of ${cut(sensor.name)}`), element('thead', {}, element('tr', {}, ...heads)), body);
  const more = element('button', { type: 'button', on: { click: () => { shown = order.length; show(); } } }, `Show all ${whole(order.length)} rows`);
  const part = element('span', { class: 'quiet one-line' }, `The first ${whole(shown)} of ${whole(order.length)} rows are shown.`);

  function sortBy(k) {
    sorting.sign = sorting.column === k ? -sorting.sign : 1;
    sorting.column = k;
    const { of } = columns[k];
    order.sort((a, b) => sorting.sign * (of(sensor.points[a], a) - of(sensor.points[b], b)) || a - b);
    show();
  }

  function show() {
    heads.forEach((head, k) => {
      const isSorted = k === sorting.column;
      head.setAttribute('aria-sort', isSorted ? (sorting.sign > 0 ? 'ascending' : 'descending') : 'none');
      head.firstChild.textContent = `${columns[k].label}${isSorted ? (sorting.sign > 0 ? ' ↑' : ' ↓') : ''}`;
    });
    body.replaceChildren(...order.slice(0, shown).map((i) => element('tr', {}, ...columns.map(({ of, text, isOver }) => element('td', { class: isOver?.(i) ? 'doubtful' : null }, text(of(sensor.points[i], i)))))));
    for (const node of [more, part]) node.hidden = shown >= order.length;
  }

  show();
  return element('div', { class: 'wide' }, element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `Sensors of ${cut(sensor.name)}` }, table), element('p', { class: 'row' }, part, more));
}
