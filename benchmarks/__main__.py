"""`python -m benchmarks`, `make bench`."""

from benchmarks.command import main

main()
