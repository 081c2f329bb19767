/**
 * The arithmetic of a network without WebAssembly: the same functions as kernel.wat has, where no
 * security policy lets WebAssembly run, and for comparison.
 *
 * @typedef {object} Kernel addresses are in bytes of `memory`; see kernel.wat
 * @property {(w: number, b: number, x: number, y: number, rows: number, columns: number, points: number) => void} linear
 * @property {(y: number, d: number, count: number) => void} sine
 * @property {(y: number, d: number, count: number) => void} multiply
 */

/**
 * @param {() => Float32Array} memory
 * @returns {Kernel}
 */
export function plainKernel(memory) {
  return {
    linear: (w, b, x, y, rows, columns, points) =>
      linear(memory(), w >> 2, b >> 2, x >> 2, y >> 2, rows, columns, points),
    sine: (y, d, count) => sine(memory(), y >> 2, d >> 2, count),
    multiply: (y, d, count) => {
      const all = memory();
      for (let i = 0; i < count; i++) all[(y >> 2) + i] *= all[(d >> 2) + i];
    },
  };
}

/**
 * @param {Float32Array} all
 * @param {number} w @param {number} b @param {number} x @param {number} y
 * @param {number} rows @param {number} columns @param {number} points
 */
function linear(all, w, b, x, y, rows, columns, points) {
  for (let row = 0; row < rows; row++, w += columns, y += points) {
    const bias = all[b + row];
    for (let p = 0; p < points; p += 4) {
      let s0 = bias;
      let s1 = bias;
      let s2 = bias;
      let s3 = bias;
      for (let i = 0, at = x + p; i < columns; i++, at += points) {
        const weight = all[w + i];
        s0 += weight * all[at];
        s1 += weight * all[at + 1];
        s2 += weight * all[at + 2];
        s3 += weight * all[at + 3];
      }
      all[y + p] = s0;
      all[y + p + 1] = s1;
      all[y + p + 2] = s2;
      all[y + p + 3] = s3;
    }
  }
}

/** @param {Float32Array} all @param {number} y @param {number} d @param {number} count */
function sine(all, y, d, count) {
  for (let i = 0; i < count; i++) {
    const t = all[y + i];
    const whole = Math.floor(t + 0.5);
    const f = t - whole;
    const sign = 1 - 2 * (whole & 1);
    all[y + i] = sign * halfTurn(f);
    if (d) all[d + i] = sign * Math.PI * halfTurn(0.5 - Math.abs(f));
  }
}

/** sin(pi f) for f in [-1/2, 1/2]: the polynomial of kernel.wat. @param {number} f */
function halfTurn(f) {
  const s = f * f;
  const inner = 2.550069808959961 + s * (-0.5982421040534973 + s * 0.07756038755178452);
  return f * (3.1415927410125732 + s * (-5.167709827423096 + s * inner));
}
