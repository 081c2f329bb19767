import { bitOf } from "./bytes.js";
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
  record.demand(specs.has("uv") === chartHasUv.includes(true), "uv network", "one exactly for charts with UV", "another");
  const closed = charts > 1 && !chartHasUv[charts - 1];
  record.demand(!openings || closed, "openings", "a last chart of several, without UV", "another");
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
  const found = new Int32Array(charts);
  const bytes = record.bytes(4, "chart_materials");
  if (!bytes) return found;
  const wide = materials > 256 ? 2 : 1;
  record.demand(bytes.length === wide * charts, "chart_materials", `${wide * charts} bytes`, bytes.length);
  for (let i = 0; i < charts; i++) {
    found[i] = wide === 1 ? bytes[i] : bytes[2 * i] + 256 * bytes[2 * i + 1];
    record.demand(found[i] < materials, "chart_materials", `below ${materials}`, found[i]);
  }
  record.demand(found.some(Boolean), "chart_materials", "absent, being all 0", "present");
  return found;
}

/** @param {Record} record @param {number} charts @returns {boolean[]} */
function readChartHasUv(record, charts) {
  const bytes = record.bytes(5, "chart_has_uv");
  if (!bytes) return new Array(charts).fill(true);
  const length = Math.ceil(charts / 8);
  record.demand(bytes.length === length, "chart_has_uv", `${length} bytes`, bytes.length);
  const bits = Array.from({ length: 8 * length }, (_, bit) => Boolean(bitOf(bytes, bit)));
  record.demand(!bits.slice(charts).includes(true), "chart_has_uv", "zeros after the last chart", "a set bit");
  const flags = bits.slice(0, charts);
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
    const use = new Record(`${record.name}.${slot}`, value);
    maps[slot] = {
      texture: use.integer(1, "texture", 0, MAX_ITEMS, 0),
      wrapU: use.choice(2, "wrap_u", WRAPS, "repeat"),
      wrapV: use.choice(3, "wrap_v", WRAPS, "repeat"),
      filter: use.choice(4, "filter", FILTERS, "linear"),
      strength: use.float(5, "strength", 1),
    };
    use.finish();
    use.demand(maps[slot].texture < textures, "texture", `below ${textures}`, maps[slot].texture);
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
    const name = typeof key === "number" ? MEASURES[key - 1] : key;
    const known = typeof key === "number" ? name !== undefined : isText(key) && !MEASURES.includes(key);
    record.demand(known, `key ${key}`, "a known number or another name", key);
    info[name] = readMeasure(record, key, name, value);
  }
  return info;
}

/** @param {Record} record @param {number|string} key @param {string} name @param {unknown} value */
function readMeasure(record, key, name, value) {
  if (key === 1) {
    const preset = typeof value === "number" ? PRESETS[value - 1] : value;
    const known = isText(preset) && (typeof value === "number" || !PRESETS.includes(/** @type {string} */ (preset)));
    record.demand(known, name, "a known number or another name", value);
    return /** @type {string} */ (preset);
  }
  const number = value instanceof Float ? value.value : value;
  if (typeof key === "string") record.demand(isText(number) || isPlain(number), name, "text, a number or a bool", typeof value);
  else record.demand(typeof value === "number" || (key > 2 && value instanceof Float), name, key > 2 ? "a number" : "an integer", typeof value);
  const counted = typeof key === "number" && key > 2 && typeof value === "number";
  return counted ? value / 1e6 : /** @type {string|number|boolean} */ (number);
}

/** @param {unknown} value */
function isPlain(value) {
  return typeof value === "number" || typeof value === "boolean";
}
