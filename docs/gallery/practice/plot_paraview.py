"""
How do I open the files in ParaView, MATLAB or Blender?
=======================================================

``save`` writes the result document and, of each part, a file of a standard format.
"""

import tempfile
from pathlib import Path

import h5py

import wsrender as ws

folder = Path(tempfile.mkdtemp())
result = ws.analyze("ur5e", ws.Sobol(1 << 16), ["manipulability"], refined_volume=None, device="cpu")
result.save(folder, formats=["mat"])
for path in sorted(each for each in folder.rglob("*") if each.is_file()):
    print(path.relative_to(folder))

# %%
# ``volume.vtkhdf`` opens in ParaView as it is; ``surface.ply`` and ``surface.glb`` in Blender. The volume is HDF5, too,
# whose first axis is z, the last x:

with h5py.File(folder / "volume.vtkhdf") as file:
    for name, data in file["VTKHDF/CellData"].items():
        print(name, data.shape, data.dtype)

# %%
# ParaView shows those cells that hold a sample (*Threshold* by ``count``, from 1), and cuts them by *Slice*, as here:

# Picture: Slice at y = 0 of the largest manipulability in each voxel, as ParaView would show it.
result.plot.slice(y=0.0)
