"""Warnings about volumes."""

from wsrender.analyses.volume_notices import few_samples


def test_shares_are_written_out():
    """Of three digits, too: not 2.9e+02."""
    (notice,) = few_samples(None, 2.914)
    assert "more samples would find at least 291" in notice.message
    (notice,) = few_samples(0.25, 0.0)
    assert "about 25 are empty" in notice.message
    (notice,) = few_samples(0.0123, 0.0)
    assert "about 1.2 are empty" in notice.message
    assert list(few_samples(0.0, 0.9)) == []
