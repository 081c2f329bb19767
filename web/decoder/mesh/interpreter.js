/**
 * Runs our own WebAssembly module where a security policy lets no WebAssembly run: without `eval`, to
 * the same answers, slower.
 */
import { Program } from "./program.js";

const PAGE = 65536;
const STACK = 1 << 14;

/** An instance, as WebAssembly makes one: `exports`, with `memory`. */
export class Interpreter {
  /** @param {Uint8Array} module @param {Record<string, (...values: number[]) => void>} imports without results */
  constructor(module, imports) {
    const program = new Program(module);
    this.program = program;
    this.list = Int32Array.from(program.list);
    this.imports = imports;
    this.stack = new Float64Array(STACK);
    this.float = new DataView(new ArrayBuffer(4));
    this.view = new DataView(new ArrayBuffer(PAGE * program.pages));
    for (const { at, bytes } of program.data) new Uint8Array(this.view.buffer).set(bytes, at);
    /** @type {Record<string, any>} */
    this.exports = { memory: this };
    for (const [name, number] of Object.entries(program.exports)) {
      this.exports[name] ??= (/** @type {number[]} */ ...values) => {
        this.stack.set(values);
        this.#call(number, values.length);
        return this.stack[0];
      };
    }
    this.#call(program.start, 0);
  }

  get buffer() {
    return this.view.buffer;
  }

  /** As many pages more; how many there were. @param {number} pages */
  grow(pages) {
    const { byteLength } = this.buffer;
    const larger = new Uint8Array(byteLength + PAGE * pages);
    larger.set(new Uint8Array(this.buffer));
    this.view = new DataView(larger.buffer);
    return byteLength / PAGE;
  }

