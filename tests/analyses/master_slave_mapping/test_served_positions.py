"""Mappings of arms under constraints: what an admissible posture serves, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

import wsrender as ws
from tests.reach.guarded_arms import COLUMN, FIRST, RADIUS, ROUND, SECOND, STROKE, scara, scara_labels, spherical
from wsrender.errors import InputError
from wsrender.geometry.alpha_shape import AlphaShape
from wsrender.mapping import SERVED, ServedShape, ServedVoxels
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.served_positions import served_positions
from wsrender.run import execute

COUNT = 4096
BESIDE_COLUMN = {
    "sampling": {"method": "sobol", "count": COUNT},
    "environment": {"items": [{"shape": "cylinder", "position_m": [*COLUMN, 0], "radius_m": ROUND, "length_m": 2.0}]},
}


@pytest.fixture(scope="module")
def positions():
    arm = scara()
    pipeline = replace(tip_pipeline(arm.robot.chain, ws.Sobol(COUNT)), constraints=arm.constraints)
    return served_positions(pipeline)


def mapped(robots, master, slave, **fields):
    job = {"analysis": "master_slave_mapping", "master": {"robot": "scara"} | master, "slave": slave, "device": "cpu"}
    return execute(job | fields, robot=robots)


def test_a_position_is_served_by_any_admitted_posture(positions):
    """Of both elbows in closed form, where the sample's own may be rejected."""
    _, free, _ = scara_labels(positions.position)
    assert len(free) == COUNT - positions.undecided and positions.undecided <= COUNT // 1000
    np.testing.assert_array_equal(positions.reasons == SERVED, free)
    assert positions.rejected.sum() > 3 * (~free).sum() > 100


@pytest.mark.parametrize("kind", ["shape", "voxels"])
def test_targets_go_with_the_positions_around_them(positions, kind):
    """Nearly all of what is blocked in closed form; and volumes are those of what is served."""
    if kind == "shape":
        space = ServedShape(AlphaShape.of(positions.position), positions.reasons)
    else:
        space = ServedVoxels.of(positions.position, positions.reasons, 0.05)
    low, high = np.array([-1.0, -1.0, -STROKE]), np.array([1.0, 1.0, 0.0])
    targets = np.random.default_rng(0).uniform(low, high, (100_000, 3))
    reach, free, _ = scara_labels(targets)
    found = space.reason(targets)
    beyond = found[np.linalg.norm(targets[:, :2], axis=1) > FIRST + SECOND + 0.1]
    assert (beyond == -1).all()
    assert (found[reach & ~free] == SERVED).mean() < 0.15 and ((found == 1) & free).sum() < 0.01 * free.sum()
    assert space.volume_m3 == pytest.approx(space.contains(targets).mean() * np.prod(high - low), rel=0.02)
    if isinstance(space, ServedShape):
        assert space.volume_m3 < 0.99 * space.shape.volume_m3 and space.served().volume_m3 < space.volume_m3


def test_a_shape_of_served_positions_alone_has_its_bits(positions):
    """Summed in the same order, whatever the threads: those of BLAS change the last bits of its products."""
    for count in range(1000, 4000, 500):
        shape = AlphaShape.of(positions.position[:count])
        assert ServedShape(shape, np.zeros(count, np.int8)).volume_m3 == shape.volume_m3


