"""Fewer triangles for a mesh: edges collapsed, vertices and UVs fitted to the source, rounded."""
