"""Errors keep what they say on their way between processes."""

import pickle
import re
from pathlib import Path

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


def test_a_missing_extra_says_what_works_from_a_clone_and_from_a_wheel():
    message = str(ws.MissingExtraError("pyvista", "render"))
    assert (
        message.startswith("pyvista is not installed; ")
        and 'in the clone of wsrender run: pip install ".[render]"' in message
    )
    assert f'pip install "wsrender-{ws.__version__}-py3-none-any.whl[render]"' in message


def test_nothing_tells_users_to_install_from_a_package_index():
    checkout = Path(__file__).parents[1]
    texts = [
        path for folder in ("wsrender", "server", "kernels", "benchmarks") for path in (checkout / folder).rglob("*")
    ]
    texts = [path for path in [*texts, *checkout.glob("*.md")] if path.suffix in (".py", ".md", ".service")]
    assert len(texts) > 300
    from_index = re.compile(r"pip install[^`\n]*[ \"']wsrender(\[|[\"'`\s]|$)", re.MULTILINE)
    assert from_index.search('pip install "wsrender[render]"') and from_index.search("`pip install wsrender`")
    found = [path.name for path in texts if from_index.search(path.read_text(encoding="utf-8"))]
    assert found == []
