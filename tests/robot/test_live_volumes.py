"""Volumes that follow limits, tool and placement, against jobs of the robot so changed."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.errors import InputError
from wsrender.results.view.interactive import Choices
from wsrender.robot.live_volumes import LiveVolumes

COUNT, VOXEL, SEED = 1 << 14, 0.1, 5
TOOL = {"position_m": [0.05, 0.0, 0.2]}
FAR = {"position_m": [30.0, -2.0, 1.0]}


def matrix(transform):
    T = np.eye(4)
    T[:3, 3] = transform["position_m"]
    return T


def job_volume(robot, statistic="maximum", **fields):
    job = {"analysis": "workspace", "robot": robot, "sampling": {"method": "sobol", "count": COUNT, "seed": SEED}}
    job |= {"indices": ["manipulability"], "voxel_size_m": VOXEL, "voxel_statistics": [statistic]}
    return ws.execute(job | {"refined_volume": None, "device": "cpu"} | fields).volume


def same(live, volume, statistic):
    """Whether both hold the same voxels of the world lattice with the same bits."""
    at = np.add(live.voxels.at.T, live.block.first_voxel)
    np.testing.assert_array_equal(at, np.add(volume.voxels.at.T, volume.first_voxel))
    np.testing.assert_array_equal(live.voxels.count, volume.voxels.count)
    if statistic != "count":
        found, expected = (each.statistics[statistic]["manipulability"] for each in (live.voxels, volume.voxels))
        assert found.tobytes() == expected.tobytes()


@pytest.mark.parametrize("statistic", ["maximum", "mean", "count"])
@pytest.mark.parametrize(
    "changed",
    [
        {"limits": {"joint2": (-1.0, 0.3), "joint1": (0.1, 0.2)}},
        {"limits": {"joint3": (-6.0, 6.5)}},
        {"tool": TOOL, "placement": FAR, "limits": {"joint2": (0.0, 0.02)}},
    ],
    ids=["narrower", "wider", "placed"],
)
def test_it_is_the_volume_of_a_job_with_those_limits(statistic, changed):
    live = LiveVolumes(ws.load_robot("puma560"), Choices(), seed=SEED)
    matrices = {name: matrix(changed[name]) for name in ("tool", "placement") if name in changed}
    found = live.volume("manipulability", statistic, COUNT, VOXEL, limits=changed["limits"], **matrices)
    limits = {name: list(ends) for name, ends in changed["limits"].items()}
    same(found, job_volume({"library": "puma560", **changed, "limits": limits}, statistic), statistic)


def test_the_block_stays_while_limits_move_within_the_robots_own():
    live = LiveVolumes(ws.load_robot("puma560"), Choices())
    blocks = [
        live.volume("manipulability", "count", 1 << 10, VOXEL, limits={"joint2": (-1.0, high)}).block
        for high in (-0.9, 0.5)
    ]
    assert blocks[0] == blocks[1] == live.volume("manipulability", "count", 1 << 10, VOXEL).block


def test_constraints_and_locked_joints_are_the_jobs():
    constraints = {"self_collision": True}
    locked = {"joint6": 0.5}
    live = LiveVolumes(ws.load_robot("ur5e"), Choices(constraints=constraints, locked=locked), seed=SEED)
    limits = {"joint3": (1.0, 2.8)}
    found = live.volume("manipulability", "maximum", COUNT, VOXEL, limits=limits)
    sampling = {"method": "sobol", "count": COUNT, "seed": SEED, "locked": locked}
    robot = {"library": "ur5e", "limits": {name: list(ends) for name, ends in limits.items()}}
    same(found, job_volume(robot, constraints=constraints, sampling=sampling), "maximum")
    free = LiveVolumes(ws.load_robot("ur5e"), Choices(locked=locked), seed=SEED)
    without = free.volume("manipulability", "maximum", COUNT, VOXEL, limits=limits)
    assert without.voxels.count.sum() == COUNT > found.voxels.count.sum()


def test_progress_that_raises_ends_the_sweep():
    class EnoughError(Exception):
        pass

    seen = []

    def look(done):
        seen.append(done)
        if done:
            raise EnoughError

    live = LiveVolumes(ws.load_robot("puma560"), Choices(), threads=1)
    with pytest.raises(EnoughError):
        live.volume("manipulability", "maximum", 1 << 24, VOXEL, progress=look)
    assert 0 < seen[-1] < 1 << 22


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"limits": {"joint9": (0.0, 1.0)}}, "limits.joint9"),
        ({"limits": {"joint1": (1.0, 1.0)}}, "limits.joint1"),
        ({"most_voxels": 100}, "voxel_size_m"),
    ],
)
def test_what_is_not_allowed_is_named(given, field):
    live = LiveVolumes(ws.load_robot("puma560"), Choices())
    with pytest.raises(InputError) as raised:
        live.volume("manipulability", "maximum", 1 << 10, VOXEL, **given)
    assert raised.value.field == field
