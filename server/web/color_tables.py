"""Writes src/scene/color_tables.ts: the colour maps of the pictures, from matplotlib: python color_tables.py."""

import base64
from pathlib import Path

import matplotlib as mpl
import numpy as np

# Safe for the colour-blind and monotonous in print; the last has a middle (Moreland 2009).
NAMES = ("viridis", "cividis", "magma", "plasma", "gray", "coolwarm")


def table(name: str) -> str:
    """256 colours, RGB bytes as matplotlib draws them, in base64."""
    colors = mpl.colormaps[name].resampled(256)(np.arange(256), bytes=True)[:, :3]
    return base64.b64encode(np.ascontiguousarray(colors).tobytes()).decode()


def module() -> str:
    """The module's text."""
    rows = "".join(f'  {name}: "{table(name)}",\n' for name in NAMES)
    about = "/** 256 colours each, RGB bytes in base64: written by color_tables.py, not by hand. */"
    return f"{about}\nexport const tables = {{\n{rows}}};\n"


if __name__ == "__main__":
    Path(__file__).with_name("src").joinpath("scene", "color_tables.ts").write_text(module())
