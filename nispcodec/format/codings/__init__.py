"""Weight codings: how one tensor is stored. Each is one file with `encode` and `decode`."""
