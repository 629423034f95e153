"""Results of every analysis have a view."""

from typing import Any

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from tests.golden.files import golden_names
from wsrender.results.view import manifest, view_of
from wsrender.results.view.interactive import Interactive

SCHEMA = Draft202012Validator(manifest.MANIFEST.json_schema())


@pytest.mark.parametrize("name", golden_names())
def test_the_view_of_every_analysis_is_one(name, local):
    """Valid, without a word of what is left out, and with every blob as long as it says."""
    view = view_of(local(name))
    shown: Any = view.manifest
    assert list(SCHEMA.iter_errors(shown)) == []
    assert view.manifest["omitted"] == []
    assert drawn(view.manifest), "nothing is shown"
    told = {data["blob"]: data for data in data_in(view.manifest)}
    assert set(told) <= set(view.blobs)
    for blob, data in told.items():
        size = {"glb": 1, "uint8": 1, "uint16": 2, "float16": 2}.get(data["type"], 4)
        assert len(view.blobs[blob]) == size * data["length"]


@pytest.mark.parametrize("name", golden_names())
def test_the_robots_of_every_view_can_be_asked(name, local):
    """Each by its number in the view, where it stands there."""
    result = local(name)
    shown, looking = view_of(result).manifest["robots"], Interactive.of_result(result)
    assert len(looking.robots) == len(shown)
    for number, (robot, entry) in enumerate(zip(looking.robots, shown, strict=True)):
        assert entry["chain"]["joints"] == list(robot.joint_names)
        np.testing.assert_array_equal(entry["chain"]["T_base"], robot.chain.T_world_base.ravel())
        at = looking.answer({"ask": "indices_at", "robot": number, "q": entry["home"]})[0]["position_m"]
        np.testing.assert_allclose(at, robot.forward_kinematics(entry["home"])[0, :3, 3], atol=1e-12)


def drawn(shown):
    """What of a manifest stands in space or beside it."""
    parts = ("robots", "skeletons", "volumes", "meshes", "points", "glyphs", "curves", "maps", "plots")
    return [part for part in parts if shown[part]]


def data_in(part):
    if isinstance(part, dict):
        if "blob" in part:
            yield part
        else:
            yield from (each for value in part.values() for each in data_in(value))
    elif isinstance(part, list):
        yield from (each for value in part for each in data_in(value))
