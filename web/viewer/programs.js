import { FIELD_GLSL } from "../field/shader.js";
import { SHADE_GLSL } from "./shade_shader.js";

const WHOLE_SCREEN = `#version 300 es
out vec2 place;
void main() {
  place = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;
  gl_Position = vec4(place, 0.0, 1.0);
}`;

const TRACE = `
in vec2 place;
uniform vec3 eye;
uniform mat3 axes;
uniform vec2 half_size;
uniform vec2 jitter;
uniform vec4 uv_map;
uniform int chart_table;
layout(location = 0) out vec4 out_hit;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_uv;
layout(location = 3) out vec4 out_slopes;
void main() {
  vec3 direction = normalize(axes * vec3((place + jitter) * half_size, -1.0));
  nispCalls = 0;
  NispHit hit = nispTrace(eye, direction);
  float calls = float(nispCalls);
  out_hit = vec4(-1.0);
  out_normal = vec4(0.0, 0.0, 0.0, calls);
  out_uv = out_slopes = vec4(0.0);
  if (hit.distance < 0.0) return;
  nispDescribe(hit, direction, uv_map);
  vec4 owner = nispTexel(chart_table + hit.chart);
  out_hit = vec4(hit.distance, float(hit.chart), owner.x, owner.y);
  out_normal = vec4(hit.normal, calls);
  out_uv = vec4(hit.uv, hit.slope_u.xy);
  out_slopes = vec4(hit.slope_u.z, hit.slope_v);
}`;

const SHADE_FIELD = `#version 300 es
precision highp float;
precision highp int;
in vec2 place;
uniform vec3 eye;
uniform mat3 axes;
uniform vec2 half_size;
uniform vec2 jitter;
uniform float width;
uniform vec2 owner;
uniform mat4 projection;
uniform sampler2D hits, normals, uvs, slopes;
out vec4 color;
${SHADE_GLSL}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 hit = texelFetch(hits, at, 0), normal = texelFetch(normals, at, 0);
  if (hit.x < 0.0 || hit.zw != owner) discard;
  vec4 first = texelFetch(uvs, at, 0), second = texelFetch(slopes, at, 0);
  vec3 towards = normalize(axes * vec3((place + jitter) * half_size, -1.0));
  vec3 slope_u = vec3(first.zw, second.x), slope_v = second.yzw;
  vec4 clip = projection * vec4(eye + hit.x * towards, 1.0);
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
  float slant = max(abs(dot(normal.xyz, towards)), 0.1);
  float area = length(cross(slope_u, slope_v)) * width * width * hit.x * hit.x / slant;
  color = shaded(towards, normal.xyz, first.xy, area, slope_u, slope_v, int(hit.y));
}`;

