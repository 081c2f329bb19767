"""The types that every part of the package shares: assets, networks, documents, errors."""
