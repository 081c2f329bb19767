import {
  ALPHA_MODES,
  ENDINGS,
  FILTERS,
  MAX_CHARTS,
  MAX_ITEMS,
  MEASURES,
  MIME_TYPES,
  NETWORKS,
  PRESETS,
  SLOTS,
  WRAPS,
} from "./enumerations.js";
import { Float, readCanonical } from "./messagepack.js";
import { isText, Record } from "./record.js";
import { readSpec } from "./topology.js";

/**
 * @typedef {import("./topology.js").Spec} Spec
 * @typedef {{texture: number, wrapU: string, wrapV: string, filter: string, strength: number}} MapUse
 * @typedef {object} Material as in glTF 2.0, factors in linear light
 * @property {string} name
 * @property {number[]} baseColor
 * @property {number} metallic
 * @property {number} roughness
 * @property {number[]} emissive
 * @property {string} alphaMode
 * @property {number} alphaCutoff
 * @property {boolean} doubleSided
 * @property {Object<string, MapUse>} maps by slot
 * @typedef {{name: string, mime: string, length: number|undefined}} TextureEntry
 * @typedef {object} Metadata
 * @property {number[]} frame center and radius
 * @property {Map<string, Spec>} specs by network, in file order; none without a field, whose charts are 0 then
 * @property {number} charts of the field
 * @property {Int32Array} chartMaterials
 * @property {boolean[]} chartHasUv
 * @property {number[]} uvMap offset and scale
 * @property {Material[]} materials
 * @property {TextureEntry[]} textures
 * @property {number} halfThickness
 * @property {boolean} openings
 * @property {Object<string, string|number|boolean>} info
 */

/**
 * The content of META, checked (section 4 of the specification).
 * @param {Uint8Array} data
 * @returns {Metadata}
 */
export function readMetadata(data) {
  const record = new Record("document", readCanonical(data, "META"));
  const frame = record.floats(1, "frame", 4);
  record.demand(frame[3] > 0, "frame", "a radius above 0", frame[3]);
  const textures = readTextures(record.array(8, "textures", true) ?? []);
  const materials = readMaterials(record, textures.length);
  const field = record.fields.has(2) ? readField(record, materials.length) : NO_FIELD;
  const metadata = { frame, ...field, materials, textures, info: readInfo(record.map(10, "info", true)) };
  record.finish();
  return metadata;
}

const NO_FIELD = {
  specs: /** @type {Map<string, Spec>} */ (new Map()),
  charts: 0,
  chartMaterials: new Int32Array(0),
  chartHasUv: /** @type {boolean[]} */ ([]),
  uvMap: [0, 0, 1, 1],
  halfThickness: 0,
  openings: false,
};

/** What is said of the field. @param {Record} record @param {number} materials @returns {typeof NO_FIELD} */
function readField(record, materials) {
  const charts = record.integer(3, "charts", 1, MAX_CHARTS, 1);
  const field = {
    specs: readNetworks(record.map(2, "networks", false), charts),
    charts,
    chartMaterials: readChartMaterials(record, charts, materials),
    chartHasUv: readChartHasUv(record, charts),
    uvMap: record.floats(6, "uv_map", 4, [0, 0, 1, 1]),
    halfThickness: record.float(9, "half_thickness", 0),
    openings: record.bool(11, "openings", false),
  };
  checkRelations(record, field);
  return field;
}

/** @param {Record} record @param {typeof NO_FIELD} field */
function checkRelations(record, { specs, charts, chartHasUv, openings }) {
  record.demand(specs.has("sdf"), "networks.sdf", "present", "absent");
  record.demand(specs.has("chart") === charts > 1, "chart network", "one exactly for two charts or more", charts);
  record.demand(specs.has("uv") === chartHasUv.includes(true), "uv network", "one exactly for charts with UV");
  const closed = charts > 1 && !chartHasUv[charts - 1];
  record.demand(!openings || closed, "openings", "a last chart of several, without UV");
}

/** @param {Record} record @param {number} charts @returns {Map<string, Spec>} */
function readNetworks(record, charts) {
  const specs = new Map();
  NETWORKS.forEach((name, i) => {
    const value = record.take(i + 1, name, true);
    const outputs = [1, charts, 2][i];
    if (value !== undefined) specs.set(name, readSpec(new Record(`networks.${name}`, value), name, outputs, charts));
  });
  record.finish();
  return specs;
}

/** @param {Record} record @param {number} charts @param {number} materials */
function readChartMaterials(record, charts, materials) {
  const reader = record.bytes(4, "chart_materials");
  if (!reader) return new Int32Array(charts);
  const found = Int32Array.from({ length: charts }, () => reader.uint(materials > 256 ? 2 : 1));
  reader.finish();
  for (const material of found) record.limit("chart_materials", material, materials - 1);
  record.demand(found.some(Boolean), "chart_materials", "absent, being all 0", "present");
  return found;
}

