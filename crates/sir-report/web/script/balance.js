// Energy balance.

const FATES = [
  { key: 'absorbed', label: 'Absorbed', about: 'by surfaces' },
  { key: 'blocked', label: 'Blocked', about: 'by backs of one-sided surfaces' },
  { key: 'escaped', label: 'Escaped', about: 'to the outside' },
  { key: 'unshot', label: 'Unshot', about: 'not sent on when the lines ended' },
];

/** Returns the balance of the whole calculation: each stage takes some of what the earlier ones left unshot. */
function totalBalance(stages) {
  const parts = allStages(stages).map(({ stage }) => stage).filter(({ balance, stages: inner }) => balance && !(inner?.length) && balance.emitted.some((x) => x !== 0));
  if (parts.length === 0) return null;
  const total = { emitted: [...parts[0].balance.emitted], absorbed: [0, 0, 0], blocked: [0, 0, 0], escaped: [0, 0, 0], unshot: [...parts[0].balance.emitted] };
  for (const { balance } of parts) {
    for (let k = 0; k < 3; k += 1) {
      for (const key of ['absorbed', 'blocked', 'escaped']) total[key][k] += balance[key]?.[k] ?? 0;
      total.unshot[k] += (balance.unshot?.[k] ?? 0) - balance.emitted[k];
    }
  }
  return total;
}

function writeBalance(facts) {
  const total = totalBalance(facts.report?.stages);
  if (!total) return;
  const rows = [
    { label: 'luminance', of: (key) => luminance(...total[key]) },
    ...BANDS.map((label, k) => ({ label, of: (key) => total[key][k] })),
  ];
  byId('balance').append(
    element('p', { class: 'quiet' }, 'Where the emitted power goes, over all stages. What a stage leaves unshot is sent on by the next.'),
    element('div', { class: 'pair' },
      element('div', { class: 'wide plot' }, balancePicture(rows), balanceKeys(rows)),
      element('div', { class: 'scroll' }, balanceTable(rows, facts.units.power))),
  );
  byId('balance').hidden = false;
}

const shareOf = (row, key) => (row.of('emitted') > 0 ? row.of(key) / row.of('emitted') : 0);

function balancePicture(rows) {
  const [left, width, high, gap] = [74, 440, 34, 10];
  const bottom = rows.length * (high + gap);
  const text = rows.map((row) => `${row.label}: ${FATES.map(({ key, label }) => `${label.toLowerCase()} ${percent(shareOf(row, key), 3)}`).join(', ')}`).join('. ');
  const picture = shape('svg', { viewBox: `0 0 544 ${bottom + 24}`, role: 'img', 'aria-label': `Energy balance. ${text}.` });
  for (const share of [0, 0.25, 0.5, 0.75, 1]) {
    const x = left + share * width;
    picture.append(shape('line', { class: 'grid', x1: x, x2: x, y1: 0, y2: bottom }), shape('text', { class: 'soft', x, y: bottom + 16, 'text-anchor': 'middle' }, `${100 * share} %`));
  }
  rows.forEach((row, i) => {
    const y = i * (high + gap) + gap / 2;
    picture.append(shape('text', { x: left - 8, y: y + high / 2 + 4, 'text-anchor': 'end' }, row.label));
    if (!(row.of('emitted') > 0)) picture.append(shape('text', { class: 'soft', x: left + 6, y: y + high / 2 + 4 }, 'no power'));
    let x = left;
    for (const { key } of FATES) {
      const span = width * clamp(shareOf(row, key), 0, 1);
      if (span < 0.3) continue;
      picture.append(shape('rect', { x, y, width: span, height: high, style: { fill: `var(--${key})` } }));
      if (span > 48) picture.append(shape('text', { x: x + span / 2, y: y + high / 2 + 4, 'text-anchor': 'middle', style: { fill: key === 'absorbed' ? 'var(--absorbed-ink)' : '#101418' } }, percent(shareOf(row, key), 3)));
      x += span;
    }
  });
  return picture;
}

function balanceKeys(rows) {
  const used = FATES.filter(({ key }) => rows.some((row) => Math.abs(shareOf(row, key)) >= 5e-4));
  return element('ul', { class: 'keys' }, ...used.map(({ key, label, about }) => (
    element('li', {}, element('span', { class: 'swatch', style: { background: `var(--${key})` } }), `${label}: ${about}`))));
}

function balanceTable(rows, unit) {
  const lines = [{ key: 'emitted', label: 'Emitted' }, ...FATES];
  // All numbers have the decimals of the largest one, with five digits.
  const decimals = clamp(4 - Math.floor(Math.log10(Math.max(...rows.map((row) => row.of('emitted')), 1e-6))), 0, 10);
  const number = (row, key) => group((row.of(key) || 0).toFixed(decimals).replace(/^-(0\.?0*)$/, '$1'));
  return element('table', {},
    element('caption', { class: 'aside' }, 'Energy balance'),
    element('thead', {}, element('tr', {}, element('th', { class: 'text', scope: 'col' }, unit), ...rows.map(({ label }) => element('th', { scope: 'col' }, label)))),
    element('tbody', {}, ...lines.map(({ key, label }) => element('tr', {}, element('th', { class: 'text', scope: 'row' }, label), ...rows.map((row) => element('td', {}, number(row, key)))))));
}
