"""Connected parts of a graph."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components


def components(count: int, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Number (count,) of the connected part that each of so many things is in, where a and b (N,) are joined."""
    graph = coo_array((np.ones(len(a), bool), (a, b)), shape=(count, count))
    return connected_components(graph, directed=False)[1] if count else np.empty(0, np.int64)
