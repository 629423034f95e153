"""The golden files: jobs that run in about a second, and what their results were.

``documents/<analysis>.json`` holds the job that stands for an analysis, ``documents/<analysis>.<branch>.json`` one of
another branch of it. ``folders/<version>/<analysis>.zip`` is a result folder as that version has saved it, of a smaller
job and without pictures; it is never written again, for later versions have to read it.
"""

import json
import zipfile
from pathlib import Path
from typing import Any

from wsrender.analyses.registry import job_classes

DOCUMENTS = Path(__file__).parent / "documents"
FOLDERS = Path(__file__).parent / "folders"

# Analyses of which no version has saved a result.
UNSAVED = frozenset({"base_placement", "inverse_reachability", "postures", "two_arm_placement"})


def analyses() -> list[str]:
    """Names of all analyses."""
    return list(job_classes())


def golden_names() -> list[str]:
    """Names of all golden jobs."""
    return sorted(path.stem for path in DOCUMENTS.glob("*.json"))


def golden(name: str) -> dict[str, Any]:
    """``job``, ``document``, ``data`` and ``pictures`` of a golden file."""
    return json.loads((DOCUMENTS / f"{name}.json").read_text(encoding="utf-8"))


def job_of(name: str) -> dict[str, Any]:
    """A golden job; the name of an analysis gives the one that stands for it."""
    return golden(name)["job"]


def saved_versions() -> list[str]:
    """Versions of which there are saved results."""
    return sorted(path.name for path in FOLDERS.iterdir())


def saved_folder(version: str, analysis: str, folder: Path) -> Path:
    """The result folder that a version has saved, unpacked as ``folder/<analysis>``."""
    with zipfile.ZipFile(FOLDERS / version / f"{analysis}.zip") as archive:
        archive.extractall(folder / analysis)
    return folder / analysis
