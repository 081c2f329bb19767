/** SplitMix64 in pairs of unsigned 32-bit halves: high, low. JavaScript has no fast 64-bit integers. */

/** @typedef {[number, number]} Wide */

/** @type {Wide} */ const GOLDEN = [0x9e3779b9, 0x7f4a7c15];
/** @type {Wide} */ const FIRST = [0xbf58476d, 0x1ce4e5b9];
/** @type {Wide} */ const SECOND = [0x94d049bb, 0x133111eb];

/**
 * Initial weights of a network (section 5.5): integers from -2^23 to below 2^23.
 * @param {number} seed
 * @param {number} first place
 * @param {number} count
 * @returns {Int32Array}
 */
export function initialWeights(seed, first, count) {
  let state = plus(mixed([0, seed]), times(GOLDEN, [0, first]));
  const found = new Int32Array(count);
  for (let i = 0; i < count; i++) {
    state = plus(state, GOLDEN);
    found[i] = (mixed(state)[0] >>> 8) - 2 ** 23;
  }
  return found;
}

/** @param {Wide} state @returns {Wide} */
function mixed(state) {
  const once = times(mixedWith(state, 30), FIRST);
  const twice = times(mixedWith(once, 27), SECOND);
  return mixedWith(twice, 31);
}

/** state ^ state >> shift. @param {Wide} state @param {number} shift below 32 @returns {Wide} */
function mixedWith([high, low], shift) {
  return [(high ^ (high >>> shift)) >>> 0, (low ^ ((low >>> shift) | (high << (32 - shift)))) >>> 0];
}

/** @param {Wide} a @param {Wide} b @returns {Wide} */
function plus(a, b) {
  const low = a[1] + b[1];
  return [(a[0] + b[0] + (low >= 2 ** 32 ? 1 : 0)) >>> 0, low >>> 0];
}

/** The lower 64 bits of the product. @param {Wide} a @param {Wide} b @returns {Wide} */
function times(a, b) {
  const [a1, a0, b1, b0] = [a[1] >>> 16, a[1] & 0xffff, b[1] >>> 16, b[1] & 0xffff];
  const middle = a1 * b0 + ((a0 * b0) >>> 16);
  const other = a0 * b1 + (middle & 0xffff);
  const carried = a1 * b1 + Math.floor(middle / 65536) + Math.floor(other / 65536);
  const high = carried + Math.imul(a[0], b[1]) + Math.imul(a[1], b[0]);
  return [high >>> 0, Math.imul(a[1], b[1]) >>> 0];
}
