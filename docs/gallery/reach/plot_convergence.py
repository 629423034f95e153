"""
How many samples are enough?
============================

``ws.Converge`` refines a grid of joint angles until a global index, here the mean of the inverse condition number,
settles to a thousandth.
"""

import matplotlib.pyplot as plt

import wsrender as ws

sampling = ws.Converge("inverse_condition_number", tolerance=0.001, start=11, step=8)
indices = ["inverse_condition_number"]
result = ws.analyze("scara", sampling, indices, task=["x", "y"], refined_volume=None, device="cpu")
rounds = result.document["convergence"]
for each in rounds:
    print(f"{each['per_joint']:3d} per joint, {each['samples']:7,d} samples: {each['value']:.4f}")

# %%
# The value over the samples:

figure, axes = plt.subplots(figsize=(6, 3.4), layout="constrained")
axes.plot([each["samples"] for each in rounds], [each["value"] for each in rounds], "o-")
axes.set(xlabel="samples", ylabel="mean of the inverse condition number")
axes.xaxis.set_major_formatter("{x:,.0f}")

# Picture: The index over the number of samples, which settles at 0.691.
figure
