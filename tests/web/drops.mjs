/**
 * Files dropped on a page of the viewer: node drops.mjs CHROMIUM ADDRESS SOUND.nisp OTHER.nisp.
 *
 * Prints JSON of what the page says and shows, and of what it holds on the graphics processor.
 */
import { readFileSync } from "node:fs";
import { launched } from "./chromium.mjs";

const [executablePath, address, sound, other] = process.argv.slice(2);

/** Counts what is created and not deleted, in `held`. */
function countHeld() {
  globalThis.held = {};
  const methods = WebGL2RenderingContext.prototype;
  for (const kind of ["Texture", "Buffer", "Framebuffer", "VertexArray"]) {
    globalThis.held[kind] = 0;
    for (const [verb, change] of [["create", 1], ["delete", -1]]) {
      const original = methods[verb + kind];
      methods[verb + kind] = function (...objects) {
        globalThis.held[kind] += change;
        return original.apply(this, objects);
      };
    }
  }
}

const browser = await launched(executablePath);
try {
  const page = await browser.newPage({ viewport: { width: 120, height: 240 } });
  await page.addInitScript(countHeld);
  await page.goto(address);
  await page.waitForFunction("globalThis.nispReady", null, { timeout: 300000 });
  await page.evaluate("nispReady");
  const files = [sound, other].map((path) => readFileSync(path).toString("base64"));
  const dropped = (...texts) =>
    page.evaluate(async (each) => {
      const file = (text, i) => new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], `${i}.nisp`);
      await Promise.allSettled(each.map((text, i) => globalThis.nispViewer.drop(file(text, i))));
      globalThis.nispViewer.picture({ size: 8, azimuth: 30, elevation: 20, field: false, channel: "color" });
      const text = (id) => document.getElementById(id).textContent;
      return { title: document.title, message: text("message"), mesh: text("mesh").split("vertices")[0], held: { ...globalThis.held } };
    }, texts);
  const found = { bad: await dropped(btoa("no such file")), first: await dropped(files[0]) };
  for (let i = 0; i < 3; i++) await dropped(files[1]);
  found.again = await dropped(files[0]);
  found.alone = await dropped(files[1]);
  found.both = await dropped(files[0], files[1]);
  found.workers = page.workers().length;
  await page.focus("#channel");
  await page.keyboard.press("ArrowDown");
  found.camera = await page.evaluate("nispViewer.camera.elevation");
  const turned = () => page.evaluate("[nispViewer.camera.azimuth, nispViewer.camera.lampAzimuth]");
  const drag = async () => {
    const { x, y, width, height } = await page.locator("#panes").boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 20, y + height / 2);
    await page.mouse.up();
  };
  await page.setViewportSize({ width: 400, height: 400 });
  found.turned = [await turned()];
  await page.keyboard.down("Shift");
  await drag();
  await page.keyboard.up("Shift");
  found.turned.push(await turned());
  await drag();
  found.turned.push(await turned());
  await page.evaluate(() => globalThis.nispViewer.pane.dispose());
  await page.waitForFunction("document.getElementById('message').textContent");
  found.lost = await page.textContent("#message");
  console.log(JSON.stringify(found));
} finally {
  await browser.close();
}
