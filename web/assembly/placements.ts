/** Where copies of a part stand (section 15.7 of the specification). */
import { bit, member, number, single } from "./bits";
import { demand, giveFloats, giveInts, PLACEMENT_MATERIALS, PLACEMENTS, SCALE_ABOVE, UNIT_ROTATION } from "./host";
import { Floats, floats, ints } from "./memory";
import { HAS_MATERIALS, MIRRORED, OFFSET, ONE_PLACE, ROTATION, SCALE, UV_OFFSET, UV_SCALE } from "./slots";

const MOST = 4096;
/** How far from 1 the squared length of a rotation may be. */
const UNIT_TOLERANCE = 1e-3;
/** Numbers of a placement. */
const NUMBERS = 14;

/** Of the last part. */
export let placementCount = 0;

/** Reads floats into places of a list. */
export function readSingles(slot: i32, list: Floats, at: i32, count: i32): void {
  for (let i = 0; i < count; i++) list[at + i] = single(slot);
}

/**
 * Reads placements, and gives each away: rotation, offset, scale, whether mirrored, scale and offset of
 * UVs, whether materials of its own follow. How many placements and materials may follow, of `left`.
 */
export function readPlacements(charts: i32, materialBits: i32, left: i32): i32 {
  placementCount = 1;
  if (bit(ONE_PLACE)) return left;
  const count = number(min(MOST, left), PLACEMENTS);
  placementCount = count;
  left -= count;
  for (let i = 0; i < count; i++) {
    const place = readPlace();
    const own = bit(HAS_MATERIALS);
    place[NUMBERS - 1] = own;
    giveFloats(changetype<usize>(place), NUMBERS);
    if (!own) continue;
    demand(charts <= left, PLACEMENT_MATERIALS, left, charts);
    left -= charts;
    readMaterials(charts, materialBits);
  }
  return left;
}

function readPlace(): Floats {
  const place = floats(NUMBERS);
  readSingles(ROTATION, place, 0, 4);
  readSingles(OFFSET, place, 4, 3);
  readSingles(SCALE, place, 7, 1);
  let length: f64 = 0;
  for (let i = 0; i < 4; i++) length += place[i] * place[i];
  demand(abs(length - 1) <= UNIT_TOLERANCE, UNIT_ROTATION);
  demand(place[7] > 0, SCALE_ABOVE);
  place[8] = bit(MIRRORED);
  readSingles(UV_SCALE, place, 9, 2);
  readSingles(UV_OFFSET, place, 11, 2);
  return place;
}

function readMaterials(charts: i32, materialBits: i32): void {
  const materials = ints(charts);
  let last = 0;
  for (let chart = 0; chart < charts; chart++) materials[chart] = last = member(materialBits, last);
  giveInts(changetype<usize>(materials), charts);
}
