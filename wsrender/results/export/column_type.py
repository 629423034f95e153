"""Arrow types of NumPy arrays."""

import numpy as np
import pyarrow as pa


def column_type(array: np.ndarray) -> pa.DataType:
    """The Arrow type of an array's values; NumPy's text has none of its own."""
    return pa.string() if array.dtype.kind == "U" else pa.from_numpy_dtype(array.dtype)
