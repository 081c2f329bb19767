import { serveExtraction } from "../extract/worker.js";

serveExtraction(/** @type {any} */ (globalThis));
