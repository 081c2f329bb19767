"""What was found, to look at: an HTML page, plots, the tables of docs/benchmarks.md."""