def test_most_positions_of_a_voxel_say_what_it_is():
    at = np.repeat([[0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [2.5, 0.5, 0.5]], [3, 2, 3], axis=0)
    space = ServedVoxels.of(at, np.array([0, 2, 2, 0, 1, 0, 0, 1], np.int8), 1.0)
    assert space.reason(at[[0, 3, 5]]).tolist() == [2, SERVED, SERVED] and space.volume_m3 == 2


def test_failing_targets_have_their_reason():
    """A cluster in the column, one beyond the arm, and one that both elbows serve."""
    corners = 0.02 * (np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T)
    centres = np.array([[*COLUMN, -0.1], [1.5, 0, -0.1], [-0.5, 0.3, -0.1]])
    targets = np.concatenate([centre + corners for centre in centres])
    reach, free, _ = scara_labels(targets)
    assert (reach.tolist(), free.tolist()) == ([True] * 8 + [False] * 8 + [True] * 8, [False] * 16 + [True] * 8)
    result = mapped([scara().robot], BESIDE_COLUMN, {"points": targets.tolist()})
    failing = result.tables["failing"]
    assert failing["reason"].tolist() == ["blocked by environment"] * 8 + ["out of reach"] * 8
    np.testing.assert_allclose(failing["slave_position"], targets[:16])
    assert result.document["mapping"]["reasons"] == {"out of reach": 8, "blocked by environment": 8}
    assert "(8 out of reach, 8 blocked by environment)" in result.summary()
    assert result.plot.title.endswith("admitted by environment") and "admitted of master " in result.summary()
    samples = result.document["admission"]["master"]
    assert samples["drawn"] == COUNT == samples["admitted"] + samples["rejected"]["environment"]
    assert samples["positions"]["served"] + samples["positions"]["blocked"]["environment"] == COUNT
    free = mapped([scara().robot], {"sampling": BESIDE_COLUMN["sampling"]}, {"points": targets.tolist()}).document
    assert free["mapping"]["failing_points"] == 8 and "reasons" not in free["mapping"] and "admission" not in free


def test_a_slaves_blocked_positions_are_no_targets():
    result = mapped(
        [scara().robot, scara().robot], {"sampling": BESIDE_COLUMN["sampling"]}, BESIDE_COLUMN | {"robot": "scara"}
    )
    places = result.tables["mapping"]
    own = places["position"][places["slave"]]
    assert scara_labels(own)[1].all() and len(own) == result.document["admission"]["slave"]["positions"]["served"]
    assert list(result.document["admission"]) == ["slave"] and "reason" not in result.tables["failing"].columns
    volumes = result.document["volume_m3"]
    assert volumes["slave"] < 0.995 * volumes["master"]


def test_a_search_ends_at_a_wall():
    """A cube of .1 m scaled by S ends at x = .05 S, of a master whose wall leaves x <= .07: S = 1.4."""
    cube = 0.05 * np.array(np.meshgrid(*[[-1, 0, 1]] * 3)).reshape(3, -1).T
    wall = {"items": [{"shape": "half_space", "point_m": [0.07 + RADIUS, 0, 0], "normal": [-1, 0, 0]}]}
    master = {"sampling": {"method": "sobol", "count": 4 * COUNT}}
    fields = {"offsets_m": [[0, 0.42, 0]], "search": {"scale": [0.5, 3.5], "steps": 26}}
    beside, alone = (
        mapped([spherical().robot], master | more, {"points": cube.tolist()}, **fields).document["mapping"]
        for more in ({"environment": wall}, {})
    )
    half = 0.6  # .03 m, the positions' spacing
    assert beside["scale"][0] == pytest.approx(1.4, abs=half) and beside["succeeded"]
    assert alone["scale"][0] == pytest.approx(2.85, abs=half) and alone["succeeded"]


@pytest.mark.parametrize("side", ["master", "slave"])
def test_errors_name_the_side(side):
    other = {"points": np.eye(4, 3).tolist()}
    arm = {"robot": "spherical", "constraints": {"self_collision": {"exclude": [["nobody", "either"]]}}}
    job = {"analysis": "master_slave_mapping", "master": other, "slave": other, side: arm}
    with pytest.raises(InputError, match="nobody") as error:
        execute(job)
    assert error.value.field.startswith(f"{side}.constraints.self_collision.exclude")
    nowhere = {"region": {"sphere": {"radius_m": 0.01, "position_m": [9, 9, 9]}}}
    with pytest.raises(InputError, match="admit none") as error:
        execute(
            job | {side: {"robot": "spherical", "sampling": {"method": "sobol", "count": 64}, "constraints": nowhere}}
        )
    assert error.value.field == f"{side}.constraints"


@pytest.mark.parametrize("containment", [{}, {"kind": "voxels", "voxel_size_m": 0.3}], ids=["shape", "voxels"])
@pytest.mark.parametrize("side", ["master", "slave"])
def test_served_positions_among_blocked_ones_enclose_nothing(side, containment):
    """The three of 512 that a ball admits make no tetrahedron, and are nowhere most of those in a voxel."""
    other = {"points": [[0, 0, 0], *(0.05 * np.eye(3)).tolist()]}
    ball = {"region": {"sphere": {"radius_m": 0.2, "position_m": [0.5, 0, 0]}}}
    arm = {"robot": "ur5e", "sampling": {"method": "sobol", "count": 512}, "constraints": ball}
    job = {"analysis": "master_slave_mapping", "master": other, "slave": other, side: arm, "containment": containment}
    with pytest.raises(InputError, match="leave 3 of 512 positions, scattered among blocked ones") as error:
        execute(job | {"device": "cpu"})
    assert error.value.field == f"{side}.constraints"


@pytest.mark.parametrize("side", ["master", "slave"])
def test_points_that_enclose_nothing_name_their_side(side):
    flat, solid = {"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}, {"points": np.eye(4, 3).tolist()}
    for containment in ({}, {"kind": "voxels", "voxel_size_m": 0.3}):
        job = {"analysis": "master_slave_mapping", "master": solid, "slave": solid, side: flat}
        with pytest.raises(InputError, match="are 3 points in a plane") as error:
            execute(job | {"containment": containment})
        assert error.value.field == f"{side}.points"
