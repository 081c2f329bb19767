"""Networks fitted to samples."""
