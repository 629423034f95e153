"""
Is the result the same again, and what fixes the seed?
======================================================

A sample is a pure function of its number and the seed: integers are summed, so that threads, chunks and shards
change no bit.
"""

import numpy as np

import wsrender as ws

common = {"indices": ["manipulability"], "voxel_size_m": 0.1, "refined_volume": None, "device": "cpu"}
first = ws.analyze("ur5e", ws.Random(1 << 16, seed=7), **common)
again = ws.analyze("ur5e", ws.Random(1 << 16, seed=7), threads=1, chunk_size=5000, **common)
other = ws.analyze("ur5e", ws.Random(1 << 16, seed=8), **common)


def counts(result: ws.Result) -> np.ndarray:
    """Samples in each voxel."""
    return result.to_xarray()["count"].values


print("same seed, other chunks:", np.array_equal(counts(first), counts(again)))
print("another seed:           ", np.array_equal(counts(first), counts(other)))

# %%
# The result document holds the whole job, defaults and seed included; it runs again as it is.

job = first.document["job"]
print(job["sampling"])
print("run again:", np.array_equal(counts(first), counts(ws.execute(job))))

# %%
# Its pictures are the same, too:

# Picture: Slice at y = 0 of the largest manipulability in each voxel: the same in each run, to the bit.
first.plot.slice(y=0.0)
