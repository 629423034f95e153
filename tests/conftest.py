"""Fixtures of the whole suite."""

import os

import pytest

STARTED_WITH = os.environ.get("PYTHONPATH")


@pytest.fixture(autouse=True)
def searched_modules():
    """No fixture that outlives its tests may change which modules the processes find that others start."""
    assert os.environ.get("PYTHONPATH") == STARTED_WITH


def available_devices():
    """Names of the devices to test on: the CPU, and a GPU where there is one."""
    try:
        import warp as wp
    except ImportError:
        return ["cpu"]
    from wsrender.engine.devices import initialize

    initialize()
    return ["cpu", "cuda"] if wp.get_cuda_devices() else ["cpu"]


@pytest.fixture(params=available_devices())
def device(request):
    """Every device that the kernels can run on here."""
    return request.param


@pytest.fixture(params=["float32", "float64"])
def precision(request):
    """Both working precisions."""
    return request.param
