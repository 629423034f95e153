"""Bases that are clamped to the edge of a table: those near the outline of a rectangle, and inside it."""

from functools import reduce

import numpy as np
import pytest

from tests.analyses.base_placement.test_base_placement import DOWN, bases_of, job, labels_of
from wsrender.analyses.jobs import parse_job
from wsrender.documents.placements import TableEdge
from wsrender.errors import DocumentError
from wsrender.run import execute, plan, run_shard

EDGE = {"kind": "table_edge", "center_m": [0.2, -0.1], "size_m": [1.2, 0.8], "yaw_deg": 30, "clamp_m": 0.13}
OVER = {"x_m": [-0.8, 1.0, 0.1], "y_m": [-0.8, 0.8, 0.1], "z_m": 0.1, "yaw_deg": [0, 180, 90]}
HOLES = [[0.2, 0.1, 0.15], [0.5, -0.2, 0.15], [-0.4, 0.3, 0.15]]
CORNERS = np.array([(0.6, 0.4), (-0.6, 0.4), (-0.6, -0.4), (0.6, -0.4)])


def on_the_edge(points):
    """Of points (N, 2): inside the turned rectangle by crossings of a ray, and near one of its four sides."""
    corners = CORNERS[:, 0] + 1j * CORNERS[:, 1]
    corners = 0.2 - 0.1j + corners * np.exp(1j * np.pi / 6)
    z = points[:, 0] + 1j * points[:, 1]
    inside, far = np.zeros(len(z), bool), np.full(len(z), np.inf)
    for a, b in zip(corners, np.roll(corners, 1), strict=True):
        crossed = (a.imag > z.imag) != (b.imag > z.imag)
        inside ^= crossed & (z.real < a.real + (z.imag - a.imag) * (b - a).real / (b - a).imag)
        along = np.clip(((z - a) * np.conj(b - a)).real / abs(b - a) ** 2, 0, 1)
        far = np.minimum(far, abs(z - a - along * (b - a)))
    return inside & (far <= 0.13)


@pytest.fixture(scope="module")
def document():
    return job("ur5e", HOLES, [DOWN] * 3, over=OVER, mounting=EDGE)


def test_bases_stand_inside_a_rectangle_and_near_its_sides():
    edge, points = TableEdge(**EDGE), np.random.default_rng(0).uniform(-1, 1, (20_000, 2))
    expected = on_the_edge(points)
    assert (edge.holds(*points.T) == expected).all() and 0.1 < expected.mean() < 0.3
    assert edge.corners @ [1, 1j] == pytest.approx(0.2 - 0.1j + CORNERS @ [1, 1j] * np.exp(1j * np.pi / 6))


def test_who_stands_beside_the_edge_serves_nothing_and_others_as_on_the_floor(document):
    result = execute(document)
    floor, found = labels_of(execute(document | {"mounting": "floor"})), labels_of(result)
    there, about = on_the_edge(bases_of(document)[:, :2, 3]), result.document["placements"]
    assert (found[there] == floor[there]).all() and (found[~there] == "unreachable").all()
    assert (floor[~there] == "served").any() and 0 < there.sum() < len(there)
    assert (result.tables["placements"]["on_the_edge"] == there).all() and about["on_the_edge"] == there.sum()
    counts = {label: (found[there] == label).sum() for label in ("served", "unreachable")}
    assert about["labels"] == counts | {"undecided": 0}
    assert there[result.document["best"]["cell"]["placement"]]


SEARCHED = {"index": "manipulability", "robot": "franka_panda", "over": {"x_m": [-0.3, 0.9, 0.15], "y_m": 0.2}}


@pytest.mark.parametrize("more", [{}, {"index": "manipulability"}, SEARCHED])
def test_what_is_refined_stays_on_the_edge(document, more, monkeypatch):
    monkeypatch.setattr("wsrender.analyses.base_placement.refined.GOING_ON", ((2, 6),))
    best = execute(document | {"refine": True} | more).document["best"]
    assert on_the_edge(np.array([[best["x_m"], best["y_m"]]])).all()
    assert best["served"] >= best["cell"]["served"]


def test_shards_without_a_place_on_the_edge_are_computed(document):
    whole = plan(document | {"over": OVER | {"x_m": [-3, 1.0, 0.1]}})
    divided = whole.settled_as(whole.division(1.0, 12))
    parts = [run_shard(divided, shard) for shard in range(len(divided.shards))]
    served = [part["served"] for part in (run_shard(whole, 0), reduce(divided.merge, parts))]
    assert (served[0] == served[1]).all() and not parts[0]["served"].any() and len(parts) > 5


def test_the_edge_is_refused_by_name(document):
    far = document | {"mounting": EDGE | {"center_m": [9, 9]}}
    with pytest.raises(DocumentError, match=r"over.*clamp_m"):
        parse_job(far)
    with pytest.raises(DocumentError, match=r"mounting.*floor"):
        parse_job(document | {"over": OVER | {"roll_deg": 10}})
    with pytest.raises(DocumentError, match="clamp_m"):
        parse_job(document | {"mounting": EDGE | {"clamp_m": 0}})
