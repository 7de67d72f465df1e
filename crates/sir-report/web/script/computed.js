// Sections of the page: notices, what was computed.

const BANDS = ['red', 'green', 'blue'];

function writeHeader(facts) {
  byId('title').textContent = cut(facts.title);
  const { seed } = facts.report ?? {};
  byId('byline').textContent = [cut(facts.program), seed === undefined ? null : `seed ${seed}`].filter(Boolean).join(' · ');
}

function writeNotices(facts) {
  const report = facts.report ?? {};
  const warnings = [...(report.scene?.warnings ?? []), ...(report.warnings ?? [])];
  const notes = facts.notes ?? [];
  if (warnings.length + notes.length === 0) return;
  const textOf = (warning) => cut(typeof warning === 'string' ? warning : JSON.stringify(warning), 2000);
  const item = (text, kind, label) => element('li', { class: kind }, element('b', {}, `${label} `), text);
  byId('notices').append(element('ul', {}, ...warnings.map((w) => item(textOf(w), 'warning', 'Warning:')), ...notes.map((n) => item(textOf(n), 'note', 'Note:'))));
  byId('notices-title').textContent = warnings.length === 0 ? 'Notes' : notes.length === 0 ? 'Warnings' : 'Warnings and notes';
  byId('notices').hidden = false;
}

/** Returns all stages with those inside of others, each with its depth. */
function allStages(stages = [], depth = 0) {
  return stages.flatMap((stage) => [{ stage, depth }, ...allStages(stage.stages, depth + 1)]);
}

function writeComputed(facts) {
  const report = facts.report ?? {};
  const { scene = {} } = report;
  const section = byId('computed');
  const list = element('dl', { class: 'facts' });
  const put = (term, value) => { if (value) list.append(element('dt', {}, term), element('dd', {}, value)); };
  const bands = (three, unit) => (three ? `${three.map((x) => digits(x)).join(' / ')} ${unit} (red / green / blue), ${digits(luminance(...three))} ${unit} weighted for luminance` : null);
  put('Scene', scene.path ? element('span', { class: 'name' }, cut(scene.path)) : null);
  put('Geometry', scene.triangles === undefined ? null : `${whole(scene.triangles)} triangles, ${whole(scene.patches)} patches with ${whole(scene.sides)} sides, ${digits(scene.area, 4)} m²`);
  put('Emitted power', bands(scene.power, facts.units.power));
  put('Up', scene.up ? `(${scene.up.map((x) => tickText(x)).join(', ')})${scene.up_from ? `, ${cut(scene.up_from)}` : ''}` : null);
  const results = allStages(report.stages).filter(({ stage }) => stage.relative_error);
  const last = results.at(-1)?.stage;
  put('Relative error of a patch', last ? `${last.relative_error.map((x) => percent(x)).join(' / ')} (red / green / blue)${errorSource(last.errors)}` : null);
  put('Program', [cut(facts.program), report.program && report.program !== facts.program ? cut(report.program) : null].filter(Boolean).join(', '));
  put('Seed', report.seed === undefined ? null : String(report.seed));
  put('Time', report.time ? duration(report.time.seconds) : null);
  put('Peak memory', report.time?.peak_memory ? memory(report.time.peak_memory) : null);
  section.append(list);
  const table = stageTable(report.stages);
  if (table) section.append(element('h3', {}, 'Stages'), element('div', { class: 'scroll' }, table));
  const { pipeline } = report;
  if (pipeline?.text) {
    section.append(element('h3', {}, 'Pipeline ', element('span', { class: 'quiet name' }, cut(pipeline.path))), element('pre', { tabindex: 0 }, cut(pipeline.text, LONGEST_TEXT)));
  }
}

function errorSource(errors) {
  if (errors?.from === 'spread') return `, from the spread of ${whole(errors.samples)} repeats`;
  if (errors?.from === 'lines') return `, from ${whole(errors.samples)} lines`;
  return '';
}

function stageTable(stages) {
  const rows = allStages(stages);
  if (rows.length === 0) return null;
  const sum = (stage) => stage.lines ?? ((stage.stages ?? []).reduce((total, inner) => total + (sum(inner) ?? 0), 0) || stage.sensors?.rays);
  const line = ({ stage, depth }) => element('tr', {},
    element('td', { class: 'text name', style: { 'padding-left': `${10 + 18 * depth}px` } }, cut(stage.sensors ? `${stage.name} “${cut(stage.sensors.name, 60)}”` : stage.name)),
    element('td', {}, sum(stage) === undefined ? '' : whole(sum(stage))),
    element('td', {}, stage.repeats === undefined ? '' : whole(stage.repeats)),
    element('td', {}, stage.relative_error ? percent(Math.max(...stage.relative_error)) : ''),
    element('td', {}, stage.time ? duration(stage.time.seconds) : ''),
    element('td', {}, stage.time?.lines_per_second ? whole(Number(stage.time.lines_per_second.toPrecision(3))) : ''));
  const head = ['Stage', 'Lines or rays', 'Repeats', 'Relative error', 'Time', 'Lines per second'];
  return element('table', {}, element('thead', {}, element('tr', {}, ...head.map((text, i) => element('th', { scope: 'col', class: i === 0 ? 'text' : null }, text)))), element('tbody', {}, ...rows.map(line)));
}
