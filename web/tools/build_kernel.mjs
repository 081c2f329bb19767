/** Builds evaluate/kernel.wat into evaluate/kernel_wasm.js: npm run kernel. With --check it only compares. */
import { readFileSync, writeFileSync } from "node:fs";
import wabt from "wabt";

const SOURCE = new URL("../evaluate/kernel.wat", import.meta.url);
const TARGET = new URL("../evaluate/kernel_wasm.js", import.meta.url);

const { parseWat } = await wabt();
const module = parseWat("kernel.wat", readFileSync(SOURCE, "utf8"), { simd: true });
module.validate();
const encoded = Buffer.from(module.toBinary({}).buffer).toString("base64");
const built = `/** kernel.wat, compiled: \`npm run kernel\` writes this file. */\nexport const KERNEL_WASM =\n  "${encoded}";\n`;
if (!process.argv.includes("--check")) writeFileSync(TARGET, built);
else if (readFileSync(TARGET, "utf8") !== built) {
  console.error("kernel_wasm.js: expected what kernel.wat compiles to, found another: npm run kernel");
  process.exit(1);
}
