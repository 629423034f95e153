"""
How do I make the figure for my paper?
======================================

Pictures are matplotlib figures: change them, and write them as vectors or at any resolution. They are yours to use.
"""

import tempfile
from pathlib import Path

import wsrender as ws

result = ws.analyze("ur5e", ws.Sobol(1 << 18), ["manipulability"], refined_volume=None, device="cpu")
figure = result.plot.slice(y=0.0, index="manipulability")
figure.set_size_inches(3.5, 3.2)  # a column
figure.suptitle("")
folder = Path(tempfile.mkdtemp())
figure.savefig(folder / "figure.svg")
figure.savefig(folder / "figure.png", dpi=600)
print({path.name: f"{path.stat().st_size / 1000:.0f} kB" for path in sorted(folder.iterdir())})

# Picture: A slice through the workspace, as narrow as a column of a paper, without a title.
figure
