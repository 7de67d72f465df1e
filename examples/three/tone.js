// SPDX-License-Identifier: MIT OR Apache-2.0

/** Tone curves. All of them multiply with `renderer.toneMappingExposure` first, unlike NoToneMapping. */

import { ACESFilmicToneMapping, CustomToneMapping, LinearToneMapping, NeutralToneMapping, ShaderChunk } from 'three';

/** The tone curve of SIR's pictures (`tone_map` in `crates/sir-view/src/tone.rs`). */
const SIR = /* glsl */ `
vec3 CustomToneMapping( vec3 color ) {
	color = max( color * toneMappingExposure, vec3( 0.0 ) );
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak <= 0.5 ) return color;
	float compressed = 1.0 - 0.25 / peak;
	float kept = 1.0 / ( 1.0 + 0.1 * ( peak - compressed ) );
	return mix( vec3( compressed ), color * ( compressed / peak ), kept );
}
`;

const EMPTY = 'vec3 CustomToneMapping( vec3 color ) { return color; }';

export const CURVES = {
  sir: CustomToneMapping,
  none: LinearToneMapping,
  aces: ACESFilmicToneMapping,
  neutral: NeutralToneMapping,
};

/** Makes CustomToneMapping the tone curve of SIR. To be called before the first frame. */
export function installToneCurve() {
  const chunk = ShaderChunk.tonemapping_pars_fragment;
  if (!chunk.includes(EMPTY)) throw new Error('This version of three.js has another CustomToneMapping.');
  ShaderChunk.tonemapping_pars_fragment = chunk.replace(EMPTY, SIR);
}
