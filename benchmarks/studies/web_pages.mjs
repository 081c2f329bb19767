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

/** In the page: calls of the SDF network a ray, by the viewer and by a plain sphere tracer; null without a field. */
function callsOfRays(across) {
  const { renderer, camera } = globalThis.nispViewer.pane;
  const { gl, field } = renderer;
  if (!field) return null;
  return { viewer: byViewer(), plain: byPlainTracer() };

  function byViewer() {
    renderer.restart();
    renderer.traceField(camera, across, across, [0, 0], across);
    gl.readBuffer(gl.COLOR_ATTACHMENT1);
    const normals = new Float32Array(4 * across * across);
    gl.readPixels(0, 0, across, across, gl.RGBA, gl.FLOAT, normals);
    return normals.reduce((sum, value, i) => sum + (i % 4 === 3 ? value : 0), 0) / across ** 2;
  }

  /** From where a ray enters the ball, by the field over its steepest slope, to the surface or out of the ball. */
  function byPlainTracer() {
    const network = globalThis.nispViewer.model.field.sdfNetwork;
    const [eye, directions] = [camera.eye(), raysOf(camera)];
    let rays = directions.map((direction) => ({ direction, ...chord(eye, direction) })).filter(({ at, end }) => at < end);
    let calls = 0;
    for (let step = 0; step < 400 && rays.length; step++) {
      const points = Float32Array.from(rays.flatMap(({ direction, at }) => direction.map((part, axis) => eye[axis] + at * part)));
      const values = network.evaluate(points);
      calls += rays.length;
      rays.forEach((ray, i) => (ray.at += Math.max(values[i] / field.occupancy.slope, 5e-4)));
      rays = rays.filter(({ at, end }, i) => values[i] >= 1e-4 && at <= end);
    }
    return calls / across ** 2;
  }

  function raysOf(camera) {
    const [axes, [wide, high]] = [camera.axes(), camera.halfSize(across, across)];
    return Array.from({ length: across ** 2 }, (_, i) => {
      const [x, y] = [i % across, Math.floor(i / across)].map((place) => (2 * (place + 0.5)) / across - 1);
      const way = [0, 1, 2].map((row) => axes[row] * x * wide + axes[3 + row] * y * high - axes[6 + row]);
      return way.map((part) => part / Math.hypot(...way));
    });
  }

  function chord(eye, direction) {
    const along = -eye.reduce((sum, part, axis) => sum + part * direction[axis], 0);
    const half = Math.sqrt(Math.max(1.01 ** 2 - (Math.hypot(...eye) ** 2 - along ** 2), 0));
    return { at: along - half, end: along + half };
  }
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