/** @param {Record} record @param {number} charts @returns {boolean[]} */
function readChartHasUv(record, charts) {
  const reader = record.bytes(5, "chart_has_uv");
  if (!reader) return new Array(charts).fill(true);
  const flags = Array.from(reader.bits(charts, 1), Boolean);
  reader.finish();
  record.demand(flags.includes(false), "chart_has_uv", "absent, being all set", "present");
  return flags;
}

/** @param {Record} record @param {number} textures @returns {Material[]} */
function readMaterials(record, textures) {
  const list = record.array(7, "materials", true);
  const maps = list ?? [new Map()];
  const lone = list?.length === 1 && list[0] instanceof Map && list[0].size === 0;
  record.demand(!lone && maps.length <= MAX_ITEMS, "materials", "absent, being the default", "present");
  return maps.map((value, i) => readMaterial(new Record(`materials.${i}`, value), textures));
}

/** @param {Record} record @param {number} textures @returns {Material} */
function readMaterial(record, textures) {
  const material = {
    name: record.text(1, "name", "material"),
    baseColor: record.floats(2, "base_color", 4, [1, 1, 1, 1]),
    metallic: record.float(3, "metallic", 0),
    roughness: record.float(4, "roughness", 1),
    emissive: record.floats(5, "emissive", 3, [0, 0, 0]),
    alphaMode: record.choice(6, "alpha_mode", ALPHA_MODES, "opaque"),
    alphaCutoff: record.float(7, "alpha_cutoff", 0.5),
    doubleSided: record.bool(8, "double_sided", false),
    maps: readMaps(record.map(9, "maps", true), textures),
  };
  record.finish();
  return material;
}

/** @param {Record} record @param {number} textures @returns {Object<string, MapUse>} */
function readMaps(record, textures) {
  /** @type {Object<string, MapUse>} */
  const maps = {};
  SLOTS.forEach((slot, i) => {
    const value = record.take(i + 1, slot, true);
    if (value === undefined) return;
    const use = new Record(record.path + slot, value);
    maps[slot] = {
      texture: use.integer(1, "texture", 0, MAX_ITEMS, 0),
      wrapU: use.choice(2, "wrap_u", WRAPS, "repeat"),
      wrapV: use.choice(3, "wrap_v", WRAPS, "repeat"),
      filter: use.choice(4, "filter", FILTERS, "linear"),
      strength: use.float(5, "strength", 1),
    };
    use.finish();
    use.limit("texture", maps[slot].texture, textures - 1);
  });
  record.finish();
  return maps;
}

/** @param {unknown[]} list @returns {TextureEntry[]} */
function readTextures(list) {
  return list.map((value, i) => {
    const record = new Record(`textures.${i}`, value);
    const mime = record.choice(2, "mime", MIME_TYPES, "image/png");
    const name = readName(record, ENDINGS[MIME_TYPES.indexOf(mime)]);
    const last = i === list.length - 1;
    const length = last ? undefined : record.integer(3, "length", 1, 2 ** 31);
    record.finish();
    return { name, mime, length };
  });
}

/** @param {Record} record @param {string} ending of the texture's type */
function readName(record, ending) {
  const name = record.text(1, "name");
  const bare = name !== "" && name !== "." && name !== ".." && !/[/\\:]/.test(name);
  record.demand(bare, "name", "a bare file name", JSON.stringify(name));
  if (!name.includes(".")) return name + ending;
  const stem = name.slice(0, -ending.length);
  const shorter = name.endsWith(ending) && stem !== "" && !stem.includes(".");
  record.demand(!shorter, "name", `${stem}, without its ending`, name);
  return name;
}

/** @param {Record} record @returns {Object<string, string|number|boolean>} */
function readInfo(record) {
  /** @type {Object<string, string|number|boolean>} */
  const info = {};
  for (const [key, value] of record.fields) {
    const name = nameOf(record, `key ${key}`, key, MEASURES);
    info[name] = readMeasure(record, key, name, value);
  }
  return info;
}

/** What a number names, or text that names what has no number. @param {Record} record @param {string} field @param {unknown} value @param {string[]} names */
function nameOf(record, field, value, names) {
  const name = typeof value === "number" ? names[value - 1] : value;
  const known = isText(name) && (name !== value || !names.includes(name));
  record.demand(known, field, "a known number or another name", value);
  return /** @type {string} */ (name);
}

/** @param {Record} record @param {number|string} key @param {string} name @param {unknown} value */
function readMeasure(record, key, name, value) {
  if (key === 1) return nameOf(record, name, value, PRESETS);
  const found = /** @type {string|number|boolean} */ (value instanceof Float ? value.value : value);
  if (typeof key === "string") {
    record.demand(isText(found) || typeof found === "number" || typeof found === "boolean", name, "text, a number or a bool", typeof value);
    return found;
  }
  const fraction = key > 2;
  record.demand(typeof (fraction ? found : value) === "number", name, fraction ? "a number" : "an integer", typeof value);
  return fraction && found === value ? Number(value) / 1e6 : found;
}
