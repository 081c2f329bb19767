import { ClampToEdgeWrapping, LinearFilter, LinearMipmapLinearFilter, MirroredRepeatWrapping, NearestFilter, NoColorSpace, RepeatWrapping, SRGBColorSpace, Texture } from "three";
import { decodeImage } from "../evaluate/images.js";

const WRAPPINGS = { repeat: RepeatWrapping, clamp: ClampToEdgeWrapping, mirror: MirroredRepeatWrapping };

/**
 * Textures of a file for three.js, each made once for each way of using it.
 *
 * Images are not flipped on upload, which an ImageBitmap cannot be: as with glTF, texture
 * coordinates that go with them begin top-left.
 */
export class TextureSet {
  /** @param {(ImageBitmap|null)[]} images by number of the texture; null for one that is left out */
  constructor(images) {
    this.images = images;
    /** @type {Map<string, Texture>} */
    this.made = new Map();
  }

  /** Images that the browser does not decode are left out, with a warning. @param {import("../decoder/document.js").Document} document */
  static async decoded({ images }) {
    const found = await Promise.allSettled(images.map(decodeImage));
    const broken = images.filter((_, i) => found[i].status === "rejected").map((image) => image.name);
    if (broken.length) console.warn(`NISPLoader: images that this browser does not decode, left out: ${broken.join(", ")}`);
    return new TextureSet(found.map((each) => (each.status === "fulfilled" ? each.value : null)));
  }

  /** @param {import("../decoder/metadata.js").MapUse|undefined} use @param {boolean} color whether it is sRGB-encoded */
  get(use, color) {
    if (!use || !this.images[use.texture]) return null;
    const key = [use.texture, use.wrapU, use.wrapV, use.filter, color].join();
    const texture = this.made.get(key) ?? this.make(use, color);
    this.made.set(key, texture);
    return texture;
  }

  /** @param {import("../decoder/metadata.js").MapUse} use @param {boolean} color */
  make(use, color) {
    const texture = new Texture(/** @type {ImageBitmap} */ (this.images[use.texture]));
    texture.wrapS = WRAPPINGS[/** @type {"repeat"} */ (use.wrapU)];
    texture.wrapT = WRAPPINGS[/** @type {"repeat"} */ (use.wrapV)];
    const nearest = use.filter === "nearest";
    texture.magFilter = nearest ? NearestFilter : LinearFilter;
    texture.minFilter = nearest ? NearestFilter : LinearMipmapLinearFilter;
    texture.colorSpace = color ? SRGBColorSpace : NoColorSpace;
    texture.flipY = false;
    texture.needsUpdate = true;
    return texture;
  }
}
