"""Labels of whole poses beside version 0.1.0's solver, in one run.

    python benchmarks/first_version.py [--device cpu] [--poses 65536] [--repeats 5] [--before 2f43cec]

Version 0.1.0 is the commit, checked out and installed with pip in an environment of its own, in a temporary folder; its
solver takes 4,096 of the poses in one thread of the CPU. Where that fails, as without git or a network, or `--before`
is empty, the others run alone. `kernel`: poses and labels stay on the device. `search`: arrays in and labels out, of
what the kernel decides. `ws.reachable`: as users call it, with configurations, residuals and reasons. Poses made by
forward kinematics, anywhere in the box of the workspace, and those of them that are unreachable. Every repeat takes all
in turn; rates are of the least times, of the processor on the CPU, where all take one thread, else of the clock. On a
GPU what the bus carries, from pageable and from pinned memory, counts the 128 bytes of a pose.
"""

import argparse
import contextlib
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import warp as wp
from closed_form import NEAR, kernel, made_anywhere, uniform
from composed import worktree
from scipy.spatial.transform import Rotation
from wsrender_kernels.free_joint import FREE_FIELDS, UNDECIDED, free_joint_kernel

import wsrender as ws
from wsrender.engine import closed_postures, devices_of, search_free_joint
from wsrender.engine.evaluation import device_array
from wsrender.engine.free_joint import kernel_shape, searches_on
from wsrender.engine.kernel_cache import launch, loaded
from wsrender.robots.closed_form import ClosedForm, FreeJointForm
from wsrender.robots.closed_form.numbers import packed

ARMS = ("ur5e", "franka_panda", "kuka_iiwa14")
FEW = 4096  # poses for version 0.1.0, and for `ws.reachable` sixteen times as many
EARLIER = """
import sys, time
import numpy as np
import wsrender as ws
from wsrender.reachability.inverse_solver import REACHABLE, InverseSolver
poses, solvers = np.load(sys.argv[1]), {}
for line in sys.stdin:
    name = line.strip()
    arm, T = name.partition(",")[0], poses[name]
    if arm not in solvers:
        options = {"position_m": 1e-5, "angle_rad": 1e-5, "device": "cpu", "threads": 1}
        solvers[arm] = InverseSolver(ws.load_robot(arm).chain, kind="pose", **options)
    started = time.process_time()
    found = solvers[arm].solve(T[:, :3, 3], T[:, :3, :3])
    print(time.process_time() - started, (found.label == REACHABLE).mean(), flush=True)
"""

Work = tuple[int, Callable[[], float]]  # poses, and what decides them and says how many seconds that took
Case = tuple[str, str, str]  # arm, poses, and what decides


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--poses", type=int, default=1 << 16)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--before", default="2f43cec", help="commit of version 0.1.0")
    options = parser.parse_args()
    device = devices_of(options.device)[0]
    poses = {name: T for arm in ARMS for name, T in poses_of(arm, options.poses, options.device).items()}
    with earlier(options.before, poses) as run_earlier:
        cases: dict[Case, Work] = {}
        for name, T in poses.items():
            arm, told = name.split(", ")
            if run_earlier:
                cases[arm, told, "0.1.0"] = min(FEW, len(T)), partial(run_earlier, name)
            cases |= {(arm, told, by): work for by, work in cases_of(arm, T, device).items()}
        if device.is_cuda:
            cases |= bus(poses["franka_panda, anywhere"], device)
        rates = rates_of(cases, options.repeats)
    print("| arm | poses | by | M poses/s | times 0.1.0's |\n|---|---|---|--:|--:|")
    for (arm, told, by), rate in rates.items():
        beside = rates.get((arm, told, "0.1.0"))
        print(f"| {arm} | {told} | {by} | {rate / 1e6:.3g} | {'' if beside is None else f'{rate / beside:.1f}'} |")


def poses_of(arm: str, count: int, device: str) -> dict[str, np.ndarray]:
    """Poses (N, 4, 4) of an arm by what they are; unreachable ones are as many as the box has."""
    chain = ws.load_robot(arm).chain.geometry
    assert chain
    made, anywhere = chain.poses(uniform(chain.lower_limits, chain.upper_limits, count)), made_anywhere(chain, count)
    if form := ClosedForm.of(chain):
        out = closed_postures(form, anywhere, device=device).slack < -1e-3
    else:
        along = FreeJointForm.of(chain)
        assert along
        out = search_free_joint(along, anywhere, device=device, **NEAR).unreachable
    return {f"{arm}, made": made, f"{arm}, anywhere": anywhere, f"{arm}, unreachable": anywhere[out]}


