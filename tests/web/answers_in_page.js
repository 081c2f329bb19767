import { decodeImage, readPixels } from "../../web/evaluate/images.js";
import { answer, written } from "./answer.js";

/** Answers in a page: the browser decodes the images. */
async function answerAll(requests) {
  const answers = [];
  for (const { file, points, kernel } of requests) {
    const bytes = Uint8Array.from(atob(file), (letter) => letter.charCodeAt(0));
    const decode = async (images) => (await Promise.all(images.map(decodeImage))).map(readPixels);
    answers.push(await answer(bytes, points, kernel, decode));
  }
  return written(answers);
}

globalThis.answerAll = answerAll;
