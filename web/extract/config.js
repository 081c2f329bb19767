/** Numbers of the extraction; lengths are of the normalized frame. */
export const EXTRACTION = Object.freeze({
  // Half an edge of the cube that is looked at: the unit ball and a little.
  cube: 1.02,
  // Nothing of an asset is outside of the ball of this radius.
  ball: 1.01,
  // Blocks along an edge of the cube from which the search for surface starts.
  root: 32,
  // Share by which the field may be steeper than is measured.
  margin: 1.25,
  // Points that tell how steep the field is.
  slopeSamples: 2000,
  // Newton steps that move a vertex onto the surface.
  newtonSteps: 2,
  // Components: a field steeper than this, relative to all, holds no surface ...
  steep: 1.7,
  // ... on a component of at most this share of the vertices;
  smallShare: 0.05,
  // one flatter than this neither, on a component of a single cell, or a small and lonely one ...
  flat: 0.6,
  // ... of at most this area ...
  smallArea: 3e-3,
  // ... with no other so near;
  isolated: 0.02,
  // vertices of a single cell;
  singleCell: 8,
  // a closed hollow of fewer of all vertices is not seen.
  hollowShare: 0.03,
  // Seams: a patch of one chart of less area, or of fewer vertices, is a mistake of the field.
  patchArea: 1.2e-4,
  patchVertices: 2,
  // Rounds in which neighbors decide whose it is.
  votes: 3,
  // Halvings that find the border between charts on an edge.
  bisections: 8,
  // Share of an edge that cuts keep from its ends.
  clearance: 0.02,
  // Mesh parts: where none of its edges is a crease, one is where normals lean by more than 45 degrees.
  smoothCosine: Math.SQRT1_2,
  // Ends of borders are in one place that are nearer than this along every axis.
  meeting: 1e-6,
  // Sides of one edge that are compared with each other: two, but for what touches there.
  edgeSides: 8,
});
