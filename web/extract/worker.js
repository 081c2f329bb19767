import { parseNISP } from "../decoder/document.js";
import { NISPModel } from "../evaluate/model.js";
import { extractMesh } from "./mesh.js";

/**
 * Answers of a worker: messages of {id, file, resolution} with {id, mesh} or {id, error}. A file is
 * sent once: without one the last is meant.
 * @param {{onmessage: unknown, postMessage: (message: unknown, transfer: Transferable[]) => void}} scope the worker's global scope
 */
export function serveExtraction(scope) {
  /** @type {NISPModel|null} */
  let model = null;
  scope.onmessage = (/** @type {MessageEvent} */ { data: { id, file, resolution } }) => {
    try {
      if (file) model = new NISPModel(parseNISP(file));
      if (!model) throw new Error("file: expected one before, found none");
      const mesh = extractMesh(model, resolution);
      const arrays = [mesh.positions, mesh.normals, mesh.uvs, mesh.charts, mesh.indices];
      scope.postMessage({ id, mesh }, arrays.map((array) => /** @type {ArrayBuffer} */ (array.buffer)));
    } catch (why) {
      scope.postMessage({ id, error: String(/** @type {Error} */ (why).message ?? why) }, []);
    }
  };
}
