"""Whether a robot is the one that a result is of."""

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.robot import Robot, as_robot, load_robot

_POSES = ("T_world_base", "T_tip_tool")


def own_robot(robot: Any, entries: Sequence[Mapping[str, Any]]) -> tuple[int, Robot]:
    """Which of a result's robots this is, and the robot as it stood there.

    ``robot`` is what `wsrender.load_robot` takes (then base, tip and placement are those of the result), or a Robot;
    ``entries`` are the parts of the result document about each robot. Entries without hashes fit any robot. Raises
    InputError naming both for another arm, or for the same with another base, tip, tool or placement.
    """
    given = as_robot(robot)
    same = [k for k, entry in enumerate(entries) if _same_model(given, entry)]
    if not same:
        raise InputError("robot", _another(given, entries))
    for k in same:
        placed = _as_in_result(robot, entries[k]) if isinstance(robot, str | Path) else given
        if _same_frames(placed, entries[k]):
            return k, placed
    raise InputError("robot", _stands_elsewhere(given, entries[same[0]]))


def _same_model(robot: Robot, entry: Mapping[str, Any]) -> bool:
    if "model_hash" not in entry:
        return True
    return robot.model_hash == entry["model_hash"] or robot.chain.content_hash == entry.get("chain_hash")


def _as_in_result(robot: str | Path, entry: Mapping[str, Any]) -> Robot:
    names = {name: entry.get(f"{name}_frame") for name in ("base", "tip")}
    placement, tool = (np.array(entry[name]) if name in entry else None for name in _POSES)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the model: said when it was loaded to be compared
        return load_robot(robot, **names, placement=placement, tool=tool)


def _same_frames(robot: Robot, entry: Mapping[str, Any]) -> bool:
    names = ("base_frame", "tip_frame")
    return all(getattr(robot, name) == entry.get(name, getattr(robot, name)) for name in names) and all(
        np.allclose(getattr(robot.chain, name), entry[name], rtol=0, atol=1e-9) for name in _POSES if name in entry
    )


def _another(robot: Robot, entries: Sequence[Mapping[str, Any]]) -> str:
    own = " and ".join(f"{entry.get('name', 'another')} (model {_short(entry)})" for entry in entries)
    mine = _short({"model_hash": robot.model_hash})
    return f"{robot.name} (model {mine}) is another arm than that of the result, {own}; give its model, or no robot"


def _stands_elsewhere(robot: Robot, entry: Mapping[str, Any]) -> str:
    frames = f"from {robot.base_frame} to {robot.tip_frame}"
    own = f"from {entry.get('base_frame')} to {entry.get('tip_frame')}"
    return (
        f"{robot.name} goes {frames} where it is placed; in the result, {entry.get('name')} goes {own}, with its own "
        "placement and tool; load it with the same base, tip, placement and tool"
    )


def _short(entry: Mapping[str, Any]) -> str:
    return str(entry.get("model_hash", "unknown"))[:8]
