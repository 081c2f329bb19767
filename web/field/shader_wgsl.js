import { CONSTANTS_WGSL } from "./constants.js";

/**
 * shader.js in WGSL, function by function, where it is explained. Textures are handed on, as a caller's
 * bindings have names of their own. The caller declares NISP_GROUPS.
 */
export const FIELD_WGSL = `
${CONSTANTS_WGSL}

var<private> nispSlope: f32;
var<private> nispIn: array<vec4f, NISP_GROUPS>;
var<private> nispOut: array<vec4f, NISP_GROUPS>;

fn nispTexel(data: texture_2d<f32>, at: i32) -> vec4f {
  return textureLoad(data, vec2i(at & 1023, at >> 10u), 0);
}

fn nispSine(t: vec4f) -> vec4f {
  let whole = floor(t + 0.5);
  let f = t - whole;
  let s = f * f;
  let inner = 2.550069808959961 + s * (-0.5982421040534973 + s * 0.07756038755178452);
  let half_turn = f * (3.1415927410125732 + s * (-5.167709827423096 + s * inner));
  return half_turn * (1.0 - 2.0 * (whole - 2.0 * floor(0.5 * whole)));
}

fn nispCoordinate(p: vec3f, mirror: i32, number: i32) -> f32 {
  if (number < 3) {
    return select(p[number], abs(p[number]), ((mirror >> u32(number)) & 1) == 1);
  }
  var left = number - 3;
  for (var axis = 0; axis < 3; axis++) {
    if (((mirror >> u32(3 + axis)) & 1) == 1) {
      if (left == 0) { return p[axis]; }
      left--;
    }
  }
  return 0.0;
}

fn nispPut(place: i32, value: f32) {
  nispIn[place >> 2u][place & 3] = value;
}

fn nispEnter(data: texture_2d<f32>, network: i32, p: vec3f, chart: i32) {
  let form = vec4i(nispTexel(data, network + 1));
  let places = nispTexel(data, network + 2);
  let sizes = vec4i(nispTexel(data, network + 3));
  let charts = nispTexel(data, network).z;
  for (var i = 0; i < (sizes.y + 3) / 4; i++) { nispIn[i] = vec4f(0.0); }
  var at = 0;
  for (var i = 0; i < form.w; i++) {
    var value: f32;
    if (form.z == 1 && i == form.w - 1) {
      value = f32(2 * chart + 1) / charts - 1.0;
    } else {
      value = nispCoordinate(p, form.x, i);
    }
    if (form.y == 0) {
      nispPut(at, value);
      at++;
    }
    for (var level = 0; level < form.y; level++) {
      let turns = exp2(f32(level)) * value;
      nispPut(at, nispSine(vec4f(turns)).x);
      nispPut(at + 1, nispSine(vec4f(turns + 0.5)).x);
      at += 2;
    }
  }
  for (var i = 0; i < sizes.x; i++) { nispPut(at + i, nispTexel(data, i32(places.z) + chart * sizes.x + i).x); }
}

fn nispRows(data: texture_2d<f32>, layer: vec4i, group: i32) -> vec4f {
  var at = layer.z + group * (1 + 4 * layer.x);
  var sum = nispTexel(data, at);
  at++;
  for (var i = 0; i < layer.x; i++) {
    let x = nispIn[i];
    sum += nispTexel(data, at) * x.x + nispTexel(data, at + 1) * x.y + nispTexel(data, at + 2) * x.z + nispTexel(data, at + 3) * x.w;
    at += 4;
  }
  return sum;
}

fn nispHidden(data: texture_2d<f32>, network: i32) -> vec4i {
  let head = vec4i(nispTexel(data, network));
  let sine = nispTexel(data, network + 2).x == 0.0;
  for (var number = 0; number < head.y - 1; number++) {
    let layer = vec4i(nispTexel(data, head.x + number));
    for (var group = 0; group < layer.y; group++) {
      let sums = nispRows(data, layer, group);
      if (sine) { nispOut[group] = nispSine(sums); } else { nispOut[group] = max(sums, vec4f(0.0)); }
    }
    for (var group = 0; group < layer.y; group++) { nispIn[group] = nispOut[group]; }
  }
  return vec4i(nispTexel(data, head.x + head.y - 1));
}

fn nispFinish(data: texture_2d<f32>, network: i32, sums: vec4f) -> vec4f {
  let kind = i32(nispTexel(data, network + 2).y);
  if (kind == 1) { return tanh(sums); }
  if (kind == 2) { return 1.0 / (1.0 + exp(-sums)); }
  return sums;
}

fn nispSdf(data: texture_2d<f32>, p: vec3f) -> f32 {
  nispEnter(data, NISP_SDF, p, 0);
  let last = nispHidden(data, NISP_SDF);
  return nispFinish(data, NISP_SDF, nispRows(data, last, 0)).x;
}

fn nispGradient(data: texture_2d<f32>, p: vec3f) -> vec3f {
  let e = vec2f(NISP_OFFSET, 0.0);
  let x = nispSdf(data, p + e.xyy) - nispSdf(data, p - e.xyy);
  let y = nispSdf(data, p + e.yxy) - nispSdf(data, p - e.yxy);
  let z = nispSdf(data, p + e.yyx) - nispSdf(data, p - e.yyx);
  return vec3f(x, y, z) / (2.0 * NISP_OFFSET);
}

fn nispChart(data: texture_2d<f32>, p: vec3f) -> i32 {
  let charts = i32(nispTexel(data, NISP_CHART).w);
  if (charts == 0) { return 0; }
  nispEnter(data, NISP_CHART, p, 0);
  let layer = nispHidden(data, NISP_CHART);
  var best = 0;
  var most = 0.0;
  for (var group = 0; group < layer.y; group++) {
    let found = nispRows(data, layer, group);
    for (var i = 0; i < 4; i++) {
      let chart = 4 * group + i;
      if (chart < charts && (chart == 0 || found[i] > most)) {
        best = chart;
        most = found[i];
      }
    }
  }
  return best;
}

fn nispUv(data: texture_2d<f32>, p: vec3f, chart: i32) -> vec2f {
  if (nispTexel(data, NISP_UV).y == 0.0) { return vec2f(0.0); }
  nispEnter(data, NISP_UV, p, chart);
  let last = nispHidden(data, NISP_UV);
  var found = nispRows(data, last, 0).xy;
  let form = vec4i(nispTexel(data, NISP_UV + 1));
  if (form.z == 2) {
    let at = i32(nispTexel(data, NISP_UV + 2).w) + chart * (form.w + 1);
    for (var i = 0; i < form.w; i++) { found += nispTexel(data, at + i).xy * nispCoordinate(p, form.x, i); }
    found += nispTexel(data, at + form.w).xy;
  }
  return nispFinish(data, NISP_UV, vec4f(found, 0.0, 0.0)).xy;
}

fn nispFree(grid: texture_3d<f32>, p: vec3f, direction: vec3f) -> f32 {
  let size = i32(textureDimensions(grid).x);
  let cell = 2.0 * NISP_CUBE / f32(size);
  let place = clamp(vec3i(floor((p + NISP_CUBE) / cell)), vec3i(0), vec3i(size - 1));
  let away = floor(255.0 * textureLoad(grid, place, 0).x + 0.5);
  if (away == 0.0) { return 0.0; }
  let low = (vec3f(place) - (away - 1.0)) * cell - NISP_CUBE;
  let high = low + (2.0 * away - 1.0) * cell;
  let spans = select((select(low, high, direction > vec3f(0.0)) - p) / direction, vec3f(1e9), abs(direction) < vec3f(1e-9));
  return max(min(spans.x, min(spans.y, spans.z)), 0.0) + 1e-5;
}

fn nispBetween(data: texture_2d<f32>, origin: vec3f, direction: vec3f, side: f32, outside: vec2f, inside: vec2f) -> f32 {
  var low = outside.x;
  var before = outside.y;
  var high = inside.x;
  var beyond = inside.y;
  for (var i = 0; i < 4; i++) {
    let middle = mix(low, high, clamp(before / (before - beyond), 0.05, 0.95));
    let there = side * nispSdf(data, origin + middle * direction);
    if (abs(there) < NISP_EXACT) { return middle; }
    if (there > 0.0) {
      low = middle;
      before = there;
    } else {
      high = middle;
      beyond = there;
    }
  }
  return mix(low, high, before / (before - beyond));
}

fn nispStep(value: f32, before: f32, way: f32) -> f32 {
  let least = value / nispSlope;
  if (before > 1e8) { return least; }
  let fall = (before - value) / way;
  if (value < NISP_CLOSE && fall > NISP_FAST * nispSlope) { return NISP_BEYOND * value / fall; }
  return clamp(NISP_OVERLAP * 2.0 * value / (nispSlope + fall), least, 4.0 * least);
}

fn nispMarch(data: texture_2d<f32>, grid: texture_3d<f32>, origin: vec3f, direction: vec3f, start: f32, leave: f32, side: f32) -> f32 {
  var at = start;
  var before = 1e9;
  var last = at;
  for (var i = 0; i < NISP_STEPS; i++) {
    if (at > leave) { return -1.0; }
    let p = origin + at * direction;
    let free = nispFree(grid, p, direction);
    if (free > 0.0) {
      before = 1e9;
      last = at;
      at += free;
      continue;
    }
    let value = side * nispSdf(data, p);
    if (value < 0.0) {
      if (before < 1e8) { return nispBetween(data, origin, direction, side, vec2f(last, before), vec2f(at, value)); }
      return at;
    }
    if (value < NISP_NEAR && value < before) { return at; }
    if (before < 1e8 && before + value < nispSlope * (at - last) - NISP_LEAST_STEP) {
      at = last + before / nispSlope;
      continue;
    }
    let step = nispStep(value, before, at - last);
    before = value;
    last = at;
    at += max(step, NISP_LEAST_STEP);
  }
  return -1.0;
}

struct NispHit {
  distance: f32,
  position: vec3f,
  normal: vec3f,
  chart: i32,
  uv: vec2f,
  slope_u: vec3f,
  slope_v: vec3f,
}

fn nispTrace(data: texture_2d<f32>, grid: texture_3d<f32>, origin: vec3f, direction: vec3f) -> NispHit {
  var hit: NispHit;
  hit.distance = -1.0;
  let held = nispTexel(data, NISP_SDF + 3).zw;
  nispSlope = held.x;
  let along = -dot(origin, direction);
  let square = NISP_BALL * NISP_BALL - (dot(origin, origin) - along * along);
  if (square <= 0.0) { return hit; }
  let half_chord = sqrt(square);
  let leave = along + half_chord;
  var at = max(along - half_chord, 0.0);
  var side = 1.0;
  for (var layer = 0; layer < NISP_LAYERS_SEEN; layer++) {
    at = nispMarch(data, grid, origin, direction, at, leave, side);
    if (at < 0.0) { return hit; }
    hit.chart = nispChart(data, origin + at * direction);
    if (hit.chart != i32(held.y)) { break; }
    at += NISP_LEAST_STEP;
    side = -side;
  }
  hit.distance = at;
  hit.position = origin + at * direction;
  return hit;
}

fn nispUvSlope(data: texture_2d<f32>, hit: NispHit, towards: vec3f, uv_map: vec4f) -> vec2f {
  return (nispUv(data, hit.position + NISP_OFFSET * towards, hit.chart) * uv_map.zw + uv_map.xy - hit.uv) / NISP_OFFSET;
}

fn nispDescribe(data: texture_2d<f32>, traced: NispHit, direction: vec3f, uv_map: vec4f) -> NispHit {
  var hit = traced;
  let slope = nispGradient(data, hit.position);
  let against = dot(slope, direction);
  if (abs(against) >= 0.1) {
    let off = clamp(-nispSdf(data, hit.position) / against, -NISP_LEAST_STEP, NISP_LEAST_STEP);
    hit.distance += off;
    hit.position += off * direction;
  }
  hit.normal = slope / max(length(slope), 1e-12);
  hit.uv = nispUv(data, hit.position, hit.chart) * uv_map.zw + uv_map.xy;
  let helper = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(hit.normal.x) < 0.7);
  let first = normalize(cross(hit.normal, helper));
  let second = cross(hit.normal, first);
  let along_first = nispUvSlope(data, hit, first, uv_map);
  let along_second = nispUvSlope(data, hit, second, uv_map);
  hit.slope_u = along_first.x * first + along_second.x * second;
  hit.slope_v = along_first.y * first + along_second.y * second;
  return hit;
}
`;
