import { BoxGeometry, Data3DTexture, DataTexture, FloatType, Mesh, NearestFilter, RGBAFormat, RedFormat } from "three";
import { DATA_WIDTH, packField } from "../field/data.js";
import { occupancyOf } from "../field/occupancy.js";

/** Base color maps that one field can show, as a fragment shader has 16 textures for certain. */
const MOST_MAPS = 8;

/**
 * What a material that traces a field reads, for either renderer. The data's texel of a chart has its
 * base color (RGB) and the number of its map, -1 without.
 */
export class FieldContent {
  /** @param {import("../evaluate/model.js").NISPModel} model @param {import("./textures.js").TextureSet} textures */
  constructor(model, textures) {
    const { metadata } = model;
    if (!model.field) throw new Error("networks: expected some, found meshes alone: NISPLoader shows them");
    const { maps, charts } = chartLooks(metadata, textures);
    const grid = occupancyOf(model.field.sdfNetwork);
    const packed = packField(model.document, charts, grid.slope);
    this.groups = packed.groups;
    this.chartTable = packed.at;
    this.uvMap = metadata.uvMap;
    this.maps = maps;
    this.data = dataTexture(packed);
    this.grid = gridTexture(grid);
  }

  dispose() {
    for (const texture of [this.data, this.grid, ...this.maps]) texture.dispose();
  }
}

/**
 * The box that a field is drawn on, in the asset's units and place.
 * @template {import("three").Material} FieldMaterial
 * @extends {Mesh<BoxGeometry, FieldMaterial>}
 */
export class FieldBox extends Mesh {
  /** @param {import("../evaluate/model.js").NISPModel} model @param {FieldMaterial} material */
  constructor(model, material) {
    super(new BoxGeometry(2.04, 2.04, 2.04), material);
    const [x, y, z, radius] = model.metadata.frame;
    this.position.set(x, y, z);
    this.scale.setScalar(radius);
  }

  dispose() {
    this.geometry.dispose();
    this.material.dispose();
  }
}

/** Base color maps, and each chart's texel. @param {import("../decoder/metadata.js").Metadata} metadata @param {import("./textures.js").TextureSet} textures */
function chartLooks({ materials, chartMaterials, chartHasUv }, textures) {
  const all = materials.map(({ maps }) => textures.get(maps.base_color, true));
  const maps = [...new Set(all)].filter((texture) => texture !== null).slice(0, MOST_MAPS);
  const charts = Array.from(chartMaterials, (number, i) => {
    const [texture, [red, green, blue]] = [all[number], materials[number].baseColor];
    return [red, green, blue, texture && chartHasUv[i] ? maps.indexOf(texture) : -1];
  });
  return { maps, charts };
}

/** @param {{texels: Float32Array, height: number}} packed */
function dataTexture({ texels, height }) {
  const texture = new DataTexture(/** @type {any} */ (texels), DATA_WIDTH, height, RGBAFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** @param {import("../field/occupancy.js").Occupancy} grid */
function gridTexture({ cells, size }) {
  const texture = new Data3DTexture(/** @type {any} */ (cells), size, size, size);
  texture.format = RedFormat;
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}
