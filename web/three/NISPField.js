import { BackSide, BoxGeometry, Data3DTexture, DataTexture, FloatType, GLSL3, Mesh, NearestFilter, RGBAFormat, RedIntegerFormat, ShaderMaterial, Texture, UnsignedByteType, Vector3, Vector4 } from "three";
import { NISPModel } from "../evaluate/model.js";
import { DATA_WIDTH, packField } from "../field/data.js";
import { occupancyOf } from "../field/occupancy.js";
import { FIELD_GLSL } from "../field/shader.js";
import { TextureSet } from "./textures.js";

/** Base color maps that one field can show, as a fragment shader has 16 textures for certain. */
const MOST_MAPS = 8;

const VERTEX = `
out vec3 nisp_place;
flat out vec3 nisp_eye;
flat out mat4 nisp_to_clip;
void main() {
  nisp_place = position;
  mat4 back = inverse(modelViewMatrix);
  // At a distance where an orthographic camera's rays are as good as parallel.
  nisp_eye = (back * vec4(0.0, 0.0, isOrthographic ? 1e4 : 0.0, 1.0)).xyz;
  nisp_to_clip = projectionMatrix * modelViewMatrix;
  gl_Position = nisp_to_clip * vec4(position, 1.0);
}`;

/** @param {number} maps */
const fragment = (maps) => `
${FIELD_GLSL}
in vec3 nisp_place;
flat in vec3 nisp_eye;
flat in mat4 nisp_to_clip;
uniform vec4 uv_map;
uniform int chart_table;
uniform vec3 lamp;
uniform vec4 base_colors[NISP_MATERIALS];
uniform int base_maps[NISP_MATERIALS];
${Array.from({ length: maps }, (_, i) => `uniform sampler2D nisp_map${i};`).join("\n")}
layout(location = 0) out vec4 pc_fragColor;
#define gl_FragColor pc_fragColor

vec4 nispTexture(int number, vec2 uv, float area) {
  ${Array.from({ length: maps }, (_, i) => `if (number == ${i}) return textureLod(nisp_map${i}, uv, 0.5 * log2(max(area * float(textureSize(nisp_map${i}, 0).x * textureSize(nisp_map${i}, 0).y), 1e-12)));`).join("\n  ")}
  return vec4(1.0);
}

void main() {
  vec3 direction = normalize(nisp_place - nisp_eye);
  float turning = length(dFdx(direction));
  // Rays start in front of the ball, or far eyes cost digits.
  float skipped = max(length(nisp_eye) - 2.0, 0.0);
  vec3 start = nisp_eye + skipped * direction;
  NispHit hit = nispTrace(start, direction);
  if (hit.distance < 0.0) discard;
  nispDescribe(hit, direction, uv_map);
  vec4 owner = nispTexel(chart_table + hit.chart);
  vec4 clip = nisp_to_clip * vec4(hit.position, 1.0);
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
  float away = skipped + hit.distance;
  float width = turning * away;
  float slant = max(abs(dot(hit.normal, direction)), 0.1);
  float area = length(cross(hit.slope_u, hit.slope_v)) * width * width / slant;
  vec4 base = base_colors[int(owner.x)];
  if (owner.y > 0.5) base *= nispTexture(base_maps[int(owner.x)], vec2(hit.uv.x, 1.0 - hit.uv.y), area);
  vec3 normal = dot(hit.normal, direction) < 0.0 ? hit.normal : -hit.normal;
  gl_FragColor = vec4(base.rgb * (0.25 + 0.75 * max(dot(normal, lamp), 0.0)), 1.0);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
}`;

/**
 * Draws a file's networks without a mesh, on the box around them: rays are sphere-traced in the
 * fragment shader, and depth is written, so that it sits among meshes. Base color under one lamp,
 * whose direction is `uniforms.lamp` in the normalized frame; opaque.
 */
export class NISPFieldMaterial extends ShaderMaterial {
  /** @param {NISPModel} model @param {TextureSet} textures */
  constructor(model, textures) {
    const { metadata } = model;
    if (!model.field) throw new Error("networks: expected some, found meshes alone: NISPLoader shows them");
    const packed = packField(model.document);
    const grid = occupancyOf(model.field.sdfNetwork);
    const maps = mapsOf(metadata.materials, textures);
    super({
      name: "NISPFieldMaterial",
      glslVersion: GLSL3,
      side: BackSide,
      defines: { NISP_GROUPS: packed.groups, NISP_MATERIALS: metadata.materials.length },
      vertexShader: VERTEX,
      fragmentShader: fragment(maps.used.length),
      uniforms: {
        nispData: { value: dataTexture(packed) },
        nispOccupancy: { value: gridTexture(grid) },
        nispSlope: { value: grid.slope },
        nispOpening: { value: metadata.openings ? metadata.charts - 1 : -1 },
        uv_map: { value: new Vector4(...metadata.uvMap) },
        chart_table: { value: packed.at },
        lamp: { value: new Vector3(-0.2, 0.7, 0.7).normalize() },
        base_colors: { value: metadata.materials.map(({ baseColor }) => new Vector4(...baseColor)) },
        base_maps: { value: maps.numbers },
        ...Object.fromEntries(maps.used.map((texture, i) => [`nisp_map${i}`, { value: texture }])),
      },
    });
  }

  dispose() {
    for (const { value } of Object.values(this.uniforms)) if (value instanceof Texture) value.dispose();
    super.dispose();
  }
}

/** A file's field as an object of a scene, in the asset's units and place. */
export class NISPField extends Mesh {
  /** @param {NISPModel} model @param {TextureSet} textures */
  constructor(model, textures) {
    super(new BoxGeometry(2.04, 2.04, 2.04), new NISPFieldMaterial(model, textures));
    const [x, y, z, radius] = model.metadata.frame;
    this.position.set(x, y, z);
    this.scale.setScalar(radius);
  }

  /** @param {import("../decoder/document.js").Document} document what parseNISP gives */
  static async from(document) {
    return new NISPField(new NISPModel(document), await TextureSet.decoded(document));
  }

  dispose() {
    this.geometry.dispose();
    /** @type {NISPFieldMaterial} */ (this.material).dispose();
  }
}

/** Base color maps, and the number of each material's, -1 without. @param {import("../decoder/metadata.js").Material[]} materials @param {TextureSet} textures */
function mapsOf(materials, textures) {
  const all = materials.map(({ maps }) => textures.get(maps.base_color, true));
  const used = [...new Set(all)].filter((texture) => texture !== null).slice(0, MOST_MAPS);
  return { used, numbers: all.map((texture) => (texture ? used.indexOf(texture) : -1)) };
}

/** @param {{texels: Float32Array, height: number}} packed */
function dataTexture({ texels, height }) {
  const texture = new DataTexture(/** @type {any} */ (texels), DATA_WIDTH, height, RGBAFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** @param {import("../field/occupancy.js").Occupancy} grid */
function gridTexture({ cells, size }) {
  const texture = new Data3DTexture(/** @type {any} */ (cells), size, size, size);
  texture.format = RedIntegerFormat;
  texture.type = UnsignedByteType;
  texture.internalFormat = "R8UI";
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}
