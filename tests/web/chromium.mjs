import { createRequire } from "node:module";

const { chromium } = createRequire(new URL("../../web/package.json", import.meta.url))("playwright-core");

/** What WebGPU takes besides: Vulkan in software, for canvases too. */
export const WEBGPU = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader"];

/** Chromium without a graphics processor. @param {string} executablePath @param {string[]} [more] arguments */
export function launched(executablePath, more = []) {
  const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", ...more];
  return chromium.launch({ executablePath, args });
}

/**
 * The page of an example at `url` that shows a model, `side` pixels wide and high; errors that it tells
 * are added to `said`.
 */
export async function exampleOf(browser, url, side, said) {
  const page = await browser.newPage({ viewport: { width: side, height: side } });
  page.on("pageerror", (error) => said.push(String(error)));
  page.on("console", (message) => {
    if (message.type() === "error" && !message.text().includes("404")) said.push(message.text());
  });
  await page.goto(url);
  await page.waitForFunction("globalThis.shown", null, { timeout: 300000 });
  return page;
}
