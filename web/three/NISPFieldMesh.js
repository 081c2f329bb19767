import { BackSide, FunctionCallNode, FunctionNode, Matrix4, NodeMaterial, Vector3, Vector4 } from "three/webgpu";
import { nodeObject, positionGeometry, sampler, texture, texture3D, uniform, vec2, vec4 } from "three/tsl";
import { NISPModel } from "../evaluate/model.js";
import { FIELD_FUNCTIONS_GLSL } from "../field/shader.js";
import { FIELD_WGSL } from "../field/shader_wgsl.js";
import { FieldBox, FieldContent } from "./field_content.js";
import { LOOK_GLSL, lookWGSL, mapsGLSL } from "./field_look.js";
import { TextureSet } from "./textures.js";

/** @typedef {{camera: import("three").Camera, object: import("three").Object3D}} Drawn */

/**
 * nispLook in the language of the renderer's backend: of which WebGPURenderer has two.
 * @extends {FunctionNode<Record<string, import("three/webgpu").Node>>}
 */
class LookNode extends FunctionNode {
  /** @param {FieldContent} content @param {import("three/webgpu").Node[]} textures which GLSL knows by name */
  constructor({ groups, maps }, textures) {
    super();
    this.textures = textures;
    this.wgsl = `${lookWGSL(maps.length)}\nconst NISP_GROUPS = ${groups};\n${FIELD_WGSL}`;
    this.glsl = `#define NISP_GROUPS ${groups}\n${FIELD_FUNCTIONS_GLSL}\n${mapsGLSL(maps.length)}\n#pragma main\n${LOOK_GLSL}`;
  }

  /** @param {any} builder */
  getNodeFunction(builder) {
    this.code = builder.renderer.backend.isWebGPUBackend ? this.wgsl : this.glsl;
    return super.getNodeFunction(builder);
  }

  /** @param {any} builder @param {string} output */
  generate(builder, output) {
    for (const each of this.textures) each.build(builder, "property");
    return super.generate(builder, output);
  }
}

/**
 * `NISPFieldMaterial` for WebGPURenderer, on either of its backends. `lamp` is a uniform: the lamp's
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
    const found = lookOf(content, { place: positionGeometry, eye, to_clip: toClip, lamp: this.lamp }).toVar();
    this.vertexNode = toClip.mul(vec4(positionGeometry, 1));
    this.fragmentNode = vec4(found.xyz, 1);
    this.depthNode = found.w;
  }

  dispose() {
    this.content.dispose();
    super.dispose();
  }
}

/** Color and depth. @param {FieldContent} content @param {Record<string, import("three/webgpu").Node>} view */
function lookOf(content, view) {
  const data = named("nispData", texture(content.data, vec2(0)));
  const grid = named("nispOccupancy", texture3D(content.grid));
  const maps = content.maps.map((map, i) => named(`nisp_map${i}`, texture(map, vec2(0))));
  const inputs = {
    ...view,
    data,
    grid,
    ...Object.fromEntries(maps.flatMap((map, i) => [[`map${i}`, map], [`sampler${i}`, sampler(map)]])),
    uv_map: uniform(new Vector4(...content.uvMap)),
    chart_table: uniform(content.chartTable, "int"),
  };
  return nodeObject(new FunctionCallNode(new LookNode(content, [data, grid, ...maps]), inputs));
}

/** The node, with the name that GLSL knows it by. @template {{name: string}} T @param {string} name @param {T} node */
function named(name, node) {
  node.name = name;
  return node;
}

/** A camera's place in the normalized frame, and the way from there to clip coordinates; in doubles, as assets may be far from the origin. */
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
