"""
How do I get results into pandas and xarray?
============================================

Tables and samples are data frames, volumes are datasets with units and coordinates.
"""

import wsrender as ws

result = ws.analyze("ur5e", ws.Sobol(1 << 17), ["manipulability"], refined_volume=None, device="cpu")
result.to_pandas("sample").describe()

# %%

volume = result.to_xarray()
print(volume)

# %%
# The largest over rings around the base's axis, above its foot, in two lines:

radius = (volume.x**2 + volume.y**2) ** 0.5
best = volume.maximum_manipulability.groupby_bins(radius.where(volume.z > 0), bins=8).max()
print(best.to_series().round(4))
