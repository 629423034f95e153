"""Errors keep what they say on their way between processes."""

import pickle

import pytest

import wsrender as ws

ERRORS = [
    ws.DocumentError([("a.b", "must be 1"), ("c", "must be 2")]),
    ws.FrameNotFoundError("tip", "no site x", ["tool", "flange"]),
    ws.InputError("field", "must be positive"),
    ws.JobFailedError("crashed", {"code": "kernel_crash", "status": 500}),
    ws.MissingExtraError("warp", "engine"),
    ws.NotConvergedError("not converged", [{"value": 0.5}]),
    ws.NumericalError("a value is not finite"),
    ws.RenderError("no OpenGL"),
    ws.QuotaError("busy", {"status": 429}, retry_after_s=3.0),
]


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_errors_survive_pickling(error):
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is type(error)
    assert str(copy) == str(error)
    assert vars(copy) == vars(error)
    assert copy.args == error.args
