"""Weight codings: how one tensor is stored. Each is one file with `encode` and `decode`.

Every `decode` takes a `Reader` and raises FormatError at its place for malformed bytes.
"""
