import { BackSide, Matrix4, NodeMaterial, Vector3, Vector4 } from "three/webgpu";
import { positionGeometry, sampler, texture, texture3D, uniform, vec2, vec4, wgsl, wgslFn } from "three/tsl";
import { NISPModel } from "../evaluate/model.js";
import { FIELD_WGSL } from "../field/shader_wgsl.js";
import { FieldBox, FieldContent } from "./field_content.js";
import { TextureSet } from "./textures.js";

/** @typedef {{camera: import("three").Camera, object: import("three").Object3D}} Drawn */

/** @param {number} maps */
const look = (maps) => `
fn nispLook(
  place: vec3f, eye: vec3f, to_clip: mat4x4f, data: texture_2d<f32>, grid: texture_3d<f32>, slope: f32, opening: i32,
  uv_map: vec4f, chart_table: i32, lamp: vec3f${Array.from({ length: maps }, (_, i) => `, map${i}: texture_2d<f32>, sampler${i}: sampler`).join("")}
) -> vec4f {
  nispSlope = slope;
  nispOpening = opening;
  let direction = normalize(place - eye);
  let turning = length(dpdx(direction));
  let skipped = max(length(eye) - 2.0, 0.0);
  let traced = nispTrace(data, grid, eye + skipped * direction, direction);
  if (traced.distance < 0.0) { discard; return vec4f(); }
  let hit = nispDescribe(data, traced, direction, uv_map);
  let clip = to_clip * vec4f(hit.position, 1.0);
  let width = turning * (skipped + hit.distance);
  let slant = max(abs(dot(hit.normal, direction)), 0.1);
  let area = length(cross(hit.slope_u, hit.slope_v)) * width * width / slant;
  let chart = nispTexel(data, chart_table + hit.chart);
  let uv = vec2f(hit.uv.x, 1.0 - hit.uv.y);
  var base = chart.rgb;
  ${Array.from({ length: maps }, (_, i) => `if (i32(chart.w) == ${i}) { base *= textureSampleLevel(map${i}, sampler${i}, uv, nispLevel(textureDimensions(map${i}), area)).rgb; }`).join("\n  ")}
  let normal = select(-hit.normal, hit.normal, dot(hit.normal, direction) < 0.0);
  return vec4f(base * (0.25 + 0.75 * max(dot(normal, lamp), 0.0)), clip.z / clip.w);
}`;

/** @param {number} groups */
const helpers = (groups) => `
const NISP_GROUPS = ${groups};
${FIELD_WGSL}
fn nispLevel(size: vec2u, area: f32) -> f32 {
  return 0.5 * log2(max(area * f32(size.x * size.y), 1e-12));
}
`;

/**
 * `NISPFieldMaterial` for WebGPURenderer, with its WebGPU backend. `lamp` is a uniform, the lamp's
 * direction in the normalized frame.
 */
export class NISPFieldNodeMaterial extends NodeMaterial {
  static get type() {
    return "NISPFieldNodeMaterial";
  }

  /** @param {NISPModel} model @param {TextureSet} textures */
  constructor(model, textures) {
    super();
    const content = new FieldContent(model, textures);
    this.content = content;
    this.side = BackSide;
    this.fog = false;
    this.lamp = uniform(new Vector3(-0.2, 0.7, 0.7).normalize());
    const { eye, toClip } = viewUniforms();
    const inputs = {
      place: positionGeometry,
      eye,
      to_clip: toClip,
      data: texture(content.data, vec2(0)),
      grid: texture3D(content.grid),
      slope: uniform(content.slope),
      opening: uniform(content.opening, "int"),
      uv_map: uniform(new Vector4(...content.uvMap)),
      chart_table: uniform(content.chartTable, "int"),
      lamp: this.lamp,
      ...mapInputs(content.maps),
    };
    const found = wgslFn(look(content.maps.length), [wgsl(helpers(content.groups))])(inputs).toVar();
    this.vertexNode = toClip.mul(vec4(positionGeometry, 1));
    this.fragmentNode = vec4(found.xyz, 1);
    this.depthNode = found.w;
  }

  dispose() {
    this.content.dispose();
    super.dispose();
  }
}

/** A camera's place, and what it sees as clip coordinates, in the normalized frame: computed in doubles, as assets may be far from the origin. */
function viewUniforms() {
  const [eye, toClip, back] = [uniform(new Vector3()), uniform(new Matrix4()), new Matrix4()];
  eye.onObjectUpdate((frame) => {
    const { camera, object } = /** @type {Drawn} */ (frame);
    // At a distance where an orthographic camera's rays are as good as parallel.
    eye.value.set(0, 0, "isOrthographicCamera" in camera ? 1e4 : 0);
    eye.value.applyMatrix4(back.multiplyMatrices(camera.matrixWorldInverse, object.matrixWorld).invert());
  });
  toClip.onObjectUpdate((frame) => {
    const { camera, object } = /** @type {Drawn} */ (frame);
    toClip.value.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(object.matrixWorld);
  });
  return { eye, toClip };
}

/** @param {import("three").Texture[]} maps @returns {Record<string, import("three/webgpu").Node>} */
function mapInputs(maps) {
  return Object.fromEntries(maps.flatMap((map, i) => [[`map${i}`, texture(map, vec2(0))], [`sampler${i}`, sampler(map)]]));
}

/** `NISPField` for WebGPURenderer, as three's SkyMesh is to its Sky. @extends {FieldBox<NISPFieldNodeMaterial>} */
export class NISPFieldMesh extends FieldBox {
  /** @param {NISPModel} model @param {TextureSet} textures */
  constructor(model, textures) {
    super(model, new NISPFieldNodeMaterial(model, textures));
  }

  /** @param {import("../decoder/document.js").Document} document what parseNISP gives */
  static async from(document) {
    return new NISPFieldMesh(new NISPModel(document), await TextureSet.decoded(document));
  }
}
