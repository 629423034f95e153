"""Device code of wsrender: Warp functions and kernels, made by factories for one precision and joint count.

Imports warp and numpy, nothing else. A factory's arguments are the compile-time part of a kernel; the robot's
numbers, the sampling and the lattice are data, so that one compiled kernel serves every robot of its shape.
"""
