"""The first ten minutes of three newcomers: what the pages say to type, typed, in a fresh environment made of a wheel.

python tests/ten_minutes.py FOLDER   # installs there, as the page says, and spends the minutes of all three
"""

import atexit
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from shutil import copytree, ignore_patterns, rmtree
from tempfile import TemporaryDirectory, mkdtemp
from typing import Any

CLONE = Path(__file__).parents[1]
sys.path.insert(0, str(CLONE))

from tests.snippets import blocks  # noqa: E402

START = CLONE / "docs" / "start"
MATLAB, MECHANISM, CELL = (
    "You come from MATLAB, with a URDF",
    "You have a parallel mechanism",
    "You have a cell and ten targets",
)
SHELL = ["bash", "-euo", "pipefail", "-c"]
LONGEST_S = 600.0  # the ten minutes
INSTALL_S = 900.0
# Robots of others, who had never heard of wsrender: package and file.
URDFS = {
    "KUKA KR 16": ("rtbdata", "xacro/kuka_description/kuka_kr16/urdf/kr16_2.urdf"),
    "ABB IRB 140": ("rtbdata", "xacro/abb_irb140_description/urdf/irb140.urdf"),
    "Puma 560": ("rtbdata", "xacro/unimation_puma560_description/urdf/puma560_robot.urdf"),
    "KUKA iiwa": ("pybullet_data", "kuka_iiwa/model.urdf"),
    "xArm6": ("pybullet_data", "xarm/xarm6_robot.urdf"),
}


def part_of(page: str, title: str) -> str:
    """What a page says under a title."""
    text = (START / page).read_text(encoding="utf-8").partition(f"\n## {title}\n")[2]
    assert text, f"{page} has no part {title}"
    return text.partition("\n## ")[0]


def program(part: str) -> str:
    """What a part of the page says to type, in its order, as one program of Python."""
    lines = ["import subprocess\n"]
    for language, typed in blocks_of(part_of("ten_minutes.md", part)):
        lines.append(typed if language == "python" else f"subprocess.run({[*SHELL, typed]!r}, check=True)\n")
    return "\n".join(lines)


def blocks_of(text: str) -> list[tuple[str, str]]:
    """(language, content) of the fenced blocks of both languages, in their order."""
    found = [(text.index(typed), language, typed) for language in ("sh", "python") for typed in blocks(text, language)]
    return [(language, typed) for _, language, typed in sorted(found)]


def installed(folder: Path) -> Path:
    """The programs of a fresh environment in a folder, by what the page says of wheels."""
    clone = copytree(CLONE, folder / "clone", ignore=ignore_patterns(".*", "node_modules", "_build", "__pycache__"))
    (make, install), there = blocks(part_of("install.md", "From a wheel"), "sh"), folder / "fresh"
    there.mkdir()
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([*SHELL, make], cwd=clone, env=environment, check=True, timeout=INSTALL_S)
    for wheel in clone.glob("*.whl"):
        wheel.rename(there / wheel.name)
    subprocess.run([*SHELL, install], cwd=there, env=environment, check=True, timeout=INSTALL_S)
    return there / ".venv" / "bin"


def spend(
    part: str, programs: Path, folder: Path, urdf: Path | None = None, also: Mapping[str, str] | None = None
) -> str:
    """Type a part in an empty folder, with an empty home and only what is in ``programs``; what was printed.

    ``urdf``: the newcomer's robot; ``also``: variables of the environment.
    """
    home, here = folder / "home", folder / "here"
    home.mkdir()
    here.mkdir()
    if urdf is not None:
        (here / "arm.urdf").write_bytes(urdf.read_bytes())
    environment = {"HOME": str(home), "PATH": f"{programs}:/usr/bin:/bin", "LANG": "C.UTF-8", "MPLBACKEND": "agg"}
    done = subprocess.run(
        [programs / "python", "-c", program(part)],
        cwd=here,
        env=environment | dict(also or {}),
        capture_output=True,
        text=True,
        timeout=LONGEST_S,
        check=False,
    )
    assert done.returncode == 0, f"{part}: {done.stdout}{done.stderr}"
    return done.stdout


def urdf_of(name: str) -> Path:
    """A robot of a package that is there."""
    package, path = URDFS[name]
    spec = find_spec(package)
    if spec is None or spec.origin is None:
        raise FileNotFoundError(f"{name} needs {package}, of the extra test-models")
    return Path(spec.origin).parent / path


@cache
def _fresh() -> Path:
    folder = Path(mkdtemp(prefix="ten_minutes_"))
    atexit.register(rmtree, folder, ignore_errors=True)  # an environment of a gigabyte
    return installed(folder)


def _spent(part: str, robot: str | None = None) -> dict[str, Any]:
    urdf = urdf_of(robot) if robot else None
    with TemporaryDirectory() as folder:
        programs, start, worked = _fresh(), time.perf_counter(), _cpu_seconds()
        try:
            lines = spend(part, programs, Path(folder), urdf).count("\n")
        except subprocess.TimeoutExpired:
            lines = None
        seconds, worked = time.perf_counter() - start, _cpu_seconds() - worked
        return {"seconds": round(seconds, 1), "cpu_seconds": round(worked, 1), "lines": lines}


def _cpu_seconds() -> float:
    """Of all processes that have been waited for: what a machine that has other work takes longer for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


PARTS: dict[str, Callable[[], dict[str, Any]]] = {
    **{name: partial(_spent, MATLAB, name) for name in URDFS},
    "mechanism": partial(_spent, MECHANISM),
    "cell": partial(_spent, CELL),
}
TOO_LONG = tuple(PARTS)  # a fresh environment for each choice; the stage "wheel" of the CI has one


def violations(figures: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Minutes that are more than ten: what had not ended then is among them."""
    late = {part: found for part, found in figures.items() if found["lines"] is None or found["seconds"] > LONGEST_S}
    return [f"{part}: {found['seconds']} s, {found['cpu_seconds']} s of work" for part, found in late.items()]


def main() -> int:
    """Install in the folder that is given, and spend the minutes of all three."""
    folder = Path(sys.argv[1]).absolute()
    programs = installed(folder)
    for part, urdf in ((MATLAB, urdf_of("KUKA KR 16")), (MECHANISM, None), (CELL, None)):
        start = time.perf_counter()
        with TemporaryDirectory(dir=folder) as place:
            print(spend(part, programs, Path(place), urdf))
        print(f"{part}: {time.perf_counter() - start:.0f} s", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
