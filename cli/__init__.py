"""The `nisp` command."""