const MESH_VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in float chart;
uniform mat4 projection;
out vec3 where;
out vec3 bent;
out vec2 texture_place;
flat out int label;
void main() {
  where = position;
  bent = normal;
  texture_place = uv;
  label = int(chart);
  gl_Position = projection * vec4(position, 1.0);
}`;

const MESH_FRAGMENT = `#version 300 es
precision highp float;
precision highp int;
in vec3 where;
in vec3 bent;
in vec2 texture_place;
flat in int label;
uniform vec3 eye;
uniform vec4 cut;
out vec4 color;
${SHADE_GLSL}
void main() {
  if (dot(cut.xyz, where) > cut.w) discard;
  // Gradients of u and v in the plane of the triangle, from what changes to the pixels beside.
  vec3 right = dFdx(where), up = dFdy(where);
  vec2 right_uv = dFdx(texture_place), up_uv = dFdy(texture_place);
  float area = abs(right_uv.x * up_uv.y - right_uv.y * up_uv.x);
  vec3 flat_normal = cross(right, up);
  float size = max(dot(flat_normal, flat_normal), 1e-30);
  vec3 to_right = cross(up, flat_normal) / size, to_up = cross(flat_normal, right) / size;
  vec3 slope_u = right_uv.x * to_right + up_uv.x * to_up, slope_v = right_uv.y * to_right + up_uv.y * to_up;
  color = shaded(normalize(where - eye), normalize(bent), texture_place, area, slope_u, slope_v, label);
}`;

const LINES_FRAGMENT = `#version 300 es
precision highp float;
in vec3 where;
uniform vec4 cut;
out vec4 color;
void main() {
  if (dot(cut.xyz, where) > cut.w) discard;
  color = vec4(0.0, 0.0, 0.0, 1.0);
}`;

const SLICE_VERTEX = `#version 300 es
uniform mat4 projection;
uniform int axis;
uniform float place;
out vec2 at;
void main() {
  at = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
  vec3 where;
  where[axis] = place;
  where[(axis + 1) % 3] = at.x;
  where[(axis + 2) % 3] = at.y;
  gl_Position = projection * vec4(where, 1.0);
}`;

/** Blue inside, orange outside, the surface black; a band for each twentieth of the radius. */
const SLICE_FRAGMENT = `#version 300 es
precision highp float;
in vec2 at;
uniform float place;
uniform sampler2D distances;
out vec4 color;
float sample_of(ivec2 texel) {
  return texelFetch(distances, clamp(texel, ivec2(0), textureSize(distances, 0) - 1), 0).x;
}
void main() {
  vec2 between = (0.5 + 0.5 * at) * vec2(textureSize(distances, 0)) - 0.5;
  ivec2 texel = ivec2(floor(between));
  vec2 share = fract(between);
  float below = mix(sample_of(texel), sample_of(texel + ivec2(1, 0)), share.x);
  float above = mix(sample_of(texel + ivec2(0, 1)), sample_of(texel + 1), share.x);
  float found = mix(below, above, share.y);
  float line = fwidth(found);
  // Beyond the unit ball networks know no distances.
  if (dot(at, at) + place * place > 1.0) discard;
  vec3 tone = found < 0.0 ? vec3(0.1, 0.3, 0.8) : vec3(0.9, 0.45, 0.1);
  tone = mix(tone, vec3(1.0), 0.8 * exp(-4.0 * abs(found)));
  if (fract(10.0 * abs(found)) > 0.5) tone *= 0.7;
  color = vec4(abs(found) < line ? vec3(0.0) : tone, 1.0);
}`;

const ADD = `#version 300 es
precision highp float;
uniform sampler2D picture;
out vec4 color;
void main() {
  color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
}`;

/** Straight alpha, sRGB-encoded; premultiplied for a canvas. */
const PRESENT = `#version 300 es
precision highp float;
in vec2 place;
uniform sampler2D picture;
uniform float samples;
uniform bool premultiplied;
out vec4 color;
void main() {
  vec4 mean = texture(picture, 0.5 + 0.5 * place) / samples;
  vec3 light = clamp(mean.rgb / max(mean.a, 1e-6), 0.0, 1.0);
  vec3 encoded = mix(12.92 * light, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, light));
  color = vec4(premultiplied ? encoded * mean.a : encoded, mean.a);
}`;

/** A linked program, and where its uniforms are. */
export class Program {
  /** @param {WebGL2RenderingContext} gl @param {string} vertex @param {string} fragment */
  constructor(gl, vertex, fragment) {
    this.gl = gl;
    this.program = /** @type {WebGLProgram} */ (gl.createProgram());
    for (const [kind, text] of /** @type {[number, string][]} */ ([
      [gl.VERTEX_SHADER, vertex],
      [gl.FRAGMENT_SHADER, fragment],
    ])) {
      const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    /** @type {Map<string, WebGLUniformLocation|null>} */
    this.places = new Map();
  }

  use() {
    const { gl, program } = this;
    if (!this.places.size && !gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const logs = gl.getAttachedShaders(program)?.map((shader) => gl.getShaderInfoLog(shader));
      throw new Error(`shader: ${gl.getProgramInfoLog(program)} ${logs?.join(" ")}`);
    }
    gl.useProgram(program);
  }

  /** @param {string} name */
  at(name) {
    if (!this.places.has(name)) this.places.set(name, this.gl.getUniformLocation(this.program, name));
    return this.places.get(name) ?? null;
  }
}

/** Programs of a context, made when first needed: shaders take long to compile. */
export class Programs {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    /** @type {Map<string, Program>} */
    this.made = new Map();
  }

  /** @param {string} name @param {() => [string, string]} sources */
  get(name, sources) {
    const program = this.made.get(name) ?? new Program(this.gl, ...sources());
    this.made.set(name, program);
    program.use();
    return program;
  }

  /** @param {number} groups of 4 in the widest layer */
  trace(groups) {
    const head = `#version 300 es\n#define NISP_GROUPS ${groups}\n`;
    return this.get(`trace${groups}`, () => [WHOLE_SCREEN, head + FIELD_GLSL + TRACE]);
  }

  shadeField() {
    return this.get("shade", () => [WHOLE_SCREEN, SHADE_FIELD]);
  }

  mesh() {
    return this.get("mesh", () => [MESH_VERTEX, MESH_FRAGMENT]);
  }

  lines() {
    return this.get("lines", () => [MESH_VERTEX, LINES_FRAGMENT]);
  }

  slice() {
    return this.get("slice", () => [SLICE_VERTEX, SLICE_FRAGMENT]);
  }

  add() {
    return this.get("add", () => [WHOLE_SCREEN, ADD]);
  }

  present() {
    return this.get("present", () => [WHOLE_SCREEN, PRESENT]);
  }
}
