/**
 * Reads our own WebAssembly module for the interpreter: functions become one list of numbers, without
 * blocks, whose branches know where they go. It trusts the module, and knows what that one has: where
 * it branches, no value is left over.
 */

/** Instructions of WebAssembly that are not only followed by nothing. */
const BLOCK = 0x02;
const LOOP = 0x03;
const IF = 0x04;
const ELSE = 0x05;
const END = 0x0b;
const BRANCH = 0x0c;
const BRANCH_IF = 0x0d;
const CALL = 0x10;
const LOCAL = 0x20;
const LAST_GLOBAL = 0x24;
const LOAD = 0x28;
const LAST_STORE = 0x3e;
const SIZE = 0x3f;
const GROW = 0x40;
const INTEGER = 0x41;
const DOUBLE = 0x44;
const ADD = 0x6a;
const SHIFT = 0x74;
const BULK = 0xfc;
const COPY = 0x0a;

/** What else is in the program: a branch unless a value is other than 0, an end, an integer loaded from a list. */
const BRANCH_UNLESS = IF;
const RETURN = 0x0f;
const LOAD_FROM = 0x01;

/**
 * @typedef {{parameters: number, results: number}} Type of a function: how many it takes and leaves
 * @typedef {{locals: number, start: number}} Code where a function starts, and its variables beside the parameters
 * @typedef {{start: number, jumps: number[]}} Block where branches to it go: a loop's start, or places that wait for its end
 */

/** What there is of a module. */
export class Program {
  /** @param {Uint8Array} module */
  constructor(module) {
    this.module = module;
    this.view = new DataView(module.buffer, module.byteOffset);
    this.at = 8;
    /** @type {Type[]} */ this.types = [];
    /** Names of those imported. @type {string[]} */ this.imports = [];
    /** Those imported, then the module's own. @type {Type[]} */ this.functions = [];
    /** Of the module's own. @type {Code[]} */ this.codes = [];
    /** @type {number[]} */ this.list = [];
    /** @type {number[]} */ this.doubles = [];
    /** @type {number[]} */ this.globals = [];
    /** Numbers of functions by name. @type {Record<string, number>} */ this.exports = {};
    /** @type {{at: number, bytes: Uint8Array}[]} */ this.data = [];
    this.pages = 0;
    this.start = 0;
    /** Where a branch may go, last. */
    this.entry = 0;
    while (this.at < module.length) {
      const kind = this.#byte();
      const length = this.#number();
      /** @type {number} */
      const end = this.at + length;
      this.#section(kind);
      this.at = end;
    }
  }

  #byte() {
    return this.module[this.at++];
  }

  /** A LEB128 integer of 32 bits. @param {number} [sign] the bit of the last byte that says so where it may be negative */
  #number(sign = 0) {
    let [value, shift, byte] = [0, 0, 128];
    for (; byte & 128; shift += 7) {
      byte = this.#byte();
      value |= (byte & 127) << shift;
    }
    return byte & sign && shift < 32 ? value | (-1 << shift) : value;
  }

  #signed() {
    return this.#number(64);
  }

  /** What stands behind its length. @template T @param {() => T} read @returns {T[]} */
  #several(read) {
    return Array.from({ length: this.#number() }, read);
  }

  #bytes() {
    const length = this.#number();
    this.at += length;
    return this.module.subarray(this.at - length, this.at);
  }

  #text() {
    return String.fromCharCode(...this.#bytes());
  }

  /** An integer between its instruction and an end. */
  #constant() {
    this.at++;
    const value = this.#signed();
    this.at++;
    return value;
  }

  /** @param {number} kind */
  #section(kind) {
    switch (kind) {
      case 1:
        this.types = this.#several(() => {
          this.at++;
          return { parameters: this.#bytes().length, results: this.#bytes().length };
        });
        break;
      case 2:
        this.functions = this.#several(() => {
          this.#bytes();
          this.imports.push(this.#text());
          this.at++;
          return this.types[this.#number()];
        });
        break;
      case 3:
        this.functions.push(...this.#several(() => this.types[this.#number()]));
        break;
      case 5:
        this.at += 2;
        this.pages = this.#number();
        break;
      case 6:
        this.globals = this.#several(() => {
          this.at += 2;
          return this.#constant();
        });
        break;
      case 7:
        this.#several(() => {
          const name = this.#text();
          this.at++;
          this.exports[name] = this.#number();
        });
        break;
      case 8:
        this.start = this.#number();
        break;
      case 10:
        this.#several(() => this.#code());
        break;
      case 11:
        this.data = this.#several(() => {
          this.at++;
          return { at: this.#constant(), bytes: this.#bytes() };
        });
    }
  }

  /** A function's own. */
  #code() {
    this.#number();
    let locals = 0;
    this.#several(() => {
      locals += this.#number();
      this.at++;
    });
    this.codes.push({ locals, start: this.list.length });
    this.#block(BLOCK, []);
    this.list.push(RETURN);
  }

  /** Instructions up to the end of a block. @param {number} kind @param {Block[]} around */
  #block(kind, around) {
    const { list } = this;
    let otherwise = kind === IF ? list.push(BRANCH_UNLESS, 0) - 1 : -1;
    /** @type {Block} */
    const block = { start: kind === LOOP ? list.length : -1, jumps: [] };
    this.entry = list.length;
    for (let instruction = this.#byte(); instruction !== END; instruction = this.#byte()) {
      if (instruction !== ELSE) this.#instruction(instruction, [block, ...around]);
      else {
        this.#branch(BRANCH, block);
        list[otherwise] = this.entry = list.length;
        otherwise = -1;
      }
    }
    if (otherwise >= 0) block.jumps.push(otherwise);
    for (const jump of block.jumps) list[jump] = list.length;
    this.entry = list.length;
  }

  /** @param {number} kind @param {Block} block */
  #branch(kind, { start, jumps }) {
    const place = this.list.push(kind, start) - 1;
    if (start < 0) jumps.push(place);
  }

  /** Whether an address is another and a number shifted by a constant, as those in lists are. */
  #isScaled() {
    const { list, entry } = this;
    const first = list.length - 4;
    return first >= entry && list[first] === INTEGER && list[first + 2] === SHIFT && list[first + 3] === ADD;
  }

  /** @param {number} instruction @param {Block[]} blocks around it, to the function's */
  #instruction(instruction, blocks) {
    const { list } = this;
    const isMemory = instruction >= LOAD && instruction <= LAST_STORE;
    switch (instruction) {
      case BLOCK:
      case LOOP:
      case IF:
        this.at++;
        return this.#block(instruction, blocks);
      case BRANCH:
      case BRANCH_IF:
        return this.#branch(instruction, blocks[this.#number()]);
      case BULK:
        instruction = this.#number();
        this.at += instruction === COPY ? 2 : 1;
    }
    if (instruction === LOAD && this.#isScaled()) list.splice(-4, 4, LOAD_FROM, list[list.length - 3]);
    else list.push(instruction);
    // How loads and stores are aligned, and which memory grows.
    if (isMemory || instruction === SIZE || instruction === GROW) this.at++;
    if (isMemory || instruction === CALL || (instruction >= LOCAL && instruction <= LAST_GLOBAL)) list.push(this.#number());
    if (instruction === INTEGER) list.push(this.#signed());
    if (instruction === DOUBLE) {
      list.push(this.doubles.push(this.view.getFloat64(this.at, true)) - 1);
      this.at += 8;
    }
  }
}
