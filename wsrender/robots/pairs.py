"""Which shapes of a robot may collide: by the rules of MuJoCo, and but for those that a user excludes."""

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from itertools import combinations

import mujoco
import numpy as np

from wsrender.errors import InputError
from wsrender.robots.shapes import Shape

Names = tuple[str, str]
MOST_NAMED = 10  # names that a hint lists


def pairs_of(model: mujoco.MjModel, geoms: Sequence[int]) -> np.ndarray:
    """Pairs of ``geoms`` that MuJoCo tests, as their places in it, (P, 2) int, each and all in ascending order.

    An explicit pair always; else geoms whose contype and conaffinity meet, on bodies that a joint separates, that are
    not excluded, and not parent and child. Bodies without a joint between them count as one; the world's are nobody's
    parent (MuJoCo, "Collision detection: selection").
    """
    explicit = {frozenset(pair) for pair in zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True)}
    excluded = {frozenset(divmod(int(signature), 2**16)) for signature in model.exclude_signature}
    body = model.geom_bodyid
    return np.array(
        [
            (i, j)
            for (i, first), (j, second) in combinations(enumerate(geoms), 2)
            if frozenset((first, second)) in explicit
            or (
                _meet(model, first, second)
                and frozenset((int(body[first]), int(body[second]))) not in excluded
                and not _rigid_or_adjacent(model, int(body[first]), int(body[second]))
            )
        ],
        int,
    ).reshape(-1, 2)


def pairs_of_child(model: mujoco.MjModel, geoms: Sequence[int], body: int, count: int) -> np.ndarray:
    """Pairs (P, 2) int of ``geoms`` with further shapes, numbered on up to ``count``, of a body fixed to ``body``.

    Those shapes have contype and conaffinity 1, MuJoCo's defaults; excludes do not name their body.
    """
    bits = (model.geom_contype | model.geom_conaffinity)[list(geoms)]
    met = np.flatnonzero(apart_from_child(model, geoms, body) & (bits & 1 != 0)).tolist()
    return np.array([(i, j) for j in range(len(geoms), count) for i in met], int).reshape(-1, 2)


def apart_from_child(model: mujoco.MjModel, geoms: Sequence[int], body: int, *, jointed: bool = False) -> np.ndarray:
    """Whether MuJoCo tests ``geoms`` against another body's whose bits they meet, (G,) bool.

    That body is fixed to ``body``, or where ``jointed`` its child across a joint.
    """
    own = [int(model.geom_bodyid[geom]) for geom in geoms]
    if not jointed:
        return np.array([not _rigid_or_adjacent(model, body, each) for each in own], bool)
    parents_count = bool(model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_FILTERPARENT)
    parent = int(model.body_weldid[body])
    return np.array([parents_count or int(model.body_weldid[each]) != parent for each in own], bool)


def collides(model: mujoco.MjModel) -> list[int]:
    """The geoms that may collide at all, with whatever there is."""
    bits = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    bits[model.pair_geom1] = bits[model.pair_geom2] = True
    return np.flatnonzero(bits).tolist()


def meet(first: tuple[int, int], second: tuple[int, int]) -> bool:
    """Whether contype of one and conaffinity of the other have a bit in common."""
    return bool(first[0] & second[1] or second[0] & first[1])


def _meet(model: mujoco.MjModel, first: int, second: int) -> bool:
    types, affinities = model.geom_contype, model.geom_conaffinity
    return meet((int(types[first]), int(affinities[first])), (int(types[second]), int(affinities[second])))


def _rigid_or_adjacent(model: mujoco.MjModel, first: int, second: int) -> bool:
    a, b = int(model.body_weldid[first]), int(model.body_weldid[second])
    if a == b:
        return True
    if not (a and b) or model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_FILTERPARENT:
        return False
    above = model.body_weldid[model.body_parentid]
    return bool(above[a] == b or above[b] == a)


def without(pairs: np.ndarray, shapes: Sequence[Shape], excluded: Iterable[Names], field: str) -> np.ndarray:
    """The pairs (P, 2) but for those of ``excluded`` names, each a shape's, or a body's for all shapes on it.

    Raises InputError, at the entry in ``field``, for a name that is neither.
    """
    known, dropped = dict.fromkeys(name for shape in shapes for name in (shape.name, shape.body)), set[frozenset[str]]()
    for entry, names in enumerate(excluded):
        for name in names:
            if name not in known:
                told = f"no shape, and no body that has one, is named {name!r}; {_hint(name, list(known))}"
                raise InputError(f"{field}.{entry}", told)
        dropped.add(frozenset(names))

    def stays(i: int, j: int) -> bool:
        first, second = shapes[i], shapes[j]
        return not any(
            frozenset((a, b)) in dropped for a in (first.name, first.body) for b in (second.name, second.body)
        )

    return np.array([pair for pair in pairs.tolist() if not dropped or stays(*pair)], int).reshape(-1, 2)


def _hint(name: str, known: Sequence[str]) -> str:
    if close := get_close_matches(name, known, n=3):
        return f"did you mean {' or '.join(map(repr, close))}?"
    more = f" and {len(known) - MOST_NAMED} more" if len(known) > MOST_NAMED else ""
    return f"there are {', '.join(known[:MOST_NAMED])}{more}"
