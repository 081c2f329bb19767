/**
 * Answers of the JavaScript decoder in headless Chromium, under a strict security policy:
 * node answers_in_browser.mjs CHROMIUM PAGE.html REQUESTS.json; JSON on standard output.
 */
import { readFileSync } from "node:fs";
import { launched } from "./chromium.mjs";

const [executable, path, requests] = process.argv.slice(2);
const browser = await launched(executable);
try {
  const page = await browser.newPage();
  const asked = JSON.parse(readFileSync(requests, "utf8")).map((each) => ({
    ...each,
    file: readFileSync(each.path).toString("base64"),
  }));
  await page.goto(`file://${path}`);
  process.stdout.write(await page.evaluate((all) => globalThis.answerAll(all), asked));
} finally {
  await browser.close();
}
