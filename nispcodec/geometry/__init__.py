"""Analysis of an asset: solid, distance, charts, symmetry, openings."""
