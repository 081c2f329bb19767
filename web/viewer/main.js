import { serveExtraction } from "../extract/worker.js";
import { fromBase64 } from "./base64.js";
import { ViewerPage } from "./page.js";

/** The script of a self-contained page, which is that of its worker, too. */
function start() {
  const own = document.getElementById("script")?.textContent ?? "";
  const address = URL.createObjectURL(new Blob([own], { type: "text/javascript" }));
  const page = new ViewerPage(() => new Worker(address));
  const content = (/** @type {string} */ id) => document.getElementById(id)?.textContent ?? "";
  const open = async () => {
    await page.open(fromBase64(content("file")), document.title);
    const original = content("original-data");
    if (original) await page.showOriginal(JSON.parse(original));
  };
  Object.assign(globalThis, { nispViewer: page, nispReady: page.guarded(open) });
}

if (typeof document === "undefined") serveExtraction(/** @type {any} */ (globalThis));
else start();
