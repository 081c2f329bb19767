/** A framebuffer of float textures, with a depth buffer where that is asked for. */
export class Target {
  /** @param {WebGL2RenderingContext} gl @param {number} count of textures @param {number} format @param {boolean} depth */
  constructor(gl, count, format, depth) {
    this.gl = gl;
    this.format = format;
    this.width = 0;
    this.height = 0;
    this.framebuffer = gl.createFramebuffer();
    this.textures = Array.from({ length: count }, () => gl.createTexture());
    this.depth = depth ? gl.createRenderbuffer() : null;
  }

  dispose() {
    this.gl.deleteFramebuffer(this.framebuffer);
    this.gl.deleteRenderbuffer(this.depth);
    for (const texture of this.textures) this.gl.deleteTexture(texture);
  }

  /** @param {number} width @param {number} height */
  bind(width, height) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffer);
    gl.viewport(0, 0, width, height);
    if (width === this.width && height === this.height) return;
    this.width = width;
    this.height = height;
    this.textures.forEach((texture, i) => {
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      const pixels = this.format === gl.RGBA8 ? gl.UNSIGNED_BYTE : gl.FLOAT;
      gl.texImage2D(gl.TEXTURE_2D, 0, this.format, width, height, 0, gl.RGBA, pixels, null);
      for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
      for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, texture, 0);
    });
    gl.drawBuffers(this.textures.map((_, i) => gl.COLOR_ATTACHMENT0 + i));
    if (!this.depth) return;
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, this.depth);
  }
}
