"""Local indices of the whole chain, as device functions: one module each, with a factory of the module's name.

``<name>(real, n, sources, plain, *choices, size, offset)`` makes the device function ``(model, q) -> value``, the chain
as of `kinematics`. ``model.limits`` (size,) holds the numbers of all constraints and indices of a sweep, those of this
one from ``offset`` on. ``rows``: those of the linear task, in base axes.
"""
