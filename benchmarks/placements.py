"""Placements of a base: maps of ten targets, and best placements beside scikit-robot's ``find_base_placement``.

    python benchmarks/placements.py maps [--device cpu] [--repeats 3]
    python benchmarks/placements.py scikit [--sets 20] [--starts 25]

``maps``: 1 cm × 1 cm × 5° over 1 m², 7.2 M pairs of a placement and a target, from the call to the map, kernels in the
cache; aims on two idle cores: 1.5 s for the UR5e, 4 s for the Panda. On a GPU the rate beside that of the kernel alone,
which labels poses that lie there, and the same of labels alone of larger maps; aim: half of it.

``scikit``: the Kuka of scikit-robot's wheel (extra bench), sets of ten poses each by a seed. Both place the base in x,
y and yaw, and count targets to 1 mm and 1°. Told are targets served, and the least joint-limit margin over them: here
of all postures and self-motions that are found at the best placement.
"""

import argparse
import time
import warnings
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender.run.steps import plan

DOWN = [0.0, 1.0, 0.0, 0.0]
HOLES = [[0.4 * np.cos(0.7 * k) + 0.1, 0.35 * np.sin(0.7 * k), 0.15 + 0.02 * k] for k in range(10)]
OVER = {"x_m": [-0.5, 0.5, 0.01], "y_m": [-0.5, 0.5, 0.01], "yaw_deg": [0, 360, 5]}
KERNEL_POSES = 1 << 22
LABELED = ((0.02, 10), (0.01, 10), (0.01, 40), (0.01, 80), (0.005, 40), (0.005, 80))  # steps [m] and targets
BOUND, CELL = 0.8, 0.2  # of bases beside scikit-robot [m]
NEAR = {"position_tolerance_m": 1e-3, "angle_tolerance_rad": float(np.deg2rad(1))}
# Arm angles from which scikit-robot starts at every base: forward low, near and far.
SEEDS = np.array([[0, 0.6, 0, -1.2, 0, 0.8, 0], [0, 0.2, 0, -1.8, 0, 1.0, 0], [0, 1.0, 0, -0.8, 0, 1.2, 0]])
STARTS = 64  # of the search for postures at the best placement


def timed(repeats: int, **asked: Any) -> tuple[float, float, Any]:
    """Least seconds of the clock and of the process, after a call that is not counted, and the result."""
    result, clock, own = ws.base_placement(**asked), [], []
    for _ in range(repeats):
        started, before = time.perf_counter(), time.process_time()
        result = ws.base_placement(**asked)
        clock.append(time.perf_counter() - started)
        own.append(time.process_time() - before)
    return min(clock), min(own), result


def maps(device: str, repeats: int) -> None:
    """Maps of ten targets with and without the symmetry of the first joint."""
    print(f"{'map of 7.2 M pairs':34s} {'s':>7s} {'CPU s':>7s} {'M pairs/s':>10s} {'served':>8s} {'undecided':>10s}")
    for name in ("ur5e", "franka_panda"):
        for symmetric in (True, False):
            asked = {"robot": name, "points_m": HOLES, "quats_wxyz": [DOWN] * 10, "over": OVER, "refine": False}
            clock, own, result = timed(repeats, **asked, use_symmetry=symmetric, device=device)
            about = result.document["placements"]
            pairs, labels = about["count"] * about["targets"], about["labels"]
            title = f"{name}, {about['alike']} alike, {device}"
            rates = f"{clock:7.2f} {own:7.2f} {pairs / clock / 1e6:10.2f}"
            print(f"{title:34s} {rates} {labels['served'] / pairs:8.3f} {labels['undecided']:10,}")
    if device == "cpu":
        return
    alone = kernel_rate(device, repeats)
    print(
        f"kernel alone, ur5e: {alone / 1e6:.1f} M poses/s; labels of placements as bits on the host, poses made there:"
    )
    for step, targets in LABELED:
        pairs, seconds = labeled(device, repeats, step, targets)
        print(f"{pairs / 1e6:8.1f} M pairs, {targets:4d} targets {seconds:8.4f} s {pairs / seconds / alone:6.3f} of it")


def labeled(device: str, repeats: int, step: float, targets: int) -> tuple[int, float]:
    """Pairs, and least seconds, of the labels alone of UR5e's placements over 4 m², of poses by a seed."""
    random = np.random.default_rng(0)
    over = {"x_m": [-1, 1, step], "y_m": [-1, 1, step], "yaw_deg": [0, 355, 5]}
    points = random.uniform([-0.6, -0.6, 0.0], [0.6, 0.6, 0.6], (targets, 3)).tolist()
    about = {"analysis": "base_placement", "robot": "ur5e", "points_m": points, "quats_wxyz": [DOWN] * targets}
    analysis = plan({**about, "over": over, "use_symmetry": False, "refine": False, "device": device})
    over, search = analysis.job.over, analysis._placements(None)
    search.bits(over, range(over.count))
    seconds = []
    for _ in range(repeats):
        started = time.perf_counter()
        search.bits(over, range(over.count))
        seconds.append(time.perf_counter() - started)
    return over.count * targets, min(seconds)


def kernel_rate(device: str, repeats: int) -> float:
    """Poses a second that the UR5e's closed form labels, of poses on the device, float64."""
    import warp as wp
    from closed_form import kernel  # pyright: ignore[reportMissingImports]

    from wsrender.reach.inverse_solver import closed_form_of
    from wsrender.robots.closed_form import ClosedForm

    chain = ws.load_robot("ur5e").chain.geometry
    assert chain
    form, random = closed_form_of(chain, "pose"), np.random.default_rng(0)
    assert isinstance(form, ClosedForm)
    T = np.tile(np.eye(4), (KERNEL_POSES, 1, 1))
    T[:, :3, 3] = random.uniform(-0.8, 0.8, (KERNEL_POSES, 3))
    count, launched = kernel(form, T, "float64", wp.get_device(device))
    launched()
    seconds = []
    for _ in range(repeats):
        wp.synchronize()
        started = time.perf_counter()
        launched()
        wp.synchronize()
        seconds.append(time.perf_counter() - started)
    return count / min(seconds)


