import { parseNISP } from "../decoder/document.js";
import { decodeImage } from "../evaluate/images.js";
import { NISPModel } from "../evaluate/model.js";
import { ExtractionClient } from "../extract/client.js";
import { Camera } from "./camera.js";
import { moveByKey, orbit } from "./controls.js";
import { readOriginal } from "./original.js";
import { Pane } from "./pane.js";
import { CHANNELS } from "./renderer.js";

/** Layers wider than this make shaders that take too long: such a file is seen as a mesh alone. */
const WIDEST_FIELD = 256;

/** Mesh parts that statistics list. */
const MOST_PARTS = 12;

/** The page that `nisp view` shows. */
export class ViewerPage {
  /** @param {() => Worker} makeWorker one that runs serveExtraction */
  constructor(makeWorker) {
    this.makeWorker = makeWorker;
    this.camera = new Camera();
    this.pane = new Pane(/** @type {HTMLCanvasElement} */ (element("model")), this.camera);
    /** @type {Pane|null} */
    this.other = null;
    /** @type {ExtractionClient|null} */
    this.client = null;
    /** @type {NISPModel|null} */
    this.model = null;
    this.turn = 0;
    this.opened = 0;
    this.listen();
  }

  get panes() {
    return this.other ? [this.pane, this.other] : [this.pane];
  }

  listen() {
    orbit(element("panes"), this.camera, () => this.panes.forEach((pane) => pane.changed()));
    document.addEventListener("keydown", (event) => this.press(event));
    element("field").addEventListener("change", () => this.choose());
    element("channel").addEventListener("change", () => this.choose());
    element("wireframe").addEventListener("change", () => this.choose());
    element("slice").addEventListener("input", () => this.choose());
    element("resolution").addEventListener("change", () => this.guarded(() => this.remesh(null)));
    element("open").addEventListener("change", (event) => {
      const chosen = /** @type {HTMLInputElement} */ (event.target);
      const [file] = chosen.files ?? [];
      if (file) this.drop(file);
      // Or the same file could not be chosen twice.
      chosen.value = "";
    });
    element("model").addEventListener("webglcontextlost", () => say("graphics: expected it to go on, found it taken away: reload the page"));
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      const file = event.dataTransfer?.files[0];
      if (file) this.drop(file);
    });
  }

  /** @param {KeyboardEvent} event */
  press(event) {
    const { target } = event;
    if (target instanceof HTMLSelectElement || (target instanceof HTMLInputElement && target.type === "range")) return;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const toggled = { f: "field", w: "wireframe" }[event.key];
    const channel = CHANNELS[Number(event.key) - 1];
    if (toggled && !input(toggled).disabled) input(toggled).checked = !input(toggled).checked;
    else if (channel) input("channel").value = channel;
    else if (!moveByKey(this.camera, event.key)) return;
    event.preventDefault();
    this.choose();
  }

  /** Shows what the controls say. */
  choose() {
    const look = { channel: input("channel").value, wireframe: input("wireframe").checked, slice: Number(input("slice").value) };
    element("slice-label").hidden = look.channel !== "distance";
    this.pane.show({ ...look, field: input("field").checked });
    this.other?.show(look);
  }

  /** @param {File} file */
  drop(file) {
    return this.guarded(async () => this.open(new Uint8Array(await file.arrayBuffer()), file.name), `${file.name}: `);
  }

  /** Runs it; says what went wrong. @param {() => Promise<void>} work @param {string} [where] */
  async guarded(work, where = "") {
    try {
      say("");
      await work();
    } catch (why) {
      say(where + String(/** @type {Error} */ (why).message ?? why));
      throw why;
    }
  }

  /** The last call wins; a file that is not sound changes nothing. @param {Uint8Array} file @param {string} name */
  async open(file, name) {
    const turn = ++this.opened;
    const started = performance.now();
    const parsed = parseNISP(file);
    const parseTime = performance.now() - started;
    const images = await decodeImages(parsed.images);
    if (turn !== this.opened) return;
    this.closeOriginal();
    this.model = new NISPModel(parsed);
    this.pane.renderer.setMaterials(parsed.metadata.materials, images);
    this.pane.renderer.setSlice(this.model);
    const widths = [...parsed.metadata.specs.values()].flatMap((spec) => spec.hidden);
    const traceable = widths.length > 0 && Math.max(...widths) <= WIDEST_FIELD;
    input("field").disabled = !traceable;
    input("resolution").disabled = !widths.length;
    if (!traceable) input("field").checked = false;
    document.title = element("name").textContent = name;
    showRows("bytes", byteRows(parsed, file.length));
    showRows("facts", factRows(parsed, parseTime));
    const meshed = this.remesh(file);
    // While the worker extracts.
    if (traceable) this.pane.renderer.setField(this.model);
    this.choose();
    await meshed;
  }

  /** Extracts anew; the last call wins. @param {Uint8Array|null} file a new one, or null */
  async remesh(file) {
    const turn = ++this.turn;
    if (file) {
      this.client?.dispose();
      this.client = new ExtractionClient(this.makeWorker());
    }
    const resolution = Number(input("resolution").value);
    element("cells").textContent = String(resolution);
    const started = performance.now();
    const mesh = await this.extracted(turn, file, resolution);
    if (!mesh || turn !== this.turn) return;
    showRows("mesh", meshRows(mesh, performance.now() - started));
    this.pane.renderer.setMesh(mesh);
    this.choose();
  }

  /** Nothing where another call came in between, which ends the worker. @param {number} turn @param {Uint8Array|null} file @param {number} resolution */
  async extracted(turn, file, resolution) {
    try {
      return await /** @type {ExtractionClient} */ (this.client).extract(file, resolution);
    } catch (why) {
      if (turn === this.turn) throw why;
      return null;
    }
  }

  /** The mesh that the file was made from, beside it. @param {unknown} data as view.py writes it */
  async showOriginal(data) {
    const original = readOriginal(data);
    element("other").hidden = false;
    this.other = new Pane(/** @type {HTMLCanvasElement} */ (element("original")), this.camera);
    this.other.renderer.setMaterials(original.materials, await decodeImages(original.images));
    this.other.renderer.setMesh(original.mesh);
    this.choose();
  }

  closeOriginal() {
    element("other").hidden = true;
    this.other?.dispose();
    this.other = null;
  }

  /**
   * A finished picture, for tests and scripts: RGBA, sRGB-encoded, straight alpha, top row first.
   * @param {{size: number, azimuth: number, elevation: number, field: boolean, channel: string, wireframe?: boolean, original?: boolean, slice?: number}} wanted
   */
  picture({ size, azimuth, elevation, field, channel, wireframe = false, original = false, slice = 0 }) {
    const camera = Object.assign(new Camera(), { azimuth, elevation });
    const pane = original ? this.other : this.pane;
    return /** @type {Pane} */ (pane).renderer.render(camera, { field, channel, wireframe, slice }, size, 3);
  }
}

