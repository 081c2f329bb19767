"""From a signed distance to a textured mesh."""
