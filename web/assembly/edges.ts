/** Flags of edges (section 15.5 of the specification). */
import { bit } from "./bits";
import { cross, product, shorten, sideAfter, wayBetween } from "./integers";
import { Floats, floats, Ints, ints, mark, release } from "./memory";

/** Digits of vectors that are multiplied. */
const DIGITS = 10;
const FLAT = 8;
const AT_BORDER = 9;

/** Two sides of a face, and their cross product. */
const ways = floats(9);

/**
 * How sharp the edge at each side is: from 0, at least a right angle, to 8, flat; 9 at borders.
 * Corners are vertices (3 m), `places` theirs (3 n).
 */
export function bendsOf(corners: Ints, twin: Ints, sides: i32, places: Ints): Ints {
  const bends = ints(sides);
  const start = mark();
  const normals = floats(sides);
  for (let at = 0; at < sides; at += 3) {
    wayBetween(places, corners[at], corners[at + 1], ways, 0);
    shortenAt(0);
    wayBetween(places, corners[at], corners[at + 2], ways, 3);
    shortenAt(3);
    cross(ways);
    shortenAt(6);
    for (let axis = 0; axis < 3; axis++) normals[at + axis] = ways[6 + axis];
  }
  for (let side = 0; side < sides; side++) {
    const other = twin[side];
    if (other < 0) {
      bends[side] = AT_BORDER;
      continue;
    }
    const m = side - (side % 3);
    const n = other - (other % 3);
    const aligned = product(normals, m, n);
    const both = product(normals, m, m) * product(normals, n, n);
    bends[side] = aligned > 0 && both > 0 ? <i32>floor((FLAT * aligned * aligned) / both) : 0;
  }
  release(start);
  return bends;
}

function shortenAt(place: i32): void {
  shorten(changetype<Floats>(changetype<usize>(ways) + (place << 3)), 3, DIGITS);
}

/** Reads `flags` (3 m), one for each edge; those of borders are there. Corners are points (3 m). */
export function readEdges(slot: i32, corners: Ints, twin: Ints, sides: i32, points: i32, bends: Ints, flags: Ints): void {
  const start = mark();
  const lines = ints(points);
  const left = ints(points);
  for (let side = 0; side < sides; side++) {
    const a = corners[side];
    const b = corners[sideAfter(side)];
    if (twin[side] < 0) {
      lines[a] += flags[side];
      lines[b] += flags[side];
    }
    if (twin[side] > side) {
      left[a]++;
      left[b]++;
    }
  }
  for (let side = 0; side < sides; side++) {
    const other = twin[side];
    if (other <= side) continue;
    const a = corners[side];
    const b = corners[sideAfter(side)];
    const one = min(lines[a], 3) * 4 + min(left[a], 4) - 1;
    const two = min(lines[b], 3) * 4 + min(left[b], 4) - 1;
    const low = min(one, two);
    const high = max(one, two);
    const state = low * 16 + high;
    const few = (low >> 2) * 4 + (high >> 2);
    const flag = bit(slot, state, state * 10 + bends[side], few * 10 + bends[side]);
    left[a]--;
    left[b]--;
    lines[a] += flag;
    lines[b] += flag;
    flags[side] = flags[other] = flag;
  }
  release(start);
}