@contextlib.contextmanager
def earlier(commit: str, poses: dict[str, np.ndarray]) -> Iterator[Callable[[str], float] | None]:
    """What decides poses by name with version 0.1.0; None where it cannot be installed."""
    with contextlib.ExitStack() as stack:
        try:
            if not commit:
                raise OSError("no commit is given")
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
            checkout = stack.enter_context(worktree(commit))
            python = installed(checkout, folder / "environment")
        except (OSError, subprocess.CalledProcessError) as error:
            print(f"0.1.0 is not measured: {error}")
            yield None
            return
        np.savez(folder / "poses.npz", **{name: T[:FEW] for name, T in poses.items()})
        command, pipe = [python, "-I", "-c", EARLIER, folder / "poses.npz"], subprocess.PIPE
        process = stack.enter_context(subprocess.Popen(command, cwd=folder, stdin=pipe, stdout=pipe, text=True))
        stack.callback(process.kill)
        seen = set()

        def run(name: str) -> float:
            print(name, file=process.stdin, flush=True)
            seconds, reached = map(float, process.stdout.readline().split())
            if name not in seen:
                print(f"0.1.0, {name}: {reached:.2%} reachable")
                seen.add(name)
            return seconds

        yield run


def installed(checkout: Path, folder: Path) -> Path:
    """Python of a new environment that holds a checkout and what it needs."""
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    python = folder / "bin/python"
    subprocess.run([python, "-I", "-m", "pip", "install", "-qq", f"{checkout}[engine]"], check=True)
    return python


def cases_of(arm: str, T: np.ndarray, device: wp.Device) -> dict[str, Work]:
    """Work by what decides."""
    robot, place = ws.load_robot(arm), device.alias
    chain = robot.chain.geometry
    assert chain
    if form := ClosedForm.of(chain):
        count, run = kernel(form, T, "float64", device)
        search = partial(closed_postures, form, T, device=place, threads=1)
    else:
        along = FreeJointForm.of(chain)
        assert along
        count, run = len(T), balls(along, T, device)
        search = partial(search_free_joint, along, T, device=place, threads=1, **NEAR)
    some = T[: 16 * FEW]
    turned = Rotation.from_matrix(some[:, :3, :3]).as_quat(scalar_first=True)
    tolerances = {"position_tolerance_m": NEAR["position_m"], "angle_tolerance_rad": NEAR["angle_rad"]}
    users = partial(ws.reachable, robot, some[:, :3, 3], turned, device=place, threads=1, **tolerances)
    work = {"kernel": (count, run), "search": (len(T), search), "ws.reachable": (len(some), users)}
    return {by: (number, partial(timed, each, device)) for by, (number, each) in work.items()}


def balls(form: FreeJointForm, T: np.ndarray, device: wp.Device) -> Callable[[], None]:
    """Launches that decide poses on the device, each of those that the one before left."""
    compiled, count = loaded(free_joint_kernel(kernel_shape(form), device.is_cuda), device), len(T)
    numbers = packed(form.numbers(**NEAR), FREE_FIELDS)
    given = [device_array(values.ravel(), wp.float64, device) for values in (numbers, T, np.eye(4))]
    state, spent = (wp.zeros(count, dtype=wp.int32, device=device) for _ in range(2))  # type: ignore[arg-type]
    at, rest, launches = wp.zeros(count, dtype=wp.float64, device=device), np.arange(count), []

    def decide(search: tuple[int, int, float], which: wp.array) -> None:
        each = 1 if device.is_cuda else len(which)
        inputs = [len(which), each, *search, *given, which]
        launch(compiled, dim=len(which) // each, inputs=inputs, outputs=[state, at, spent], device=device)

    for search in searches_on(device):
        if len(rest):
            launches.append((search, device_array(rest, wp.int32, device)))
            decide(*launches[-1])
            rest = np.flatnonzero(state.numpy() == UNDECIDED)

    def run() -> None:
        state.zero_()
        for each in launches:
            decide(*each)
        wp.synchronize_device(device)

    return run


def bus(T: np.ndarray, device: wp.Device) -> dict[Case, Work]:
    """Poses moved to the device."""
    count, there = T.size, wp.empty(T.size, dtype=wp.float64, device=device)
    pinned = wp.array(T.ravel(), dtype=wp.float64, device="cpu", pinned=True)
    plain = wp.array(T.ravel(), dtype=wp.float64, device="cpu")

    def move(source: wp.array) -> None:
        wp.copy(there, source, count=count)
        wp.synchronize_device(device)

    sources = {"pageable": plain, "pinned": pinned}
    return {("", "any", f"bus, {k}"): (len(T), partial(timed, partial(move, a), device)) for k, a in sources.items()}


def timed(run: Callable[[], object], device: wp.Device) -> float:
    """Seconds of the processor, of what runs on a GPU of the clock."""
    clock = time.perf_counter if device.is_cuda else time.process_time
    started = clock()
    run()
    return clock() - started


def rates_of(cases: dict[Case, Work], repeats: int) -> dict[Case, float]:
    """Poses a second, all cases in turn; the first turn is not counted, as kernels are compiled."""
    least = dict.fromkeys(cases, np.inf)
    for repeat in range(repeats + 1):
        for case, (_, run) in cases.items():
            seconds = run()
            least[case] = min(least[case], seconds) if repeat else np.inf
    return {case: cases[case][0] / seconds for case, seconds in least.items()}


if __name__ == "__main__":
    main()
