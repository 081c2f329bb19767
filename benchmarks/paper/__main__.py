"""`python -m benchmarks.paper`."""

from benchmarks.paper.command import main

main()
