/**
 * A self-contained page in headless Chromium, without a graphics processor:
 *
 *     node web_pages.mjs CHROMIUM PAGE.html RUNS SIZE
 *
 * JSON on standard output: seconds from the start of navigation to the first picture, run by run; and
 * where the page's file has a field, how often rays of a picture of SIZE^2 pixels ask the network.
 */
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { launched } from "../../tests/web/chromium.mjs";

const [executablePath, file, runs, size] = process.argv.slice(2);
const address = pathToFileURL(resolve(file)).href;

/** In the page: seconds until its first picture is drawn. */
async function firstPicture() {
  await globalThis.nispReady;
  const { renderer } = globalThis.nispViewer.pane;
  while (!renderer.mesh || !renderer.samples) await new Promise(requestAnimationFrame);
  renderer.finish();
  return performance.now() / 1000;
}

/** In the page: calls of the SDF network a ray, with the grid of free space and without; null without a field. */
function callsOfRays(across) {
  const { renderer, camera } = globalThis.nispViewer.pane;
  const { gl, field } = renderer;
  if (!field) return null;
  const mean = () => {
    renderer.restart();
    renderer.traceField(camera, across, across, [0, 0], across);
    gl.readBuffer(gl.COLOR_ATTACHMENT1);
    const normals = new Float32Array(4 * across * across);
    gl.readPixels(0, 0, across, across, gl.RGBA, gl.FLOAT, normals);
    return normals.reduce((sum, value, i) => sum + (i % 4 === 3 ? value : 0), 0) / across ** 2;
  };
  const grid = mean();
  const side = field.occupancy.size;
  gl.bindTexture(gl.TEXTURE_3D, field.grid);
  // Nowhere free: a sphere tracer as it is.
  gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, side, side, side, gl.RED_INTEGER, gl.UNSIGNED_BYTE, new Uint8Array(side ** 3));
  return { grid, plain: mean() };
}

const browser = await launched(executablePath);
try {
  const seconds = [];
  let calls = null;
  for (let i = 0; i < Number(runs); i++) {
    const page = await browser.newPage({ viewport: { width: 800, height: 600 } });
    await page.goto(address);
    await page.waitForFunction("globalThis.nispReady", null, { timeout: 300000 });
    seconds.push(await page.evaluate(firstPicture));
    if (i === 0 && Number(size)) calls = await page.evaluate(callsOfRays, Number(size));
    await page.close();
  }
  console.log(JSON.stringify({ seconds, calls }));
} finally {
  await browser.close();
}
