// SPDX-License-Identifier: MIT OR Apache-2.0

/**
 * Lightmaps of SIR for the GLTFLoader of three.js. This file can be copied into other projects.
 *
 *     loader.register((parser) => new SirLightmapPlugin(parser));
 *
 * In a GLB file of SIR, `extras.lightmap` of a node has the light of its mesh: `{ index, texCoord, intensity, uv_rect }`, a
 * texture, its set of coordinates, the factor from linear texels to irradiance as it is shown, and corner and size of the
 * place of the node on the texture. `extras.lightmap` of the scene has the exposure that the intensity contains.
 *
 * three.js adds `lightMapIntensity * texel` to the irradiance of a surface. The diffuse radiance is `color / pi` times that.
 */

import { Material, MeshLambertMaterial, SRGBColorSpace } from 'three';

/** Sets of texture coordinates that three.js has. */
const CHANNELS = 4;

export class SirLightmapPlugin {

  /**
   * @param {object} parser The parser of GLTFLoader.
   * @param {object} [options]
   * @param {'diffuse'|'source'} [options.materials] `diffuse` replaces materials by MeshLambertMaterial, which reflects
   *   exactly the light that SIR computed. `source` keeps the materials of the file: metals, and highlights of lights that
   *   you add. MeshStandardMaterial then gives a few per cent of the light to its highlights, which a lightmap lacks.
   * @param {boolean} [options.lights] True to keep the lights of the file. Their light is in the lightmap already.
   */
  constructor(parser, { materials = 'diffuse', lights = false } = {}) {
    this.name = 'SIR_lightmap';
    this.parser = parser;
    this.materials = materials;
    this.lights = lights;
    this.exposure = 1;
    this.textures = new Map();
    this.lit = new Map();
  }

  /** Adds the light after all scenes are loaded. Sets `gltf.userData.lightmap`: `{ meshes, exposure }`. */
  async afterRoot(gltf) {
    const { json } = this.parser;
    this.exposure = json.scenes?.[json.scene ?? 0]?.extras?.lightmap?.exposure ?? 1;
    const meshes = [];
    for (const scene of gltf.scenes) {
      scene.traverse((object) => {
        if (object.isMesh) meshes.push(object);
        // Children of a light stay visible.
        if (object.isLight && !this.lights) object.layers.disableAll();
      });
    }
    let count = 0;
    for (const mesh of meshes) {
      const place = this.place(mesh);
      if (place) {
        mesh.material = await this.material(mesh.material, place);
        count += 1;
      }
    }
    gltf.userData.lightmap = { meshes: count, exposure: this.exposure };
  }

  /** Returns where the light of a mesh is, or null. */
  place(mesh) {
    const { json, associations } = this.parser;
    const material = json.materials?.[associations.get(mesh.material)?.materials];
    // Colors of unlit materials have the light already.
    if (material?.extensions?.KHR_materials_unlit) return null;
    let object = mesh;
    while (object && associations.get(object)?.nodes === undefined) object = object.parent;
    const lightmap = json.nodes[associations.get(object)?.nodes]?.extras?.lightmap;
    if (!lightmap) return null;
    const { index, texCoord, intensity, uv_rect } = lightmap;
    return { texture: index, channel: texCoord, intensity, rect: uv_rect };
  }

  /** Returns the material of a mesh with its light. Meshes with the same light share it. */
  async material(source, place) {
    const key = [source.uuid, place.texture, place.channel, ...place.rect].join(' ');
    if (!this.lit.has(key)) {
      const material = this.materials === 'diffuse' ? diffuse(source) : source.clone();
      material.lightMap = await this.texture(place);
      material.lightMapIntensity = place.intensity;
      // The radiance of the file is multiplied with the exposure, as the lightmap is.
      material.emissiveIntensity *= this.exposure;
      this.lit.set(key, material);
    }
    return this.lit.get(key);
  }

  /** Returns a texture that reads the place of a page. All places of a page share its image on the GPU. */
  async texture({ texture: index, channel, rect }) {
    if (channel >= CHANNELS) throw new Error(`three.js has no texture coordinates ${channel}.`);
    const key = [index, channel, ...rect].join(' ');
    if (!this.textures.has(key)) {
      const texture = (await this.parser.getDependency('texture', index)).clone();
      texture.colorSpace = SRGBColorSpace;
      texture.flipY = false;
      texture.channel = channel;
      texture.offset.set(rect[0], rect[1]);
      texture.repeat.set(rect[2], rect[3]);
      this.textures.set(key, texture);
    }
    return this.textures.get(key);
  }
}

/** Returns a diffuse material with color, transparency and emission of another one. Metals reflect their color diffusely. */
function diffuse(source) {
  const material = new MeshLambertMaterial();
  Material.prototype.copy.call(material, source);
  for (const name of ['color', 'emissive']) material[name].copy(source[name]);
  // No occlusion map: the light is occluded already.
  for (const name of ['map', 'alphaMap', 'emissiveMap', 'emissiveIntensity', 'flatShading']) material[name] = source[name];
  return material;
}
