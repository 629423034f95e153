"""
How do I get results into pandas and xarray?
============================================

Tables and samples are data frames, volumes are datasets with units and coordinates.
"""

import matplotlib.pyplot as plt

import wsrender as ws

result = ws.analyze("ur5e", ws.Sobol(1 << 17), ["manipulability"], refined_volume=None, device="cpu")
result.to_pandas("sample")[["x", "y", "z", "manipulability"]].describe()

# %%

volume = result.to_xarray()
print(volume)

# %%
# The largest over rings around the base's axis, above its foot, in two lines:

radius = (volume.x**2 + volume.y**2) ** 0.5
best = volume.maximum_manipulability.groupby_bins(radius.where(volume.z > 0), bins=8).max()
print(best.to_series().round(4))

# %%
# And a picture of it by matplotlib:

figure, axes = plt.subplots(figsize=(6, 3.4), layout="constrained")
axes.plot([ring.mid for ring in best.group_bins.values], best, "o-")
axes.set(xlabel="distance from the base's axis [m]", ylabel="largest manipulability [m³]")

# Picture: The largest manipulability over the distance from the base's axis: it rises to 0.18 m³ at 0.8 m, and falls.
figure
