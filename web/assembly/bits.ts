/** Bits under probabilities that adapt to the bits before (section 15.1 of the specification). */
import { BYTES, COORDINATE, demand, END, FINITE, NUMBER_BITS } from "./host";
import { Bytes, bytes, Ints, ints, reserve } from "./memory";
import { BORDER, CREASE, MEMBER, priors, SEAM, SLOTS_END, STEP } from "./slots";

// prettier-ignore
const KNOTS = memory.data<u16>([
  22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4972, 7812, 11955, 17625, 24743, 32768,
  40793, 47911, 53581, 57724, 60564, 62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438,
  65476, 65500, 65514,
]);
const MOST_ODDS = 2047;
/** Bytes of zeros that may follow those that are there. */
const PADDING = 4;
const MOST_BITS = 24;
/** A weight before anything was seen. */
const EVEN = 20000;

/** A decision: what it takes to say how likely a bit is. */
@unmanaged
class Slot {
  /** Counters by general, medium and special contexts, each a probability times 256 plus bits seen; 0 is a new one. */
  one: Ints = changetype<Ints>(0);
  two: Ints = changetype<Ints>(0);
  three: Ints = changetype<Ints>(0);
  /** A new counter of a general context. */
  prior: i32 = 0;
  weightOfOne: f64 = 0;
  weightOfTwo: f64 = 0;
  weightOfThree: f64 = 0;
}

let data: Bytes = changetype<Bytes>(0);
let length = 0;
let at = 0;
let range: u32 = 0xffffffff;
let code: u32 = 0;

/** Probabilities in 65536ths by logarithmic odds, from -2048 on; and the lowest odds whose probability is not below so many 4096ths. */
const squashed = ints(4096);
const stretched = ints(4096);
/** 65536 by 2 plus the bits that a counter has seen, up to 255. */
const rates = ints(256);
/** One after the other. */
const slots = reserve(SLOTS_END * offsetof<Slot>());

/** How much longer than expected the last coordinate was, from 1 to 10. */
export let longer = 0;

/** The address of so many bytes, which are then to be decoded. */
export function begin(count: i32): Bytes {
  data = bytes(count);
  length = count;
  at = code = 0;
  range = 0xffffffff;
  for (let place = 1; place < 4096; place++) squashed[place] = squash(place);
  for (let p = 0, place = 1; p < 4096; p++) {
    while (place < 4095 && squashed[place] >> 4 < p) place++;
    stretched[p] = place - 2048;
  }
  for (let seen = 0; seen < 256; seen++) rates[seen] = 65536 / (seen + 2);
  const shares = priors();
  // As many contexts as are asked for below and in other modules at most.
  for (let slot = 0; slot < SLOTS_END; slot++) {
    if (slot === MEMBER) beginSlot(slot, 0, 1 << 16, 1 << 16, 1 << 19);
    else if (slot <= BORDER) beginSlot(slot, shares[slot], 121, 256, 6800);
    else if (slot === SEAM || slot === CREASE) beginSlot(slot, shares[slot], 256, 2560, 2560);
    else beginSlot(slot, shares[slot], 16, 288, 128);
  }
  return data;
}

/** With a share of bits that are 1, in 256ths, or 0; for so many contexts, from the general to the special. */
function beginSlot(number: i32, share: i32, general: i32, medium: i32, special: i32): void {
  const slot = slotOf(number);
  slot.one = ints(general);
  slot.two = ints(medium);
  slot.three = ints(special);
  slot.prior = share ? (share << 16) + 4 : 32768 << 8;
  slot.weightOfOne = slot.weightOfTwo = slot.weightOfThree = EVEN;
}

@inline
function slotOf(number: i32): Slot {
  return changetype<Slot>(slots + number * offsetof<Slot>());
}

/** Begins to decode. */
export function start(): void {
  for (let i = 0; i < 4; i++) take();
}

/** The next byte joins the code. */
function take(): void {
  code = (code << 8) | (at < length ? data[at] : 0);
  at++;
}

/** A probability in 65536ths, between those of the knots. */
function squash(place: i32): i32 {
  const rest = place & 127;
  const knot = KNOTS + ((place >> 7) << 1);
  return (load<u16>(knot) * (128 - rest) + load<u16>(knot, 2) * rest + 64) >> 7;
}

/** A bit that is 1 with a probability of so many 65536ths. */
function divide(p: i32): i32 {
  const zero: u32 = 65536 - p;
  const bound: u32 = (range >>> 16) * zero + (((range & 65535) * zero) >>> 16);
  const bit = code >= bound;
  if (bit) {
    code -= bound;
    range -= bound;
  } else range = bound;
  while (range < 1 << 24) {
    demand(at < length + PADDING, BYTES, 0, length);
    range <<= 8;
    take();
  }
  return bit;
}

