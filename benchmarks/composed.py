"""Composed jobs: a placement scan beside that of an earlier commit, and one job on two workers beside one.

    python benchmarks/composed.py scan --before 387fc60~1 [--repeats 5]
    python benchmarks/composed.py workers [--repeats 3]
    python benchmarks/composed.py steps

`scan`: two robots, 12 placements, no refined volumes; this checkout and the commit, in a temporary worktree, run in
turn. `workers`: a shared_workspace job on a server with one and with two workers of one thread each, in turn, each run
with another seed. `steps`: the same job's steps one after the other in one thread, and from their seconds of the
processor what one and two workers would take, which other load changes less. Prints the least seconds of the clock,
of a scan those of the processor too, and their ratios: nothing is asserted.
"""

import argparse
import contextlib
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import reduce
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
SCAN = """
import sys, time
import wsrender as ws
robots = [ws.load_robot("ur5e", placement=ws.Transform(position_m=(x, 0, 0))) for x in (0, 0.5)]
scan = {"axis": "x", "values": [0.1 * k for k in range(12)]}
def run():
    return ws.shared_workspace(robots, scan=scan, refined_volume=None, device="cpu")
print(run().tables["scan"]["occupied_shared"].tolist(), flush=True)
for _ in sys.stdin:
    wall, cpu = time.perf_counter(), time.process_time()
    run()
    print(time.perf_counter() - wall, time.process_time() - cpu, flush=True)
"""
PLACES = ((0, 0, 0), (0.5, 0, 0))
SAMPLES, SHARD = 1 << 30, 1 << 26  # half a minute on one worker: files and pictures take 2 s of any job


def main() -> None:
    """Parse the options and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["scan", "workers", "steps"])
    parser.add_argument("--before", default="387fc60~1", help="commit that the scan is compared with")
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    if options.what == "scan":
        print_scan(options.before, options.repeats)
    elif options.what == "workers":
        print_workers(options.repeats)
    else:
        print_steps()


def print_scan(before: str, repeats: int) -> None:
    """Seconds of a scan here and at a commit."""
    with worktree(before) as earlier:
        runs = {"here": child(ROOT), before: child(earlier)}
        for name, run in runs.items():
            print(f"{name}: occupied_shared {run.stdout.readline().strip()}")
        taken = {name: [] for name in runs}
        for _ in range(repeats):
            for name, run in runs.items():
                run.stdin.write("run\n")
                run.stdin.flush()
                taken[name].append([float(value) for value in run.stdout.readline().split()])
        for run in runs.values():
            run.stdin.close()
            run.wait()
    print_ratio(taken)


@contextlib.contextmanager
def worktree(commit: str) -> Iterator[Path]:
    """A commit checked out in a folder that goes again."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "before"
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--detach", "-q", path, commit], check=True)
        try:
            yield path
        finally:
            subprocess.run(["git", "-C", ROOT, "worktree", "remove", "--force", path], check=True)


def child(root: Path) -> subprocess.Popen:
    """A process that runs the scan of a checkout whenever it is asked."""
    paths = ":".join(str(root / part) for part in ("", "kernels", "server"))
    command, pipe = [sys.executable, "-c", SCAN], subprocess.PIPE
    return subprocess.Popen(command, cwd=root, env={"PYTHONPATH": paths}, stdin=pipe, stdout=pipe, text=True)


def print_workers(repeats: int) -> None:
    """Seconds of a job on one worker and on two."""
    from wsrender_server.local_server import LocalServer

    import wsrender as ws

    os.environ |= {"WSRENDER_THREADS_PER_WORKER": "1", "WSRENDER_SHARD_SAMPLES": str(SHARD)}
    taken = {"two workers": [], "one worker": []}
    with contextlib.ExitStack() as stack:
        clients = {}
        for name, workers in (("two workers", 2), ("one worker", 1)):
            data = Path(stack.enter_context(tempfile.TemporaryDirectory()))
            server = stack.enter_context(LocalServer(data, ["--workers", str(workers)]))
            clients[name] = stack.enter_context(ws.Client(server.url))
            for seed in range(workers + 1):  # kernels loaded by every worker
                clients[name].submit(shared(1 << 12, seed)).wait()
        for seed in range(repeats):
            for name, client in clients.items():
                started = time.perf_counter()
                client.submit(shared(SAMPLES, seed)).wait()
                taken[name].append([time.perf_counter() - started])
    print_ratio(taken)


def print_steps() -> None:
    """Seconds of the processor of every step of a job, and what one and two workers make of them."""
    from wsrender import run

    def timed(step: Callable[[], Any]) -> tuple[Any, float]:
        started = time.process_time()
        return step(), time.process_time() - started

    whole = run.plan(shared(SAMPLES, 0))
    run.run_shard(whole.over(0, SHARD >> 5), 0, threads=1)  # kernels are loaded

    def planned() -> run.Plan:
        plan = run.plan(shared(SAMPLES, 0))
        _ = plan.estimate  # which a server tells before the job runs
        return plan.settled_as(plan.division(SHARD, 256))

    divided, planning = timed(planned)
    swept = [timed(lambda k=k: run.run_shard(divided, k, threads=1)) for k in range(len(divided.shards))]
    partials, shards = zip(*swept, strict=True)

    def finish(folder: str) -> None:
        run.finish(divided, reduce(divided.merged, partials), threads=1).save(folder)

    with tempfile.TemporaryDirectory() as folder:
        finish(folder)  # what writes files is imported
        _, finishing = timed(lambda: finish(folder))
    two = [0.0, 0.0]
    for seconds in shards:
        two[two.index(min(two))] += seconds
    print(f"plan {planning:.3f} s, {len(shards)} shards {sum(shards):.3f} s, merge and finish {finishing:.3f} s")
    print_ratio({name: [[planning + each + finishing]] for name, each in (("two", max(two)), ("one", sum(shards)))})


def shared(samples: int, seed: int) -> dict:
    """A job of two arms."""
    sampling = {"method": "sobol", "count": samples, "seed": seed}
    robots = [{"robot": {"library": "ur5e", "placement": {"position_m": at}}, "sampling": sampling} for at in PLACES]
    return {"analysis": "shared_workspace", "robots": robots, "voxel_size_m": 0.05, "refined_volume": None}


def print_ratio(taken: dict[str, list[list[float]]]) -> None:
    """Least seconds of each, and those of the second over those of the first."""
    least = {name: [min(each) for each in zip(*rows, strict=True)] for name, rows in taken.items()}
    for name, seconds in least.items():
        print(f"{name:12}", *(f"{value:8.3f} s" for value in seconds))
    first, second = least.values()
    print(f"{'ratio':12}", *(f"{b / a:8.3f}  " for a, b in zip(first, second, strict=True)))


if __name__ == "__main__":
    main()
