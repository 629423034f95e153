"""Local indices: catalogue, functions of the singular values, and the mathematics they may use."""

from wsrender.indices.catalogue import CONVENTIONS, DYNAMIC, KINEMATIC, Index, catalogue, find, register_index, resolve

__all__ = ["CONVENTIONS", "DYNAMIC", "KINEMATIC", "Index", "catalogue", "find", "register_index", "resolve"]
