"""Searches of a mesh in C++: the same answers as in numpy, many times as fast.

`mesh_kernel` is the entrance. The libraries are built by `setup.py` where there is a compiler, one
for each instruction set.
"""
