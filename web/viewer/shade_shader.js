/**
 * GLSL of the one look that mesh and field have, the same that `nisp render` draws: Lambert and
 * normalized Blinn-Phong under one lamp, an even environment, metallic-roughness materials; in
 * linear light.
 */
export const SHADE_GLSL = `
uniform vec4 base_color;
uniform vec3 emissive;
uniform vec2 metallic_roughness;
// Alpha mode (0 opaque, 1 mask, 2 blend) and cutoff; strengths of the normal and occlusion maps.
uniform vec4 modes;
uniform bool has_map[5];
uniform sampler2D map0, map1, map2, map3, map4;
uniform vec3 lamp;
uniform int channel;

// At which level a texel covers as much as a sample of the picture.
float level_of(sampler2D map, float area) {
  ivec2 size = textureSize(map, 0);
  return 0.5 * log2(max(area * float(size.x) * float(size.y), 1e-12));
}

vec4 texel_of(bool there, sampler2D map, vec2 uv, float area) {
  return there ? textureLod(map, vec2(uv.x, 1.0 - uv.y), level_of(map, area)) : vec4(1.0);
}

vec3 to_linear(vec3 value) {
  return mix(value / 12.92, pow((value + 0.055) / 1.055, vec3(2.4)), step(0.04045, value));
}

vec3 turned_by_map(vec3 normal, vec2 uv, float area, vec3 slope_u, vec3 slope_v) {
  vec3 texel = 2.0 * texel_of(true, map1, uv, area).xyz - 1.0;
  float side = dot(cross(slope_u, slope_v), normal) < 0.0 ? -1.0 : 1.0;
  vec3 tangent = cross(slope_v, normal) * side;
  if (length(tangent) < 1e-6) return normal;
  tangent = normalize(tangent);
  vec3 bitangent = cross(normal, tangent) * side;
  return normalize(modes.z * (texel.x * tangent + texel.y * bitangent) + texel.z * normal);
}

vec3 chart_color(int chart) {
  float turn = fract(0.618034 * float(chart));
  return 0.55 + 0.4 * cos(6.2831853 * (turn + vec3(0.0, 1.0, 2.0) / 3.0));
}

// Premultiplied linear light. towards: from the eye; normal: outwards; area: of a sample in uv.
vec4 shaded(vec3 towards, vec3 normal, vec2 uv, float area, vec3 slope_u, vec3 slope_v, int chart) {
  normal = dot(normal, towards) < 0.0 ? normal : -normal;
  vec4 base = base_color * texel_of(has_map[0], map0, uv, area);
  float alpha = modes.x == 0.0 ? 1.0 : modes.x == 1.0 ? step(modes.y, base.a) : base.a;
  if (alpha <= 0.0) discard;
  if (has_map[1]) normal = turned_by_map(normal, uv, area, slope_u, slope_v);
  if (channel == 1) return vec4(to_linear(0.5 + 0.5 * normal), 1.0);
  if (channel == 2) return vec4(to_linear(vec3(fract(uv), 0.0)), 1.0);
  if (channel == 3) return vec4(to_linear(chart_color(chart)), 1.0);
  vec4 rough = texel_of(has_map[2], map2, uv, area);
  float metallic = rough.z * metallic_roughness.x, roughness = rough.y * metallic_roughness.y;
  float occlusion = 1.0 + modes.w * (texel_of(has_map[3], map3, uv, area).x - 1.0);
  vec3 light = emissive * texel_of(has_map[4], map4, uv, area).xyz;
  vec3 middle = normalize(lamp - towards);
  float incident = clamp(dot(normal, lamp), 0.0, 1.0), aligned = clamp(dot(normal, middle), 0.0, 1.0);
  float exponent = 2.0 / pow(max(roughness, 0.1), 4.0) - 2.0;
  float gloss = (exponent + 2.0) / 8.0 * (exponent > 0.0 ? pow(aligned, exponent) : 1.0);
  vec3 reflectance = 0.04 + (base.xyz - 0.04) * metallic, diffuse = base.xyz * (1.0 - metallic);
  light += 0.75 * incident * (diffuse + reflectance * gloss) + 0.25 * occlusion * (diffuse + reflectance);
  return vec4(light * alpha, alpha);
}
`;
