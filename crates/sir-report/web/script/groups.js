// Light groups.

function writeGroups(facts) {
  const groups = facts.report?.groups ?? [];
  if (groups.length === 0) return;
  const sum = facts.report.mixed_from
    ? 'The light is the sum of the groups, each times its factor.'
    : 'The light is the sum of the groups. “sir mix” dims and colors them without tracing lines again.';
  const sky = facts.sky ? ' The flux of the sky is that around the whole scene, not that which enters rooms.' : '';
  byId('groups').append(
    element('p', { class: 'quiet' }, sum + sky),
    element('div', { class: 'scroll' }, groupTable(groups, facts.units.power)),
  );
  byId('groups').hidden = false;
}

/** Writes a factor: one number if that of all bands is the same. */
const factorText = (factor) => (factor.every((x) => x === factor[0]) ? tickText(factor[0]) : factor.map(tickText).join(' / '));

/** Makes a table of the groups: factor, flux with it in total and per band, the share of the flux of all, and the error. */
function groupTable(groups, unit) {
  const errorOf = (stages) => allStages(stages).map(({ stage }) => stage.relative_error).filter(Boolean).at(-1);
  const rows = groups.map(({ name, power, factor, stages }) => ({ name, factor: factorText(factor), bands: power.map((x, k) => x * factor[k]), error: errorOf(stages) }));
  const all = { name: 'All', factor: '', bands: BANDS.map((_, k) => rows.reduce((sum, { bands }) => sum + bands[k], 0)) };
  const total = luminance(...all.bands);
  const shareOfAll = (bands) => (total > 0 ? `${(100 * luminance(...bands) / total).toFixed(1)} %` : '–');
  const row = ({ name, factor, bands, error }) => element('tr', {},
    element('th', { class: 'text name', scope: 'row' }, cut(name)),
    ...[factor, digits(luminance(...bands), 4), ...bands.map((x) => digits(x, 4)), shareOfAll(bands), error ? percent(Math.max(...error)) : ''].map((text) => element('td', {}, text)));
  const head = ['Group', 'Factor', `Flux (${unit})`, 'Red', 'Green', 'Blue', 'Share', 'Relative error'];
  return element('table', {},
    element('caption', { class: 'aside' }, 'Light groups: emitted flux with the factor, weighted for luminance and per band, its share of that of all groups, and the relative error of a patch in the light of the group alone'),
    element('thead', {}, element('tr', {}, ...head.map((text, k) => element('th', { scope: 'col', class: k === 0 ? 'text' : null }, text)))),
    element('tbody', {}, ...rows.map(row), ...(rows.length > 1 ? [row(all)] : [])));
}
