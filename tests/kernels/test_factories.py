"""Factories of kernels under threads: Warp's registers are shared, so nothing may be made twice or side by side."""

import time
from concurrent.futures import ThreadPoolExecutor

import warp as wp
from wsrender_kernels.factories import factory
from wsrender_kernels.inverse import inverse_kernel

THREADS = 4


def test_threads_that_ask_at_once_get_one_thing():
    made = []

    @factory
    def slow(name: str) -> object:
        made.append(name)
        time.sleep(0.05)
        return object()

    with ThreadPoolExecutor(THREADS) as pool:
        things = list(pool.map(slow, ["same"] * THREADS))
    assert made == ["same"]
    assert len(set(map(id, things))) == 1


def test_one_thing_is_made_at_a_time():
    making, at_once = [], []

    @factory
    def outer(name: str) -> str:
        making.append(name)
        time.sleep(0.02)
        at_once.append(len(making))
        making.remove(name)
        return inner(name)

    @factory
    def inner(name: str) -> str:
        return name * 2

    with ThreadPoolExecutor(THREADS) as pool:
        assert list(pool.map(outer, "abcd")) == ["aa", "bb", "cc", "dd"]
    assert at_once == [1] * 4


def test_threads_share_a_kernel():
    def make(_thread: int) -> wp.Kernel:
        return inverse_kernel(wp.float32, 11, tuple(range(11)), True, "axis", False)

    with ThreadPoolExecutor(THREADS) as pool:
        assert len(set(map(id, pool.map(make, range(THREADS))))) == 1
