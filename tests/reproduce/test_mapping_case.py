"""The rows of the mapping of slave_5r into master_4dof: documents that can be run, values where they belong."""

from types import SimpleNamespace

import numpy as np

from tests.reference.chain_kinematics import forward_kinematics
from wsrender.analyses.jobs import parse_job
from wsrender.reproduce import reproduce, zhang
from wsrender.robots import library, load_path


def test_rows_hold_what_the_jobs_found(monkeypatch):
    seen = []

    def execute(document, progress=None):
        job = parse_job(document)
        seen.append(job)
        if job.analysis == "parallel_workspace":
            refined = {"value": 3.0, "ci95": [2.0, 4.0]}
            return SimpleNamespace(document={"volume_m3": {"refined": refined}})
        offsets = [
            {"offset_m": offset, "scale": [0.1 * k] * 3, "succeeded": k > 0, "failing_points": 5, "volume_m3": k,
             "efficiency": 0.01 * k}
            for k, offset in enumerate(job.offsets_m)
        ]  # fmt: skip
        volumes = {"master": 3.1, "slave": 0.1, "mapped": 2}
        return SimpleNamespace(document={"volume_m3": volumes, "mapping": offsets[-1], "offsets": offsets})

    monkeypatch.setattr(zhang, "execute", execute)
    rows = reproduce("wsrender-mapping")
    assert [row.reproduced for row in rows] == [3.0, 3.1, 0.1, 0.0, 0.1, 0.2, 2, 0.02]
    assert (rows[0].low, rows[0].high) == (2.0, 4.0)
    assert "5 points outside" in rows[3].note and "all points inside" in rows[4].note
    mapping, master = seen
    assert mapping.master.mechanism.library == master.mechanism.library == "master_4dof"
    assert mapping.slave.robot.library == "slave_5r"


def test_the_slave_moves_on_a_sphere():
    chain = load_path(library.find("slave_5r")).chain
    q = np.random.default_rng(0).uniform(chain.lower_limits, chain.upper_limits, (20, chain.n))
    positions = np.array([forward_kinematics(chain, each)[:3, 3] for each in q])
    np.testing.assert_allclose(np.linalg.norm(positions, axis=1), 0.3, rtol=1e-12)
