"""Shards that would lose samples are refused where they run."""

import numpy as np
import pytest

from tests.run.small_jobs import SMALL_JOBS
from wsrender.engine import SweepPlan
from wsrender.errors import InputError
from wsrender.run import plan, run_shard

SCARA = SMALL_JOBS["workspace"] | {"refined_volume": None, "sampling": {"method": "grid", "per_joint": 7}}
SIX_PUS = SMALL_JOBS["parallel_workspace"] | {"refined_volume": None}


def divided(document, shards):
    whole = plan(document)
    return plan(whole.job, resolved=whole.resolved() | {"shards": shards})


@pytest.mark.parametrize("shard", [(0, 1000), (1000, 1401), (0, 2402), (-1, 10), (2401, 1)])
@pytest.mark.parametrize("path", ["collapsed", "direct"])
def test_a_shard_that_would_lose_samples_is_refused(shard, path):
    document = SCARA | {"keep_map": path == "direct"}
    planned = divided(document, [list(shard)])
    assert SweepPlan(planned.pipeline).sampling_path == path
    unit = planned.resolved()["shard_unit"]
    message = rf"shards: {shard[1]} samples from sample {shard[0]} are not allowed: .* shard_unit {unit}, .* 2401$"
    with pytest.raises(InputError, match=message):
        run_shard(planned, 0)


def test_a_mechanisms_shard_too():
    unit = plan(SIX_PUS).resolved()["shard_unit"]
    with pytest.raises(
        InputError, match=rf"shards: {unit} samples from sample 1 are not allowed: .* shard_unit {unit}"
    ):
        run_shard(divided(SIX_PUS, [[1, unit]]), 0)


def test_shards_at_multiples_of_the_unit_lose_none():
    document = SCARA | {"keep_map": True}
    unit = plan(document).resolved()["shard_unit"]
    shards = [[first, min(unit, 2401 - first)] for first in range(0, 2401, unit)]
    planned = divided(document, shards)
    partials = [run_shard(planned, number).sweep for number in range(len(shards))]
    assert len(shards) > 5 and sum(partial.samples for partial in partials) == 2401
    assert sum(np.sum(partial.count) for partial in partials) == 2401
