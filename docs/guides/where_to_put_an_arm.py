"""Where to put a UR5e for ten holes of a plate on a table, with a post in the way: a map, the best place, a picture.

python docs/guides/where_to_put_an_arm.py [picture.png]
"""

import sys
from pathlib import Path

import wsrender as ws

PICTURE = Path(__file__).with_suffix(".png")
HOLES = [(0.5 + 0.06 * row, y, 0.12) for row in range(5) for y in (-0.03, 0.03)]  # 2 cm above the plate
DOWN = (0, 1, 0, 0)  # the tool's z points downwards
AROUND = ws.Environment(
    [
        ws.Box(name="table", size_m=(2.0, 1.4, 0.05), position_m=(0.3, 0.0, -0.026)),
        ws.Box(name="plate", size_m=(0.36, 0.14, 0.1), position_m=(0.62, 0.0, 0.05)),
        ws.Cylinder(name="post", radius_m=0.04, length_m=1.0, position_m=(0.35, 0.25, 0.5)),
    ]
)


def placed(step_m: float = 0.05, **fields) -> ws.Result:
    """Which holes the arm serves from where its base may stand on the table, and the best place."""
    over = {"x_m": [-0.5, 1.2, step_m], "y_m": [-0.6, 0.6, step_m], "yaw_deg": [0, 360, 30]}
    asked = {"over": over, "environment": AROUND, "constraints": {"self_collision": True}}
    asked |= {"index": "minimum_singular_value"} | fields
    return ws.base_placement("ur5e", HOLES, [DOWN] * len(HOLES), **asked)


def main(picture: Path) -> None:
    """Print what is found and draw the picture."""
    result = placed()
    best = result.document["best"]
    print(result.document["placements"])
    print({name: best[name] for name in ("x_m", "y_m", "yaw_deg", "served", "minimum_singular_value", "tolerance")})
    print("from the cell", best["cell"])
    drawn(result, picture)


def drawn(result: ws.Result, picture: Path) -> None:
    """The picture of the guide: how many holes are served from each cell."""
    result.plot.placements().savefig(picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else PICTURE)
