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

/**
 * Throws unless `holds`.
 * @param {unknown} holds
 * @param {string} section
 * @param {string} field
 * @param {unknown} expected
 * @param {unknown} [found]
 * @returns {asserts holds}
 */
export function demand(holds, section, field, expected, found = "another value") {
  if (!holds) throw new NISPError(section, field, expected, found);
}
