/** Pairs of integers by number, in the order in which they came. */
import { filled, Ints, ints, reserve } from "./memory";

/** Odd and not known before, so that no file can be made whose pairs all fall together. */
let factorOfOne = 0;
let factorOfOther = 0;

export function setFactors(one: i32, other: i32): void {
  factorOfOne = one | 1;
  factorOfOther = other | 1;
}

/** Odd, with bits all over: numbers in a row are to fall apart. */
const MIX: u32 = 0x9e3779b1;

@unmanaged
export class PairTable {
  ones: Ints = changetype<Ints>(0);
  others: Ints = changetype<Ints>(0);
  count: i32 = 0;
  /** The last pair of each hash value, or -1; and the one before each of the same. */
  private heads: Ints = changetype<Ints>(0);
  private earlier: Ints = changetype<Ints>(0);
  private shift: i32 = 0;

  /** Where pairs of a hash value begin. */
  private bucket(one: i32, other: i32): i32 {
    const mixed: u32 = one * factorOfOne + other * factorOfOther;
    return ((mixed ^ (mixed >>> 15)) * MIX) >>> this.shift;
  }

  /** The number of a pair, or -1. */
  find(one: i32, other: i32): i32 {
    let number = this.heads[this.bucket(one, other)];
    while (number >= 0 && (this.ones[number] !== one || this.others[number] !== other)) number = this.earlier[number];
    return number;
  }

  /** The number of a pair, which is new or not. */
  add(one: i32, other: i32): i32 {
    const found = this.find(one, other);
    if (found >= 0) return found;
    const bucket = this.bucket(one, other);
    const number = this.count++;
    this.ones[number] = one;
    this.others[number] = other;
    this.earlier[number] = this.heads[bucket];
    return (this.heads[bucket] = number);
  }

  /** One without pairs, for so many at most. */
  static begin(most: i32): PairTable {
    const table = changetype<PairTable>(reserve(offsetof<PairTable>()));
    // At least two hash values: a shift by 32 is none.
    const bits = 32 - clz(most | 1);
    table.shift = 32 - bits;
    table.heads = filled(1 << bits, -1);
    table.ones = ints(most);
    table.others = ints(most);
    table.earlier = ints(most);
    return table;
  }
}
