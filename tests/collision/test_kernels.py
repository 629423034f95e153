"""The filter as it is written for CUDA beside the one of the CPU, and what each pass leaves to the next."""

from dataclasses import replace

import numpy as np
import pytest
import warp as wp
from wsrender_kernels.collision import CAPACITY, filter_kernel, narrow_kernel
from wsrender_kernels.collision_unrolled import MOST_TESTS, unrolled

import wsrender as ws
from tests.collision.robots import drawn, nearest, random_text
from tests.collision.test_labels import AROUND, pipeline
from tests.collision.test_labels import labels as rejected
from wsrender.documents.constraints import Constraints
from wsrender.engine import configurations, devices_of
from wsrender.engine.collision import _on_device, collisions_of
from wsrender.engine.drawn_configurations import device_space
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.engine.sweep_plan import SweepPlan
from wsrender.robot.constraints import constraints_for

N = 1 << 15
SELF = Constraints(self_collision=True)
WORLD = ws.Environment(
    [
        ws.HalfSpace(name="floor", point_m=(0, 0, -0.05)),
        ws.Box(name="box", size_m=(0.2, 0.2, 0.2), position_m=(0.4, 0, 0.4)),
    ]
)


def collisions(robot, environment=None, count=N):
    """What labels, and the sample space, of random configurations."""
    each = pipeline(robot, ws.Random(count), constraints_for(robot, SELF, environment))
    (device,) = devices_of("cpu")
    return collisions_of(each, SweepPlan(each).shape, device, count), device_space(each.sampling, "float32", device)


def filtered(own, space, kernel, tasks):
    """Labels (N,), masks (N, words), and whether a sample is listed (N,), by a filter."""
    device, words = own.device, own.words
    labels, listed = wp.zeros(N, dtype=wp.uint8, device=device), wp.zeros(1, dtype=wp.int32, device=device)
    ids, masks = (wp.zeros(N * k, dtype=t, device=device) for k, t in ((1, wp.int32), (words, wp.uint32)))
    inputs, outputs = [own._programs[0], space, 0, N], [labels, listed, ids, masks]
    launch(loaded(kernel, device), dim=tasks, inputs=inputs, outputs=outputs, device=device)
    at = ids.numpy()[: listed.numpy()[0]]
    found, open_ = np.zeros((N, words), np.uint32), np.zeros(N, bool)
    found[at], open_[at] = masks.numpy().reshape(N, words)[: len(at)], True
    return labels.numpy(), found, open_


@pytest.mark.parametrize("case", ["ur5e", "ur5e in a world", "franka_panda", 6, 7, 8, 10, 12])
def test_the_filter_written_for_one_robot_says_what_the_one_for_all_says(case):
    if isinstance(case, int):
        robot, environment = ws.load_robot(random_text(case, 4)), AROUND
    else:
        robot, environment = ws.load_robot(case.split()[0]), WORLD if "world" in case else None
    own, space = collisions(robot, environment)
    program, joints = own.program, len(own.chain.joint_source)
    size = max(-(-len(program.capsules) // CAPACITY), 1) * CAPACITY
    of_all = filter_kernel(wp.float32, own.chain.n, joints, size, own.words, "random", 0, False)
    of_one = filter_kernel(
        wp.float32, own.chain.n, joints, size, own.words, "random", 0, True, unrolled(program, own.words)
    )
    labels, masks, open_ = filtered(own, space, of_all, N // 256)
    found, own_masks, own_open = filtered(own, space, of_one, N)
    same = open_ == own_open
    assert same.mean() > 0.9999  # rounding may move one that lies on a bound
    np.testing.assert_array_equal(found[same], labels[same])
    assert (own_masks[same] == masks[same]).all(axis=1).mean() > 0.9999
    assert (open_.any() or case == "franka_panda") and not open_.all() and (labels > 0).any()


def test_the_filter_written_for_one_robot_decides_nothing_beyond_the_limits():
    """Limits are those of the robot, but for one half of its first joint's range."""
    own, space = collisions(ws.load_robot("ur5e"))
    upper = own.program.upper.copy()
    upper[0] = (own.program.lower[0] + upper[0]) / 2
    own.program = replace(own.program, upper=upper)
    own._programs = _on_device(own.program, own.pairs, own.words, own.device)
    joints = len(own.chain.joint_source)
    kernel = filter_kernel(
        wp.float32, own.chain.n, joints, CAPACITY, own.words, "random", 0, True, unrolled(own.program, own.words)
    )
    found, masks, open_ = filtered(own, space, kernel, N)
    beyond = np.asarray(configurations(own.pipeline))[:, 0] > upper[0] + 1e-3
    assert 0.4 < beyond.mean() < 0.6
    assert open_[beyond].all() and not found[beyond].any() and (masks[beyond] == 2**32 - 1).all()
    assert not open_[~beyond].all()


@pytest.mark.parametrize("name", ["filter", "narrow", "exact"])
def test_kernels_compile_for_cuda_without_a_gpu(name, tmp_path):
    """With surfaces, whose text is beside that of all others."""
    if name == "filter":
        kernel = filter_kernel(wp.float32, 6, 6, CAPACITY, 2, "random", 0, True, surfaces=True)
    else:
        kernel = narrow_kernel(wp.float32, 6, 6, 2, "random", True, name == "exact", surfaces=True)
    wp.compile_aot_module(kernel.module, device=None, arch=90, module_dir=str(tmp_path), use_ptx=True)
    assert list(tmp_path.glob("*.ptx"))


def test_what_rounding_decides_is_asked_of_mujoco():
    """Configurations within 1e-8 m of where MuJoCo says that shapes touch have the label that it gives."""
    robot = ws.load_robot(random_text(8, 4))
    constraints = constraints_for(robot, SELF, AROUND)
    q = drawn(robot, 4000)
    hit = np.any([nearest(each, q) < 0 for each in constraints], axis=0)
    count = min(hit.sum(), (~hit).sum(), 1000)
    free, blocked = q[~hit][:count], q[hit][:count]
    for _ in range(26):
        middle = (free + blocked) / 2
        touching = np.any([nearest(each, middle) < 0 for each in constraints], axis=0)[:, None]
        free, blocked = np.where(touching, free, middle), np.where(touching, middle, blocked)
    assert count > 100
    assert not rejected(robot, free, constraints, "float64").any()
    assert rejected(robot, blocked, constraints, "float64").all()


def test_a_program_of_too_many_tests_is_read_as_data():
    own, _ = collisions(ws.load_robot("ur5e"))
    assert unrolled(own.program, own.words) is not None
    pairs = own.program.pairs.copy()
    pairs[0, 2] += MOST_TESTS + 1 - pairs[:, 2].sum()
    assert unrolled(replace(own.program, pairs=pairs), own.words) is None


def test_float64_leaves_little_to_mujoco():
    own, space = collisions(ws.load_robot("ur5e"), WORLD, 1 << 18)
    own.label(space, 0, 1 << 18, (1 << 18) // 256)
    by_filter, narrow, exact, by_mujoco = own.decided.tolist()
    assert by_filter + narrow + exact + by_mujoco == 1 << 18
    assert min(by_filter, narrow, exact) > 0 and by_mujoco <= 0.3 * (exact + by_mujoco)
