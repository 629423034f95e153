"""Closed-form inverse kinematics beside EAIK, ssik and the numerical solver, side by side in one run.

    python benchmarks/closed_form.py [--device cpu] [--poses 262144] [--repeats 5]

Poses made by forward kinematics, all postures of each with limits and windings, one thread; the solver finds one
configuration. Every repeat takes all cases in turn; rates are of the least times, ratios of the rates. EAIK and ssik
are in the extra test-models; what is not installed is left out. Aims: 75 times EAIK's rate for the same arm in float64
or more, for the quartic of a general arm 45 times that for the UR5e.

Of arms of seven hinges labels alone: a search in balls beside the solver, of poses made and of poses anywhere in the
box that holds the workspace. Aims, for the Panda: 25 and 150 times the solver of version 0.1.0. Of open arms of six the
same, aims 10 and 25 times, and sets of all postures beside ssik's, aim 40 times.
"""

import argparse
import importlib
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import warp as wp
from scipy.spatial.transform import Rotation
from wsrender_kernels.closed_form import FIELDS, LANES, closed_form_kernel

import wsrender as ws
from wsrender.engine import devices_of, open_wrist_postures, search_free_joint, search_open_wrist
from wsrender.engine.closed_form import shape_of
from wsrender.engine.evaluation import REAL, device_array
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.reach import InverseSolver
from wsrender.robots.chain import Chain
from wsrender.robots.closed_form import ClosedForm, FreeJointForm, OpenWristForm
from wsrender.robots.closed_form.numbers import packed
from wsrender.robots.kinematics import Kinematics
from wsrender.robots.reachable_box import reachable_box

SSIK = {
    "ur5e": "universal_robots.ur5e_ik",
    "puma560": "unimation.puma560_ik",
    "crx10ia": "fanuc.crx10ia_ik",
    "xarm6": "ufactory.xarm6_ik",
}
NEAR: dict[str, Any] = {"position_m": 1e-5, "angle_rad": 1e-5}
ARRAYS = 1 << 21  # poses in arrays
FEW, FEWER = 4096, 256  # poses for the solver and EAIK, and for ssik
GENERAL = [(0.1, 70, 0.2), (0.4, 40, 0.1), (0.15, -80, 0.05), (0.0, 90, 0.35), (0.0, -90, 0.0), (0.0, 0, 0.1)]
# Open arms: a [m], alpha [°], d [m], theta [°], and the limits [°] of every joint.
OPEN = {
    "crx10ia": [
        (0, 90, 0.245, 0, (-190, 190)),
        (0.54, 180, 0, 90, (-179.9, 179.9)),
        (0, 90, 0, 180, (-71, 251)),
        (0, 90, -0.54, 180, (-190, 190)),
        (0, 90, 0.15, 180, (-179.9, 179.9)),
        (0, 0, -0.16, 0, (-225, 225)),
    ],
    "xarm6": [
        (0, 90, 0.267, 0, (-360, 360)),
        (0.289487, 0, 0, 100.6501, (-118, 120)),
        (-0.0775, 90, 0, -100.6501, (-225, 11)),
        (0, 90, 0.3425, 180, (-360, 360)),
        (-0.076, 90, 0, 180, (-97, 180)),
        (0, 0, -0.097, 0, (-360, 360)),
    ],
}

Work = tuple[int, Callable[[], object]]  # poses, and what solves them


def arms() -> dict[str, Chain]:
    """Chains by name; of `general` no two of the first three axes meet or are parallel."""
    rows = [ws.DHRow(a=a, alpha_deg=alpha, d=d, limits_deg=(-170, 170)) for a, alpha, d in GENERAL]
    table = ws.DHTable(convention="standard", rows=tuple(rows), name="general")
    robots = [*map(ws.load_robot, ("ur5e", "puma560", "gao_6r", "stanford_arm")), ws.load_robot(table)]
    return {robot.name: chain for robot in robots if (chain := robot.chain.geometry)}


