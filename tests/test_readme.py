"""What the README shows works as it is written."""

import re

from tests.snippets import CLONE, run

README = (CLONE / "README.md").read_text(encoding="utf-8")


def test_python_example(tmp_path, monkeypatch, capsys):
    names = run(CLONE / "README.md", tmp_path, monkeypatch)
    assert "manipulability" in capsys.readouterr().out
    assert (tmp_path / "slice.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "out" / "result.json").is_file()
    assert names["robot"].forward_kinematics([0, -1.5, 1.5, 0, 1, 0]).shape == (1, 4, 4)
    assert list(names["found"].labels) == ["reachable", "unreachable"]
    assert list(names["found"].reasons) == ["", "out of reach"]


def test_it_is_read_in_two_minutes():
    """Its words beside code and tables, at 250 a minute."""
    prose = re.sub(r"^```.*?^```|^\|.*$", "", README, flags=re.MULTILINE | re.DOTALL)
    assert len(prose.split()) <= 500
