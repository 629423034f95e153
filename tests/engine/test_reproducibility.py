"""The same bits whatever the chunks, the threads, the shards and the order in which they are merged."""

from importlib import import_module
from itertools import permutations

import numpy as np
import pytest

from tests.engine.test_voxels import executed, job
from tests.lasting import lasting
from wsrender import run
from wsrender.engine import thread_count
from wsrender.errors import InputError

COUNT = 20_000
SPLITS = [
    [(0, COUNT)],
    [(0, 256), (256, COUNT - 256)],
    [(0, 5120), (5120, 5120), (10240, COUNT - 10240)],
]


def rows_of(partial):
    return np.concatenate([partial.rows[first] for first in sorted(partial.rows)], axis=1)


def assert_same_bits(a, b):
    assert a.samples == b.samples
    for name in ("extremes", "totals", "cells", "count", "records", "sums"):
        first, second = getattr(a, name), getattr(b, name)
        assert first.dtype == second.dtype and first.tobytes() == second.tobytes(), name
    assert rows_of(a).tobytes() == rows_of(b).tobytes()


@pytest.mark.parametrize("chunk_size", [1000, 4096, 1_000_000])
@pytest.mark.parametrize("threads", [1, 2, 3])
def test_chunks_and_threads_change_no_bit(chunk_size, threads, precision):
    _, expected, _ = executed(job(precision, COUNT), threads=1, chunk_size=2048)
    _, found, _ = executed(job(precision, COUNT), threads=threads, chunk_size=chunk_size)
    assert_same_bits(found, expected)


@pytest.mark.parametrize("split", SPLITS)
def test_shards_merge_in_any_order(split, precision, device):
    document = job(precision, COUNT, device=device)
    _, expected, _ = executed(document)
    plan = run.plan(document, resolved={**run.plan(document).resolved(), "shards": split})
    partials = [run.run_shard(plan, i, chunk_size=4096) for i in range(len(split))]
    for order in permutations(range(len(split))):
        merged = partials[order[0]]
        for i in order[1:]:
            merged = run.merge(plan, merged, partials[i])
        assert_same_bits(merged.sweep, expected)
    if len(split) == 3:
        a, b, c = partials
        assert_same_bits(run.merge(plan, a, run.merge(plan, b, c)).sweep, expected)


def test_documents_of_equal_jobs_are_equal(precision):
    one, _, _ = executed(job(precision, COUNT), threads=1, chunk_size=1000)
    two, _, _ = executed(job(precision, COUNT), threads=2, chunk_size=1_000_000)
    assert lasting(one.document) == lasting(two.document)


def test_folding_32_bit_counts_changes_nothing(precision, monkeypatch):
    _, expected, _ = executed(job(precision, COUNT))
    monkeypatch.setattr(import_module("wsrender.engine.sweep_plan"), "FOLD_AFTER", 3000)
    _, found, _ = executed(job(precision, COUNT), threads=2, chunk_size=1024)
    assert_same_bits(found, expected)


@pytest.mark.parametrize("method", ["sobol", "boundary", "grid"])
def test_other_sampling_methods(method):
    sampling = (
        {"method": "grid", "per_joint": [3, 31, 7, 1, 5, 2]}
        if method == "grid"
        else {"method": method, "count": 5000, "seed": 3}
    )
    document = job("float32", voxel_statistics=["count"], indices=["manipulability"], keep_map=True)
    document["sampling"] = sampling
    _, one, _ = executed(document, threads=1, chunk_size=256)
    _, two, _ = executed(document, threads=2, chunk_size=1_000_000)
    assert_same_bits(one, two)
    assert one.count.sum() == one.samples == (6510 if method == "grid" else 5000)


@pytest.mark.parametrize("threads", [0, -1, 2.5, "2", True])
def test_threads_that_are_no_count_are_refused(threads):
    with pytest.raises(InputError, match=r"threads: .* is not allowed; a positive whole number is"):
        thread_count(threads)


def test_the_variable_sets_the_threads(monkeypatch):
    monkeypatch.setenv("WSRENDER_THREADS", "3")
    assert (thread_count(), thread_count(np.int64(2))) == (3, 2)
    for text in ("0", "²", "two", "1.5", "-1", "9" * 30):
        monkeypatch.setenv("WSRENDER_THREADS", text)
        with pytest.raises(InputError, match=r"WSRENDER_THREADS: .* is not allowed; a positive whole number is"):
            thread_count()
