"""Steps between the cells stay where the base may stand."""

import numpy as np

from tests.analyses.base_placement.test_base_placement import RING, job
from wsrender.analyses.base_placement.refined import _within
from wsrender.analyses.jobs import parse_job


def test_steps_end_at_the_ranges_but_whole_turns_go_on():
    beyond = np.array([[1.2, -0.1, 3.0, 0.0, 0.0, 370.0], [-0.2, 0.5, 3.0, 0.0, 0.0, -30.0]])
    over = {"x_m": [0, 1, 0.5], "y_m": [0, 1, 0.5], "z_m": 3.0}
    for yaw, ends in (([0, 360, 60], (10.0, 330.0)), ([0, 90, 45], (90.0, 0.0))):
        parsed = parse_job(job("ur5e", RING, over=over | {"yaw_deg": yaw}))
        first, second = _within(parsed, beyond)
        assert first.tolist() == [1.0, 0.0, 3.0, 0.0, 0.0, ends[0]]
        assert second.tolist() == [0.0, 0.5, 3.0, 0.0, 0.0, ends[1]]
