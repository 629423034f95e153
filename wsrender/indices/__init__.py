"""Local indices: catalogue, functions of the singular values, and the mathematics they may use."""

from wsrender.indices.entry import Index, Option
from wsrender.indices.index_catalogue import CONVENTIONS, DYNAMIC, KINEMATIC, catalogue, find, register_index, resolve

__all__ = ["CONVENTIONS", "DYNAMIC", "KINEMATIC", "Index", "Option", "catalogue", "find", "register_index", "resolve"]
