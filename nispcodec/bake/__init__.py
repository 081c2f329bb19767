"""New atlases, and textures for them."""