def kernel(closed: ClosedForm, T: np.ndarray, precision: str, device: wp.Device) -> Work:
    """A launch, its poses on the device."""
    real, count = REAL[precision], len(T) // LANES * LANES
    compiled = loaded(closed_form_kernel(shape_of(closed, precision, keep=False), device.is_cuda), device)
    numbers = device_array(packed(closed.numbers(), FIELDS), real, device)
    targets = device_array(closed.targets(T[:count]).T.ravel(), real, device)
    postures, flags = (wp.empty(count, dtype=wp.int32, device=device) for _ in range(2))  # type: ignore[arg-type]
    slack, kept = wp.empty(count, dtype=real, device=device), wp.empty(0, dtype=real, device=device)
    dim = count if device.is_cuda else count // LANES

    def run() -> None:
        inputs, outputs = [count, numbers, targets], [postures, slack, flags, kept]
        launch(compiled, dim=dim, inputs=inputs, outputs=outputs, device=device)
        wp.synchronize_device(device)

    return count, run


def eaik(chain: Chain, T: np.ndarray) -> Work:
    """EAIK for the same axes; without limits and windings."""
    from eaik.IK_HP import HPRobot  # pyright: ignore[reportMissingImports]

    frames = chain.frames(np.zeros((1, chain.n)))[0]
    points = np.vstack([np.zeros(3), frames[:, :3, 3]])
    peer = HPRobot(frames[:-1, :3, 2], np.diff(points, axis=0))
    poses = T[:FEW].copy()
    poses[:, :3, :3] = poses[:, :3, :3] @ frames[-1, :3, :3].T
    listed = list(poses)
    return len(listed), lambda: peer.IK_batched(listed, 1)


def ssik(name: str, seed: int = 0) -> Work:
    """Ssik's module for the arm, with limits and windings, its own poses."""
    module = importlib.import_module(f"ssik.prebuilt.{SSIK[name]}")
    limits = [ends or (-np.pi, np.pi) for ends in module._JOINT_LIMITS]
    q = np.random.default_rng(seed).uniform(*np.transpose(limits), (FEWER, 6))
    poses = [module.fk(row) for row in q]
    return FEWER, lambda: [module.solve(T) for T in poses]


def solver(chain: Kinematics, T: np.ndarray) -> Work:
    """The numerical solver alone: it finds one configuration."""
    made = InverseSolver(chain, kind="pose", device="cpu", threads=1, **NEAR)
    made.closed = None
    return FEW, lambda: made.solve(T[:FEW, :3, 3], T[:FEW, :3, :3])


def cases_of(name: str, chain: Chain, count: int, device: wp.Device) -> dict[str, Work]:
    """Work by what does it."""
    T = chain.poses(np.random.default_rng(0).uniform(chain.lower_limits, chain.upper_limits, (count, chain.n)))
    closed = ClosedForm.of(chain)
    assert closed
    cases = {precision: kernel(closed, T, precision, device) for precision in ("float64", "float32")}
    if chain.joint_is_revolute.all() and name != "general":
        try:
            cases["EAIK"] = eaik(chain, T)
        except ImportError:
            print("EAIK is not installed")
    if name in SSIK:
        try:
            cases["ssik"] = ssik(name)
        except ImportError:
            print("ssik is not installed")
    return cases | {"solver": solver(chain, T)}


def redundant_cases(count: int, device: str) -> dict[tuple[str, str], Work]:
    """Labels of arms of seven hinges, by arm and what is done of which poses."""
    cases = {}
    for name in ("franka_panda", "kuka_iiwa14"):
        chain = ws.load_robot(name).chain
        form = FreeJointForm.of(chain)
        assert form and chain.geometry
        made, random = chain.poses(uniform(chain.lower_limits, chain.upper_limits, count)), made_anywhere(chain, count)
        for told, T in (("made", made), ("anywhere", random)):
            cases[name, f"balls, {told}"] = (
                count,
                partial(search_free_joint, form, T, device=device, threads=1, **NEAR),
            )
            cases[name, f"solver, {told}"] = solver(chain, T)
    return cases


