/**
 * Images as the specification wants their texels: embedded color profiles, gamma and orientation
 * are ignored. Browsers can be told to ignore profiles, but not orientation: it is renamed.
 */
import { crc32 } from "../decoder/bytes.js";

/** "noNe", the name of a chunk that readers of PNG, JPEG and WebP pass over. */
const NO_CHUNK = [0x6e, 0x6f, 0x4e, 0x65];
/** "irot", by nothing. */
const NO_TURN = [0x69, 0x72, 0x6f, 0x74, 0];

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
 * The image file, where what turns it goes by another name: EXIF in PNG, JPEG and WebP; `irot`, `imir`
 * and `clap` of AVIF. What does not look like such a file stays: the image decoder says what is wrong.
 * @param {string} mime
 * @param {Uint8Array} data
 * @returns {Uint8Array}
 */
export function withoutOrientation(mime, data) {
  const copy = new Uint8Array(data);
  const rename = { "image/png": renameInPNG, "image/jpeg": renameInJPEG, "image/webp": renameInWebP }[mime] ?? renameInAVIF;
  rename(copy, new DataView(copy.buffer));
  return copy;
}

/** @param {Uint8Array} data @param {number} at */
function textAt(data, at) {
  return String.fromCharCode(...data.subarray(at, at + 4));
}

/** Chunks have a checksum over name and content. @param {Uint8Array} data @param {DataView} view */
function renameInPNG(data, view) {
  for (let at = 8; at + 12 <= data.length; ) {
    const end = at + 12 + view.getUint32(at);
    if (textAt(data, at + 4) === "eXIf" && end <= data.length) {
      data.set(NO_CHUNK, at + 4);
      view.setUint32(end - 4, crc32(data.subarray(at + 4, end - 4)));
    }
    at = end;
  }
}

/** Segments before the image's own data. @param {Uint8Array} data @param {DataView} view */
function renameInJPEG(data, view) {
  for (let at = 2; at + 8 <= data.length && data[at] === 0xff; at += 2 + view.getUint16(at + 2)) {
    const marker = data[at + 1];
    if (marker === 0xda || marker < 0xc0) return;
    if (marker === 0xe1 && textAt(data, at + 4) === "Exif") data.set(NO_CHUNK, at + 4);
  }
}

/** Chunks of even length; the first may say that there is EXIF. @param {Uint8Array} data @param {DataView} view */
function renameInWebP(data, view) {
  for (let at = 12; at + 8 <= data.length; ) {
    if (textAt(data, at) === "EXIF") {
      data.set(NO_CHUNK, at);
      if (textAt(data, 12) === "VP8X") data[20] &= ~8;
    }
    const length = view.getUint32(at + 4, true);
    at += 8 + length + (length & 1);
  }
}

/** Boxes that turn, mirror or crop become turns by nothing: to leave them out would move others. @param {Uint8Array} data @param {DataView} view */
function renameInAVIF(data, view) {
  for (let at = 4; at + 5 <= data.length; at++) {
    const size = { irot: 9, imir: 9, clap: 40 }[textAt(data, at)];
    if (size === view.getUint32(at - 4)) data.set(NO_TURN, at);
  }
}
