import { Color, DoubleSide, FrontSide, MeshStandardMaterial, Vector2 } from "three";

/**
 * A material of a file for three.js.
 * @param {import("../decoder/metadata.js").Material} material
 * @param {import("./textures.js").TextureSet} textures
 * @param {boolean} textured whether its faces have texture coordinates: without, factors alone
 */
export function standardMaterial(material, textures, textured) {
  const maps = textured ? material.maps : {};
  const rough = textures.get(maps.metallic_roughness, false);
  const [red, green, blue, alpha] = material.baseColor;
  const strength = maps.normal?.strength ?? 1;
  return new MeshStandardMaterial({
    name: material.name,
    color: new Color(red, green, blue),
    opacity: alpha,
    metalness: material.metallic,
    roughness: material.roughness,
    emissive: new Color(...material.emissive),
    map: textures.get(maps.base_color, true),
    normalMap: textures.get(maps.normal, false),
    // Our normal maps have y up, texture coordinates here run down: as GLTFLoader does it.
    normalScale: new Vector2(strength, -strength),
    metalnessMap: rough,
    roughnessMap: rough,
    aoMap: textures.get(maps.occlusion, false),
    aoMapIntensity: maps.occlusion?.strength ?? 1,
    emissiveMap: textures.get(maps.emissive, true),
    transparent: material.alphaMode === "blend",
    depthWrite: material.alphaMode !== "blend",
    alphaTest: material.alphaMode === "mask" ? material.alphaCutoff : 0,
    side: material.doubleSided ? DoubleSide : FrontSide,
  });
}
