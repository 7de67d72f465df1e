// Picks.

function makePicks(viewer) {
  const { values } = viewer;
  const list = [];
  let last = 0;
  const head = ['No.', 'Object', 'Material', 'Patch', 'Triangle', 'x (m)', 'y (m)', 'z (m)', `E (${values.unitE})`, '± σ', `B (${values.unitB})`, 'E red', 'E green', 'E blue', ''];
  const body = element('tbody');
  byId('picks-table').append(
    element('caption', { class: 'aside' }, 'Values of patches that were picked in the view'),
    element('thead', {}, element('tr', {}, ...head.map((text, i) => element('th', { scope: 'col', class: i === 1 || i === 2 ? 'text' : null }, text || element('span', { class: 'aside' }, 'Remove'))))),
    body,
  );

  function add({ side, point }) {
    const pick = { number: (last += 1), side, point, ...values.ofSide(side) };
    pick.marker = element('div', { class: 'marker' }, element('span', {}, String(pick.number)));
    pick.row = rowOf(pick);
    list.push(pick);
    byId('markers').append(pick.marker);
    body.append(pick.row);
    show();
    byId('picks-live').textContent = `Pick ${pick.number}: ${pick.object}, ${pick.material}, ${digits(pick.e)} ${values.unitE}`;
    return pick;
  }

  function rowOf(pick) {
    const cell = (text) => element('td', {}, text);
    const name = (text) => element('td', { class: 'text name' }, element('div', { class: 'clamp', title: text }, text));
    const button = element('button', { type: 'button', 'aria-label': `Remove pick ${pick.number}`, on: { click: () => remove(pick) } }, '×');
    return element('tr', {}, element('th', { scope: 'row' }, String(pick.number)), name(pick.object), name(pick.material), cell(String(pick.patch)), cell(String(pick.triangle)),
      ...pick.point.map((x) => cell(meters(x))), cell(digits(pick.e)), cell(pick.error > 0 ? digits(pick.error, 2) : '–'), cell(digits(pick.b)),
      ...pick.bands.map((x) => cell(digits(x))), element('td', {}, button));
  }

  function remove(pick) {
    list.splice(list.indexOf(pick), 1);
    pick.marker.remove();
    pick.row.remove();
    show();
    byId('picks-live').textContent = `Pick ${pick.number} was removed.`;
    viewer.changed();
  }

  function clear() {
    list.forEach(({ marker, row }) => [marker, row].forEach((node) => node.remove()));
    list.length = 0;
    last = 0;
    show();
  }

  function show() {
    byId('picks').classList.toggle('empty', list.length === 0);
    byId('picks-hint').hidden = list.length > 0;
    byId('picks-scroll').hidden = list.length === 0;
    for (const id of ['picks-copy', 'picks-clear']) byId(id).disabled = list.length === 0;
  }

  /** Moves the markers to where the picks are in the picture. */
  function place() {
    for (const { marker, point } of list) {
      const at = project(viewer.state.camera, viewer.aspect(), point);
      marker.hidden = !isVisible(at);
      marker.style.left = `${100 * at.x}%`;
      marker.style.top = `${100 * at.y}%`;
    }
  }

  function csv() {
    const columns = ['pick', 'object', 'material', 'patch', 'triangle', 'x', 'y', 'z', 'E', 'sigma', 'B', 'E_r', 'E_g', 'E_b', 'unit_E', 'unit_B'];
    const rows = list.map((p) => [p.number, ...[p.object, p.material].map((name) => (name === '–' ? '' : name)), p.patch, p.triangle, ...p.point, p.e, p.error > 0 ? p.error : '', p.b, ...p.bands, values.unitE, values.unitB]);
    return toCsv([columns, ...rows]);
  }

  show();
  return { list, add, clear, place, csv };
}

/** Writes rows as CSV. Names that a spreadsheet would take as formulas are kept from it by an apostrophe. */
function toCsv(rows) {
  const cell = (value) => {
    if (typeof value === 'number') return plain(value);
    const text = /^[=+\-@\t\r]/.test(value) ? `'${value}` : value;
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return rows.map((row) => `${row.map(cell).join(',')}\n`).join('');
}

/** Copies a text. Where the clipboard is not available, a field shows the text, selected. */
async function copyText(text, button, place) {
  const label = (button.dataset.label ??= button.textContent);
  place.querySelector('.copy-box')?.remove();
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = 'Copied';
  } catch {
    const box = element('textarea', { class: 'copy-box', readonly: '', 'aria-label': 'Text to copy' });
    box.value = text;
    place.append(box);
    box.select();
    button.textContent = document.execCommand?.('copy') ? 'Copied' : 'Selected below';
  }
  setTimeout(() => { button.textContent = label; }, 2000);
}
