"""Distortion, defined once: used by the encoder's report, the command line and the benchmarks."""
