/** Integers of section 15: 32 bits where they fit, else doubles, exact below 2^53. */
import { Floats, Ints } from "./memory";

/** How many bits a number from 0 has. */
export function bitLength(value: f64): i32 {
  return value < 4294967296 ? 32 - <i32>clz(<u32>value) : 32 + bitLength(floor(value / 4294967296));
}

/** A quotient rounded to the nearest integer, halves up. */
export function rounded(value: f64, divisor: f64): f64 {
  return floor((2 * value + divisor) / (2 * divisor));
}

/** The two bits after the first of a scale. */
export function quarterOf(scale: i32): i32 {
  return scale ? ((scale << 2) >> (31 - clz(scale))) & 3 : 0;
}

/** With an exponent from 0 to 60. */
function powerOfTwo(exponent: i32): f64 {
  const half: i32 = 1 << (exponent >> 1);
  const rest: i32 = 1 << ((exponent + 1) >> 1);
  return <f64>half * <f64>rest;
}

/** Takes so many last bits from values that `bits` are enough for each. */
export function shorten(values: Floats, count: i32, bits: i32): void {
  let most: f64 = 0;
  for (let i = 0; i < count; i++) most = max(most, abs(values[i]));
  const spare = bitLength(most) - bits;
  if (spare <= 0) return;
  const unit = powerOfTwo(spare);
  for (let i = 0; i < count; i++) values[i] = floor(values[i] / unit);
}

/** The product of two vectors in a list, which begin at i and j. */
export function product(list: Floats, i: i32, j: i32): f64 {
  return list[i] * list[j] + list[i + 1] * list[j + 1] + list[i + 2] * list[j + 2];
}

/** Writes the way between two nodes of `places` (3 n) at `at`. */
export function wayBetween(places: Ints, from: i32, to: i32, ways: Floats, at: i32): void {
  for (let axis = 0; axis < 3; axis++) ways[at + axis] = places[3 * to + axis] - places[3 * from + axis];
}

/** Writes the cross product of the first two vectors in a list behind them. */
export function cross(ways: Floats): void {
  for (let axis = 0; axis < 3; axis++) {
    const next = (axis + 1) % 3;
    const last = (axis + 2) % 3;
    ways[6 + axis] = ways[next] * ways[3 + last] - ways[last] * ways[3 + next];
  }
}

/** The side of the same face so many steps on, 1 or 2. */
export function sideAfter(side: i32, steps: i32 = 1): i32 {
  const place = side % 3;
  return side - place + ((place + steps) % 3);
}
