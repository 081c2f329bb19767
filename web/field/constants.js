/** The numbers by which shader.js and shader_wgsl.js trace a field, once for both languages. */

// The first three: where data.js puts the networks' headers, in texels.
const WHOLE = { NISP_SDF: 0, NISP_CHART: 4, NISP_UV: 8, NISP_STEPS: 400, NISP_LAYERS_SEEN: 8 };

const REAL = {
  NISP_BALL: 1.01,
  NISP_CUBE: 1.02,
  // A ray that grazes the surface goes on by so much at least; it has met it when as near as that.
  NISP_LEAST_STEP: 5e-4,
  NISP_NEAR: 1e-4,
  // A crossing is not looked for more exactly: a Newton step follows.
  NISP_EXACT: 1e-4,
  // How far from a point slopes are taken.
  NISP_OFFSET: 1e-3,
  // A ray so close, whose field falls by at least such a share of the steepest slope, goes on by so much
  // more than to where it would meet the surface; others by such a share of what is sure to miss nothing.
  NISP_CLOSE: 0.02,
  NISP_FAST: 0.2,
  NISP_BEYOND: 1.15,
  NISP_OVERLAP: 0.97,
};

/** A line for each. @param {string} whole @param {string} real how a constant begins in the language */
const lines = (whole, real) =>
  [
    ...Object.entries(WHOLE).map(([name, value]) => `${whole} ${name} = ${value};`),
    ...Object.entries(REAL).map(([name, value]) => `${real} ${name} = ${value};`),
  ].join("\n");

export const CONSTANTS_GLSL = lines("const int", "const float");
export const CONSTANTS_WGSL = lines("const", "const");
