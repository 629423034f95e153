"""Published cases run again: what was printed, what comes out here, and what is exact."""

from wsrender.reproduce.cases import CASES, reproduce
from wsrender.reproduce.row import Row

__all__ = ["CASES", "Row", "reproduce"]
