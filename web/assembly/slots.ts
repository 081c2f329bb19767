import { Bytes, bytes } from "./memory";

/** Slots of section 15.1: a number for each decision, two for floats, 64 for integers. */
export const NEW = 0;
export const RIGHT = 1;
export const LEFT = 2;
export const BORDER = 4;
export const PAIR = 5;
export const FAR = 6;
export const BACK = 7;
export const HAS_COPIES = 8;
export const IS_COPY = 9;
export const SHEET = 10;
export const HAS_SEAMS = 11;
export const SEAM = 12;
export const HAS_CREASES = 13;
export const CREASE = 14;
export const BORDER_CREASE = 15;
export const HAS_UV = 16;
export const MEMBER = 17;
export const ONE_PLACE = 18;
export const MIRRORED = 19;
export const HAS_MATERIALS = 20;
export const FLIP = 21;
export const DOWN = 22;
export const SEEN = 23;
export const BESIDE = 24;
export const STACKED = 25;
export const STEP = 32;
export const ORIGIN = 34;
export const UV_STEP = 36;
export const UV_ORIGIN = 38;
export const ROTATION = 40;
export const OFFSET = 42;
export const SCALE = 44;
export const UV_SCALE = 46;
export const UV_OFFSET = 48;
export const STEPS = 64;
export const RANK = 128;
export const POSITION = 192;
export const NORMAL = 256;
export const POSITION_START = 320;
export const UV = 384;
export const UV_START = 448;
export const UV_SECOND = 512;
export const UV_THIRD = 576;
export const SLOTS_END = 640;
const INTEGERS = 9;

/** Shares of integers from STEPS on: how many follow, whether one is longer than expected, and again; then whether shorter. */
// prettier-ignore
const LENGTHS = memory.data<u8>([
  6, 254, 252, 66, 54, 21, 8, 0,
  3, 44, 34, 6, 0,
  11, 132, 129, 80, 74, 91, 101, 126, 104, 94, 67, 21, 8, 138, 127, 126, 121, 133, 152, 184, 207,
  12, 171, 178, 138, 107, 99, 88, 91, 64, 78, 111, 166, 21, 7, 142, 137, 144, 162, 171, 207, 18,
  3, 12, 10, 10, 10, 223, 215, 201, 178, 179, 176, 188, 162, 214, 133,
  9, 92, 125, 104, 74, 42, 72, 82, 37, 21, 5, 179, 160, 148, 150, 161,
  4, 144, 177, 120, 2, 7, 169, 158, 161, 144, 164, 157, 138,
  6, 32, 52, 56, 25, 235, 21, 9, 150, 170, 184, 181, 208, 212, 239, 250, 219,
  10, 155, 160, 100, 56, 50, 70, 92, 235, 128, 37, 6, 155, 160, 190, 236, 188, 243,
]);

/** What shares of bits are 1 at first, in 256ths, by slot (SLOTS_END); 0 where nothing is said. */
export function priors(): Bytes {
  const found = bytes(SLOTS_END);
  found[RIGHT] = 62;
  found[LEFT] = 217;
  found[PAIR] = 231;
  found[FAR] = 11;
  found[IS_COPY] = 9;
  found[SEAM] = 63;
  found[BESIDE] = 151;
  found[SEEN] = 48;
  let at = LENGTHS;
  for (let i = 0; i < 2 * INTEGERS; i++) {
    const first = STEPS + 64 * (i >> 1) + (i & 1 ? 20 : 2);
    const count = <i32>load<u8>(at++);
    for (let j = 0; j < count; j++) found[first + j] = load<u8>(at++);
  }
  return found;
}
