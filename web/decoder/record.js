import { ByteReader } from "./bytes.js";
import { Place } from "./errors.js";
import { Float } from "./messagepack.js";

/** A map of META whose fields are taken out one by one; a field left over is unknown. */
export class Record extends Place {
  /**
   * @param {string} name that errors begin with
   * @param {unknown} value which must be a map
   */
  constructor(name, value) {
    super("META", `${name}.`);
    this.demand(value instanceof Map, "map", "a map", typeof value);
    /** @type {Map<number|string, unknown>} */
    this.fields = new Map(/** @type {Map<number|string, unknown>} */ (value));
  }

  /**
   * The raw value, undefined where it is absent and has a default.
   * @param {number} key
   * @param {string} field
   * @param {boolean} optional
   */
  take(key, field, optional) {
    const value = this.fields.get(key);
    this.fields.delete(key);
    this.demand(value !== undefined || optional, field, "present", "absent");
    return value;
  }

  /**
   * @template T
   * @param {number} key
   * @param {string} field
   * @param {T|undefined} fallback the default; none where the field must be there
   * @param {(value: any) => T} convert throws what is no value of the type
   * @returns {T}
   */
  #typed(key, field, fallback, convert) {
    const raw = this.take(key, field, fallback !== undefined);
    if (raw === undefined) return /** @type {T} */ (fallback);
    const value = convert(raw);
    const same = Array.isArray(value) && Array.isArray(fallback) ? equal(value, fallback) : value === fallback;
    this.demand(!same, field, "absent, being the default", "present");
    return value;
  }

  /** @param {number} key @param {string} field @param {number} least @param {number} most @param {number} [fallback] */
  integer(key, field, least, most, fallback) {
    return this.#typed(key, field, fallback, (value) => {
      this.demand(typeof value === "number", field, "an integer", typeof value);
      this.limit(field, value, most, least);
      return /** @type {number} */ (value);
    });
  }

  /** @param {number} key @param {string} field @param {number} [fallback] */
  float(key, field, fallback) {
    return this.#typed(key, field, fallback, (value) => {
      this.demand(value instanceof Float, field, "a float", typeof value);
      return /** @type {number} */ (value.value);
    });
  }

  /** @param {number} key @param {string} field @param {number} count @param {number[]} [fallback] */
  floats(key, field, count, fallback) {
    return this.#typed(key, field, fallback, (value) => {
      const right = Array.isArray(value) && value.length === count && value.every((each) => each instanceof Float);
      this.demand(right, field, `${count} floats`);
      return /** @type {number[]} */ (value.map((/** @type {Float} */ each) => each.value));
    });
  }

  /** @param {number} key @param {string} field @param {boolean} fallback */
  bool(key, field, fallback) {
    return this.#typed(key, field, fallback, (value) => {
      this.demand(typeof value === "boolean", field, "a bool", typeof value);
      return /** @type {boolean} */ (value);
    });
  }

  /** @param {number} key @param {string} field @param {string} [fallback] */
  text(key, field, fallback) {
    return this.#typed(key, field, fallback, (value) => {
      this.demand(isText(value), field, "text without control characters");
      return /** @type {string} */ (value);
    });
  }

  /**
   * One of an enumeration.
   * @template {string} T
   * @param {number} key
   * @param {string} field
   * @param {readonly T[]} names
   * @param {T} [fallback]
   */
  choice(key, field, names, fallback) {
    return this.#typed(key, field, fallback, (value) => {
      this.demand(typeof value === "number" && names[value - 1], field, `1 to ${names.length}`, value);
      return names[value - 1];
    });
  }

  /** A reader of bytes, undefined where absent. @param {number} key @param {string} field */
  bytes(key, field) {
    const value = this.take(key, field, true);
    if (value === undefined) return value;
    this.demand(value instanceof Uint8Array, field, "bytes", typeof value);
    return new ByteReader(/** @type {Uint8Array} */ (value), this.section, `${this.path}${field}.`);
  }

  /**
   * An array that must not be empty; undefined where absent.
   * @param {number} key @param {string} field @param {boolean} optional @returns {unknown[]|undefined}
   */
  array(key, field, optional) {
    const value = this.take(key, field, optional);
    this.demand(value === undefined || (Array.isArray(value) && value.length), field, "a list, not empty");
    return /** @type {unknown[]|undefined} */ (value);
  }

  /** A map, not empty where it is there. @param {number} key @param {string} field @param {boolean} optional */
  map(key, field, optional) {
    const value = this.take(key, field, optional);
    const record = new Record(this.path + field, value ?? new Map());
    this.demand(!value || record.fields.size, field, "a map, not empty");
    return record;
  }

  finish() {
    for (const key of this.fields.keys()) this.demand(false, "field", "a known one", key);
  }
}

/** Whether it is text without control characters. @param {unknown} value @returns {value is string} */
export function isText(value) {
  return typeof value === "string" && !/[\0-\x1f\x7f]/.test(value);
}

/** @param {unknown[]} a @param {unknown[]} b */
function equal(a, b) {
  return a.length === b.length && a.every((value, i) => value === b[i]);
}
