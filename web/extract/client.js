/** Extracts meshes of one file in a worker of its own. */
export class ExtractionClient {
  /** @param {Worker} worker one that runs serveExtraction */
  constructor(worker) {
    this.worker = worker;
    this.next = 0;
    /** @type {Map<number, {resolve: (mesh: import("./mesh.js").MeshData) => void, reject: (why: Error) => void}>} */
    this.waiting = new Map();
    worker.onmessage = ({ data: { id, mesh, error } }) => {
      const call = this.waiting.get(id);
      this.waiting.delete(id);
      if (error) call?.reject(new Error(error));
      else call?.resolve(mesh);
    };
    worker.onerror = (event) => {
      for (const call of this.waiting.values()) call.reject(new Error(`worker: ${event.message}`));
      this.waiting.clear();
    };
  }

  /**
   * @param {Uint8Array|null} file null where it is that of the last call
   * @param {number} resolution
   * @returns {Promise<import("./mesh.js").MeshData>}
   */
  extract(file, resolution) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, file, resolution });
    });
  }

  dispose() {
    this.worker.terminate();
    for (const call of this.waiting.values()) call.reject(new Error("extraction: ended"));
    this.waiting.clear();
  }
}
