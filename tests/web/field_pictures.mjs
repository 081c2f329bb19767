/**
 * A field under WebGLRenderer and WebGPURenderer, in headless Chromium, by the example pages:
 * node field_pictures.mjs CHROMIUM ADDRESS MODEL..., where ADDRESS serves the folder web/ and MODEL is a
 * file's path below it. Prints JSON: what pages `said`, and for each model, as it is drawn by `webgl`,
 * `webgpu` (left out where Chromium has no adapter) and WebGPURenderer's `fallback`, pictures of two
 * cameras, with the floor through the field's middle, and one of the field alone.
 */
import { WEBGPU, exampleOf, launched } from "./chromium.mjs";

const [executable, address, ...models] = process.argv.slice(2);
const browser = await launched(executable, WEBGPU);
const found = { said: [], models: {} };

/** Pictures of what an example shows, without antialiasing, which the two renderers do in different spaces. */
async function pictures(forceWebGL) {
  const { scene, camera, renderer, object } = globalThis.shown;
  const plain = new renderer.constructor({ antialias: false, forceWebGL });
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
  for (const each of scene.children) each.visible = each === object;
  const alone = taken(camera);
  for (const each of scene.children) each.visible = true;
  return { ...seen, alone };
}

const shown = (name, model) => exampleOf(browser, `${address}/three/example_${name}.html?${model}`, 96, found.said);

try {
  for (const model of models) {
    const seen = (found.models[model] = {});
    const [old, page] = [await shown("field", model), await shown("field_webgpu", model)];
    seen.webgl = await old.evaluate(pictures);
    if (await page.evaluate(() => navigator.gpu?.requestAdapter())) seen.webgpu = await page.evaluate(pictures, false);
    seen.fallback = await page.evaluate(pictures, true);
    await Promise.all([old.close(), page.close()]);
  }
  console.log(JSON.stringify(found));
} finally {
  await browser.close();
}
