/**
 * A page in headless Chromium: node browser.mjs CHROMIUM ADDRESS REQUESTS.json FOLDER.
 *
 * Waits for the viewer, writes each picture that is asked for into the folder as raw RGBA, and
 * prints JSON of what the page said and how long it took.
 */
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { launched } from "./chromium.mjs";

const [executablePath, address, requests, folder] = process.argv.slice(2);
const browser = await launched(executablePath);
const said = [];
try {
  const page = await browser.newPage({ viewport: { width: 640, height: 480 } });
  page.on("console", (message) => said.push(message.text()));
  page.on("pageerror", (error) => said.push(String(error)));
  page.on("request", (request) => {
    const url = request.url();
    if (url !== address && !url.startsWith("blob:") && !url.startsWith("data:")) said.push(`request: ${url}`);
  });
  const started = performance.now();
  await page.goto(address);
  await page.waitForFunction("globalThis.nispReady", null, { timeout: 300000 });
  await page.evaluate("nispReady");
  const ready = performance.now() - started;
  const pictures = [];
  for (const wanted of JSON.parse(readFileSync(requests, "utf8"))) {
    const began = performance.now();
    const { pixels, facts } = await page.evaluate((each) => {
      const raw = globalThis.nispViewer.picture(each);
      let text = "";
      for (let i = 0; i < raw.length; i += 8192) text += String.fromCharCode(...raw.subarray(i, i + 8192));
      return { pixels: btoa(text), facts: document.getElementById("mesh").textContent };
    }, wanted);
    writeFileSync(join(folder, `${wanted.name}.rgba`), Buffer.from(pixels, "base64"));
    pictures.push({ name: wanted.name, seconds: (performance.now() - began) / 1000, facts });
  }
  if (process.argv[6]) await page.screenshot({ path: process.argv[6] });
  const message = await page.locator("#message").textContent();
  console.log(JSON.stringify({ ready, pictures, said, message }));
} finally {
  await browser.close();
}
