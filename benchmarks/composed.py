"""Composed jobs: a placement scan beside that of an earlier commit, and one job on two workers beside one.

    python benchmarks/composed.py scan --before 387fc60~1 [--repeats 5]
    python benchmarks/composed.py workers [--repeats 3]

`scan`: two robots, 12 placements, no refined volumes; this checkout and the commit, in a temporary worktree, run in
turn. `workers`: a shared_workspace job on a server with one and with two workers of one thread each, in turn, each run
with another seed. Prints the least seconds of the wall clock and of the processor, and their ratios: nothing is
asserted, and on a busy machine those of the processor say more.
"""

import argparse
import contextlib
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

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
SAMPLES, SHARD = 1 << 26, 1 << 23


def main() -> None:
    """Parse the options and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["scan", "workers"])
    parser.add_argument("--before", default="387fc60~1", help="commit that the scan is compared with")
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    if options.what == "scan":
        print_scan(options.before, options.repeats)
    else:
        print_workers(options.repeats)


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


def shared(samples: int, seed: int) -> dict:
    """A job of two arms."""
    sampling = {"method": "sobol", "count": samples, "seed": seed}
    robots = [{"robot": {"library": "ur5e", "placement": {"position_m": at}}, "sampling": sampling} for at in PLACES]
    return {"analysis": "shared_workspace", "robots": robots, "voxel_size_m": 0.02, "refined_volume": None}


def print_ratio(taken: dict[str, list[list[float]]]) -> None:
    """Least seconds of each, and those of the second over those of the first."""
    least = {name: [min(each) for each in zip(*rows, strict=True)] for name, rows in taken.items()}
    for name, seconds in least.items():
        print(f"{name:12}", *(f"{value:8.3f} s" for value in seconds))
    first, second = least.values()
    print(f"{'ratio':12}", *(f"{b / a:8.3f}  " for a, b in zip(first, second, strict=True)), "(wall, processor)")


if __name__ == "__main__":
    main()
