/**
 * The decoder of MESH (section 15 of the specification), in AssemblyScript: `npm run kernel` compiles
 * it into decoder/mesh/module.js. An instance decodes one section: `begin` says where its bytes go.
 */
import { begin as beginBits, finish, number, start } from "./bits";
import { demand, PARTS, PLACED_FACES } from "./host";
import { mark, release } from "./memory";
import { setFactors } from "./pair_table";
import { faceCount, readPart } from "./part";
import { placementCount } from "./placements";

const MOST_FACES = 262144;
const FACES_PER_BYTE = 64;
const MOST_PLACED_FACES = 2097152;

/** Lists of modules end here, which started before; all behind are of one file. */
const lasting = mark();

/** The address for so many bytes; what was decoded before is gone. Two random integers keep a file from slowing the decoder. */
export function begin(length: i32, one: i32, other: i32): usize {
  release(lasting);
  setFactors(one, other);
  return changetype<usize>(beginBits(length));
}

/** Decodes the bytes, and gives parts away, or refuses them. */
export function read(length: i32): void {
  start();
  let left = min(MOST_FACES / FACES_PER_BYTE, length) * FACES_PER_BYTE;
  const count = number(left, PARTS);
  let placed = 0;
  for (let i = 0; i < count; i++) {
    left = readPart(left);
    placed += faceCount * placementCount;
    demand(placed <= MOST_PLACED_FACES, PLACED_FACES, MOST_PLACED_FACES, placed);
  }
  finish();
}
