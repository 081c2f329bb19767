"""What an asset is: solid, distance, charts, symmetry, openings."""
