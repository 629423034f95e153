"""Labels of self-collisions beside MuJoCo and coal, and filtered sweeps beside the same without: one thread, in turn.

    python benchmarks/collisions.py [--robots ur5e …, or PATH@TIP] [--repeats 5] [--exclude a,b] [--device cuda]

Labels are exact: sampling, kinematics, filter, narrow phase and MuJoCo for what is open, in CPU seconds of the thread;
sweeps on a CPU in those of the process.
MuJoCo's loop (mujoco_loop.c, compiled here with cc against the wheel's headers) takes kinematics and collisions; coal's
(coal_loop.cpp; packages coal and cmeel-eigen) MuJoCo's kinematics, and of the same shapes the same pairs until one
collides, less those whose balls are apart. All three label the same samples. Ratios are of the least times of the
repeats. Boxes: surroundings of 20 and 100, in times of the sweep with self-collisions.
"""

import argparse
import ctypes
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import warp as wp
from throughput import plan_of

import wsrender as ws
from wsrender.documents.constraints import Constraints
from wsrender.engine import configurations, devices_of, sweep
from wsrender.engine.collision import Collisions, collisions_of
from wsrender.engine.drawn_configurations import device_space
from wsrender.engine.sweep_plan import SweepPlan
from wsrender.errors import ResourceError
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot.constraints import constraints_for

SAMPLES, CHUNK, OF_MUJOCO, SWEPT = 1 << 21, 1 << 18, 1 << 15, 1 << 22
ON_GPU, GPU_CHUNK = 1 << 28, 1 << 26


Labels = Callable[[mujoco.MjModel, np.ndarray], np.ndarray]


def of_mujoco(package: Path) -> list[str | Path]:
    """A compiler's options for MuJoCo's headers and library."""
    (runtime,) = package.glob("libmujoco.so.*")
    headers = [f"-I{path}" for path in (package / "include", package) if path.is_dir()]
    return [*headers, runtime, f"-Wl,-rpath,{package}"]


def mujoco_loop() -> Labels:
    """Labels (N,) of configurations (N, nq) by mujoco_loop.c."""
    folder, package = tempfile.mkdtemp(), Path(mujoco.__file__).parent
    library = Path(folder, "mujoco_loop.so")
    source = Path(__file__).with_name("mujoco_loop.c")
    subprocess.run(["cc", "-O3", "-shared", "-fPIC", source, "-o", library, *of_mujoco(package)], check=True)
    run = ctypes.CDLL(str(library)).blocked

    def labels(model: mujoco.MjModel, q: np.ndarray) -> np.ndarray:
        data, found = mujoco.MjData(model), np.zeros(len(q), np.uint8)
        pointers = [ctypes.c_void_p(each) for each in (model._address, data._address, q.ctypes.data)]
        run(*pointers, len(q), ctypes.c_void_p(found.ctypes.data))
        return found

    return labels


def coal_library() -> ctypes.CDLL | str:
    """coal_loop.cpp, or why it cannot be had."""
    prefixes = [Path(at, "cmeel.prefix") for at in sys.path]
    prefix = next((each for each in prefixes if (each / "include/coal").is_dir()), None)
    if prefix is None or not (prefix / "include/eigen3").is_dir():
        return 'the packages coal and cmeel-eigen are not installed: pip install ".[bench]"'
    library, source = Path(tempfile.mkdtemp(), "coal_loop.so"), Path(__file__).with_name("coal_loop.cpp")
    headers = [f"-I{prefix / each}" for each in ("include", "include/eigen3")]
    runtime = [prefix / "lib/libcoal.so", f"-Wl,-rpath,{prefix / 'lib'}", *of_mujoco(Path(mujoco.__file__).parent)]
    # Without -march=native, for coal's own library aligns Eigen's matrices without it.
    options = ["-w", "-O3", "-DNDEBUG", "-DCOAL_HAS_QHULL", "-std=c++17", "-shared", "-fPIC"]
    try:
        subprocess.run(["c++", *options, *headers, source, "-o", library, *runtime], check=True)
    except (FileNotFoundError, subprocess.CalledProcessError) as error:
        return f"coal_loop.cpp cannot be compiled: {error}"
    loaded = ctypes.CDLL(str(library))
    loaded.make_world.restype = ctypes.c_void_p
    return loaded


