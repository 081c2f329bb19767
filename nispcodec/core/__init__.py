"""What every part of the package speaks: assets, networks, documents, errors."""