/** A counter after one more bit. */
@inline
function moved(counter: i32, bit: i32): i32 {
  const seen = counter & 255;
  const probability = counter >> 8;
  const step = ((65535 * bit - probability) * rates[seen]) >> 16;
  return ((probability + step) << 8) + min(seen + 1, 255);
}

/** How a weight moves. */
@inline
function stepOf(x: i32, error: i32): f64 {
  return (x * error * 10 + 32768) >> 16;
}

/** A decision under three contexts, from the general to the special. */
export function bit(number: i32, general: i32 = 0, medium: i32 = 0, special: i32 = 0): i32 {
  const slot = slotOf(number);
  const a = slot.one[general] || slot.prior;
  const begun = (a & ~255) + 1;
  const b = slot.two[medium] || begun;
  const c = slot.three[special] || begun;
  const x = stretched[a >> 12];
  const y = stretched[b >> 12];
  const z = stretched[c >> 12];
  const sum = slot.weightOfOne * x + slot.weightOfTwo * y + slot.weightOfThree * z;
  const odds = <i32>floor(sum * (1 / 65536));
  const p = squashed[min(max(odds, -MOST_ODDS), MOST_ODDS) + 2048];
  const bit = divide(p);
  const error = 65535 * bit - p;
  slot.weightOfOne += stepOf(x, error);
  slot.weightOfTwo += stepOf(y, error);
  slot.weightOfThree += stepOf(z, error);
  slot.one[general] = moved(a, bit);
  slot.two[medium] = moved(b, bit);
  slot.three[special] = moved(c, bit);
  return bit;
}

/** An integer of even bits. */
export function bits(count: i32): i32 {
  let value = 0;
  while (count-- > 0) value = (value << 1) | divide(32768);
  return value;
}

/** An integer below `end`; `what` says so in an error. */
export function below(end: i32, what: i32): i32 {
  const value = bits(32 - clz(end - 1));
  demand(value < end, what, end, value);
  return value;
}

/** An integer from 1: how many bits it has, then these without the first. */
export function number(most: i32, what: i32): i32 {
  const length = bits(5);
  const value = length ? (1 << (length - 1)) + bits(length - 1) : 0;
  demand(value > 0 && value <= most, what, most, value);
  return value;
}

/** A float32; 0 and 1 have bits of their own. */
export function single(slot: i32): f64 {
  if (bit(slot)) return 0;
  if (bit(slot + 1)) return 1;
  const value = <f64>reinterpret<f32>(bits(32));
  demand(abs(value) <= f32.MAX_VALUE, FINITE + ((slot - STEP) >> 1));
  return value;
}

/** A number of so many bits, from the highest on; `last` is the one before. */
export function member(count: i32, last: i32): i32 {
  let node = 1;
  for (let i = 0; i < count; i++) node = (node << 1) | bit(MEMBER, node, node, (node << 3) | (last & 7));
  return node - (1 << count);
}

/** An integer: whether it is longer or shorter than the bits expected, its sign, its other digits. */
export function signed(slot: i32, expected: i32, general: i32, medium: i32, special: i32): i32 {
  let length = expected;
  if (bit(slot + 2, general, medium, special)) {
    length++;
    while (bit(slot + 3 + min(length - expected - 1, 15), general, medium, special)) {
      demand(++length <= MOST_BITS, NUMBER_BITS);
    }
  } else while (length > 0 && bit(slot + 20 + expected - length, general, medium, special)) length--;
  if (!length) return 0;
  const negative = bit(slot, 0, medium, special);
  let size = 1;
  if (length > 1) {
    const relative = min(max(length - expected + 4, 0), 8);
    size = 2 | bit(slot + 1, relative, (relative << 5) | length, relative);
    size = (size << (length - 2)) | bits(length - 2);
  }
  return negative ? -size : size;
}

/** An integer from 0 to `top`, near one expected; `longer` is then how much longer than `length` its rest is. */
export function coordinate(expected: f64, top: i32, slot: i32, length: i32, general: i32, medium: i32, special: i32): i32 {
  const rest = signed(slot, length, general, medium, special);
  const value = <i32>min(max(expected, 0), <f64>top) + rest;
  demand(value >= 0 && value <= top, COORDINATE, top, value);
  longer = min(max(32 - clz(abs(rest)) - length + 4, 1), 10);
  return value;
}

/** Refuses bytes after the end that are not 0. */
export function finish(): void {
  for (; at < length; at++) demand(!data[at], END, 0, length - at);
}
