import { BACK, BORDER, FAR, HAS_COPIES, IS_COPY, LEFT, NEW, PAIR, RIGHT, STEPS } from "./slots.js";

/** What a gate is: gone, open, or one over which there is no face. */
const GONE = 0;
const OPEN = 1;
const DEAD = 2;
const BUCKETS = 16;
/** The action that is no other: any gate's start is the third point. */
const SPLIT = 3;

/**
 * How faces hang together: a border of gates that grows over the surface, face by face (section 15.2
 * of the specification).
 */
export class Growth {
  /** @param {import("./bits.js").BitDecoder} bits @param {number} count of faces */
  constructor(bits, count) {
    this.bits = bits;
    this.corners = new Int32Array(3 * count);
    this.twin = new Int32Array(3 * count).fill(-1);
    this.end = 0;
    /** @type {number[]} */ this.degree = [];
    /** Gates of each point, by number. @type {number[][]} */ this.gatesAt = [];
    // A face makes three gates at most.
    const gates = 3 * count + 3;
    this.gates = 0;
    this.start = new Int32Array(gates);
    this.after = new Int32Array(gates);
    this.before = new Int32Array(gates);
    this.side = new Int32Array(gates);
    this.state = new Uint8Array(gates);
    /** @type {number[][]} */ this.buckets = Array.from({ length: BUCKETS }, () => []);
    this.history = 0;
    while (this.end < 3 * count) {
      const gate = this.best();
      if (gate < 0) this.begin();
      else this.grow(gate);
    }
  }

  point() {
    this.gatesAt.push([]);
    return this.degree.push(0) - 1;
  }

  /** @param {number} a @param {number} b @param {number} c points */
  face(a, b, c) {
    this.corners[this.end++] = a;
    this.corners[this.end++] = b;
    this.corners[this.end++] = c;
    for (const point of [a, b, c]) this.degree[point]++;
    return this.end - 3;
  }

  /** @param {number} start @param {number} side */
  gate(start, side) {
    const gate = this.gates++;
    this.start[gate] = start;
    this.side[gate] = side;
    this.state[gate] = OPEN;
    this.gatesAt[start].push(gate);
    return gate;
  }

  /** @param {number} gate @param {number} next */
  join(gate, next) {
    this.after[gate] = next;
    this.before[next] = gate;
  }

  /** @param {number} gate */
  remove(gate) {
    this.state[gate] = GONE;
    const gates = this.gatesAt[this.start[gate]];
    gates.splice(placeOf(gates, gate), 1);
  }

  /** Two sides are one edge. @param {number} side @param {number} other */
  meet(side, other) {
    this.twin[side] = other;
    this.twin[other] = side;
  }

  /** @param {number} gate @param {number} other */
  close(gate, other) {
    this.meet(this.side[gate], this.side[other]);
    this.remove(gate);
    this.remove(other);
  }

  /** @param {number} gate */
  touch(gate) {
    if (this.state[gate] !== OPEN) return;
    const most = Math.max(this.degree[this.start[gate]], this.degree[this.start[this.after[gate]]]);
    this.buckets[Math.min(most, BUCKETS - 1)].push(gate);
  }

  /** The open gate at the points with most faces, -1 without one. */
  best() {
    for (let i = BUCKETS - 1; i >= 0; i--) {
      for (let gate; (gate = this.buckets[i].pop()) !== undefined; ) if (this.state[gate] === OPEN) return gate;
    }
    return -1;
  }

  /** The first face of a component. */
  begin() {
    const [x, y, z] = [this.point(), this.point(), this.point()];
    const side = this.face(x, y, z);
    const gates = [this.gate(y, side), this.gate(x, side + 2), this.gate(z, side + 1)];
    gates.forEach((gate, i) => this.join(gate, gates[(i + 1) % 3]));
    for (const gate of gates) this.touch(gate);
  }

