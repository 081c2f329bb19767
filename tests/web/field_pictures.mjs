/**
 * The examples of a field under WebGLRenderer and WebGPURenderer, in headless Chromium:
 * node field_pictures.mjs CHROMIUM ADDRESS MODEL..., where ADDRESS serves the folder web/ and MODEL is a
 * file's path below it. Prints JSON: `adapter`, null where Chromium has none for WebGPU, what pages `said`,
 * and for each model and example the pictures of two cameras, with the floor through the field's
 * middle, and one of the field alone.
 */
import { WEBGPU, launched } from "./chromium.mjs";

const [executable, address, ...models] = process.argv.slice(2);
const browser = await launched(executable, WEBGPU);
const found = { adapter: null, said: [], models: {} };

/** Pictures of what an example shows, without antialiasing, which the two renderers do in different spaces. */
async function pictures() {
  const { scene, camera, renderer, object } = globalThis.shown;
  const plain = new renderer.constructor({ antialias: false });
  plain.setSize(innerWidth, innerHeight);
  await plain.init?.();
  scene.children.find((each) => each.isMesh && each !== object).position.y = object.position.y;
  const canvas = new OffscreenCanvas(innerWidth, innerHeight).getContext("2d", { willReadFrequently: true });
  const taken = (from) => {
    plain.render(scene, from);
    canvas.fillRect(0, 0, innerWidth, innerHeight);
    canvas.drawImage(plain.domElement, 0, 0);
    return [...canvas.getImageData(0, 0, innerWidth, innerHeight).data];
  };
  const { OrthographicCamera } = await import("three");
  const size = object.scale.x;
  const flat = new OrthographicCamera(-1.5 * size, 1.5 * size, 1.5 * size, -1.5 * size, size / 100, 100 * size);
  flat.position.copy(object.position).add({ x: -2 * size, y: 3 * size, z: 4 * size });
  flat.lookAt(object.position);
  const seen = { perspective: taken(camera), orthographic: taken(flat) };
  for (const each of scene.children) each.visible &&= each === object;
  return { ...seen, alone: taken(camera) };
}

try {
  for (const model of models) {
    found.models[model] = {};
    for (const name of ["field", "field_webgpu"]) {
      const page = await browser.newPage({ viewport: { width: 96, height: 96 } });
      page.on("pageerror", (error) => found.said.push(String(error)));
      page.on("console", (message) => {
        if (message.type() === "error" && !message.text().includes("404")) found.said.push(message.text());
      });
      await page.goto(`${address}/three/example_${name}.html?${model}`);
      found.adapter = await page.evaluate(async () => (await navigator.gpu?.requestAdapter())?.info.vendor ?? null);
      if (found.adapter === null) break;
      await page.waitForFunction("globalThis.shown", null, { timeout: 300000 });
      found.models[model][name] = await page.evaluate(pictures);
      await page.close();
    }
  }
  console.log(JSON.stringify(found));
} finally {
  await browser.close();
}
