"""What CONTRIBUTING names is there: files and folders, commands, groups of entry points, and functions."""

import re
import shlex
import tomllib
from importlib import import_module

import wsrender as ws
from tests import long
from tests.snippets import CLONE
from wsrender.analyses.contract import Analysis, Draft
from wsrender.pipeline.pipeline import Pipeline
from wsrender.results.result import Result
from wsrender.robots.chain import Chain
from wsrender.robots.library import LibraryRobot
from wsrender.run import steps

TEXT = re.sub(
    r"^```.*?^```", "", (CLONE / "CONTRIBUTING.md").read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL
)
NAMED = list(dict.fromkeys(re.findall(r"`([^`]+)`", TEXT)))
PROJECT = tomllib.loads((CLONE / "pyproject.toml").read_text(encoding="utf-8"))
# Where paths begin that are shortened, as the text beside them says.
ROOTS = ("", "kernels", "wsrender", "wsrender/results", "server/wsrender_server", "server/web", "server/web/src")
# Of which file or folder ``<name>`` stands for another each time: those of one that is there.
NAMES = {"mjcf": "ur5e", "wsrender/analyses": "capability", "wsrender/pipeline/constraints": "torque"}
NAMES["wsrender_kernels/constraints"] = "torque"
PATH = re.compile(r"[\w.<>/-]*(/|\.(py|md|ts|toml|xml))[\w.<>/-]*")
WORDS = {"dev", "utils", "wsrender", "warp", "wsrender_kernels", "<custom>", "tool", "example"}
TYPED = ("ruff", "pyright", "lint-imports", "npm", "sphinx-build", "python", "pip", "wsrender run", "import", "POST")
MODULES = ("wsrender.client", "wsrender.engine", "wsrender.errors")


def test_paths_are_there():
    paths = [name for name in NAMED if PATH.fullmatch(name)]
    assert len(paths) > 80
    assert [path for path in paths if not _is_there(path)] == []


def _is_there(path):
    name = next((NAMES[folder] for folder in NAMES if path.startswith(f"{folder}/<name>")), "")
    path = path.replace("<name>", name)
    found = [place / path for place in _roots() if (place / path).exists()]
    return any(each.is_dir() == path.endswith("/") or path == ".ci/run" for each in found)


def _roots():
    yield from (CLONE / root for root in ROOTS)
    yield from (
        CLONE / "mjcf" / "ur5e",
        CLONE / "wsrender" / "analyses" / "capability",
        CLONE / "wsrender/results/export",
    )
    yield from (CLONE / "wsrender" / "analyses" / "base_placement",)  # which has a view.py


def test_commands_are_there():
    commands = [shlex.split(name) for name in NAMED if name.startswith(("python ", "pip ", "ruff ", "wsrender "))]
    assert len(commands) >= 10
    for command in commands:
        if command[:2] == ["python", "-m"]:
            program = CLONE / f"{command[2].replace('.', '/')}.py"
            assert "__main__" in program.read_text(encoding="utf-8"), command
        elif command[0] == "python":
            assert (CLONE / command[1]).is_file() and (len(command) < 3 or command[2] in long.PIECES), command
        elif command[0] == "pip":
            assert set(re.findall(r"\[(.*)\]", command[-1])) <= set(PROJECT["project"]["optional-dependencies"]), (
                command
            )


def test_what_is_left_is_a_name_of_the_program():
    """An extra, a group of entry points, or a function, class or constant where the text says that it stands."""
    groups = {f"wsrender.{kind}" for kind in ("analyses", "commands", "constraints", "formats", "indices", "pictures")}
    extras = set(PROJECT["project"]["optional-dependencies"])
    owners = (ws, steps, Analysis, Result, long, long.PIECES["gallery"])
    classes = {each.__name__ for each in (Chain, Draft, Pipeline, LibraryRobot, ws.Robot)}

    def known(name):
        bare = re.sub(r"^(ws|result)\.|\(.*", "", name)
        return (
            PATH.fullmatch(name)
            or name in WORDS | groups | extras | classes | set(LibraryRobot.__dataclass_fields__)
            or name.startswith(TYPED)
            or any(hasattr(owner, bare) for owner in owners)
            or (name in MODULES and import_module(name))
            or " → " in name
        )

    assert [name for name in NAMED if not known(name)] == []
