"""Labels alone, whose poses are composed where they are solved for: those of `reachable`, however arrays come."""

import numpy as np
import pytest
import warp as wp
from scipy.spatial.transform import Rotation
from wsrender_kernels.closed_form import closed_labels_kernel
from wsrender_kernels.free_joint import FreeJointShape, free_joint_kernel

import wsrender as ws
from tests.engine.test_closed_form import in_the_box, near_limits
from tests.reach.test_closed_labels import solver
from tests.reference.arms_by_axes import PARALLEL, RELATIONS, random_arm, reversed_chain
from tests.reference.open_arms import open_arm
from tests.reference.redundant_arms import RANDOM_ARMS
from wsrender.engine import closed_labels
from wsrender.engine.closed_form import LANES, shape_of
from wsrender.reach import targets as reach_targets
from wsrender.reach.evidence import LABELS, REACHABLE, UNDECIDED, UNREACHABLE, Evidence
from wsrender.reach.inverse_solver import InverseSolver, closed_form_of
from wsrender.robots.closed_form import ClosedForm

PLACED = ws.Transform(position_m=(30, -0.2, 0.1), rpy_deg=(20, -30, 140))


def targets(chain, count, seed=0):
    """Positions and quaternions of lengths around 1, of poses at limits and a little beside, and of any in the box."""
    random = np.random.default_rng(seed)
    T = np.concatenate([chain.poses(near_limits(chain, count, seed)), in_the_box(chain, count, seed)])
    T[: count // 2, :3, 3] += random.normal(size=(count // 2, 3)) * 1e-4  # on both sides of the boundary
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    return T[:, :3, 3].copy(), quat * random.uniform(-3, 3, (len(T), 1))


def names(label):
    return [LABELS[each] for each in label.tolist()]


def without_closed_form():
    rows = [(0.1, 70, 0.2), (0.3, 40, 0.1), (0.2, -80, 0.1), (0.1, 60, 0.3), (0.1, -50, 0.1), (0.05, 30, 0.1)]
    joints = [ws.DHRow(a=a, alpha_deg=alpha, d=d, limits_deg=(-170, 170)) for a, alpha, d in rows]
    return ws.DHTable(convention="standard", rows=tuple(joints), name="arm")


@pytest.mark.parametrize(
    ("arm", "count"), [("ur5e", 2000), ("puma560", 2000), ("franka_panda", 1000), ("spherical", 500), (None, 15)]
)
def test_labels_are_those_of_reachable(arm, count, device):
    robot = ws.load_robot(arm or without_closed_form(), placement=PLACED)
    assert (robot.closed_form is None) == (arm is None)
    position, quat = targets(robot.chain, count)
    for asked in (quat, None):
        found = ws.reachable(robot, position, asked, device=device).labels.tolist()
        label = ws.reachable_labels(robot, position, asked, device=device)
        assert label.dtype == np.int8 and label.shape == (2 * count,)
        assert names(label) == found
        assert len(set(found)) > 1 or asked is None


@pytest.mark.parametrize(
    "chain",
    [
        random_arm(RELATIONS[0], 3),
        *(reversed_chain(random_arm(kind, 3)) for kind in ("general arm", PARALLEL)),
        *list(RANDOM_ARMS.values())[:2],
        open_arm("CRX-10iA"),
    ],
    ids=["nested", "general", "parallel", "free", "free, backwards", "open"],
)
def test_closed_forms_decide_as_they_do_composed_poses(chain):
    """Before any search, from the base and from the tip."""
    position, quat = targets(chain, 100, 1)
    R, closed = Rotation.from_quat(quat, scalar_first=True).as_matrix(), solver(chain).closed
    label = closed.labels_by_quaternions(position, quat)
    assert label.tolist() == closed.labels(position, R).tolist()
    assert {REACHABLE, UNREACHABLE} <= set(label.tolist())


def test_what_is_left_open_is_searched():
    arm = solver(ws.load_robot("puma560").chain)
    position, quat = targets(arm.chain, 1000)
    open_ = arm.closed.labels_by_quaternions(position, quat) == UNDECIDED
    assert open_.sum() > 50 and (arm.labels(position, quat)[open_] != UNDECIDED).mean() > 0.9


@pytest.mark.parametrize("arm", ["puma560", "stanford_arm", PARALLEL])
def test_poses_tried_from_every_posture_are_decided_as_by_the_whole_search(arm, monkeypatch):
    """Poses a few tolerances beside those at limits, and any: with fewer tries, and nothing that is reached is lost."""
    own = solver(random_arm(arm, 3) if arm == PARALLEL else ws.load_robot(arm).chain)
    chain, random = own.chain, np.random.default_rng(6)
    T = np.concatenate([chain.poses(near_limits(chain, 3000, 6)), in_the_box(chain, 100_000, 6)])
    T[:3000, :3, 3] += random.normal(size=(3000, 3)) * 1e-5
    position, R = T[:, :3, 3], T[:, :3, :3]
    at = np.flatnonzero(own.closed.labels(position, R) == UNDECIDED)
    beside, anywhere = at[at < 3000][:500], at[at >= 3000]
    tried, found = [], []

    def counted(self, targets, starts, **options):
        tried[-1] += len(starts)
        return tries(self, targets, starts, **options)

    tries = InverseSolver._tries
    monkeypatch.setattr(InverseSolver, "_tries", counted)
    for _ in range(2):
        for part in (anywhere, beside):
            tried.append(0)
            found.append(own.solve(position[part], R[part]).label)
        monkeypatch.setattr(Evidence, "exhaust", lambda self, at: None)
    for few, whole in zip(found[:2], found[2:], strict=True):
        assert ((few == REACHABLE) == (whole == REACHABLE)).all() and (few[whole == UNREACHABLE] == UNREACHABLE).all()
    assert (found[3] == REACHABLE).sum() > 100 and (found[0] == UNREACHABLE).sum() > 5
    assert tried[0] < 0.6 * tried[2]


def test_the_margin_is_what_tolerances_ask_for():
    """Poses within a tolerance of one that is reached are open, and then reached."""
    robot = ws.load_robot("ur5e")
    position, quat = targets(robot.chain, 1000)
    for tolerance in (1e-5, 1e-2):
        near = {"position_tolerance_m": tolerance, "angle_tolerance_rad": tolerance, "device": "cpu"}
        found = ws.reachable(robot, position, quat, **near).labels
        assert names(ws.reachable_labels(robot, position, quat, **near)) == found.tolist()
        assert (found[:500] == "reachable").all() == (tolerance == 1e-2)


def test_solvers_are_kept_for_what_is_asked_alone():
    chain = ws.load_robot("ur5e").chain
    asked = {"characteristic_length_m": 0.3, "seed": 1, "precision": "float64", "device": "cpu"}

    def kept(chain=chain, tolerances=(1e-5, 2e-5), threads=1, **other):
        return reach_targets._solver(chain, "pose", tolerances, threads, **(asked | other))

    arm = kept()
    assert kept() is arm
    assert (arm.accuracy.position_m, arm.accuracy.angle_rad, arm.accuracy.length, arm.seed) == (1e-5, 2e-5, 0.3, 1)
    assert kept(tolerances=(1e-5, 3e-5)).accuracy.angle_rad == 3e-5
    assert kept(characteristic_length_m=0.4).accuracy.length == 0.4
    assert kept(threads=2).closed.threads == 2
    assert kept(chain=ws.load_robot("puma560").chain) is not arm


@pytest.mark.parametrize("oriented", [True, False])
@pytest.mark.parametrize("count", [0, 1, LANES - 1, LANES, LANES + 1, 3000])
def test_any_number_of_poses_in_any_number_of_threads(count, oriented, device):
    chain = ws.load_robot("puma560").chain
    form = closed_form_of(chain, "pose" if oriented else "position")
    position, quat = (part[:count] for part in targets(chain, 1500, 2))
    few, many = (
        closed_labels(form, position, quat if oriented else None, margin=1e-3, device=device, threads=threads)
        for threads in (1, 3)
    )
    alone = [
        closed_labels(form, position[k : k + 1], quat[k : k + 1] if oriented else None, margin=1e-3, device=device)[0]
        for k in range(0, count, 40)
    ]
    assert few.shape == (count,) and few.tolist() == many.tolist() and few[::40].tolist() == alone


def test_arrays_of_any_layout():
    """Not contiguous, of other numbers, read-only: they are copied where they must be, and never written."""
    robot = ws.load_robot("ur5e")
    position, quat = targets(robot.chain, 300)
    position, quat = position.astype(np.float32).astype(float), quat.astype(np.float32).astype(float)
    before, label = (position.copy(), quat.copy()), ws.reachable_labels(robot, position, quat, device="cpu")
    assert np.array_equal(before[0], position) and np.array_equal(before[1], quat)
    position.setflags(write=False)
    for p, q in (
        (np.asfortranarray(position), np.asfortranarray(quat)),
        (np.column_stack([position, position])[:, 3:], np.repeat(quat, 2, axis=0)[::2]),
        (position.astype(np.float32), quat.astype(np.float32)),
        (position.tolist(), quat.tolist()),
        (position, quat),
    ):
        assert ws.reachable_labels(robot, p, q, device="cpu").tolist() == label.tolist()


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("points", [[0.4, 0, 0.4], [0.4, np.nan, 0.4]], "row 1 has a value that is not finite"),
        ("points", [[0.4, 0], [0.4, 0]], "shape"),
        ("points", "targets.csv", "not an array of numbers"),
        ("orientations", [[1, 0, 0, 0], [np.inf, 0, 0, 0]], "row 1 has a value that is not finite"),
        ("orientations", [[0, 1, 0, 0], [0, 0, 1e-7, 0]], "row 1 has length 0"),
        ("orientations", [[1, 0, 0, 0]] * 3, "3 rows for 2 points"),
        ("position_tolerance_m", -1, "greater than 0"),
        ("angle_tolerance_rad", 0, "greater than 0"),
        ("threads", 0, "whole number"),
        ("device", "cuda:99", "not available"),
    ],
)
def test_errors_name_the_field(field, value, message):
    given = {"points": [[0.4, 0, 0.4]] * 2, "orientations": [[1, 0, 0, 0]] * 2, field: value}
    with pytest.raises(ws.InputError, match=message) as error:
        ws.reachable_labels("ur5e", **given)
    assert error.value.field == field


def test_kernels_compile_for_cuda_without_a_gpu(tmp_path):
    shape = shape_of(ClosedForm.of(ws.load_robot("ur5e").chain), "float64", keep=False)
    kernels = [closed_labels_kernel(shape, False, oriented, cuda=True) for oriented in (True, False)]
    kernels.append(free_joint_kernel(FreeJointShape(wp.float64, (1, 0), True, quaternions=True), cuda=True))
    for kernel in kernels:
        wp.compile_aot_module(kernel.module, device=None, arch=90, module_dir=str(tmp_path), use_ptx=True)
    assert len(list(tmp_path.glob("*.ptx"))) == 3
