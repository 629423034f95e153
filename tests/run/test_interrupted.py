"""Ctrl-C during a run says what was kept."""

import pytest

import wsrender as ws

JOB = {
    "analysis": "workspace",
    "robot": "scara",
    "sampling": {"method": "sobol", "count": 5000},
    "voxel_size_m": 0.1,
    "indices": ["manipulability"],
}


def test_a_run_says_how_far_it_was():
    def press(done, total, message):
        if message == "samples" and done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as stopped:
        ws.execute(JOB, press)
    (note,) = stopped.value.__notes__
    assert note == "samples, 5,000 of 5,000 done; nothing of this run was kept"
