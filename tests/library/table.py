"""Library robots side by side: ``python -m tests.library.table [name …]``, all by default; what is odd is marked.

A row each: joints, payload, reach, the headline of a workspace of 2^18 Sobol samples, its share of the ball of the
reach, and in how many of 2,000 random configurations the shapes touch. A model in the wrong unit or with a wrong length
stands out by its share of the ball, shapes too coarse by how often they touch.
"""

import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass

import wsrender as ws
from tests.library.readme import collision_share
from wsrender.robots import library

SAMPLES = 2**18
CONFIGURATIONS = 2000
BALL = (0.25, 2.2)  # of the reach: what the tip reaches; makers measure to the wrist or the flange, tools are beyond
TOUCHING = 30.0  # [%]


@dataclass(frozen=True)
class Row:
    """Numbers of a robot, in m, m³, kg and %; None where there is none."""

    name: str
    joints: int
    payload_kg: float | None
    reach_m: float | None
    volume_m3: float | None
    touching: float

    @property
    def of_the_ball(self) -> float | None:
        """The headline by the volume of a ball whose radius is the reach."""
        if self.reach_m is None or self.volume_m3 is None:
            return None
        return self.volume_m3 / (4 / 3 * math.pi * self.reach_m**3)

    @property
    def odd(self) -> list[str]:
        """What to look at."""
        share = self.of_the_ball
        ball = [] if share is None or BALL[0] <= share <= BALL[1] else ["volume"]
        return ball + (["touching"] if self.touching > TOUCHING else [])


def rows(names: list[str]) -> Iterator[Row]:
    """A row for each robot of these names."""
    robots = {robot.name: robot for robot in library.describe()}
    for name in names:
        robot = robots[name]
        headline = ws.workspace(name, sampling=ws.Sobol(SAMPLES)).document["headline"]
        volume = headline["value"] if headline["quantity"] == "volume" else None
        touching = collision_share(name, CONFIGURATIONS)
        yield Row(name, robot.joints, robot.payload_kg, robot.reach_m, volume, touching)


def main(names: list[str]) -> None:
    """Print the table."""
    print("| robot | joints | payload [kg] | reach [m] | volume [m³] | of the ball | touching [%] | look at |")
    print("| --- | --: | --: | --: | --: | --: | --: | --- |")
    for row in rows(names or library.names()):
        numbers = (row.payload_kg, row.reach_m, row.volume_m3, row.of_the_ball, row.touching)
        said = ["—" if number is None else f"{number:.3g}" for number in numbers]
        print(f"| {row.name} | {row.joints} | {' | '.join(said)} | {', '.join(row.odd)} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
