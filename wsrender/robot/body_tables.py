"""Bodies of a robot as tables."""

from typing import TYPE_CHECKING

import numpy as np

from wsrender.volume.table import Table

if TYPE_CHECKING:
    from wsrender.robots.bodies import Bodies


def shape_table(bodies: "Bodies") -> Table:
    """A row for each shape; see `Robot.shapes`."""
    from scipy.spatial.transform import Rotation

    shapes = bodies.shapes
    T = np.array([shape.T_frame_shape for shape in shapes]).reshape(-1, 4, 4)
    quats = [Rotation.from_matrix(R).as_quat(scalar_first=True) for R in T[:, :3, :3]]
    sizes = [np.ptp(shape.vertices, axis=0) if shape.kind == "mesh" else shape.size for shape in shapes]
    texts = {name: np.array([getattr(shape, name) for shape in shapes], str) for name in ("name", "body", "kind")}
    columns = {
        **texts,
        "frame": np.array([shape.frame for shape in shapes], int),
        "position_m": T[:, :3, 3],
        "quat_wxyz": np.array(quats).reshape(-1, 4),
        "size_m": np.array(sizes).reshape(-1, 3),
        "vertices": np.array([len(shape.vertices) for shape in shapes], int),
        "surroundings": np.array([shape.surroundings for shape in shapes], bool),
        "rgba": np.array([shape.rgba for shape in shapes]).reshape(-1, 4),
    }
    return Table(columns, {"position_m": "m", "size_m": "m"})


def pair_table(bodies: "Bodies") -> Table:
    """A row for each pair of shapes; see `Robot.pairs`."""
    first, second = ([bodies.shapes[number] for number in column] for column in bodies.pairs.T)
    names = {"first": [shape.name for shape in first], "second": [shape.name for shape in second]}
    of = {"first_body": [shape.body for shape in first], "second_body": [shape.body for shape in second]}
    return Table({name: np.array(column, str) for name, column in (names | of).items()})