def array_cases(device: str) -> dict[tuple[str, str], Work]:
    """Labels alone, arrays in and out, and what the kernel does of it, by arm and which poses."""
    cases, count = {}, ARRAYS
    for name in ("ur5e", "puma560"):
        chain = ws.load_robot(name).chain
        own = InverseSolver(chain, kind="pose", device=device, threads=1, **NEAR)
        assert own.closed
        made, random = chain.poses(uniform(chain.lower_limits, chain.upper_limits, count)), made_anywhere(chain, count)
        for told, T in (("made", made), ("anywhere", random)):
            poses = T[:, :3, 3].copy(), Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
            cases[name, f"arrays, {told}"] = count, partial(own.labels, *poses)
            cases[name, f"arrays, {told}: kernel"] = count, partial(own.closed.labels_by_quaternions, *poses)
    return cases


def open_cases(count: int, device: str) -> dict[tuple[str, str], Work]:
    """Labels and sets of open arms of six hinges, by arm and what is done of which poses."""
    cases = {}
    for name, rows in OPEN.items():
        joints = [ws.DHRow(a=a, alpha_deg=A, d=d, theta_deg=t, limits_deg=ends) for a, A, d, t, ends in rows]
        chain = ws.load_robot(ws.DHTable(convention="standard", rows=tuple(joints), name=name)).chain
        form = OpenWristForm.of(chain)
        assert form and chain.geometry
        made, random = chain.poses(uniform(chain.lower_limits, chain.upper_limits, count)), made_anywhere(chain, count)
        for told, T in (("made", made), ("anywhere", random)):
            search = partial(search_open_wrist, form, T, device=device, threads=1, **NEAR)
            cases[name, f"balls, {told}"] = count, search
            cases[name, f"solver, {told}"] = solver(chain, T)
        some = made[: max(1, count // 16)]
        cases[name, "sets, made"] = len(some), partial(open_wrist_postures, form, some, device=device, threads=1)
        try:
            cases[name, "ssik, made"] = ssik(name)
        except ImportError:
            print("ssik is not installed")
    return cases


def uniform(lower: np.ndarray, upper: np.ndarray, count: int) -> np.ndarray:
    """Points (N, k) of a box."""
    return np.random.default_rng(0).uniform(lower, upper, (count, len(lower)))


def made_anywhere(chain: Kinematics, count: int) -> np.ndarray:
    """Poses (N, 4, 4) whose positions lie in the box that holds the workspace, turned in any way."""
    T = np.tile(np.eye(4), (count, 1, 1))
    T[:, :3, 3] = uniform(*reachable_box(chain, chain.lower_limits, chain.upper_limits), count)
    T[:, :3, :3] = Rotation.random(count, rng=1).as_matrix()
    return T


def least_times(work: dict[tuple[str, str], Work], repeats: int) -> dict[tuple[str, str], float]:
    """Poses per second by case, all cases in turn."""
    least = dict.fromkeys(work, np.inf)
    for repeat in range(repeats + 1):
        for case, (_, run) in work.items():
            started = time.perf_counter()
            run()
            if repeat:  # the first is not warm
                least[case] = min(least[case], time.perf_counter() - started)
    return {case: work[case][0] / seconds for case, seconds in least.items()}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--poses", type=int, default=1 << 18)
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    device = devices_of(arguments.device)[0]
    by_arm = {name: cases_of(name, chain, arguments.poses, device) for name, chain in arms().items()}
    work = {(name, case): each for name, cases in by_arm.items() for case, each in cases.items()}
    rates = least_times(work, arguments.repeats)
    print("| arm | by | poses/s | float64 is so many times | of EAIK's rate for the UR5e |\n|---|---|--:|--:|--:|")
    for (name, case), rate in rates.items():
        beside = rate / rates["ur5e", "EAIK"] if ("ur5e", "EAIK") in rates else np.nan
        print(f"| {name} | {case} | {rate:,.0f} | {rates[name, 'float64'] / rate:.1f} | {beside:.1f} |")
    along = redundant_cases(arguments.poses, arguments.device) | open_cases(arguments.poses, arguments.device)
    along |= array_cases(arguments.device)
    rates = least_times(along, arguments.repeats)
    print("| arm | labels of poses | poses/s |\n|---|---|--:|")
    for (name, case), rate in rates.items():
        print(f"| {name} | {case} | {rate:,.0f} |")


if __name__ == "__main__":
    main()
