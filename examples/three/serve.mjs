#!/usr/bin/env node
// SPDX-License-Identifier: MIT OR Apache-2.0

/**
 * Serves this folder and one lightmapped GLB file on 127.0.0.1, for browsers of this machine only.
 *
 *     node serve.mjs path/to/room-lit.glb [port]
 */

import { createReadStream, existsSync, realpathSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { dirname, extname, join, sep } from 'node:path';
import { fileURLToPath } from 'node:url';

const ROOT = realpathSync(dirname(fileURLToPath(import.meta.url)));

const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
};

/** Nothing may be loaded from elsewhere. Textures of a GLB file are blobs. */
const POLICY = "default-src 'self'; script-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; connect-src 'self' blob: data:";

/** Returns the file for a path of an address, or null. Only pages, scripts and styles of this folder and of three.js exist. */
function find(path) {
  const parts = path === '/' ? ['index.html'] : path.slice(1).split('/');
  const isPlain = parts.every((part) => /^[\w@-][\w.@-]*$/.test(part));
  if (!isPlain || !(extname(parts.at(-1)) in TYPES)) return null;
  if (parts[0] === 'node_modules' && parts[1] !== 'three') return null;
  const file = join(ROOT, ...parts);
  if (!existsSync(file) || !statSync(file).isFile()) return null;
  // Links do not lead out of the folder.
  return realpathSync(file).startsWith(ROOT + sep) ? file : null;
}

function send(response, method, file, type) {
  response.writeHead(200, {
    'Content-Type': type,
    'Content-Length': statSync(file).size,
    'Content-Security-Policy': POLICY,
    'X-Content-Type-Options': 'nosniff',
    'Cache-Control': 'no-store',
  });
  if (method === 'HEAD') return response.end();
  createReadStream(file).on('error', () => response.destroy()).pipe(response);
}

function refuse(response, status, text) {
  response.writeHead(status, { 'Content-Type': 'text/plain; charset=utf-8' }).end(`${text}\n`);
}

function answer(request, response, scene) {
  const { method, url } = request;
  if (method !== 'GET' && method !== 'HEAD') return refuse(response, 405, 'Only GET and HEAD are answered.');
  // A page of another site may have a name that leads here.
  if (!/^(127\.0\.0\.1|localhost)(:\d+)?$/.test(request.headers.host ?? '')) return refuse(response, 403, 'Unknown host.');
  const path = url.split('?')[0];
  if (path === '/scene.glb') return send(response, method, scene, 'model/gltf-binary');
  const file = find(path);
  if (!file) return refuse(response, 404, 'There is no such file.');
  send(response, method, file, TYPES[extname(file)]);
}

function stop(text) {
  console.error(text);
  process.exit(1);
}

const [scene, port = '0'] = process.argv.slice(2);
if (!scene || process.argv.length > 4) stop('usage: node serve.mjs path/to/room-lit.glb [port]');
if (extname(scene) !== '.glb' || !existsSync(scene)) stop(`${scene} is not a GLB file.`);
if (!existsSync(join(ROOT, 'node_modules', 'three'))) stop(`three.js is not installed; run "npm ci" in ${ROOT}.`);
if (!/^\d{1,5}$/.test(port) || Number(port) > 65535) stop(`${port} is not a port.`);
const server = createServer((request, response) => answer(request, response, scene));
server.on('error', (error) => stop(error.message));
server.listen(Number(port), '127.0.0.1', () => console.log(`http://127.0.0.1:${server.address().port}/`));
