/** node unzstd.mjs FOLDER: decodes each NAME.zst and compares it with NAME; prints the names that differ. */
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { unzstd } from "../../web/decoder/zstd.js";

const folder = process.argv[2];
for (const name of readdirSync(folder).filter((each) => each.endsWith(".zst"))) {
  const wanted = readFileSync(join(folder, name.slice(0, -4)));
  const found = unzstd(new Uint8Array(readFileSync(join(folder, name))), wanted.length, name);
  if (Buffer.compare(Buffer.from(found), wanted)) console.log(name);
}
