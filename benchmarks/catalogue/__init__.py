"""Benchmarks of whole catalogues: speed, bookkeeping, chaos."""
