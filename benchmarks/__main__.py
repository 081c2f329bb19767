"""`python -m benchmarks`, `make bench`."""

from benchmarks.rate_distortion.command import main

main()
