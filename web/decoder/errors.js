/** What is wrong with a file, and where. */
export class NISPError extends Error {
  /**
   * @param {string} section of the file, or "header"
   * @param {string} field in it
   * @param {unknown} expected
   * @param {unknown} found
   */
  constructor(section, field, expected, found) {
    super(`${section}: ${field}: expected ${expected}, found ${found}`);
    this.name = "NISPError";
    this.section = section;
    this.field = field;
  }
}

/** A part of a file, whose name is in the errors that it throws. */
export class Place {
  /** @param {string} section of the file, or "header" @param {string} [path] in it */
  constructor(section, path = "") {
    this.section = section;
    this.path = path;
  }

  /**
   * Throws unless `holds`.
   * @param {unknown} holds
   * @param {string} field
   * @param {unknown} expected
   * @param {unknown} [found]
   */
  demand(holds, field, expected, found = "something else") {
    if (!holds) throw new NISPError(this.section, this.path + field, expected, found);
  }

  /** Throws unless a number is from `least` to `most`. @param {string} field @param {number} value @param {number} most @param {number} [least] */
  limit(field, value, most, least = 0) {
    const within = value >= least && value <= most;
    if (!within) this.demand(false, field, `${least} to ${most}`, value);
  }
}
