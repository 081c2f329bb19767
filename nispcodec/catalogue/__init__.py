"""Catalogues: many assets encoded side by side, with a record of each, that can be gone on with."""
