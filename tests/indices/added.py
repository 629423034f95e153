"""Indices that tests add, and their twins in NumPy."""

import numpy as np

import wsrender as ws
from wsrender.indices import math


def anisotropy(sigma, m, n):
    return 1.0 - math.divide(sigma[-1], sigma[0])


def weighted(sigma, m, n, *, weight, squared):
    value = sigma[0] + weight * sigma[-1]
    return value * value if squared else value


WEIGHT = ws.Option("weight", default=0.5, range=(0.0, 4.0), description="share of the smallest value")
SQUARED = ws.Option("squared", default=False, kind="boolean")
ANISOTROPY = ws.Index("anisotropy", "1 - 1/κ", anisotropy, "test", range=(0.0, 1.0), unit="1", bound=1.0)
WEIGHTED = ws.Index(
    "weighted", "σ_w", weighted, "test", unit=lambda A: A.value, options=(WEIGHT, SQUARED),
    bound=lambda norm, m, n, weight, squared: ((1 + weight) * norm) ** (2 if squared else 1),
)  # fmt: skip


def register(index, **changes):
    """The index, registered as a user does."""
    fields = [
        "function",
        "symbol",
        "unit",
        "source",
        "range",
        "needs",
        "bound",
        "options",
        "voxel_statistics",
        "survives",
    ]
    given = {field: getattr(index, field) for field in fields} | changes
    return ws.register_index(index.name, given.pop("function"), **given)


def twins(J, weight=0.5, squared=False):
    """Values (N,) by index of Jacobians' task rows (N, m, n)."""
    sigma = np.linalg.svd(J, compute_uv=False)
    value = sigma[:, 0] + weight * sigma[:, -1]
    return {"anisotropy": 1 - sigma[:, -1] / sigma[:, 0], "weighted": value**2 if squared else value}
