"""Training in C++ on the processor: the steps of the torch backend, several times as fast.

`engine` is the entrance. The libraries are built by `setup.py` where there is a compiler, one for
each instruction set, and found when they are asked for.
"""
