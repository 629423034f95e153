"""What the results of all analyses of several robots say of each of them."""

from typing import Any

import numpy as np

from wsrender.analyses.several_robots import SeveralPlans
from wsrender.notices import Notice
from wsrender.results.result import Result

OF_EACH = (
    *("robot", "sampling", "samples", "rejections", "indices", "volume_m3", "headline", "bounds_m", "global"),
    "convergence",
)


def common_entries(several: SeveralPlans, results: list[Result]) -> dict[str, Any]:
    """Robots with the values of each alone, the choices they share and the voxel size."""
    documents = [result.document for result in results]
    robots = [
        {"name": name, **{key: document[key] for key in OF_EACH if key in document}}
        for name, document in zip(several.names, documents, strict=True)
    ]
    return {
        "robots": robots,
        "choices": documents[0]["choices"],
        "voxel_size_m": several.plans[0].voxel_size_m,
    }


def notices_of_each(names: list[str], results: list[Result]) -> list[Notice]:
    """What is known of each robot's numbers, led by its name."""
    return [
        Notice(**{**warning, "message": f"{name}: {warning['message']}"})
        for name, result in zip(names, results, strict=True)
        for warning in result.document["warnings"]
    ]


def skeletons(results: list[Result], posture: int = 1) -> np.ndarray:
    """Every robot in one of its postures, by default at mid-range, (K, L + 2, 3) [m]; shorter arms repeat their tip."""
    arms = [result.skeleton[posture] for result in results if result.skeleton is not None]
    length = max(map(len, arms))
    return np.stack([np.concatenate([arm, np.repeat(arm[-1:], length - len(arm), axis=0)]) for arm in arms])


def sampling_path(results: list[Result]) -> str:
    """How the samples of the robots were evaluated; where that differs, of each in turn: "collapsed, direct"."""
    paths = [result.document["provenance"]["sampling_path"] for result in results]
    return paths[0] if len(set(paths)) == 1 else ", ".join(paths)
