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

/** Takes so many last bits from integers that `bits` are enough for each. @param {number[]} values changed @param {number} bits */
export function shortened(values, bits) {
  let most = 0;
  for (let i = 0; i < values.length; i++) most = Math.max(most, Math.abs(values[i]));
  const spare = bitLength(most) - bits;
  if (spare <= 0) return values;
  const unit = 2 ** -spare;
  for (let i = 0; i < values.length; i++) values[i] = Math.floor(values[i] * unit);
  return values;
}

/** @param {number} square an integer below 2^52 */
export function rootOf(square) {
  return Math.floor(Math.sqrt(square));
}

/** The product of two vectors in a list. @param {ArrayLike<number>} list @param {number} i @param {number} j where they begin */
export function product(list, i, j) {
  return list[i] * list[j] + list[i + 1] * list[j + 1] + list[i + 2] * list[j + 2];
}

/** @param {Int32Array} places (3 n) @param {number} from @param {number} to */
export function wayBetween(places, from, to) {
  const [i, j] = [3 * from, 3 * to];
  return [places[j] - places[i], places[j + 1] - places[i + 1], places[j + 2] - places[i + 2]];
}

/** @param {number[]} a @param {number[]} b */
export function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** From the least to the greatest of nodes' values along an axis. @param {Int32Array} values (width n) @param {number} width @param {number} axis @param {number[]} nodes or -1 */
export function spreadOf(values, width, axis, nodes) {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < nodes.length; i++) {
    if (nodes[i] < 0) continue;
    const value = values[width * nodes[i] + axis];
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return [low, high];
}

/** The side of the same face so many steps on. @param {number} side @param {number} [steps] 1 or 2 */
export function sideAfter(side, steps = 1) {
  const place = side % 3;
  return side - place + ((place + steps) % 3);
}
