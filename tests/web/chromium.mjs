import { createRequire } from "node:module";

const { chromium } = createRequire(new URL("../../web/package.json", import.meta.url))("playwright-core");

/** What WebGPU takes besides: Vulkan in software, for canvases too. */
export const WEBGPU = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader"];

/** Chromium without a graphics processor. @param {string} executablePath @param {string[]} [more] arguments */
export function launched(executablePath, more = []) {
  const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", ...more];
  return chromium.launch({ executablePath, args });
}
