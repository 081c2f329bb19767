const SLOT_ORDER = ["base_color", "normal", "metallic_roughness", "occlusion", "emissive"];
const MODES = ["opaque", "mask", "blend"];

/**
 * @typedef {import("../decoder/metadata.js").Material} Material
 * @typedef {import("../decoder/metadata.js").MapUse} MapUse
 */

/** Materials of an asset on a graphics processor. */
export class MaterialSet {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {Material[]} materials
   * @param {(ImageBitmap|null)[]} images by number of the texture
   */
  constructor(gl, materials, images) {
    this.gl = gl;
    this.materials = materials;
    this.images = images;
    /** @type {Map<string, WebGLTexture|null>} */
    this.textures = new Map();
    this.white = this.blank();
  }

  dispose() {
    for (const texture of [this.white, ...this.textures.values()]) this.gl.deleteTexture(texture);
    for (const image of this.images) image?.close();
  }

  blank() {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4).fill(255));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    return texture;
  }

  /**
   * Sets the uniforms of SHADE_GLSL.
   * @param {import("./programs.js").Program} program
   * @param {number} number of the material
   * @param {boolean} textured whether its faces have texture coordinates
   * @param {number} first texture unit to use
   */
  apply(program, number, textured, first) {
    const { gl } = this;
    const { baseColor, emissive, metallic, roughness, alphaMode, alphaCutoff, maps } = this.materials[number];
    gl.uniform4fv(program.at("base_color"), baseColor);
    gl.uniform3fv(program.at("emissive"), emissive);
    gl.uniform2f(program.at("metallic_roughness"), metallic, roughness);
    const strengths = [maps.normal?.strength ?? 1, maps.occlusion?.strength ?? 1];
    gl.uniform4f(program.at("modes"), MODES.indexOf(alphaMode), alphaCutoff, strengths[0], strengths[1]);
    const there = SLOT_ORDER.map((slot, i) => {
      const use = textured ? maps[slot] : undefined;
      const texture = use && this.images[use.texture] ? this.texture(use, slot) : null;
      gl.activeTexture(gl.TEXTURE0 + first + i);
      gl.bindTexture(gl.TEXTURE_2D, texture ?? this.white);
      gl.uniform1i(program.at(`map${i}`), first + i);
      return texture ? 1 : 0;
    });
    gl.uniform1iv(program.at("has_map[0]"), there);
  }

  /** @param {MapUse} use @param {string} slot */
  texture(use, slot) {
    const color = slot === "base_color" || slot === "emissive";
    const key = [use.texture, color, use.wrapU, use.wrapV, use.filter].join();
    if (!this.textures.has(key)) this.textures.set(key, this.upload(use, color));
    return this.textures.get(key) ?? null;
  }

  /** @param {MapUse} use @param {boolean} color whether texels are sRGB-encoded */
  upload(use, color) {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    const image = /** @type {ImageBitmap} */ (this.images[use.texture]);
    gl.texImage2D(gl.TEXTURE_2D, 0, color ? gl.SRGB8_ALPHA8 : gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, image);
    gl.generateMipmap(gl.TEXTURE_2D);
    const wraps = { repeat: gl.REPEAT, clamp: gl.CLAMP_TO_EDGE, mirror: gl.MIRRORED_REPEAT };
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wraps[/** @type {"clamp"} */ (use.wrapU)]);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wraps[/** @type {"clamp"} */ (use.wrapV)]);
    const nearest = use.filter === "nearest";
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, nearest ? gl.NEAREST : gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, nearest ? gl.NEAREST : gl.LINEAR_MIPMAP_LINEAR);
    return texture;
  }
}
