/** Numbers of what may be wrong: places in the list of decoder/mesh/section.js, which says it in words. */
export const BYTES = 0;
export const NUMBER_BITS = 1;
export const COORDINATE = 2;
export const END = 3;
export const THIRD_POINT = 4;
export const POINT = 5;
export const GATE_THERE = 6;
export const GATE = 7;
export const GATE_STEPS = 8;
export const COPY_OF = 9;
export const COPY = 10;
export const UV_RANK = 11;
export const SEEN_BEFORE = 12;
export const UV_VALUE = 13;
export const PARTS = 14;
export const FACES = 15;
export const GRID_BITS = 16;
export const UV_GRID_BITS = 17;
export const STEP_ABOVE = 18;
export const FACE_OF_THREE = 19;
export const MATERIAL_BITS = 20;
export const PLACEMENTS = 21;
export const PLACEMENT_MATERIALS = 22;
export const UNIT_ROTATION = 23;
export const SCALE_ABOVE = 24;
export const PLACED_FACES = 25;
/** Nine of them, from that of STEP on. */
export const FINITE = 26;

/** Refuses the file: does not return. */
@external("nisp", "refuse")
declare function refuse(what: i32, limit: i32, found: i32): void;

/** Gives a list of integers away. */
@external("nisp", "giveInts")
export declare function giveInts(list: usize, count: i32): void;

/** Gives a list of doubles away. */
@external("nisp", "giveFloats")
export declare function giveFloats(list: usize, count: i32): void;

/** Refuses the file unless `holds`; some texts state a limit. */
@inline
export function demand(holds: bool, what: i32, limit: i32 = 0, found: i32 = 0): void {
  if (!holds) refuse(what, limit, found);
}
