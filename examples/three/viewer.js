// SPDX-License-Identifier: MIT OR Apache-2.0

/**
 * Page that shows the lightmapped GLB file of `serve.mjs`. Its address has options behind `#`, joined with `&`:
 *
 * - `camera=0`: number or name of a camera of the file;
 * - `eye=x,y,z`, `target=x,y,z`, `fov=degrees`: another camera, in the coordinates of the GLB file (y is up);
 * - `exposure=stops`; `tone=sir`, `none`, `aces` or `neutral`;
 * - `materials=source` keeps the materials of the file, and `lights=1` its lights;
 * - `panel=0` hides the controls.
 *
 * `window.sirReady` is true after the first frame.
 */

import { Box3, Color, PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

import { SirLightmapPlugin } from './sir-lightmap.js';
import { CURVES, installToneCurve } from './tone.js';

const element = (id) => document.getElementById(id);
const options = new URLSearchParams(location.hash.slice(1));

function fail(error) {
  const text = String(error?.message ?? error);
  document.documentElement.dataset.error ??= text;
  const message = element('message');
  message.textContent = `The scene cannot be shown: ${text}`;
  message.className = 'error';
  message.hidden = false;
}

addEventListener('error', (event) => fail(event.error ?? event.message));
addEventListener('unhandledrejection', (event) => fail(event.reason));
// Options are read once.
addEventListener('hashchange', () => location.reload());

/** Loads the scene with its light. */
async function load() {
  const loader = new GLTFLoader();
  const settings = {
    materials: options.get('materials') ?? 'diffuse',
    lights: options.get('lights') === '1',
  };
  loader.register((parser) => new SirLightmapPlugin(parser, settings));
  return loader.loadAsync('scene.glb');
}

/** Returns three numbers of an option, or null. */
function vector(name) {
  if (!options.has(name)) return null;
  const numbers = options.get(name).split(',').map(Number);
  if (numbers.length !== 3 || !numbers.every(Number.isFinite)) throw new Error(`"${name}" needs three numbers`);
  return new Vector3(...numbers);
}

/** Returns the cameras to choose from: that of the address, those of the file, and one that shows the whole scene. */
function viewpoints(gltf, sphere) {
  const views = gltf.cameras.map((camera, i) => {
    camera.updateWorldMatrix(true, false);
    const copy = camera.clone(false);
    camera.matrixWorld.decompose(copy.position, copy.quaternion, copy.scale);
    copy.scale.set(1, 1, 1);
    // The loader changes names; `userData` has that of the file.
    return { name: camera.userData.name || camera.name || `camera ${i}`, camera: copy };
  });
  const whole = new PerspectiveCamera(45);
  whole.position.set(0.4, 0.3, 1).normalize().multiplyScalar(2.4 * sphere.radius).add(sphere.center);
  whole.lookAt(sphere.center);
  views.push({ name: 'whole scene', camera: whole });
  const [eye, target] = [vector('eye'), vector('target')];
  if (eye && target) {
    const camera = new PerspectiveCamera(Number(options.get('fov') ?? 45));
    camera.position.copy(eye);
    camera.lookAt(target);
    views.unshift({ name: 'of the address', camera, target });
  }
  return views;
}

/** Returns the index of the camera that the address asks for. */
function chosen(views) {
  const name = options.get('camera');
  if (name === null) return 0;
  const index = views.findIndex((view, i) => view.name === name || String(i) === name);
  if (index < 0) throw new Error(`there is no camera "${name}"; there are ${views.map((view) => view.name).join(', ')}`);
  return index;
}

async function start() {
  installToneCurve();
  const renderer = new WebGLRenderer({ canvas: element('canvas'), antialias: true });
  renderer.setPixelRatio(devicePixelRatio);
  const gltf = await load();
  const scene = new Scene();
  scene.background = new Color(0);
  scene.add(gltf.scene);
  const sphere = new Box3().setFromObject(gltf.scene).getBoundingSphere(new Sphere());
  const views = viewpoints(gltf, sphere);

  let camera;
  let controls;
  let isAsked = false;
  /** Draws a frame as soon as possible. */
  const draw = () => {
    if (isAsked) return;
    isAsked = true;
    requestAnimationFrame(() => {
      isAsked = false;
      renderer.render(scene, camera);
      requestAnimationFrame(() => {
        window.sirReady = true;
        document.documentElement.dataset.ready = '1';
      });
    });
  };
  const resize = () => {
    renderer.setSize(innerWidth, innerHeight, false);
    const aspect = innerWidth / innerHeight;
    if (camera.isPerspectiveCamera) {
      camera.aspect = aspect;
    } else {
      [camera.left, camera.right] = [-aspect * camera.top, aspect * camera.top];
    }
    camera.updateProjectionMatrix();
    draw();
  };
  const look = (index) => {
    const view = views[index];
    camera = view.camera;
    // Depth has 24 bits, so the near plane is not nearer than needed.
    camera.near = Math.max(camera.near, sphere.radius / 2000);
    camera.far = camera.position.distanceTo(sphere.center) + 2 * sphere.radius;
    const forward = camera.getWorldDirection(new Vector3());
    const distance = Math.max(sphere.center.clone().sub(camera.position).dot(forward), 0.2 * sphere.radius);
    // The constructor turns the camera to the center of the scene's coordinates.
    const turn = camera.quaternion.clone();
    controls?.dispose();
    controls = new OrbitControls(camera, renderer.domElement);
    camera.quaternion.copy(turn);
    // Kept for the next time that this camera is chosen.
    view.target ??= camera.position.clone().addScaledVector(forward, distance);
    controls.target.copy(view.target);
    controls.update();
    controls.addEventListener('change', draw);
    resize();
  };

  const { meshes } = gltf.userData.lightmap;
  const expose = () => {
    const stops = Number(element('exposure').value);
    renderer.toneMappingExposure = 2 ** stops;
    element('exposure-text').textContent = `${stops.toFixed(1)} stops`;
    draw();
  };
  const curve = () => {
    renderer.toneMapping = CURVES[element('tone').value];
    draw();
  };
  for (const [i, view] of views.entries()) element('camera').add(new Option(view.name, i));
  element('camera').value = chosen(views);
  element('exposure').value = options.get('exposure') ?? 0;
  // Colors of a file without lightmap have a tone curve already.
  element('tone').value = options.get('tone') ?? (meshes > 0 ? 'sir' : 'none');
  if (!element('tone').value) throw new Error(`there is no tone curve "${options.get('tone')}"`);
  element('note').textContent = meshes > 0 ? '' : 'The file has no lightmap.';
  element('panel').hidden = options.get('panel') === '0';
  element('message').hidden = true;

  look(chosen(views));
  expose();
  curve();
  element('camera').addEventListener('change', (event) => look(Number(event.target.value)));
  element('exposure').addEventListener('input', expose);
  element('tone').addEventListener('change', curve);
  addEventListener('resize', resize);
}

start().catch(fail);
