import { BufferAttribute, BufferGeometry, FileLoader, Group, Loader, Mesh } from "three";
import { parseNISP } from "../decoder/document.js";
import { ExtractionClient } from "../extract/client.js";
import { standardMaterial } from "./materials.js";
import { TextureSet } from "./textures.js";

/** Cells along an edge of the cube, and workers, where nothing else is said. */
const DEFAULTS = Object.freeze({ resolution: 128, workers: 2 });

/**
 * Loads a `.nisp` file as a Group of meshes with MeshStandardMaterial; meshes are extracted in
 * workers. Used as three's own loaders are:
 *
 *     const group = await new NISPLoader().setResolution(192).loadAsync("model.nisp");
 */
export class NISPLoader extends Loader {
  /** @param {import("three").LoadingManager} [manager] */
  constructor(manager) {
    super(manager);
    /** @type {number} */ this.resolution = DEFAULTS.resolution;
    /** @type {number} */ this.limit = DEFAULTS.workers;
    /** @type {ExtractionClient[]} */
    this.clients = [];
  }

  /** @param {number} resolution cells along an edge of the cube: more is finer, and takes longer */
  setResolution(resolution) {
    this.resolution = resolution;
    return this;
  }

  /** @param {number} limit workers that extract side by side, at least 1 */
  setWorkerLimit(limit) {
    if (!(limit >= 1)) throw new RangeError(`worker limit: expected at least 1, found ${limit}`);
    this.limit = limit;
    return this;
  }

  /**
   * @param {string} url
   * @param {(group: Group) => void} onLoad
   * @param {(event: ProgressEvent) => void} [onProgress]
   * @param {(error: unknown) => void} [onError]
   */
  load(url, onLoad, onProgress, onError) {
    const loader = new FileLoader(this.manager);
    loader.setPath(this.path);
    loader.setResponseType("arraybuffer");
    loader.setRequestHeader(this.requestHeader);
    loader.setWithCredentials(this.withCredentials);
    const fail = (/** @type {unknown} */ why) => {
      if (onError) onError(why);
      else console.error(why);
      this.manager.itemError(url);
    };
    loader.load(url, (data) => this.parse(/** @type {ArrayBuffer} */ (data)).then(onLoad).catch(fail), onProgress, fail);
  }

  /**
   * The asset in its own units. A mesh has the middle of the asset as its place, so that coordinates
   * stay exact far from the origin. Rejects with NISPError for a malformed file.
   * @param {ArrayBuffer|Uint8Array} data
   * @returns {Promise<Group>}
   */
  async parse(data) {
    const file = data instanceof Uint8Array ? data : new Uint8Array(data);
    const document = parseNISP(file);
    const [mesh, textures] = await Promise.all([this.client().extract(file, this.resolution), TextureSet.decoded(document)]);
    return groupOf(document, mesh, textures);
  }

  /** The worker whose turn it is; a new one in place of one that failed. */
  client() {
    this.clients = this.clients.filter((client) => !client.ended);
    if (this.clients.length < this.limit) this.clients.push(new ExtractionClient(makeWorker()));
    else this.clients.push(/** @type {ExtractionClient} */ (this.clients.shift()));
    return this.clients[this.clients.length - 1];
  }

  /** Ends the workers. */
  dispose() {
    for (const client of this.clients) client.dispose();
    this.clients = [];
    return this;
  }
}

function makeWorker() {
  return new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
}

/**
 * @param {import("../decoder/document.js").Document} document
 * @param {import("../extract/mesh.js").MeshData} mesh
 * @param {TextureSet} textures
 */
function groupOf({ metadata }, mesh, textures) {
  const [x, y, z, radius] = metadata.frame;
  const attributes = {
    position: new BufferAttribute(mesh.positions.map((value) => value * radius), 3),
    normal: new BufferAttribute(mesh.normals, 3),
    uv: new BufferAttribute(mesh.uvs.map((value, i) => (i & 1 ? 1 - value : value)), 2),
  };
  const group = new Group();
  for (const part of mesh.groups) {
    const geometry = new BufferGeometry();
    for (const [name, attribute] of Object.entries(attributes)) geometry.setAttribute(name, attribute);
    geometry.setIndex(new BufferAttribute(mesh.indices.subarray(part.start, part.start + part.count), 1));
    const material = metadata.materials[part.material];
    const child = new Mesh(geometry, standardMaterial(material, textures, part.textured));
    child.name = material.name;
    child.position.set(x, y, z);
    group.add(child);
  }
  return group;
}