def coal_loop(library: ctypes.CDLL, robot: ws.Robot) -> Labels | None:
    """Labels (N,) of configurations (N, nq) by coal; None where it has no shape for one of the robot's."""
    bodies = robot.bodies
    geoms = np.array([shape.geom for shape in bodies.shapes], np.int32)
    pairs = np.ascontiguousarray(geoms[bodies.pairs])
    if (pairs < 0).any():  # of a tool that the model lacks
        return None
    model = bodies.model
    world = library.make_world(ctypes.c_void_p(model._address), ctypes.c_void_p(pairs.ctypes.data), len(pairs))

    def labels(model: mujoco.MjModel, q: np.ndarray) -> np.ndarray:
        data, found = mujoco.MjData(model), np.zeros(len(q), np.uint8)
        pointers = [ctypes.c_void_p(each) for each in (world, model._address, data._address, q.ctypes.data)]
        library.blocked(*pointers, len(q), ctypes.c_void_p(found.ctypes.data))
        return found

    return labels if world else None


def labelled(
    robot: ws.Robot, constraints: tuple, device: str = "cpu", count: int = SAMPLES, chunk: int = CHUNK
) -> tuple[Collisions, Pipeline, object]:
    """What labels ``count`` random configurations on a device, their pipeline and sample space."""
    sampling = plan_sampling(robot.chain, ws.Random(count))
    pipeline = Pipeline(Evaluation(robot.chain), sampling, constraints, kept_rows=frozenset(), precision="float32")
    (own,) = devices_of(device)[:1]
    space = device_space(sampling, "float32", own)
    return collisions_of(pipeline, SweepPlan(pipeline).shape, own, chunk), pipeline, space


def least(repeats: int, cases: dict[str, Callable[[], object]]) -> dict[str, float]:
    """Least CPU seconds of this thread of every case, taken in turn."""
    found = dict.fromkeys(cases, np.inf)
    for _ in range(repeats + 1):
        for name, case in cases.items():
            started = time.thread_time()
            case()
            found[name] = min(found[name], time.thread_time() - started)
    return found


def boxes(robot: ws.Robot, count: int) -> ws.Environment:
    """Boxes of 10 cm that stand about the robot, none at its base."""
    random, reach = np.random.default_rng(0), robot.chain.reach
    away = random.normal(size=(count, 3))
    places = (
        robot.chain.center + away / np.linalg.norm(away, axis=1)[:, None] * random.uniform(0.6, 1.1, (count, 1)) * reach
    )
    return ws.Environment([ws.Box(size_m=(0.1, 0.1, 0.1), position_m=tuple(place.tolist())) for place in places])


def on_gpu(robot: ws.Robot, repeats: int) -> None:
    """Print what one GPU does of a robot's self-collisions, labels alone and swept into voxels."""
    constraints = constraints_for(robot, Constraints(self_collision=True))
    started = time.perf_counter()
    own, _, space = labelled(robot, constraints, "cuda", ON_GPU, GPU_CHUNK)
    ready = time.perf_counter() - started
    bare = plan_of(robot, "float32", "cuda", sampling=ws.Random(ON_GPU))
    bare = replace(bare, kept_rows=None)
    filtered, devices = replace(bare, constraints=constraints), devices_of("cuda")[:1]

    def all_labels() -> None:
        for first in range(0, ON_GPU, GPU_CHUNK):
            own.label(space, first, GPU_CHUNK, 0)
        wp.synchronize()

    cases: dict[str, Callable[[], object]] = {
        "labels": all_labels,
        "sweep": lambda: sweep(bare, 0, ON_GPU, devices),
        "filtered sweep": lambda: sweep(filtered, 0, ON_GPU, devices),
    }
    seconds = dict.fromkeys(cases, np.inf)
    for _ in range(repeats + 1):
        for name, case in cases.items():
            started = time.perf_counter()
            case()
            seconds[name] = min(seconds[name], time.perf_counter() - started)
    rates = ", ".join(f"{name} {ON_GPU / each / 1e9:.2f} G/s" for name, each in seconds.items())
    print(f"{robot.name} on {devices[0].name}: {rates}; ready in {ready:.1f} s")
    print(
        f"  decided by filter, narrow phase (float32, float64), MuJoCo: {np.round(own.decided / own.decided.sum(), 8)}"
    )


