/** Lists in the module's memory, one after the other: those from some place on are given back together. */

/** Where lists end. */
let end: usize = __heap_base;
/** Where nothing was ever: zeros. */
let fresh: usize = __heap_base;

/** Where lists end, for `release`. */
export function mark(): usize {
  return end;
}

/** Gives back all lists from a mark on. */
export function release(place: usize): void {
  end = place;
}

/** The address of so many new bytes, all 0. */
export function reserve(bytes: usize): usize {
  const start = end;
  end = (end + bytes + 7) & ~7;
  if (start < fresh) memory.fill(start, 0, min(end, fresh) - start);
  fresh = max(fresh, end);
  const missing = <i32>((end + 0xffff) >>> 16) - memory.size();
  // Rather twice as much as again and again.
  if (missing > 0 && memory.grow(max(missing, memory.size())) < 0) unreachable();
  return start;
}

/** Bytes, one after the other. */
@unmanaged
export class Bytes {
  @inline @operator("[]") get(at: i32): i32 {
    return load<u8>(changetype<usize>(this) + at);
  }
  @inline @operator("[]=") set(at: i32, value: i32): void {
    store<u8>(changetype<usize>(this) + at, value);
  }
}

/** Numbers of one kind, one after the other. */
@unmanaged
export class Items<T> {
  @inline @operator("[]") get(at: i32): T {
    return load<T>(changetype<usize>(this) + (<usize>at << alignof<T>()));
  }
  @inline @operator("[]=") set(at: i32, value: T): void {
    store<T>(changetype<usize>(this) + (<usize>at << alignof<T>()), value);
  }
}

/** Integers of 32 bits. */
export type Ints = Items<i32>;
/** Doubles. */
export type Floats = Items<f64>;

export function bytes(count: i32): Bytes {
  return changetype<Bytes>(reserve(count));
}

export function ints(count: i32): Ints {
  return changetype<Ints>(reserve(<usize>count << 2));
}

/** So many times the same. */
export function filled(count: i32, value: i32): Ints {
  const list = ints(count);
  for (let i = 0; i < count; i++) list[i] = value;
  return list;
}

export function floats(count: i32): Floats {
  return changetype<Floats>(reserve(<usize>count << 3));
}

/** The greatest of a list, and 0. */
export function greatest(list: Ints, count: i32): i32 {
  let most = 0;
  for (let i = 0; i < count; i++) most = max(most, list[i]);
  return most;
}
