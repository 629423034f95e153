"""Seconds to import wsrender, and of the first and second `wsrender run` with an empty kernel cache.

python benchmarks/start_up.py [--robot ur5e] [--repeats 3]
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def seconds(command: list[str], cache: Path | None = None) -> float:
    """Wall-clock time of a command that must succeed, its kernels kept in the folder ``cache``."""
    environment = dict(os.environ) if cache is None else {**os.environ, "WARP_CACHE_PATH": str(cache)}
    started = time.perf_counter()
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - started


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--robot", default="ur5e")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    python = [sys.executable, "-c"]
    rows: dict[str, list[float]] = {"python": [], "import wsrender": [], "first run": [], "second run": []}
    for _repeat in range(arguments.repeats):
        rows["python"].append(seconds([*python, "pass"]))
        rows["import wsrender"].append(seconds([*python, "import wsrender"]) - rows["python"][-1])
        with tempfile.TemporaryDirectory() as folder:
            cache, out = Path(folder, "kernels"), Path(folder, "out")
            run = [*python, "from wsrender.cli import main; main()", "run", arguments.robot, "-o"]
            rows["first run"].append(seconds([*run, f"{out}1"], cache))
            rows["second run"].append(seconds([*run, f"{out}2"], cache))
    print("| what | median [s] | min … max |\n|---|--:|--:|")
    for name, times in rows.items():
        print(f"| {name} | {statistics.median(times):.3g} | {min(times):.3g} … {max(times):.3g} |")


if __name__ == "__main__":
    main()
