/**
 * Images as the specification wants their texels: color profiles, gamma and orientation are
 * ignored. Browsers turn images whatever they are asked: what says so is taken out of the files.
 */

/**
 * @param {import("../decoder/document.js").Texture} texture
 * @returns {Promise<ImageBitmap>} straight alpha, top row first
 */
export function decodeImage({ mime, data }) {
  const blob = new Blob([/** @type {BlobPart} */ (asStored(mime, data))], { type: mime });
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
 * The image file without what says how its pixels are to be shown: EXIF and color chunks of PNG,
 * EXIF and profiles of JPEG and WebP, turns, mirrors and crops of AVIF. A file of another structure is
 * returned as it is: the image decoder says what is wrong with it.
 * @param {string} mime
 * @param {Uint8Array} data
 * @returns {Uint8Array}
 */
export function asStored(mime, data) {
  if (mime === "image/png") return withoutParts(data, 8, pngPart, PNG_UNWANTED);
  if (mime === "image/jpeg") return withoutParts(data, 2, jpegPart, ["Exif", "ICC_"]);
  if (mime === "image/webp") return unsaidChunks(data);
  return withoutTransforms(data);
}

const PNG_UNWANTED = ["eXIf", "iCCP", "sRGB", "gAMA", "cHRM", "cICP"];

/** @typedef {{end: number, name: string}|null} Part null where parts end */

/** @param {Uint8Array} data @param {number} start @param {(data: Uint8Array, at: number) => Part} partAt @param {string[]} unwanted */
function withoutParts(data, start, partAt, unwanted) {
  const kept = [data.subarray(0, start)];
  let at = start;
  for (let part = partAt(data, at); part && part.end <= data.length; part = partAt(data, at)) {
    if (!unwanted.includes(part.name)) kept.push(data.subarray(at, part.end));
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
  const name = marker === 0xe1 || marker === 0xe2 ? textAt(data, at + 4) : "";
  return { end: at + 2 + ((data[at + 2] << 8) | data[at + 3]), name };
}

/** Under other names the chunks of EXIF and of a profile say nothing. @param {Uint8Array} data */
function unsaidChunks(data) {
  const copy = data.slice();
  const view = new DataView(copy.buffer);
  for (let at = 12; at + 8 <= copy.length; ) {
    const length = view.getUint32(at + 4, true);
    if (["EXIF", "ICCP"].includes(textAt(copy, at))) copy.set([0x6e, 0x6f, 0x6e, 0x65], at);
    // Bits of the extended header that say that they are there.
    if (textAt(copy, at) === "VP8X") copy[at + 8] &= ~0x28;
    at += 8 + length + (length & 1);
  }
  return copy;
}

/** Boxes of AVIF between two places: names, and where their contents are. @param {Uint8Array} data @param {number} start @param {number} end */
function boxesIn(data, start, end) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const boxes = [];
  for (let at = start; at + 8 <= end; ) {
    const size = view.getUint32(at);
    if (size < 8 || at + size > end) break;
    boxes.push({ name: textAt(data, at + 4), start: at + 8, end: at + size });
    at += size;
  }
  return boxes;
}

/**
 * Transforms are properties (`ipco`), which items name by number (`ipma`): the number 0 is none.
 * @param {Uint8Array} data
 */
function withoutTransforms(data) {
  const copy = data.slice();
  const inside = (/** @type {{start: number, end: number}[]} */ boxes, /** @type {string} */ name, skipped = 0) =>
    boxes.flatMap((box) => boxesIn(copy, box.start + skipped, box.end)).filter((box) => box.name === name);
  const meta = boxesIn(copy, 0, copy.length).filter((box) => box.name === "meta");
  const properties = inside(meta, "iprp", 4);
  const names = inside(properties, "ipco").flatMap((box) => boxesIn(copy, box.start, box.end).map((each) => each.name));
  for (const box of inside(properties, "ipma")) unnameTransforms(copy, box.start, box.end, names);
  return copy;
}

/** @param {Uint8Array} data @param {number} start @param {number} end @param {string[]} names of the properties, from number 1 */
function unnameTransforms(data, start, end, names) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const [wideItems, wideNumbers] = [data[start] > 0, data[start + 3] & 1];
  let at = start + 8;
  for (let item = view.getUint32(start + 4); item > 0 && at < end; item--) {
    at += wideItems ? 4 : 2;
    for (let count = data[at++]; count > 0 && at < end; count--) {
      const number = wideNumbers ? view.getUint16(at) & 0x7fff : data[at] & 0x7f;
      if (["irot", "imir", "clap"].includes(names[number - 1])) data.fill(0, at, at + (wideNumbers ? 2 : 1));
      at += wideNumbers ? 2 : 1;
    }
  }
}
