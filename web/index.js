/** The decoder for programs: parse a file, ask its networks, extract a mesh. See docs/web.md. */
export { parseNISP } from "./decoder/document.js";
export { NISPError } from "./decoder/errors.js";
export { Arithmetic } from "./evaluate/arithmetic.js";
export { gradient } from "./evaluate/gradient.js";
export { decodeImage, readPixels } from "./evaluate/images.js";
export { NISPModel } from "./evaluate/model.js";
export { extractMesh } from "./extract/mesh.js";
