"""Memory does not grow with the samples; what does not fit is refused with its numbers; bounds are kept."""

import importlib
import resource
import sys
from dataclasses import replace

import numpy as np
import pytest

import wsrender as ws
from tests.engine.test_voxels import job
from wsrender import run
from wsrender.errors import InputError, NumericalError, ResourceError


def peak_bytes():
    """Largest resident memory of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def swept(count):
    return ws.analyze(
        "phantom_omni",
        ws.Random(count, seed=0),
        indices=["manipulability", "inverse_condition_number"],
        voxel_size_m=0.01,
        device="cpu",
    )


def test_memory_does_not_grow_with_the_samples():
    swept(4_000_000)
    before = peak_bytes()
    result = swept(20_000_000)
    assert result.volume.count.sum() == 20_000_000
    # A single byte kept per sample would show.
    assert peak_bytes() - before < 15_000_000


def test_voxels_that_do_not_fit_are_refused_with_their_numbers():
    message = (
        r"voxel_size_m: 2e-05 gives \d+ x \d+ x \d+ voxels, [\d.]+ GiB of records; [\d.]+ GiB are free on cpu: "
        r"choose larger voxels or fewer statistics"
    )
    with pytest.raises(ResourceError, match=message):
        ws.analyze("phantom_omni", ws.Random(1000), voxel_size_m=2e-5, device="cpu")


def test_a_value_beyond_its_bound_fails_the_job():
    """Bounds of dynamic and user indices come from a coarse first pass and may be passed."""
    document = job("float32", 5000)
    plan = run.plan(document)
    plan.sweep = replace(plan.sweep, bounds=np.array([1e-6, 1.0]))
    with pytest.raises(NumericalError, match=r"index manipulability reaches 0\.\d+, beyond 1e-06.*bound the index"):
        run.run_shard(plan, 0)


@pytest.mark.parametrize("chunk_size", [1, 2**20, 2**31, 2**40])
def test_no_chunk_overflows_32_bit_counts(chunk_size):
    module = importlib.import_module("wsrender.engine.sweep")
    plan = run.plan(job("float32", keep_map=False)).sweep
    assert 256 <= module._chunk_size(plan, chunk_size) <= module.FOLD_AFTER < 2**31


@pytest.mark.parametrize("voxel_size_m", [1e-10, 1e-300, 5e-324])
def test_voxels_too_small_to_number_are_refused(voxel_size_m):
    with pytest.raises(InputError, match=r"voxel_size_m: .* is too small for a workspace of"):
        ws.analyze("phantom_omni", ws.Random(256), voxel_size_m=voxel_size_m, device="cpu")
