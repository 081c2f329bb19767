import { BackSide, GLSL3, ShaderMaterial, Vector3, Vector4 } from "three";
import { NISPModel } from "../evaluate/model.js";
import { FIELD_GLSL } from "../field/shader.js";
import { FieldBox, FieldContent } from "./field_content.js";
import { LOOK_GLSL, mapsGLSL } from "./field_look.js";
import { TextureSet } from "./textures.js";

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
${Array.from({ length: maps }, (_, i) => `uniform sampler2D nisp_map${i};`).join("\n")}
layout(location = 0) out vec4 pc_fragColor;
#define gl_FragColor pc_fragColor

${mapsGLSL(maps)}
${LOOK_GLSL}

void main() {
  vec4 found = nispLook(nisp_place, nisp_eye, nisp_to_clip, uv_map, chart_table, lamp);
  gl_FragDepth = found.w;
  gl_FragColor = vec4(found.rgb, 1.0);
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
    const content = new FieldContent(model, textures);
    super({
      name: "NISPFieldMaterial",
      glslVersion: GLSL3,
      side: BackSide,
      defines: { NISP_GROUPS: content.groups },
      vertexShader: VERTEX,
      fragmentShader: fragment(content.maps.length),
      uniforms: {
        nispData: { value: content.data },
        nispOccupancy: { value: content.grid },
        uv_map: { value: new Vector4(...content.uvMap) },
        chart_table: { value: content.chartTable },
        lamp: { value: new Vector3(-0.2, 0.7, 0.7).normalize() },
        ...Object.fromEntries(content.maps.map((texture, i) => [`nisp_map${i}`, { value: texture }])),
      },
    });
    this.content = content;
  }

  dispose() {
    this.content.dispose();
    super.dispose();
  }
}

/**
 * A file's field as an object of a scene, under WebGLRenderer; `NISPFieldMesh` is that for WebGPURenderer.
 * @extends {FieldBox<NISPFieldMaterial>}
 */
export class NISPField extends FieldBox {
  /** @param {NISPModel} model @param {TextureSet} textures */
  constructor(model, textures) {
    super(model, new NISPFieldMaterial(model, textures));
  }

  /** @param {import("../decoder/document.js").Document} document what parseNISP gives */
  static async from(document) {
    return new NISPField(new NISPModel(document), await TextureSet.decoded(document));
  }
}
