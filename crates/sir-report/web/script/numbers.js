// Numbers as text.

/** Writes a number with the given significant digits. */
function digits(value, count = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 9.995e6) return value.toExponential(count - 1).replace('e+', 'e').replace('-', '−').replace('e-', 'e−');
  const rounded = Number(value.toPrecision(count));
  const decimals = Math.max(0, count - 1 - Math.floor(Math.log10(Math.abs(rounded))));
  return group(rounded.toFixed(decimals));
}

/** Separates thousands. Four digits stay together. */
function group(text) {
  const [whole, decimals] = text.replace('-', '−').split('.');
  const grouped = whole.replace('−', '').length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, ',') : whole;
  return decimals === undefined ? grouped : `${grouped}.${decimals}`;
}

const whole = (value) => (Number.isFinite(value) ? group(String(Math.round(value))) : '–');
const percent = (share, count = 2) => (Number.isFinite(share) ? `${digits(100 * share, count)} %` : '–');
const meters = (value) => value.toFixed(3).replace(/^-(?=0\.000$)/, '').replace('-', '−');

/** Writes a number for a file or a link: plain ASCII, and no more digits than needed. */
const plain = (value, count = 7) => String(Number(value.toPrecision(count)));

function duration(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  if (seconds < 60) return `${digits(seconds)} s`;
  const s = Math.round(seconds);
  if (s < 3600) return `${Math.floor(s / 60)} min ${s % 60} s`;
  return `${whole(Math.floor(s / 3600))} h ${Math.floor((s % 3600) / 60)} min`;
}

function memory(bytes) {
  if (!Number.isFinite(bytes)) return '–';
  const power = Math.min(3, Math.max(0, Math.floor(Math.log10(Math.max(1, bytes)) / 3)));
  return `${digits(bytes / 1000 ** power)} ${['B', 'kB', 'MB', 'GB'][power]}`;
}

/** Returns the smallest of 1, 2 and 5 times a power of ten that is at least `least`. */
function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= least * (1 - 1e-9));
}

/** Returns round numbers from `low` to `high`, at most about `count`. */
function linearTicks(low, high, count) {
  if (!(high > low)) return [];
  const step = niceStep((high - low) / Math.max(1, count));
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-6); i * step <= high + 1e-6 * step && ticks.length < 100; i += 1) {
    ticks.push(Number((i * step).toPrecision(12)));
  }
  return ticks;
}

/** Returns 1, 2 and 5 times powers of ten from `low` to `high`, or fewer if there is no room. */
function logTicks(low, high, count) {
  if (!(low > 0 && high > low)) return [];
  const decades = Math.log10(high / low);
  const factors = decades * 3 <= count ? [1, 2, 5] : decades * 2 <= count ? [1, 3] : [1];
  const stride = Math.max(1, Math.ceil(decades / Math.max(1, count)));
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power += 1) {
    if (power % stride !== 0) continue;
    for (const factor of factors) {
      const tick = Number(`${factor}e${power}`);
      if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) ticks.push(tick);
    }
  }
  return ticks.length > 1 ? ticks : linearTicks(low, high, count);
}

/** Writes the number of a tick. */
function tickText(value) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e6) return value.toExponential().replace('e+', 'e').replace('-', '−');
  return group(String(Number(value.toPrecision(6))));
}
