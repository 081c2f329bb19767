/**
 * The examples for three.js in headless Chromium: node examples.mjs CHROMIUM ADDRESS MODEL [EXAMPLE...],
 * where ADDRESS serves the folder web/ and MODEL is the file's path below it; all examples by default. Prints JSON of what is seen.
 */
import { exampleOf, launched } from "./chromium.mjs";

const [executable, address, model, ...wanted] = process.argv.slice(2);
const browser = await launched(executable);
const found = { said: [] };
try {
  for (const name of wanted.length ? wanted : ["mesh", "field"]) {
    const page = await exampleOf(browser, `${address}/three/example_${name}.html?${model}`, 64, found.said);
    found[name] = await page.evaluate(() => {
      const { scene, camera, renderer, object } = globalThis.shown;
      renderer.render(scene, camera);
      const gl = renderer.getContext();
      const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
      const pixels = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      const meshes = [];
      object.traverse((each) => {
        if (!each.isMesh) return;
        each.geometry.computeBoundingBox();
        const box = each.geometry.boundingBox.clone().applyMatrix4(each.matrixWorld);
        meshes.push({ name: each.name, material: each.material.type, low: box.min.toArray(), high: box.max.toArray() });
      });
      return { width, height, pixels: [...pixels], meshes };
    });
    await page.close();
  }
  console.log(JSON.stringify(found));
} finally {
  await browser.close();
}
