"""
How do I cite it, and what do I state in the paper?
===================================================

The result's provenance says what ran: versions, the hash of the model, the device. Beside ``CITATION.cff`` it is what a
reader needs to get the same numbers.
"""

import wsrender as ws

result = ws.analyze("ur5e", ws.Sobol(1 << 16), ["manipulability"], refined_volume=0.02, device="cpu")
provenance = result.document["provenance"]
for name in ("wsrender", "warp-lang", "mujoco", "numpy", "precision", "seed", "pipeline", "citation"):
    print(f"{name:10s} {provenance[name]}")

# %%
# A sentence for the paper, from the document:

headline = result.document["headline"]
print(
    f"The reachable {headline['quantity']} is {headline['value']:.2f} m³ "
    f"(95 % interval {headline['ci95'][0]:.2f} to {headline['ci95'][1]:.2f}), wsrender {ws.__version__}."
)

# %%
# Pictures of your results are yours. Their titles say robot and sampling:

# Picture: Slice at y = 0 through the workspace, coloured by manipulability, with robot and number of samples above.
result.plot.slice(y=0.0)