def scikit(sets: int, starts: int) -> None:
    """Best placements for sets of targets, one beside the other."""
    import skrobot  # pyright: ignore[reportMissingImports]
    from skrobot.coordinates import Coordinates  # pyright: ignore[reportMissingImports]
    from skrobot.data import kuka_urdfpath  # pyright: ignore[reportMissingImports]
    from skrobot.kinematics import find_base_placement  # pyright: ignore[reportMissingImports]

    kuka = skrobot.models.Kuka()
    end, last = kuka.rarm_end_coords, kuka.lbr_iiwa_with_wsg50__lbr_iiwa_link_7
    T = np.linalg.inv(last.worldcoords().T()) @ end.worldcoords().T()
    tool = {"position_m": T[:3, 3].tolist(), "quat_wxyz": quat_of(T[:3, :3])}
    arm = ws.load_robot(kuka_urdfpath(), tip=last.name, tool=tool)
    over = {"x_m": [-BOUND, BOUND, CELL], "y_m": [-BOUND, BOUND, CELL], "yaw_deg": [0, 360, 90]}
    side = np.linspace(-BOUND, BOUND, round(np.sqrt(starts)))
    bases = [Coordinates(pos=[x, y, 0]) for x in side for y in side]
    print("set  served: skrobot   here  margin: skrobot   here  CPU s: skrobot   here")
    kept = []
    for seed in range(sets):
        points, quats = targets_of(seed)
        coordinates = [Coordinates(pos=p, rot=Rotation.from_quat(q, scalar_first=True).as_matrix())
                       for p, q in zip(points, quats, strict=True)]  # fmt: skip
        before = time.process_time()
        theirs = find_base_placement(
            kuka, coordinates, move_target=end, joint_list=kuka.rarm.joint_list, initial_base_poses=bases,
            base_bounds=((-BOUND, BOUND),) * 2, thre=NEAR["position_tolerance_m"], rthre=NEAR["angle_tolerance_rad"],
            maximize_margin=True, initial_angles=SEEDS,
        )  # fmt: skip
        between = time.process_time()
        ours = ws.base_placement(arm, points, quats, over=over, index="joint_limit_margin", device="cpu", **NEAR)
        best = ours.document["best"]
        served = ours.tables["targets"]["label"] == "reachable"
        margin = margin_at(arm, np.array(best["T_world_base"]), points[served], quats[served])
        after = time.process_time()
        reached = theirs.success
        their_margin = float(theirs.joint_margins[reached].min()) if reached.any() else 0.0
        row = (int(reached.sum()), best["served"], their_margin, max(margin, best["joint_limit_margin"]))
        kept.append(row)
        times = f"{between - before:14.1f} {after - between:6.1f}"
        print(f"{seed:3d} {row[0]:16d} {row[1]:6d} {row[2]:16.3f} {row[3]:6.3f} {times}", flush=True)
    found = np.array(kept)
    same, more = found[:, 1] == found[:, 0], found[:, 1] > found[:, 0]
    print(
        f"of {len(found)} sets: more targets served in {more.sum()}, as many in {same.sum()}, of these with a margin "
    )
    print(f"at least as large in {(found[same, 3] >= found[same, 2]).sum()}")


def targets_of(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Ten poses around the middle, pointing down but for tilts of up to 40°: positions (10, 3), (10, 4) wxyz."""
    random = np.random.default_rng(seed)
    points = random.uniform([-0.5, -0.5, 0.2], [0.5, 0.5, 0.9], (10, 3))
    tilts = Rotation.from_rotvec(np.deg2rad(40) * random.uniform(-1, 1, (10, 3)) / np.sqrt(3))
    return points, (tilts * Rotation.from_quat(DOWN, scalar_first=True)).as_quat(scalar_first=True)


def margin_at(arm: ws.Robot, T_world_base: np.ndarray, points: np.ndarray, quats: np.ndarray) -> float:
    """Least over poses of the largest joint-limit margin of the postures and self-motions that are found."""
    T = T_world_base @ np.linalg.inv(arm.chain.T_world_base)
    positions = (points - T[:3, 3]) @ T[:3, :3]
    rotations = T[:3, :3].T @ Rotation.from_quat(quats, scalar_first=True).as_matrix()
    turned = Rotation.from_matrix(rotations).as_quat(scalar_first=True)
    found, least = ws.postures(arm, positions, turned, starts=STARTS, device="cpu"), np.zeros(len(points))
    for k, pose in enumerate(found.pose):
        curve = found.curves[k]
        q = found.configurations[k : k + 1] if curve is None else curve.configurations
        margins = np.minimum(q - arm.lower_limits, arm.upper_limits - q) / (arm.upper_limits - arm.lower_limits)
        least[pose] = max(least[pose], margins.min(axis=1).max())
    return float(least.min())


def quat_of(rotation: np.ndarray) -> list[float]:
    return Rotation.from_matrix(rotation).as_quat(scalar_first=True).tolist()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=("maps", "scikit"))
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--sets", type=int, default=20)
    parser.add_argument("--starts", type=int, default=25)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    if given.part == "maps":
        maps(given.device, given.repeats)
    else:
        scikit(given.sets, given.starts)
