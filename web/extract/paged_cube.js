const EDGE = 8;
const SIZE = EDGE ** 3;

/** A cube of numbers of which few are set: memory is taken for pages of 8^3 at a time. */
export class PagedCube {
  /**
   * @param {number} size numbers along an edge
   * @param {number} empty what numbers are that were not set
   * @param {(count: number) => Float32Array|Int32Array} make an array for a page
   */
  constructor(size, empty, make) {
    this.across = Math.ceil(size / EDGE);
    this.empty = empty;
    this.make = make;
    /** @type {(Float32Array|Int32Array|undefined)[]} */
    this.pages = new Array(this.across ** 3);
  }

  /** @param {number} x @param {number} y @param {number} z */
  page(x, y, z) {
    return ((x >> 3) * this.across + (y >> 3)) * this.across + (z >> 3);
  }

  /** @param {number} x @param {number} y @param {number} z @returns {number} */
  get(x, y, z) {
    const page = this.pages[this.page(x, y, z)];
    return page ? page[((x & 7) << 6) | ((y & 7) << 3) | (z & 7)] : this.empty;
  }

  /** @param {number} x @param {number} y @param {number} z @param {number} value */
  set(x, y, z, value) {
    const number = this.page(x, y, z);
    const page = (this.pages[number] ??= this.make(SIZE).fill(this.empty));
    page[((x & 7) << 6) | ((y & 7) << 3) | (z & 7)] = value;
  }
}