  /** The face over a gate, or none. @param {number} gate */
  grow(gate) {
    const { after, before, start, state } = this;
    const action = this.action(gate);
    if (action === BORDER) {
      state[gate] = DEAD;
      return;
    }
    this.history = ((this.history << 2) | action) & 255;
    const third = action === NEW ? -1 : this.third(gate, action);
    const [next, previous, u, w] = [after[gate], before[gate], start[gate], start[after[gate]]];
    const t = third < 0 ? this.point() : start[third];
    this.bits.demand(t !== u && t !== w, "third_point", "another than the gate's", t);
    const side = this.face(u, w, t);
    this.meet(side, this.side[gate]);
    this.remove(gate);
    const [left, right] = [this.gate(u, side + 2), this.gate(t, side + 1)];
    this.join(third < 0 ? left : before[third], right);
    if (third >= 0) this.join(left, third);
    this.join(previous, left);
    this.join(right, next);
    for (const each of [previous, left, right, next]) this.touch(each);
    if (action === RIGHT) this.zip(right, left);
    if (action === LEFT) this.zip(left, right);
  }

  /** Closes a gate with the next; and another with its next where both are a loop. @param {number} closed @param {number} other */
  zip(closed, other) {
    const { after, state } = this;
    this.close(closed, after[closed]);
    const last = after[other];
    if (after[last] === other && state[last] === OPEN && this.bits.bit(PAIR)) this.close(other, last);
  }

  /** @param {number} gate */
  action(gate) {
    const { bits, degree, start, after, before, state } = this;
    const [next, previous] = [after[gate], before[gate]];
    const [u, w] = [Math.min(degree[start[gate]], 10), Math.min(degree[start[next]], 10)];
    const open = (state[next] === OPEN ? 2 : 0) + (state[previous] === OPEN ? 1 : 0);
    const far = Math.min(degree[start[previous]], 9) * 10 + Math.min(degree[start[after[next]]], 9);
    const special = (Math.min(u + w, 16) * 100 + far) * 4 + open;
    if (bits.bit(NEW, u * 11 + w, this.history, special)) return NEW;
    if (open & 2 && bits.bit(RIGHT, u * 11 + w, this.history, special)) return RIGHT;
    if (open & 1 && bits.bit(LEFT, u * 11 + w, this.history, special)) return LEFT;
    return bits.bit(BORDER, open, this.history, special) ? BORDER : SPLIT;
  }

  /** The gate that begins at the third point. @param {number} gate @param {number} action */
  third(gate, action) {
    const { bits, after, before } = this;
    if (action === RIGHT) return after[after[gate]];
    if (action === LEFT) return before[gate];
    if (bits.bit(FAR)) {
      const gates = this.gatesAt[bits.below(this.degree.length, "point")];
      bits.demand(gates.length, "gate", "one at the point", "none");
      return gates[bits.below(gates.length, "gate")];
    }
    const links = bits.bit(BACK) ? before : after;
    const steps = bits.signed(STEPS, 0, 0, 0, 0);
    bits.demand(steps > 0 && steps <= 255, "steps", "1 to 255", steps);
    for (let i = 0; i < steps; i++) gate = links[gate];
    return gate;
  }
}

/** Where a number is in a list in order. @param {number[]} list @param {number} number */
function placeOf(list, number) {
  let [low, high] = [0, list.length - 1];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < number) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The vertex of each point. @param {import("./bits.js").BitDecoder} bits @param {number} points */
export function readVertices(bits, points) {
  const found = new Int32Array(points).map((_, i) => i);
  if (!bits.bit(HAS_COPIES)) return found;
  let [count, copy] = [0, 0];
  for (let point = 0; point < points; point++) {
    copy = bits.bit(IS_COPY, copy, copy, copy);
    bits.demand(count || !copy, "copy", "a vertex before it", "none");
    found[point] = copy ? bits.below(count, "copy") : count++;
  }
  return found;
}
