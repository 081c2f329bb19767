import { plainKernel } from "./kernel_plain.js";
import { KERNEL_WASM } from "./kernel_wasm.js";

const PAGE = 65536;

/** Memory that kernels compute in, and the kernel: WebAssembly with SIMD where that is allowed. */
export class Arithmetic {
  /** @param {"wasm"|"plain"} [wanted] by default whatever runs fastest here */
  constructor(wanted) {
    this.end = 64;
    this.all = new Float32Array(0);
    const wasm = wanted === "plain" ? null : wasmKernel();
    if (wanted === "wasm" && !wasm) throw new Error("WebAssembly with SIMD: not available here");
    this.memory = wasm?.memory ?? null;
    this.kernel = wasm?.kernel ?? plainKernel(() => this.all);
    this.reserve(0);
  }

  get name() {
    return this.memory ? "wasm" : "plain";
  }

  /**
   * Address of a new region of so many floats, for vectors of 16 bytes.
   * @param {number} count
   */
  reserve(count) {
    const start = this.end;
    this.end += 4 * Math.ceil(count / 4) * 4;
    if (this.end > this.all.byteLength) this.#grow();
    return start;
  }

  #grow() {
    if (this.memory) {
      const missing = this.end - this.memory.buffer.byteLength;
      if (missing > 0) this.memory.grow(Math.ceil(missing / PAGE));
      this.all = new Float32Array(this.memory.buffer);
      return;
    }
    const larger = new Float32Array(Math.max(PAGE, this.end / 2));
    larger.set(this.all);
    this.all = larger;
  }
}

/** @returns {{memory: WebAssembly.Memory, kernel: import("./kernel_plain.js").Kernel}|null} */
function wasmKernel() {
  try {
    const bytes = Uint8Array.from(atob(KERNEL_WASM), (letter) => letter.charCodeAt(0));
    const memory = new WebAssembly.Memory({ initial: 1 });
    const instance = new WebAssembly.Instance(new WebAssembly.Module(bytes), { nisp: { memory } });
    return { memory, kernel: /** @type {any} */ (instance.exports) };
  } catch {
    // A security policy without wasm-unsafe-eval, or a browser without SIMD.
    return null;
  }
}
