"""What is coded: an asset on disk, its corners, fewer of its triangles, where to get some."""
