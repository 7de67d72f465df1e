// Shaders.

/** What is shown, in the order of the menu. The position is the number in the shader. */
const MODES = ['lit', 'illuminance', 'radiosity', 'direct', 'reflected', 'error'];

const glslVector = (row) => `vec3(${row.map((x) => x.toFixed(10)).join(', ')})`;

const VERTEX_SHADER = `#version 300 es
precision highp float;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 code;
layout(location = 2) in uint side;
uniform mat4 clip;
uniform vec2 codes;  // lowest logarithm, step
out vec3 place;
out vec3 light;
flat out uint which;
void main() {
  place = position;
  which = side;
  light = mix(exp(codes.x + (code - 1.0) * codes.y), vec3(0.0), equal(code, vec3(0.0)));
  gl_Position = clip * vec4(position, 1.0);
}`;

// Without a section, nothing is discarded: tests of the depth are then earlier and faster.
const SECTION_TEST = `
#ifdef SECTION
  if (dot(section.xyz, place) > section.w) discard;
#endif`;

const COLOR_SHADER = `#version 300 es
precision highp float;
precision highp int;
in vec3 place;
in vec3 light;
flat in uint which;
uniform sampler2D sideLight;
uniform sampler2D sideSurface;
uniform sampler2D sideSource;
uniform int mode;
uniform bool flatValues;
uniform bool logarithmic;
uniform vec2 limits;    // lower limit and inverse of the span, of logarithms if logarithmic
uniform float exposure;
uniform vec4 section;
out vec4 color;

const vec3 WEIGHTS = ${glslVector(LUMINANCE)};

vec3 toneMap(vec3 x) {
  float peak = max(x.r, max(x.g, x.b));
  if (peak <= 0.5) return x;
  peak = min(peak, 1e30);
  float compressed = 1.0 - 0.25 / peak;
  float kept = 1.0 / (1.0 + 0.1 * (peak - compressed));
  return mix(vec3(compressed), x * (compressed / peak), kept);
}

vec3 srgb(vec3 linear) {
  vec3 x = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

vec3 viridis(float t) {
  vec3 sum = ${glslVector(VIRIDIS[6])};
${VIRIDIS.slice(0, 6).reverse().map((row) => `  sum = sum * t + ${glslVector(row)};`).join('\n')}
  return clamp(sum, 0.0, 1.0);
}

void main() {${SECTION_TEST}
  ivec2 texel = ivec2(int(which) % ${TEXTURE_WIDTH}, int(which) / ${TEXTURE_WIDTH});
  vec4 own = texelFetch(sideLight, texel, 0);
  vec4 surface = texelFetch(sideSurface, texel, 0);
  vec3 source = texelFetch(sideSource, texel, 0).rgb;
  vec3 irradiance = flatValues ? own.rgb : light;
  vec3 radiosity = source + surface.rgb * irradiance;
  if (mode == 0) {
    color = vec4(srgb(toneMap(radiosity * (exposure * 0.3183098861837907))), 1.0);
    return;
  }
  float value = dot(irradiance, WEIGHTS);
  if (mode == 2) value = dot(radiosity, WEIGHTS);
  if (mode == 3) value = surface.a;
  if (mode == 4) {
    float all = dot(own.rgb, WEIGHTS);
    value = all - surface.a > ${ROUNDING} * all ? all - surface.a : 0.0;
  }
  if (mode == 5) {
    float mean = dot(own.rgb, WEIGHTS);
    if (own.a <= 0.0 || mean <= 0.0) {
      color = vec4(0.55, 0.55, 0.55, 1.0);
      return;
    }
    value = 100.0 * own.a / mean;
  }
  float t = ((logarithmic ? log(max(value, 1e-37)) : value) - limits.x) * limits.y;
  color = vec4(viridis(clamp(t, 0.0, 1.0)), 1.0);
}`;

const PICK_SHADER = `#version 300 es
precision highp float;
precision highp int;
in vec3 place;
flat in uint which;
uniform vec4 section;
out uvec4 found;
void main() {${SECTION_TEST}
  found = uvec4(which + 1u, floatBitsToUint(place));
}`;

const LINE_VERTEX_SHADER = `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
uniform sampler2D positions;
uniform usampler2D edges;
uniform mat4 clip;
uniform vec4 eye;       // position and 1, or direction and 0 of an orthographic view
uniform float nearer;   // how far lines are moved toward the eye
out vec3 place;
vec3 vertex(uint i) {
  return texelFetch(positions, ivec2(int(i) % ${TEXTURE_WIDTH}, int(i) / ${TEXTURE_WIDTH}), 0).xyz;
}
void main() {
  int edge = gl_VertexID / 2;
  uvec3 code = texelFetch(edges, ivec2(edge % ${TEXTURE_WIDTH}, edge / ${TEXTURE_WIDTH}), 0).xyz;
  vec3 a = vertex(code.x);
  vec3 b = vertex(code.y);
  vec3 normal = cross(b - a, vertex(code.z & 0x7fffffffu) - a);
  if (code.z >= 0x80000000u) normal = -normal;
  place = gl_VertexID % 2 == 0 ? a : b;
  vec3 toEye = eye.w > 0.0 ? eye.xyz - place : -eye.xyz;
  gl_Position = clip * vec4(place + nearer * toEye, 1.0);
  // The outlines of backs are not drawn.
  if (dot(normal, toEye) <= 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;

const LINE_SHADER = `#version 300 es
precision highp float;
in vec3 place;
uniform vec4 section;
uniform vec4 ink;
out vec4 color;
void main() {${SECTION_TEST}
  color = ink;
}`;

/** Returns a function that makes a program when it is first used: with a section or without. */
function programPair(gl, vertexText, fragmentText) {
  const made = {};
  return (sectioned) => {
    made[sectioned] ??= makeProgram(gl, vertexText, sectioned ? fragmentText.replace('\n', '\n#define SECTION\n') : fragmentText);
    return made[sectioned];
  };
}

function makeProgram(gl, vertexText, fragmentText) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, fragmentText]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(`A shader was not accepted: ${gl.getShaderInfoLog(shader)}`);
    }
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new Error(`The shaders were not accepted: ${gl.getProgramInfoLog(program)}`);
  }
  const at = {};
  const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) ?? 0;
  for (let i = 0; i < count; i += 1) {
    const { name } = gl.getActiveUniform(program, i);
    at[name] = gl.getUniformLocation(program, name);
  }
  return { program, at };
}
