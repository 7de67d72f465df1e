// Takes a picture of a page when it says that it is ready.
//
//     node screenshot.mjs URL PICTURE WIDTH HEIGHT READY BROWSER ARGUMENT…
//
// READY is an expression of the page. `--screenshot` of Chromium does not wait for images that a script decodes; this
// program asks the page through the DevTools protocol instead. Prints what the page writes to the console and uncaught
// errors, a line each. Fails if the page is not ready after a minute.

import { spawn } from 'node:child_process';
import { writeFileSync } from 'node:fs';

const LIMIT = 60_000;

const [url, picture, width, height, ready, browser, ...browserArguments] = process.argv.slice(2);
const child = spawn(browser, [...browserArguments, '--remote-debugging-pipe', 'about:blank'], {
  stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'],
});
const [, , , input, output] = child.stdio;

function stop(text) {
  console.error(text);
  child.kill();
  process.exit(1);
}

child.on('error', (error) => stop(`${browser} does not start: ${error.message}`));
child.on('exit', () => stop(`${browser} has ended.`));
setTimeout(() => stop('The page is not ready.'), LIMIT);

const waiting = new Map();
let last = 0;

/** Sends a command, and returns its result. */
function send(method, params = {}, sessionId = undefined) {
  last += 1;
  input.write(`${JSON.stringify({ id: last, method, params, sessionId })}\0`);
  return new Promise((resolve) => waiting.set(last, resolve));
}

function receive({ id, result, error, method, params }) {
  if (error) stop(`${error.message} (${error.code})`);
  waiting.get(id)?.(result);
  if (method === 'Runtime.consoleAPICalled') {
    console.log(`${params.type}: ${params.args.map((argument) => argument.value ?? argument.description).join(' ')}`);
  } else if (method === 'Runtime.exceptionThrown') {
    console.log(`exception: ${params.exceptionDetails.exception?.description ?? params.exceptionDetails.text}`);
  } else if (method === 'Log.entryAdded') {
    console.log(`${params.entry.level}: ${params.entry.text} ${params.entry.url ?? ''}`);
  }
}

let rest = '';
output.setEncoding('utf8').on('data', (text) => {
  const messages = (rest + text).split('\0');
  rest = messages.pop();
  messages.forEach((message) => receive(JSON.parse(message)));
});

const { targetInfos } = await send('Target.getTargets');
const { targetId } = targetInfos.find((target) => target.type === 'page');
const { sessionId } = await send('Target.attachToTarget', { targetId, flatten: true });
const page = (method, params) => send(method, params, sessionId);
await page('Runtime.enable');
await page('Log.enable');
await page('Page.enable');
const size = { width: Number(width), height: Number(height), deviceScaleFactor: 1, mobile: false };
await page('Emulation.setDeviceMetricsOverride', size);
await page('Page.navigate', { url });
for (;;) {
  const { result } = await page('Runtime.evaluate', { expression: ready });
  if (result.value) break;
  await new Promise((resolve) => setTimeout(resolve, 50));
}
const { data } = await page('Page.captureScreenshot', { format: 'png' });
writeFileSync(picture, Buffer.from(data, 'base64'));
child.removeAllListeners('exit');
await Promise.race([send('Browser.close'), new Promise((resolve) => child.on('exit', resolve))]);
process.exit(0);
