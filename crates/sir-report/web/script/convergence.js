// Convergence.

function writeConvergence(facts) {
  const stage = allStages(facts.report?.stages).map((item) => item.stage).filter(({ convergence }) => convergence?.length).at(-1);
  const points = (stage?.convergence ?? []).filter(({ lines, relative_error: error }) => lines > 0 && error?.some((x) => x > 0));
  if (points.length === 0) return;
  const last = points.at(-1);
  byId('convergence').append(
    element('p', { class: 'quiet' }, `Relative error of a patch over the lines so far, after each repeat. After ${whole(last.lines)} lines it is ${last.relative_error.map((x) => percent(x)).join(' / ')} (red / green / blue).`),
    element('div', { class: 'scroll plot' }, convergencePlot(points, targetOf(facts.report?.pipeline?.text))),
    element('ul', { class: 'keys' }, ...BANDS.map((band, k) => element('li', {}, bandKey(k), band)), element('li', {}, guideKey(), 'slope of 1/√n')),
  );
  byId('convergence').hidden = false;
}

/** Returns the target of the pipeline if it states exactly one. */
function targetOf(text) {
  const found = [...String(text ?? '').slice(0, LONGEST_TEXT).replace(/\/\/[^\n]*/g, '').matchAll(/RelativeError\(\s*([0-9._eE+-]+)\s*\)/g)];
  const target = found.length === 1 ? Number(found[0][1].replaceAll('_', '')) : NaN;
  return target > 0 && target < 1 ? target : null;
}

const DASHES = [null, '7 3', '2 3'];
const bandColor = (k) => `var(--band-${'rgb'[k]})`;
const smallKey = (...children) => shape('svg', { viewBox: '0 0 28 10', style: { width: '28px', height: '10px' }, 'aria-hidden': 'true' }, ...children);
const bandKey = (k) => smallKey(shape('line', { x1: 0, x2: 28, y1: 5, y2: 5, 'stroke-width': 2, 'stroke-dasharray': DASHES[k], style: { stroke: bandColor(k) } }));
const guideKey = () => smallKey(shape('line', { x1: 0, x2: 28, y1: 5, y2: 5, 'stroke-width': 1, style: { stroke: 'var(--guide)' } }));

function convergencePlot(points, target) {
  const [width, height, left, right, top, bottom] = [720, 300, 60, 16, 10, 44];
  const errors = points.flatMap((point) => point.relative_error).filter((x) => x > 0);
  const range = (list, least) => {
    const [low, high] = [Math.log(Math.min(...list)), Math.log(Math.max(...list))];
    const more = Math.max(0.06 * (high - low), (least - (high - low)) / 2, 0.02);
    return [low - more, high + more];
  };
  const [x0, x1] = range(points.map(({ lines }) => lines), 0.4);
  const [y0, y1] = range(target ? [...errors, target] : errors, 0.3);
  const x = (lines) => left + ((Math.log(lines) - x0) / (x1 - x0)) * (width - left - right);
  const y = (error) => height - bottom - ((Math.log(error) - y0) / (y1 - y0)) * (height - top - bottom);
  const last = points.at(-1);
  const picture = shape('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `Relative error over lines, both logarithmic. It falls from ${percent(Math.max(...points[0].relative_error))} at ${whole(points[0].lines)} lines to ${percent(Math.max(...last.relative_error))} at ${whole(last.lines)} lines.` });
  for (const tick of logTicks(Math.exp(x0), Math.exp(x1), 7)) {
    picture.append(shape('line', { class: 'grid', x1: x(tick), x2: x(tick), y1: top, y2: height - bottom }), shape('text', { class: 'soft', x: x(tick), y: height - bottom + 17, 'text-anchor': 'middle' }, linesText(tick)));
  }
  for (const tick of logTicks(Math.exp(y0), Math.exp(y1), 6)) {
    picture.append(shape('line', { class: 'grid', x1: left, x2: width - right, y1: y(tick), y2: y(tick) }), shape('text', { class: 'soft', x: left - 8, y: y(tick) + 4, 'text-anchor': 'end' }, `${tickText(Number((100 * tick).toPrecision(6)))} %`));
  }
  picture.append(shape('rect', { class: 'frame', x: left, y: top, width: width - left - right, height: height - top - bottom }),
    shape('text', { class: 'soft', x: (left + width - right) / 2, y: height - 8, 'text-anchor': 'middle' }, 'lines'));
  drawGuide(picture, last, [x0, x1, y0, y1], x, y);
  if (target) {
    picture.append(shape('line', { x1: left, x2: width - right, y1: y(target), y2: y(target), 'stroke-dasharray': '10 4 2 4', style: { stroke: 'var(--ink)' } }),
      shape('text', { x: width - right - 6, y: y(target) - 5, 'text-anchor': 'end' }, `target ${percent(target)}`));
  }
  BANDS.forEach((_, k) => drawBand(picture, points, k, x, y));
  return picture;
}

/** Writes a number of lines: 20 M. */
function linesText(lines) {
  const power = Math.min(4, Math.max(0, Math.floor(Math.log10(lines) / 3 + 1e-9)));
  return `${Number((lines / 1000 ** power).toPrecision(4))}${['', ' k', ' M', ' G', ' T'][power]}`;
}

/** Draws the slope of 1/√n through the last point, within the frame. */
function drawGuide(picture, last, [x0, x1, y0, y1], x, y) {
  const [endX, endY] = [Math.log(last.lines), Math.log(Math.max(...last.relative_error))];
  const from = Math.max(x0, endX - 2 * (y1 - endY));
  const to = Math.min(x1, endX + 2 * (endY - y0));
  const at = (u) => ({ x: x(Math.exp(u)), y: y(Math.exp(endY - (u - endX) / 2)) });
  picture.append(shape('line', { x1: at(from).x, y1: at(from).y, x2: at(to).x, y2: at(to).y, style: { stroke: 'var(--guide)' } }));
}

function drawBand(picture, points, k, x, y) {
  const shown = points.filter((point) => point.relative_error[k] > 0);
  const places = shown.map((point) => [x(point.lines), y(point.relative_error[k])]);
  const path = places.map((place) => place.map((c) => c.toFixed(1)).join(',')).join(' ');
  picture.append(shape('polyline', { points: path, fill: 'none', 'stroke-width': 2, 'stroke-dasharray': DASHES[k], style: { stroke: bandColor(k) } }));
  if (places.length <= 60) places.forEach(([cx, cy]) => picture.append(shape('circle', { cx, cy, r: 3, style: { fill: bandColor(k) } })));
}