/** @param {import("../decoder/document.js").Texture[]} images @returns {Promise<(ImageBitmap|null)[]>} null for one that does not decode */
async function decodeImages(images) {
  const found = await Promise.allSettled(images.map(decodeImage));
  const broken = images.filter((_, i) => found[i].status === "rejected").map((image) => image.name);
  if (broken.length) say(`images that this browser does not decode, left out: ${broken.join(", ")}`);
  return found.map((each) => (each.status === "fulfilled" ? each.value : null));
}

/** @param {string} id @returns {HTMLElement} */
function element(id) {
  return /** @type {HTMLElement} */ (document.getElementById(id));
}

/** @param {string} id @returns {HTMLInputElement} */
function input(id) {
  return /** @type {HTMLInputElement} */ (element(id));
}

/** @param {string} text */
function say(text) {
  element("message").textContent = text;
  element("message").hidden = !text;
}

/** @param {string} id @param {[string, string][]} rows */
function showRows(id, rows) {
  element(id).replaceChildren(
    ...rows.map(([name, value]) => {
      const row = document.createElement("tr");
      for (const text of [name, value]) row.appendChild(document.createElement("td")).textContent = text;
      return row;
    }),
  );
}

/** @param {import("../decoder/document.js").Document} parsed @param {number} length @returns {[string, string][]} */
function byteRows(parsed, length) {
  const images = parsed.bytes.get("TXTR") ?? 0;
  const rows = [...parsed.bytes].map(([part, bytes]) => [part, bytes.toLocaleString("en")]);
  return /** @type {[string, string][]} */ ([
    ...rows,
    ["without images", (length - images).toLocaleString("en")],
    ["file", length.toLocaleString("en")],
  ]);
}

/** @param {import("../decoder/document.js").Document} parsed @param {number} milliseconds @returns {[string, string][]} */
function factRows({ metadata, tensors, parts, chartMaterials }, milliseconds) {
  const weights = [...tensors.values()].flatMap((each) => [...each.values()]).reduce((sum, { values }) => sum + values.length, 0);
  return [
    ["charts", String(chartMaterials.length)],
    ["materials", String(metadata.materials.length)],
    ["weights", weights.toLocaleString("en")],
    ...partRows(parts),
    ["parsed in", `${milliseconds.toFixed(1)} ms`],
  ];
}

/** Triangles of the file, part by part. @param {import("../decoder/mesh/part.js").MeshPart[]} parts @returns {[string, string][]} */
function partRows(parts) {
  /** @type {[string, string][]} */
  const rows = parts.slice(0, MOST_PARTS).map(({ faceCharts, placements }, i) => {
    const copies = placements.length > 1 ? `, ${placements.length} copies` : "";
    return [`mesh part ${i + 1}`, `${faceCharts.length.toLocaleString("en")} triangles${copies}`];
  });
  return parts.length > MOST_PARTS ? [...rows, ["more mesh parts", String(parts.length - MOST_PARTS)]] : rows;
}

/** @param {import("../extract/mesh.js").MeshData} mesh @param {number} milliseconds @returns {[string, string][]} */
function meshRows(mesh, milliseconds) {
  return [
    ["triangles", (mesh.indices.length / 3).toLocaleString("en")],
    ["vertices", (mesh.positions.length / 3).toLocaleString("en")],
    ["extracted in", `${milliseconds.toFixed(0)} ms`],
  ];
}
