/** Integers of section 15 are doubles, exact below 2^53: shifts of JavaScript take 32 bits alone. */

/** How many bits a number from 0 has. @param {number} value @returns {number} */
export function bitLength(value) {
  return value < 2 ** 32 ? 32 - Math.clz32(value) : 32 + bitLength(Math.floor(value / 2 ** 32));
}

/** A quotient rounded to the nearest integer, halves up. @param {number} value @param {number} divisor */
export function rounded(value, divisor) {
  return Math.floor((2 * value + divisor) / (2 * divisor));
}

/** The two bits after the first of a scale. @param {number} scale */
export function quarterOf(scale) {
  return scale ? Math.floor((4 * scale) / 2 ** (bitLength(scale) - 1)) & 3 : 0;
}

/** Integers without so many of their last bits that `bits` are enough for each. @param {number[]} values @param {number} bits */
export function shortened(values, bits) {
  const unit = 2 ** Math.max(bitLength(Math.max(...values.map(Math.abs))) - bits, 0);
  return values.map((value) => Math.floor(value / unit));
}

/** @param {number} square an integer below 2^52 */
export function rootOf(square) {
  return Math.floor(Math.sqrt(square));
}

/** @param {number[]} a @param {number[]} b */
export function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** @param {number[]} a @param {number[]} b */
export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** The side of the same face so many steps on. @param {number} side @param {number} [steps] 1 or 2 */
export function sideAfter(side, steps = 1) {
  const place = side % 3;
  return side - place + ((place + steps) % 3);
}
