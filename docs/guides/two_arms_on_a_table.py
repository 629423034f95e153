"""An arm on a table beside another arm: the volume that is free for it and the volume that they block, and a picture.

python docs/guides/two_arms_on_a_table.py [picture.png]
"""

import sys
from pathlib import Path

import wsrender as ws

PICTURE = Path(__file__).with_suffix(".png")
# The arms stand on the table's top, z = 0, and 0.6 m from each other.
AROUND = ws.Environment(
    [
        ws.Box(name="table", size_m=(1.0, 1.4, 0.05), position_m=(0.2, 0.3, -0.026)),
        ws.OtherRobot(
            name="neighbour",
            robot={"library": "franka_panda", "placement": {"position_m": [0, 0.6, 0]}},
            configuration=[0, 0.2, 0, -1.8, 0, 2.0, 0.8],
        ),
    ]
)


def analysed(samples: int = 4_000_000, tolerance: float | None = 0.01, **fields) -> ws.Result:
    """The UR5e's workspace off itself, the table and the other arm; ``tolerance``: of the free volume."""
    kept = {"self_collision": True, "environment": {"margin_m": 0.001}}
    options = {"refined_volume": tolerance, "indices": ["manipulability"], **fields}
    return ws.analyze("ur5e", ws.Sobol(samples), environment=AROUND, constraints=kept, **options)


def main(picture: Path) -> None:
    """Print the volumes and draw the picture."""
    result = analysed()
    volume = result.document["volume_m3"]
    print(result.document["headline"])
    print("blocked", volume["blocked"])
    print("undecided", volume["undecided"])
    print(result.document["samples"])
    drawn(result, picture)


def drawn(result: ws.Result, picture: Path) -> None:
    """The picture of the guide: planes through the arms' bases and above the table."""
    result.plot.admission(at=(0.1, 0.0, 0.3)).savefig(picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else PICTURE)
