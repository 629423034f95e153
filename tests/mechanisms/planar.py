"""Planar mechanisms that tests share, and the area of what their legs allow."""

import numpy as np

BASE = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.8]]
PLATFORM = [[-0.1, -0.06], [0.1, -0.06], [0.0, 0.12]]
LINKS = (0.5, 0.35)


def rrr(base, platform, links=LINKS, height=0.2) -> dict:
    """A serial leg of three hinges about z that holds the platform's pose."""
    body = (
        f'<body pos="{base[0]} {base[1]} {height}"><joint name="a" type="hinge" axis="0 0 1"/><geom size=".01"/>'
        f'<body pos="{links[0]} 0 0"><joint name="b" type="hinge" axis="0 0 1"/><geom size=".01"/>'
        f'<body pos="{links[1]} 0 0"><joint name="c" type="hinge" axis="0 0 1"/><geom size=".01"/>'
        '<site name="tool"/></body></body></body>'
    )
    mjcf = f'<mujoco><compiler autolimits="true"/><worldbody>{body}</worldbody></mujoco>'
    attachment = {"position_m": [*platform, 0.0]}
    return {"type": "serial", "robot": {"mjcf": mjcf}, "attachment": attachment, "actuated": ["a"], "holds": "pose"}


def three_rrr(**fields) -> dict:
    """A planar 3-RRR in the plane z = 0.2 of its base."""
    return {"legs": [rrr(b, p) for b, p in zip(BASE, PLATFORM, strict=True)], **fields}


def annuli_area(lines: int = 20_001) -> float:
    """Area [m²] of the intersection of the three annuli at the level orientation, by exact lengths of lines y = const.

    Chord by chord (Simpson's rule across): along each line the annuli are intervals.
    """
    centres = np.array(BASE) - PLATFORM
    outer, inner = sum(LINKS), LINKS[0] - LINKS[1]
    y = np.linspace((centres[:, 1] - outer).max(), (centres[:, 1] + outer).min(), lines)
    lengths = np.array([_length(centres, outer, inner, value) for value in y])
    return float(np.trapezoid(lengths, y))


def _length(centres: np.ndarray, outer: float, inner: float, y: float) -> float:
    ends = sorted({x for c in centres for r in (outer, inner) for x in _crossings(c, r, y)})
    middles = np.add(ends[1:], ends[:-1]) / 2
    distance = np.hypot(middles[:, None] - centres[:, 0], y - centres[:, 1])
    inside = ((distance <= outer) & (distance >= inner)).all(axis=1)
    return float((np.diff(ends) * inside).sum())


def _crossings(centre: np.ndarray, radius: float, y: float) -> list[float]:
    square = radius**2 - (y - centre[1]) ** 2
    return [centre[0] - np.sqrt(square), centre[0] + np.sqrt(square)] if square > 0 else []
