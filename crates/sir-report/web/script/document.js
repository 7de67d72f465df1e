// The document.

const root = document.documentElement;
const byId = (id) => document.getElementById(id);

/** Longest name that is shown, in UTF-16 units. */
const LONGEST_NAME = 200;
/** Longest text of a pipeline that is shown. */
const LONGEST_TEXT = 200000;

/** Makes an element. All text is set as text, never as markup. */
function element(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

/** Makes an SVG element. */
function shape(tag, attributes = {}, ...children) {
  return fill(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);
}

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name === 'style') Object.entries(value).forEach(([key, text]) => node.style.setProperty(key, text));
    else if (name === 'on') Object.entries(value).forEach(([event, action]) => node.addEventListener(event, action));
    else if (value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

/** Cuts a text that may be of any length. */
function cut(text, longest = LONGEST_NAME) {
  const whole = String(text ?? '');
  if (whole.length <= longest) return whole;
  // A surrogate pair is not divided.
  return whole.slice(0, longest).replace(/[\uD800-\uDBFF]$/, '') + '…';
}

/** Keeps the first failure where a program that opens the page finds it. */
function fail(error) {
  root.dataset.error ??= cut(error?.message ?? error, 1000);
}

/** Does a part of the page. A failure leaves the other parts as they are. */
function attempt(part, ...values) {
  try {
    return part(...values);
  } catch (error) {
    fail(error);
    return undefined;
  }
}

/** Waits until the browser has had time to show what changed. */
const pause = () => new Promise((resolve) => setTimeout(resolve, 0));
