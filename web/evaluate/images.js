/**
 * Images as the specification wants their texels: embedded color profiles, gamma and orientation
 * are ignored. Browsers can be told to ignore profiles, but not orientation: it is taken out.
 */

/**
 * @param {import("../decoder/document.js").Texture} texture
 * @returns {Promise<ImageBitmap>} straight alpha, top row first
 */
export function decodeImage({ mime, data }) {
  const blob = new Blob([/** @type {BlobPart} */ (withoutOrientation(mime, data))], { type: mime });
  return createImageBitmap(blob, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
}

/**
 * The texels of an image, for `NISPModel.color`. By WebGL, as a canvas in two dimensions would
 * multiply by alpha and lose digits.
 * @param {ImageBitmap} image
 * @returns {import("./texture.js").Pixels}
 */
export function readPixels(image) {
  const { width, height } = image;
  const gl = new OffscreenCanvas(1, 1).getContext("webgl2");
  if (!gl) throw new Error("WebGL 2: expected it, found a browser without");
  gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, image);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  const texture = gl.getParameter(gl.TEXTURE_BINDING_2D);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  const data = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return { width, height, data };
}

/**
 * The image file without what turns it: EXIF in PNG, JPEG and WebP; `irot`, `imir` and `clap` of AVIF.
 * A file of another structure is returned as it is: the image decoder says what is wrong with it.
 * @param {string} mime
 * @param {Uint8Array} data
 * @returns {Uint8Array}
 */
export function withoutOrientation(mime, data) {
  if (mime === "image/png") return withoutParts(data, 8, pngPart, "eXIf");
  if (mime === "image/jpeg") return withoutParts(data, 2, jpegPart, "Exif");
  if (mime === "image/webp") return renamedExif(data);
  return withoutRotation(data);
}

/** @typedef {{end: number, name: string}|null} Part null where parts end */

/** @param {Uint8Array} data @param {number} start @param {(data: Uint8Array, at: number) => Part} partAt @param {string} unwanted */
function withoutParts(data, start, partAt, unwanted) {
  const kept = [data.subarray(0, start)];
  let at = start;
  for (let part = partAt(data, at); part && part.end <= data.length; part = partAt(data, at)) {
    if (part.name !== unwanted) kept.push(data.subarray(at, part.end));
    at = part.end;
  }
  kept.push(data.subarray(at));
  const whole = new Uint8Array(kept.reduce((sum, part) => sum + part.length, 0));
  let place = 0;
  for (const part of kept) {
    whole.set(part, place);
    place += part.length;
  }
  return whole;
}

/** @param {Uint8Array} data @param {number} at */
function textAt(data, at) {
  return String.fromCharCode(...data.subarray(at, at + 4));
}

/** A chunk. @param {Uint8Array} data @param {number} at @returns {Part} */
function pngPart(data, at) {
  if (at + 12 > data.length) return null;
  const length = data[at] * 2 ** 24 + ((data[at + 1] << 16) | (data[at + 2] << 8) | data[at + 3]);
  return { end: at + 12 + length, name: textAt(data, at + 4) };
}

/** A segment before the image's own data. @param {Uint8Array} data @param {number} at @returns {Part} */
function jpegPart(data, at) {
  const marker = data[at + 1];
  if (at + 8 > data.length || data[at] !== 0xff || marker === 0xda || marker < 0xc0) return null;
  const name = marker === 0xe1 ? textAt(data, at + 4) : "";
  return { end: at + 2 + ((data[at + 2] << 8) | data[at + 3]), name };
}

/** Under another name the chunk says nothing. @param {Uint8Array} data */
function renamedExif(data) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  for (let at = 12; at + 8 <= data.length; ) {
    const length = view.getUint32(at + 4, true);
    if (textAt(data, at) === "EXIF") {
      const copy = data.slice();
      copy.set([0x6e, 0x6f, 0x6e, 0x65], at);
      if (textAt(copy, 12) === "VP8X") copy[20] &= ~8;
      return copy;
    }
    at += 8 + length + (length & 1);
  }
  return data;
}

/** Boxes that turn, mirror or crop become turns by nothing: to leave them out would move others. @param {Uint8Array} data */
function withoutRotation(data) {
  const copy = data.slice();
  for (let at = 4; at + 5 <= data.length; at++) {
    const size = data[at - 1];
    const there = { irot: 9, imir: 9, clap: 40 }[textAt(data, at)] === size && !(data[at - 2] | data[at - 3] | data[at - 4]);
    if (there) copy.set([0x69, 0x72, 0x6f, 0x74, 0], at);
  }
  return copy;
}