  /**
   * A function, whose parameters are on the stack and its results then in their place.
   * @param {number} number @param {number} top of the stack
   * @returns {number} the top then
   */
  #call(number, top) {
    const { program, stack } = this;
    const { parameters, results } = program.functions[number];
    const base = top - parameters;
    const imported = program.imports[number];
    if (imported) this.imports[imported](...stack.subarray(base, top));
    else {
      const { locals, start } = program.codes[number - program.imports.length];
      stack.fill(0, top, top + locals);
      const end = this.#run(start, base, top + locals);
      stack.copyWithin(base, end - results, end);
    }
    return base + results;
  }

  /**
   * Instructions up to the end of a function.
   * @param {number} at in the program @param {number} base where variables begin on the stack @param {number} top
   * @returns {number} the top at the end
   */
  #run(at, base, top) {
    const { list, stack, float } = this;
    const { doubles, globals } = this.program;
    let { view } = this;
    for (;;) {
      switch (list[at++]) {
        case 0x00:
          throw new RangeError("unreachable");
        case 0x04:
          at = stack[--top] ? at + 1 : list[at];
          break;
        case 0x0d:
          at = stack[--top] ? list[at] : at + 1;
          break;
        case 0x0c:
          at = list[at];
          break;
        case 0x0f:
          return top;
        case 0x10:
          top = this.#call(list[at++], top);
          view = this.view;
          break;
        case 0x1a:
          top--;
          break;
        case 0x1b:
          top -= 2;
          if (!stack[top + 1]) stack[top - 1] = stack[top];
          break;
        case 0x20:
          stack[top++] = stack[base + list[at++]];
          break;
        case 0x21:
          stack[base + list[at++]] = stack[--top];
          break;
        case 0x22:
          stack[base + list[at++]] = stack[top - 1];
          break;
        case 0x23:
          stack[top++] = globals[list[at++]];
          break;
        case 0x24:
          globals[list[at++]] = stack[--top];
          break;
        case 0x28:
          stack[top - 1] = view.getInt32((stack[top - 1] >>> 0) + list[at++], true);
          break;
        case 0x2b:
          stack[top - 1] = view.getFloat64((stack[top - 1] >>> 0) + list[at++], true);
          break;
        case 0x2d:
          stack[top - 1] = view.getUint8((stack[top - 1] >>> 0) + list[at++]);
          break;
        case 0x2f:
          stack[top - 1] = view.getUint16((stack[top - 1] >>> 0) + list[at++], true);
          break;
        case 0x36:
          top -= 2;
          view.setInt32((stack[top] >>> 0) + list[at++], stack[top + 1], true);
          break;
        case 0x39:
          top -= 2;
          view.setFloat64((stack[top] >>> 0) + list[at++], stack[top + 1], true);
          break;
        case 0x3a:
          top -= 2;
          view.setUint8((stack[top] >>> 0) + list[at++], stack[top + 1]);
          break;
        case 0x3f:
          stack[top++] = view.byteLength / PAGE;
          break;
        case 0x40:
          stack[top - 1] = this.grow(stack[top - 1]);
          view = this.view;
          break;
        case 0x01:
          top--;
          stack[top - 1] = view.getInt32(stack[top - 1] + (stack[top] << list[at]) + list[at + 1], true);
          at += 2;
          break;
        case 0x0a:
          top -= 3;
          new Uint8Array(view.buffer).copyWithin(stack[top], stack[top + 1], stack[top + 1] + stack[top + 2]);
          break;
        case 0x0b:
          top -= 3;
          new Uint8Array(view.buffer).fill(stack[top + 1], stack[top], stack[top] + stack[top + 2]);
          break;
        case 0x41:
          stack[top++] = list[at++];
          break;
        case 0x44:
          stack[top++] = doubles[list[at++]];
          break;
        case 0x45:
          stack[top - 1] = Number(!stack[top - 1]);
          break;
        case 0x46:
        case 0x61:
          stack[--top - 1] = Number(stack[top - 1] === stack[top]);
          break;
        case 0x47:
        case 0x62:
          stack[--top - 1] = Number(stack[top - 1] !== stack[top]);
          break;
        case 0x48:
        case 0x63:
          stack[--top - 1] = Number(stack[top - 1] < stack[top]);
          break;
        case 0x4a:
        case 0x64:
          stack[--top - 1] = Number(stack[top - 1] > stack[top]);
          break;
        case 0x4c:
        case 0x65:
          stack[--top - 1] = Number(stack[top - 1] <= stack[top]);
          break;
        case 0x4e:
        case 0x66:
          stack[--top - 1] = Number(stack[top - 1] >= stack[top]);
          break;
        case 0x49:
          stack[--top - 1] = Number(stack[top - 1] >>> 0 < stack[top] >>> 0);
          break;
        case 0x4b:
          stack[--top - 1] = Number(stack[top - 1] >>> 0 > stack[top] >>> 0);
          break;
        case 0x4d:
          stack[--top - 1] = Number(stack[top - 1] >>> 0 <= stack[top] >>> 0);
          break;
        case 0x67:
          stack[top - 1] = Math.clz32(stack[top - 1]);
          break;
        case 0x6a:
          stack[--top - 1] = (stack[top - 1] + stack[top]) | 0;
          break;
        case 0x6b:
          stack[--top - 1] = (stack[top - 1] - stack[top]) | 0;
          break;
        case 0x6c:
          stack[--top - 1] = Math.imul(stack[top - 1], stack[top]);
          break;
        case 0x6d:
          stack[--top - 1] = (stack[top - 1] / stack[top]) | 0;
          break;
        case 0x6f:
          stack[--top - 1] = stack[top - 1] % stack[top] | 0;
          break;
        case 0x71:
          stack[--top - 1] = stack[top - 1] & stack[top];
          break;
        case 0x72:
          stack[--top - 1] = stack[top - 1] | stack[top];
          break;
        case 0x73:
          stack[--top - 1] = stack[top - 1] ^ stack[top];
          break;
        case 0x74:
          stack[--top - 1] = stack[top - 1] << stack[top];
          break;
        case 0x75:
          stack[--top - 1] = stack[top - 1] >> stack[top];
          break;
        case 0x76:
          stack[--top - 1] = (stack[top - 1] >>> stack[top]) | 0;
          break;
        case 0x99:
          stack[top - 1] = Math.abs(stack[top - 1]);
          break;
        case 0x9a:
          stack[top - 1] = -stack[top - 1];
          break;
        case 0x9c:
          stack[top - 1] = Math.floor(stack[top - 1]);
          break;
        case 0x9f:
          stack[top - 1] = Math.sqrt(stack[top - 1]);
          break;
        case 0xa0:
          stack[--top - 1] = stack[top - 1] + stack[top];
          break;
        case 0xa1:
          stack[--top - 1] = stack[top - 1] - stack[top];
          break;
        case 0xa2:
          stack[--top - 1] = stack[top - 1] * stack[top];
          break;
        case 0xa3:
          stack[--top - 1] = stack[top - 1] / stack[top];
          break;
        case 0xa4:
          stack[--top - 1] = Math.min(stack[top - 1], stack[top]);
          break;
        case 0xa5:
          stack[--top - 1] = Math.max(stack[top - 1], stack[top]);
          break;
        case 0xaa:
        case 0xab:
          stack[top - 1] = stack[top - 1] | 0;
          break;
        case 0xb8:
          stack[top - 1] = stack[top - 1] >>> 0;
          break;
        case 0xbe:
          float.setInt32(0, stack[top - 1]);
          stack[top - 1] = float.getFloat32(0);
          break;
        case 0xb7:
        case 0xbb:
          break;
        default:
          throw new RangeError(`instruction ${list[at - 1]}`);
      }
    }
  }
}
