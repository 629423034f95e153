"""The seed of a job is the one that whatever draws for it gets; most results would not show another."""

from importlib import import_module

import pytest

import wsrender as ws
from tests.golden.files import job_of
from tests.run.small_jobs import SMALL_JOBS

SEED = 12345
SMALL = {name: job | {"seed": SEED} for name, job in SMALL_JOBS.items()}
SAMPLING = {"method": "sobol", "count": 512, "seed": SEED}
WORKSPACE = SMALL_JOBS["workspace"] | {"robot": "spherical", "sampling": SAMPLING}  # which fills a volume
UPRIGHT = {"orientation": {"toward": [0, 0, 1], "within_deg": 120}}  # which rejects some of every arm's samples
UPRIGHT_SIDE = {"robot": "spherical", "sampling": SAMPLING, "constraints": UPRIGHT}
MAPPING_SEARCH = {"scale": [0.1, 2], "offset_m": [[-0.1, 0.1]] * 3, "seed": SEED}


def seeded(name):
    """A golden job whose search has the seed."""
    return job_of(name) | {"search": job_of(name)["search"] | {"seed": SEED}}


SOLVER = "wsrender.reach.inverse_solver.InverseSolver", "__init__"
DRAWING = {  # what draws, and jobs for which it does
    ("wsrender.reach.occupied_cells", "Sobol"): {"capability": SMALL["capability"], "refined volume": WORKSPACE},
    SOLVER: {
        "reachability": SMALL["reachability"],
        "placements": SMALL["base_placement"],
        "capability": SMALL["capability"],
        "refined volume": WORKSPACE | {"voxel_labels": False},
        "labels": WORKSPACE | {"refined_volume": None},
        "free volume": WORKSPACE | {"voxel_labels": False, "constraints": UPRIGHT},
        "labels under constraints": WORKSPACE | {"refined_volume": None, "constraints": UPRIGHT},
        "mapping": job_of("master_slave_mapping") | {"master": UPRIGHT_SIDE, "search": None},
    },
    ("wsrender.analyses.base_placement.run", "largest_ball"): {"tolerance": SMALL["base_placement"] | {"refine": True}},
    ("wsrender.reach.volume_refinement", "estimate_volumes"): {"refined volume": WORKSPACE},
    ("wsrender.reach.free_volume", "estimate_volumes"): {"free volume": WORKSPACE | {"constraints": UPRIGHT}},
    ("wsrender.analyses.parallel_workspace.refined", "estimate_volumes"): {"legs": SMALL["parallel_workspace"]},
    ("wsrender.analyses.parallel_workspace.run", "random_orientations"): {
        "orientations": job_of("parallel_workspace.orientation") | {"seed": SEED}
    },
    ("wsrender.mapping", "differential_evolution"): {
        "mapping": job_of("master_slave_mapping") | {"offsets_m": [[0, 0, 0]], "search": MAPPING_SEARCH}
    },
    ("wsrender.analyses.design_optimization.run", "evolve"): {"design": seeded("design_optimization.searched")},
    ("wsrender.analyses.design_optimization.run", "pareto"): {"design": seeded("design_optimization.pareto")},
}
CASES = [
    pytest.param(*place, job, id=f"{place[1]}-{name}") for place, jobs in DRAWING.items() for name, job in jobs.items()
]


@pytest.mark.parametrize(("place", "function", "job"), CASES)
def test_what_draws_gets_the_seed_of_the_job(place, function, job, monkeypatch):
    module, _, last = place.rpartition(".")
    holder = getattr(import_module(module), last) if last[0].isupper() else import_module(place)
    called, seeds = getattr(holder, function), []

    def noting(*args, **options):
        seeds.append(next((options[name] for name in ("seed", "rng") if name in options), args[-1]))
        return called(*args, **options)

    monkeypatch.setattr(holder, function, noting)
    ws.execute(job)
    assert set(seeds) == {SEED}