def differing(robot: ws.Robot, qpos: np.ndarray, expected: np.ndarray, found: np.ndarray) -> None:
    """Print how many labels of coal differ from MuJoCo's, and how deep MuJoCo's contacts are where coal has none."""
    missed, more = np.flatnonzero(expected & ~found), np.flatnonzero(found & ~expected)
    model, deepest = robot.bodies.model, []
    data = mujoco.MjData(model)
    for number in missed:
        data.qpos[:] = qpos[number]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        deepest.append(-min(contact.dist for contact in data.contact))
    depth = f", where MuJoCo's contacts are {min(deepest):.1e} to {max(deepest):.1e} m deep" if deepest else ""
    print(f"  coal's labels: {len(missed)} collisions of {expected.sum()} missed{depth}; {len(more)} more")


def report(robot: ws.Robot, loop: Labels, coal: ctypes.CDLL | str, repeats: int) -> None:
    """Print what is measured of one robot."""
    constraints = constraints_for(robot, Constraints(self_collision=True))
    own, pipeline, space = labelled(robot, constraints)
    model, bodies = robot.bodies.model, robot.bodies
    q = np.asarray(configurations(pipeline, np.arange(OF_MUJOCO)), np.float64)
    qpos = np.ascontiguousarray(bodies.qpos(q))
    expected, found = loop(model, qpos), own.label(space, 0, CHUNK, CHUNK // 256).numpy()[:OF_MUJOCO] > 0

    def all_labels() -> None:
        for first in range(0, SAMPLES, CHUNK):
            own.label(space, first, CHUNK, CHUNK // 256)

    cases: dict[str, Callable[[], object]] = {"labels": all_labels, "MuJoCo": lambda: loop(model, qpos)}
    with_coal = None if isinstance(coal, str) else coal_loop(coal, robot)
    if with_coal:
        cases["coal"] = lambda: with_coal(model, qpos)
    took = least(repeats, cases)
    rate = SAMPLES / took["labels"]
    print(f"{robot.name}: {len(bodies.pairs)} pairs, blocked {expected.mean():.4f}; {(found != expected).sum()} differ")
    for name in list(cases)[1:]:
        other = OF_MUJOCO / took[name]
        print(f"  labels {rate / 1e6:.2f} M/s, {name} {other / 1e6:.3f} M/s: {rate / other:.1f} times")
    if with_coal:
        differing(robot, qpos, expected > 0, with_coal(model, qpos) > 0)
    else:
        print(f"  without coal: {coal if isinstance(coal, str) else 'it is given no such shape or tool'}")
    print(
        f"  decided by filter, narrow phase (float32, float64), MuJoCo: {np.round(own.decided / own.decided.sum(), 7)}"
    )
    bare = plan_of(robot, "float32", "cpu", sampling=ws.Random(SWEPT))
    bare = replace(bare, kept_rows=None)
    sweeps = {"unfiltered": bare, "self-collision": replace(bare, constraints=constraints)}
    for count in (20, 100):
        try:
            both = constraints_for(robot, Constraints(self_collision=True), boxes(robot, count))
        except ResourceError as error:  # more pairs than are kept apart
            print(f"  {count} boxes: {error}")
            continue
        sweeps[f"{count} boxes"] = replace(bare, constraints=both)
    devices = devices_of("cpu")
    swept = {name: lambda each=each: sweep(each, 0, SWEPT, devices, threads=1) for name, each in sweeps.items()}
    seconds = dict.fromkeys(swept, np.inf)
    for _ in range(repeats + 1):
        for name, case in swept.items():
            started = time.process_time()
            case()
            seconds[name] = min(seconds[name], time.process_time() - started)
    for name, each in seconds.items():
        print(
            f"  sweep, {name}: {SWEPT / each / 1e6:.2f} M/s, {seconds['unfiltered'] / each:.2f} of the unfiltered rate"
        )
    for name in list(sweeps)[2:]:
        print(f"  {name} take {seconds[name] / seconds['self-collision']:.2f} times as long as self-collision")


def main() -> None:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", nargs="+", default=["ur5e", "franka_panda", "kuka_iiwa14"])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--exclude", nargs="*", default=[], metavar="A,B")
    parser.add_argument("--device", choices=["cpu", "cuda"], default="cpu")
    given = parser.parse_args()
    if given.device == "cuda":
        for name in given.robots:
            on_gpu(ws.load_robot(name), given.repeats)
        return
    loop, coal, excluded = mujoco_loop(), coal_library(), [tuple(each.split(",")) for each in given.exclude]
    for name in given.robots:
        path, _, tip = name.partition("@")
        report(ws.load_robot(path, tip=tip or None, exclude=excluded), loop, coal, given.repeats)


if __name__ == "__main__":
    main()
