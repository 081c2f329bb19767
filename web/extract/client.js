/** Extracts meshes of one file in a worker of its own. */
export class ExtractionClient {
  /** @param {Worker} worker one that runs serveExtraction */
  constructor(worker) {
    this.worker = worker;
    this.next = 0;
    /** Why nothing is answered any more; empty while the worker works. */
    this.ended = "";
    /** @type {Map<number, {resolve: (mesh: import("./mesh.js").MeshData) => void, reject: (why: Error) => void}>} */
    this.waiting = new Map();
    worker.onmessage = ({ data: { id, mesh, error } }) => {
      const call = this.waiting.get(id);
      this.waiting.delete(id);
      if (error) call?.reject(new Error(error));
      else call?.resolve(mesh);
    };
    // A script that a server or a security policy withholds has no message.
    worker.onerror = (event) => this.end(`worker: expected it to run, found ${event.message ?? "that it did not start"}`);
  }

  /**
   * @param {Uint8Array|null} file null where it is that of the last call
   * @param {number} resolution
   * @returns {Promise<import("./mesh.js").MeshData>}
   */
  extract(file, resolution) {
    if (this.ended) return Promise.reject(new Error(this.ended));
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, file, resolution });
    });
  }

  dispose() {
    this.end("extraction: ended");
  }

  /** @param {string} why */
  end(why) {
    this.ended = why;
    this.worker.terminate();
    for (const call of this.waiting.values()) call.reject(new Error(why));
    this.waiting.clear();
  }
}
