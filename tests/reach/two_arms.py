"""Two arms in a plane beside each other, in closed form: where both are free, and where they keep apart as well."""

import numpy as np

import wsrender as ws

RADIUS, FIRST, SECOND, AHEAD, BESIDE = 0.03, 0.5, 0.4, 0.1, 0.6  # the tip is ahead of the second link's capsule
ENDS = 2.6, 2.4  # of the hinges, to either side
WALL = 0.45  # y of what they keep out of; they stand at y = 0


def arm() -> dict:
    """A robot of a document: two links with capsules that turn in the x-y plane."""

    def link(name: str, at: float, end: float, length: float, inner: str) -> str:
        inertial = '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'
        joint = f'<joint name="{name}" type="hinge" axis="0 0 1" range="{-end} {end}"/>'
        geom = f'<geom name="{name}" type="capsule" size="{RADIUS}" fromto="0 0 0 {length} 0 0"/>'
        return f'<body name="{name}" pos="{at} 0 0">{inertial}{joint}{geom}{inner}</body>'

    second = link("second", FIRST, ENDS[1], SECOND - AHEAD, f'<site name="tool" pos="{SECOND} 0 0"/>')
    bodies = link("first", 0, ENDS[0], FIRST, second)
    return {"mjcf": f'<mujoco><compiler angle="radian"/><worldbody>{bodies}</worldbody></mujoco>'}


def both() -> tuple[dict, dict]:
    """The two, the other turned about."""
    return arm(), arm() | {"placement": {"position_m": [BESIDE, 0, 0], "rpy_deg": [0, 0, 180]}}


def wall() -> ws.Environment:
    """What neither enters."""
    return ws.Environment([ws.HalfSpace(name="wall", point_m=(0, WALL, 0), normal=(0, -1, 0))])


def labels(points: np.ndarray, *, wall: bool) -> dict[str, np.ndarray]:
    """Of points (N, 2), bool (N,): ``reached`` by both, ``free`` of the wall for both, ``apart`` in such postures.

    And ``margin`` (N,): how far what decides is from where that changes at least [m or rad].
    """
    postures, margin = [], np.full(len(points), np.inf)
    for base, turned in ((np.zeros(2), 0.0), (np.array([BESIDE, 0]), np.pi)):
        own = points - base
        cosine = ((own**2).sum(axis=1) - FIRST**2 - SECOND**2) / (2 * FIRST * SECOND)
        margin = np.minimum(margin, np.abs(1 - np.abs(cosine)))
        of_arm = []
        for sign in (1, -1):
            q2 = sign * np.arccos(np.clip(cosine, -1, 1))
            at = np.arctan2(own[:, 1], own[:, 0]) - np.arctan2(SECOND * np.sin(q2), FIRST + SECOND * np.cos(q2))
            q1 = np.remainder(at - turned + np.pi, 2 * np.pi) - np.pi
            there = (np.abs(cosine) <= 1) & (np.abs(q1) <= ENDS[0]) & (np.abs(q2) <= ENDS[1])
            margin = np.minimum.reduce([margin, np.abs(ENDS[0] - np.abs(q1)), np.abs(ENDS[1] - np.abs(q2))])
            elbow = base + FIRST * np.stack([np.cos(at), np.sin(at)], axis=1)
            end = elbow + (1 - AHEAD / SECOND) * (points - elbow)
            clear = np.full(len(points), np.inf)
            if wall:
                clear = WALL - RADIUS - np.maximum.reduce([np.full(len(points), base[1]), elbow[:, 1], end[:, 1]])
                margin = np.minimum(margin, np.abs(clear))
            of_arm.append((there, there & (clear >= 0), [(np.broadcast_to(base, elbow.shape), elbow), (elbow, end)]))
        postures.append(of_arm)
    reached, free = ([np.logical_or(*(each[k] for each in of_arm)) for of_arm in postures] for k in (0, 1))
    apart = np.zeros(len(points), bool)
    for _, free_a, links_a in postures[0]:
        for _, free_b, links_b in postures[1]:
            gap = np.min([_distance(a, b) for a in links_a for b in links_b], axis=0) - 2 * RADIUS
            apart |= free_a & free_b & (gap >= 0)
            margin = np.minimum(margin, np.abs(gap))
    return {"reached": reached[0] & reached[1], "free": free[0] & free[1], "apart": apart, "margin": margin}


def areas(levels: int = 1500, *, wall: bool) -> dict[str, float]:
    """Areas [m²] where `labels` hold, by the midpoint rule over the square around the first arm."""
    edge = 2 * (FIRST + SECOND) / levels
    middle = -(FIRST + SECOND) + edge * (np.arange(levels) + 0.5)
    x, y = np.meshgrid(middle, middle, indexing="ij")
    found = labels(np.stack([x.ravel(), y.ravel()], axis=1), wall=wall)
    return {name: float(found[name].sum() * edge**2) for name in ("reached", "free", "apart")}


def _distance(a: tuple[np.ndarray, np.ndarray], b: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Of segments in a plane, (N,): 0 where they cross, else from an end of one to the other."""

    def cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]

    def of_point(p: np.ndarray, segment: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        start, along = segment[0], segment[1] - segment[0]
        t = np.clip(((p - start) * along).sum(axis=1) / (along**2).sum(axis=1), 0, 1)
        return np.linalg.norm(start + t[:, None] * along - p, axis=1)

    sides = [cross(s[1] - s[0], o[0] - s[0]) * cross(s[1] - s[0], o[1] - s[0]) < 0 for s, o in ((a, b), (b, a))]
    ends = np.min([of_point(p, other) for segment, other in ((a, b), (b, a)) for p in segment], axis=0)
    return np.where(sides[0] & sides[1], 0.0, ends)
