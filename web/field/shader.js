import { CONSTANTS_GLSL } from "./constants.js";

/**
 * GLSL (ES 3.00) that evaluates a model's networks from the texels of data.js, and traces rays to
 * their surface. Weights are data: the text is the same for every file, but for NISP_GROUPS, the
 * groups of 4 in the widest layer. The caller declares two uniforms, as FIELD_GLSL does.
 */
export const FIELD_FUNCTIONS_GLSL = `
${CONSTANTS_GLSL}

vec4 nispIn[NISP_GROUPS];
vec4 nispOut[NISP_GROUPS];
int nispCalls;
float nispSlope;

vec4 nispTexel(int at) {
  return texelFetch(nispData, ivec2(at & 1023, at >> 10), 0);
}

// sin(pi t), by the polynomial of kernel.wat.
vec4 nispSine(vec4 t) {
  vec4 whole = floor(t + 0.5);
  vec4 f = t - whole;
  vec4 s = f * f;
  vec4 inner = 2.550069808959961 + s * (-0.5982421040534973 + s * 0.07756038755178452);
  vec4 half_turn = f * (3.1415927410125732 + s * (-5.167709827423096 + s * inner));
  return half_turn * (1.0 - 2.0 * (whole - 2.0 * floor(0.5 * whole)));
}

float nispCoordinate(vec3 p, int mirror, int number) {
  if (number < 3) return (mirror >> number & 1) == 1 ? abs(p[number]) : p[number];
  int left = number - 3;
  for (int axis = 0; axis < 3; axis++) {
    if ((mirror >> (3 + axis) & 1) == 1 && left-- == 0) return p[axis];
  }
  return 0.0;
}

void nispPut(int place, float value) {
  nispIn[place >> 2][place & 3] = value;
}

// Inputs of a network into nispIn.
void nispEnter(int network, vec3 p, int chart) {
  ivec4 form = ivec4(nispTexel(network + 1));
  vec4 places = nispTexel(network + 2);
  ivec4 sizes = ivec4(nispTexel(network + 3));
  float charts = nispTexel(network).z;
  for (int i = 0; i < (sizes.y + 3) / 4; i++) nispIn[i] = vec4(0.0);
  int at = 0;
  for (int i = 0; i < form.w; i++) {
    bool scalar = form.z == 1 && i == form.w - 1;
    float value = scalar ? float(2 * chart + 1) / charts - 1.0 : nispCoordinate(p, form.x, i);
    if (form.y == 0) nispPut(at++, value);
    for (int level = 0; level < form.y; level++) {
      float turns = exp2(float(level)) * value;
      nispPut(at++, nispSine(vec4(turns)).x);
      nispPut(at++, nispSine(vec4(turns + 0.5)).x);
    }
  }
  for (int i = 0; i < sizes.x; i++) nispPut(at++, nispTexel(int(places.z) + chart * sizes.x + i).x);
}

// Four outputs of a layer whose inputs are in nispIn.
vec4 nispRows(ivec4 layer, int group) {
  int at = layer.z + group * (1 + 4 * layer.x);
  vec4 sum = nispTexel(at++);
  for (int i = 0; i < layer.x; i++) {
    vec4 x = nispIn[i];
    sum += nispTexel(at) * x.x + nispTexel(at + 1) * x.y + nispTexel(at + 2) * x.z + nispTexel(at + 3) * x.w;
    at += 4;
  }
  return sum;
}

// Runs the inputs through the hidden layers; what enters the last one is in nispIn. That layer.
ivec4 nispHidden(int network) {
  ivec4 head = ivec4(nispTexel(network));
  bool sine = nispTexel(network + 2).x == 0.0;
  for (int number = 0; number < head.y - 1; number++) {
    ivec4 layer = ivec4(nispTexel(head.x + number));
    for (int group = 0; group < layer.y; group++) {
      vec4 sums = nispRows(layer, group);
      nispOut[group] = sine ? nispSine(sums) : max(sums, 0.0);
    }
    for (int group = 0; group < layer.y; group++) nispIn[group] = nispOut[group];
  }
  return ivec4(nispTexel(head.x + head.y - 1));
}

vec4 nispFinish(int network, vec4 sums) {
  int kind = int(nispTexel(network + 2).y);
  if (kind == 1) return tanh(sums);
  return kind == 2 ? 1.0 / (1.0 + exp(-sums)) : sums;
}

float nispSdf(vec3 p) {
  nispCalls++;
  nispEnter(NISP_SDF, p, 0);
  return nispFinish(NISP_SDF, nispRows(nispHidden(NISP_SDF), 0)).x;
}

vec3 nispGradient(vec3 p) {
  vec2 e = vec2(NISP_OFFSET, 0.0);
  return vec3(
    nispSdf(p + e.xyy) - nispSdf(p - e.xyy),
    nispSdf(p + e.yxy) - nispSdf(p - e.yxy),
    nispSdf(p + e.yyx) - nispSdf(p - e.yyx)) / (2.0 * NISP_OFFSET);
}

int nispChart(vec3 p) {
  int charts = int(nispTexel(NISP_CHART).w);
  if (charts == 0) return 0;
  nispEnter(NISP_CHART, p, 0);
  ivec4 layer = nispHidden(NISP_CHART);
  int best = 0;
  float most = 0.0;
  for (int group = 0; group < layer.y; group++) {
    vec4 found = nispRows(layer, group);
    for (int i = 0; i < 4; i++) {
      int chart = 4 * group + i;
      if (chart < charts && (chart == 0 || found[i] > most)) {
        best = chart;
        most = found[i];
      }
    }
  }
  return best;
}

// Before the map of META. 0 without network.
vec2 nispUv(vec3 p, int chart) {
  if (nispTexel(NISP_UV).y == 0.0) return vec2(0.0);
  nispEnter(NISP_UV, p, chart);
  vec2 found = nispRows(nispHidden(NISP_UV), 0).xy;
  ivec4 form = ivec4(nispTexel(NISP_UV + 1));
  if (form.z == 2) {
    int at = int(nispTexel(NISP_UV + 2).w) + chart * (form.w + 1);
    for (int i = 0; i < form.w; i++) found += nispTexel(at + i).xy * nispCoordinate(p, form.x, i);
    found += nispTexel(at + form.w).xy;
  }
  return nispFinish(NISP_UV, vec4(found, 0.0, 0.0)).xy;
}

// How far along the ray the network need not be asked: through a box of free cells.
float nispFree(vec3 p, vec3 direction) {
  int size = textureSize(nispOccupancy, 0).x;
  float cell = 2.0 * NISP_CUBE / float(size);
  ivec3 place = clamp(ivec3(floor((p + NISP_CUBE) / cell)), ivec3(0), ivec3(size - 1));
  float away = floor(255.0 * texelFetch(nispOccupancy, place, 0).x + 0.5);
  if (away == 0.0) return 0.0;
  vec3 low = (vec3(place) - (away - 1.0)) * cell - NISP_CUBE;
  vec3 high = low + (2.0 * away - 1.0) * cell;
  vec3 spans;
  for (int axis = 0; axis < 3; axis++) {
    float towards = direction[axis];
    spans[axis] = abs(towards) < 1e-9 ? 1e9 : ((towards > 0.0 ? high[axis] : low[axis]) - p[axis]) / towards;
  }
  return max(min(spans.x, min(spans.y, spans.z)), 0.0) + 1e-5;
}

// Between a point outside and one inside (distances along the ray, fields there).
float nispBetween(vec3 origin, vec3 direction, float side, float low, float before, float high, float beyond) {
  for (int i = 0; i < 4; i++) {
    float middle = mix(low, high, clamp(before / (before - beyond), 0.05, 0.95));
    float there = side * nispSdf(origin + middle * direction);
    if (abs(there) < NISP_EXACT) return middle;
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

// How far to go from a field of this value, by how it fell on the way here: beyond the surface where it
// falls fast, so that the crossing is between two points; else so far that the balls without surface
// around two points overlap (Keinert et al. 2014).
float nispStep(float value, float before, float way) {
  float least = value / nispSlope;
  if (before > 1e8) return least;
  float fall = (before - value) / way;
  if (value < NISP_CLOSE && fall > NISP_FAST * nispSlope) return NISP_BEYOND * value / fall;
  return clamp(NISP_OVERLAP * 2.0 * value / (nispSlope + fall), least, 4.0 * least);
}

// Where a ray meets the surface after a distance, -1 where it does not. side: -1 from inside.
float nispMarch(vec3 origin, vec3 direction, float at, float leave, float side) {
  float before = 1e9, last = at;
  for (int i = 0; i < NISP_STEPS; i++) {
    if (at > leave) return -1.0;
    vec3 p = origin + at * direction;
    float free = nispFree(p, direction);
    if (free > 0.0) {
      before = 1e9;
      last = at;
      at += free;
      continue;
    }
    float value = side * nispSdf(p);
    if (value < 0.0) {
      if (before < 1e8) return nispBetween(origin, direction, side, last, before, at, value);
      return at;
    }
    if (value < NISP_NEAR && value < before) return at;
    // Gone so far that between the two points there may be surface: back to where there is none.
    if (before < 1e8 && before + value < nispSlope * (at - last) - NISP_LEAST_STEP) {
      at = last + before / nispSlope;
      continue;
    }
    float step = nispStep(value, before, at - last);
    before = value;
    last = at;
    at += max(step, NISP_LEAST_STEP);
  }
  return -1.0;
}

struct NispHit {
  float distance;
  vec3 position;
  vec3 normal;
  int chart;
  vec2 uv;
  // Gradients of u and v in the tangent plane.
  vec3 slope_u;
  vec3 slope_v;
};

// The first surface of the asset along a ray of the normalized frame; distance -1 without.
NispHit nispTrace(vec3 origin, vec3 direction) {
  NispHit hit;
  hit.distance = -1.0;
  vec2 held = nispTexel(NISP_SDF + 3).zw;
  nispSlope = held.x;
  float along = -dot(origin, direction);
  float half_chord = NISP_BALL * NISP_BALL - (dot(origin, origin) - along * along);
  if (half_chord <= 0.0) return hit;
  half_chord = sqrt(half_chord);
  float at = max(along - half_chord, 0.0), leave = along + half_chord, side = 1.0;
  for (int layer = 0; layer < NISP_LAYERS_SEEN; layer++) {
    at = nispMarch(origin, direction, at, leave, side);
    if (at < 0.0) return hit;
    hit.chart = nispChart(origin + at * direction);
    if (hit.chart != int(held.y)) break;
    at += NISP_LEAST_STEP;
    side = -side;
  }
  hit.distance = at;
  hit.position = origin + at * direction;
  return hit;
}

// What a hit's surface looks like: normal, towards the ray's start, texture coordinates.
void nispDescribe(inout NispHit hit, vec3 direction, vec4 uv_map) {
  vec3 slope = nispGradient(hit.position);
  float against = dot(slope, direction);
  float off = abs(against) < 0.1 ? 0.0 : clamp(-nispSdf(hit.position) / against, -NISP_LEAST_STEP, NISP_LEAST_STEP);
  hit.distance += off;
  hit.position += off * direction;
  hit.normal = slope / max(length(slope), 1e-12);
  hit.uv = nispUv(hit.position, hit.chart) * uv_map.zw + uv_map.xy;
  vec3 first = normalize(abs(hit.normal.x) < 0.7 ? cross(hit.normal, vec3(1, 0, 0)) : cross(hit.normal, vec3(0, 1, 0)));
  vec3 second = cross(hit.normal, first);
  vec2 along_first = (nispUv(hit.position + NISP_OFFSET * first, hit.chart) * uv_map.zw + uv_map.xy - hit.uv) / NISP_OFFSET;
  vec2 along_second = (nispUv(hit.position + NISP_OFFSET * second, hit.chart) * uv_map.zw + uv_map.xy - hit.uv) / NISP_OFFSET;
  hit.slope_u = along_first.x * first + along_second.x * second;
  hit.slope_v = along_first.y * first + along_second.y * second;
}
`;

/** The same with the textures that it reads. */
export const FIELD_GLSL = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;

uniform sampler2D nispData;
uniform sampler3D nispOccupancy;
${FIELD_FUNCTIONS_GLSL}`;
