/** Workers that fail: node loader.mjs prints JSON of what the client and the loader of three.js say. */
import { ExtractionClient } from "../../web/extract/client.js";
import { NISPLoader } from "../../web/three/NISPLoader.js";

const said = (promise) => promise.then(() => "done", (why) => why.message);
const worker = { terminated: 0, postMessage() {}, terminate() { this.terminated++; } };
const client = new ExtractionClient(worker);
const waiting = said(client.extract(new Uint8Array(1), 8));
// What browsers send where the script is not there, or not allowed.
worker.onerror({ type: "error" });
const found = { waiting: await waiting, later: await said(client.extract(null, 8)), terminated: worker.terminated };

const made = [];
globalThis.Worker = class {
  constructor() {
    made.push(this);
  }
  postMessage({ id }) {
    if (made.length === 1) this.onerror({ message: "out of memory" });
    else this.onmessage({ data: { id, mesh: "a mesh" } });
  }
  terminate() {}
};
const loader = new NISPLoader().setWorkerLimit(1);
found.first = await said(loader.client().extract(new Uint8Array(1), 8));
found.second = await loader.client().extract(new Uint8Array(1), 8);
found.workers = made.length;
loader.dispose();
try {
  loader.setWorkerLimit(0);
} catch (why) {
  found.limit = why.message;
}
console.log(JSON.stringify(found));
