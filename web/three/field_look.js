/** A look into maps, in GLSL: the samplers nisp_map0 and so on. @param {number} maps */
export const mapsGLSL = (maps) => `
vec4 nispTexture(int number, vec2 uv, float area) {
  ${each(maps, (i) => `if (number == ${i}) return textureLod(nisp_map${i}, uv, 0.5 * log2(max(area * float(textureSize(nisp_map${i}, 0).x * textureSize(nisp_map${i}, 0).y), 1e-12)));`)}
  return vec4(1.0);
}`;

/** Color (RGB) and depth of what is seen through a place of a field's box, in GLSL; goes with mapsGLSL and field/shader.js. */
export const LOOK_GLSL = `
vec4 nispLook(vec3 place, vec3 eye, mat4 to_clip, vec4 uv_map, int chart_table, vec3 lamp) {
  float far = length(place - eye);
  vec3 direction = (place - eye) / far;
  float turning = length(dFdx(direction));
  // Rays start at the box's diameter from its back, or far eyes cost digits.
  float back = min(far, 3.6);
  NispHit hit = nispTrace(place - back * direction, direction);
  if (hit.distance < 0.0) discard;
  nispDescribe(hit, direction, uv_map);
  vec4 clip = to_clip * vec4(hit.position, 1.0);
  float width = turning * (far - back + hit.distance);
  float slant = max(abs(dot(hit.normal, direction)), 0.1);
  float area = length(cross(hit.slope_u, hit.slope_v)) * width * width / slant;
  vec4 chart = nispTexel(chart_table + hit.chart);
  vec3 base = chart.rgb * nispTexture(int(chart.w), vec2(hit.uv.x, 1.0 - hit.uv.y), area).rgb;
  vec3 normal = dot(hit.normal, direction) < 0.0 ? hit.normal : -hit.normal;
  return vec4(base * (0.25 + 0.75 * max(dot(normal, lamp), 0.0)), 0.5 + 0.5 * clip.z / clip.w);
}`;

/** The same in WGSL, which goes with field/shader_wgsl.js; textures are handed over. @param {number} maps */
export const lookWGSL = (maps) => `
fn nispLook(
  place: vec3f, eye: vec3f, to_clip: mat4x4f, uv_map: vec4f, chart_table: i32, lamp: vec3f,
  data: texture_2d<f32>, grid: texture_3d<f32>,
  ${each(maps, (i) => `map${i}: texture_2d<f32>, sampler${i}: sampler,`)}
) -> vec4f {
  let far = length(place - eye);
  let direction = (place - eye) / far;
  let turning = length(dpdx(direction));
  let back = min(far, 3.6);
  let traced = nispTrace(data, grid, place - back * direction, direction);
  if (traced.distance < 0.0) {
    discard;
    return vec4f();
  }
  let hit = nispDescribe(data, traced, direction, uv_map);
  let clip = to_clip * vec4f(hit.position, 1.0);
  let width = turning * (far - back + hit.distance);
  let slant = max(abs(dot(hit.normal, direction)), 0.1);
  let area = length(cross(hit.slope_u, hit.slope_v)) * width * width / slant;
  let chart = nispTexel(data, chart_table + hit.chart);
  let uv = vec2f(hit.uv.x, 1.0 - hit.uv.y);
  var base = chart.rgb;
  ${each(maps, (i) => `if (i32(chart.w) == ${i}) { base *= textureSampleLevel(map${i}, sampler${i}, uv, nispLevel(textureDimensions(map${i}), area)).rgb; }`)}
  let normal = select(-hit.normal, hit.normal, dot(hit.normal, direction) < 0.0);
  return vec4f(base * (0.25 + 0.75 * max(dot(normal, lamp), 0.0)), clip.z / clip.w);
}

fn nispLevel(size: vec2u, area: f32) -> f32 {
  return 0.5 * log2(max(area * f32(size.x * size.y), 1e-12));
}`;

/** A line for each of some numbers. @param {number} count @param {(number: number) => string} line */
function each(count, line) {
  return Array.from({ length: count }, (_, i) => line(i)).join("\n  ");
}
