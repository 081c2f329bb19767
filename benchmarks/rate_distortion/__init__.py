"""Every codec at every setting on every asset: `python -m benchmarks`."""
