/**
 * Texels of a decoded image: RGBA, top row first.
 * @typedef {{width: number, height: number, data: Uint8Array|Uint8ClampedArray|Float32Array}} Pixels
 */

/** @param {number} value of a channel in sRGB */
export function srgbToLinear(value) {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

/** @param {number} value */
export function linearToSrgb(value) {
  return value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
}

/** @param {number} index @param {number} size @param {string} wrap */
function wrapped(index, size, wrap) {
  if (wrap === "clamp") return Math.min(Math.max(index, 0), size - 1);
  const period = wrap === "mirror" ? 2 * size : size;
  const place = ((index % period) + period) % period;
  return Math.min(place, period - 1 - (wrap === "mirror" ? place : 0));
}

/**
 * The color of a map at a texture coordinate (section 8 of the specification).
 * @param {Pixels} image
 * @param {number} u @param {number} v origin bottom-left
 * @param {import("../decoder/metadata.js").MapUse} use
 * @returns {number[]} RGBA in [0, 1], as stored
 */
export function lookUp(image, u, v, use) {
  if (!Number.isFinite(u)) u = 0;
  if (!Number.isFinite(v)) v = 0;
  const { width, height, data } = image;
  const top = data instanceof Float32Array ? 1 : 255;
  const texel = (/** @type {number} */ x, /** @type {number} */ y) =>
    4 * (wrapped(y, height, use.wrapV) * width + wrapped(x, width, use.wrapU));
  const nearest = use.filter === "nearest";
  const toCenter = nearest ? 0 : 0.5;
  const [x, y] = [u * width - toCenter, (1 - v) * height - toCenter];
  const [left, above] = [Math.floor(x), Math.floor(y)];
  const [right, low] = nearest ? [0, 0] : [x - left, y - above];
  const corners = [texel(left, above), texel(left + 1, above), texel(left, above + 1), texel(left + 1, above + 1)];
  const shares = [(1 - right) * (1 - low), right * (1 - low), (1 - right) * low, right * low];
  return [0, 1, 2, 3].map((channel) =>
    corners.reduce((sum, at, i) => sum + (shares[i] * data[at + channel]) / top, 0),
  );
}

/**
 * A material's base color, sRGB-encoded.
 * @param {number[]} factor
 * @param {number[]|null} texel RGBA of the map; null without map or texture coordinates
 */
export function baseColor(factor, texel) {
  if (texel && factor.every((value) => value === 1)) return texel;
  return factor.map((value, i) => {
    const found = texel ? (i < 3 ? srgbToLinear(texel[i]) : texel[i]) : 1;
    const clipped = Math.min(Math.max(value * found, 0), 1);
    return i < 3 ? linearToSrgb(clipped) : clipped;
  });
}
