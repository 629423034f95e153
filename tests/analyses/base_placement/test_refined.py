"""What is between the cells: where the base may stand, and how well."""

import numpy as np
import pytest

import wsrender as ws
from tests.analyses.base_placement.test_base_placement import RING, job
from wsrender.analyses.base_placement import run
from wsrender.analyses.base_placement.refined import CELLS, RefinedPlacement, _within, looked_at, refined
from wsrender.analyses.base_placement.result import least_value
from wsrender.analyses.base_placement.run import BasePlacementAnalysis
from wsrender.analyses.jobs import parse_job
from wsrender.documents.placements import IN_DEGREES, placed
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.reach.placements import Decided
from wsrender.run import execute, plan


def test_steps_end_at_the_ranges_but_whole_turns_go_on():
    beyond = np.array([[1.2, -0.1, 3.0, 0.0, 0.0, 370.0], [-0.2, 0.5, 3.0, 0.0, 0.0, -30.0]])
    over = {"x_m": [0, 1, 0.5], "y_m": [0, 1, 0.5], "z_m": 3.0}
    for yaw, ends in (([0, 360, 60], (10.0, 330.0)), ([0, 90, 45], (90.0, 0.0))):
        parsed = parse_job(job("ur5e", RING, over=over | {"yaw_deg": yaw}))
        first, second = _within(parsed, beyond, beyond[0])
        assert first.tolist() == [1.0, 0.0, 3.0, 0.0, 0.0, ends[0]]
        assert second.tolist() == [0.0, 0.5, 3.0, 0.0, 0.0, ends[1]]


LINKS, LIMIT = np.array([0.5, 0.4, 0.3]), np.deg2rad(120)
POINTS = np.array([[0.55, 0.1, 0.0], [-0.25, 0.5, 0.0], [-0.3, -0.45, 0.0], [0.2, -0.6, 0.0]])


def best_margins(bases, points, turns=360):
    """Largest joint-limit margin (P, K) of three links in the plane: all directions of the last link, both elbows."""
    a, b, c = LINKS
    way = (points[:, :2] - bases[:, None, :2])[:, :, None]  # (P, K, 1, 2)
    towards = np.linspace(-np.pi, np.pi, turns, endpoint=False)
    wrist = way - c * np.stack([np.cos(towards), np.sin(towards)], axis=-1)
    cosine = ((wrist**2).sum(axis=-1) - a**2 - b**2) / (2 * a * b)
    best = np.full(way.shape[:2], np.nan)
    for side in (1, -1):
        second = side * np.arccos(np.where(np.abs(cosine) <= 1 + 1e-4, np.clip(cosine, -1, 1), np.nan))
        first = np.arctan2(wrist[..., 1], wrist[..., 0]) - np.arctan2(b * np.sin(second), a + b * np.cos(second))
        q = np.stack([first, second, towards - first - second], axis=-1)
        q = (q + np.pi) % (2 * np.pi) - np.pi
        margin = (LIMIT - np.abs(q)).min(axis=-1) / (2 * LIMIT)
        best = np.fmax(best, np.fmax.reduce(np.where(margin >= 0, margin, np.nan), axis=-1))
    return best


def in_the_plane(**fields):
    """A job of the three links, which a search decides, over cells of 40 cm."""
    table = {"convention": "standard", "rows": [{"a": float(a), "limits_deg": [-120, 120]} for a in LINKS]}
    over = {"x_m": [-0.8, 0.8, 0.4], "y_m": [-0.8, 0.8, 0.4]}
    return job({"dh": table}, POINTS, over=over, index="joint_limit_margin", refine=True, **fields)


def test_a_redundant_arm_is_placed_as_well_as_on_a_fine_grid():
    """A grid of 2 cm serves no more, by no larger margin at the best of all postures, than what 40 cm start."""
    planned = plan(in_the_plane())
    assert isinstance(planned, BasePlacementAnalysis)
    search, over = planned._placements(None), planned.job.over
    cells = over.coordinates(np.arange(over.count))
    decided = search.decide(cells * IN_DEGREES, placed(cells))
    first = np.lexsort((least_value(decided.value), (decided.label == REACHABLE).sum(axis=1)))[::-1]
    found = refined(planned.job, np.ones(len(POINTS)), search, planned.standing.chain, cells[first])
    side = np.arange(-0.8, 0.81, 0.02)
    bases = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    margins = best_margins(bases, POINTS)
    served = (~np.isnan(margins)).sum(axis=1)
    most = served.max()
    least = np.nanmin(margins[served == most], axis=1).max()
    there = best_margins(found.place[None, :2], POINTS, 20_000)
    assert (found.found.label == REACHABLE).sum() == (~np.isnan(there)).sum() == most
    assert found.found.value == pytest.approx(there[0], abs=2e-3, nan_ok=True)
    assert np.nanmin(found.found.value) >= least - 1e-3


class Hills:
    """Stands for a search: each of two targets is served anywhere, by a value that has two tops, the higher one on the
    right; what is continued is, if asked so, served nowhere."""

    exhaustive = False
    tops = np.array([[-0.5, 0.3], [0.55, -0.35]])

    def __init__(self, lost=False):
        self.lost = lost

    def height(self, T):
        far = np.linalg.norm(T[:, None, :2, 3] - self.tops, axis=-1)
        return (np.array([1.0, 2.0]) * np.exp(-((far / 0.2) ** 2))).sum(axis=-1)

    def configurations(self, coordinates, T):
        value = np.repeat(self.height(T), 2)
        return Decided(np.full(2, REACHABLE, np.int8), np.zeros(2, np.int8), value, np.zeros(2, bool)), np.zeros((2, 3))

    def continued(self, coordinates, T, starts):
        label = np.full((len(T), 2), UNDECIDED if self.lost else REACHABLE, np.int8)
        value = np.where(self.lost, np.nan, np.repeat(self.height(T)[:, None], 2, axis=1))
        return Decided(label, np.zeros_like(label), value, label < 0), starts[:, :, 0]


LOW, FAR, HIGH = [-0.6, 0.2, 0, 0, 0, 0], [-0.7, 0.4, 0, 0, 0, 0], [0.6, -0.2, 0, 0, 0, 0]  # beside either top


def continued_from(cells, seed=0, **options):
    planned = plan(in_the_plane(seed=seed))
    return refined(planned.job, np.ones(2), Hills(**options), planned.standing.chain, np.array(cells, float))


def test_each_of_several_cells_is_continued_and_the_best_top_is_found():
    alone, both = continued_from([LOW]), continued_from([LOW, FAR, HIGH])
    assert alone.place[:2] == pytest.approx(Hills.tops[0], abs=1e-3)
    assert both.place[:2] == pytest.approx(Hills.tops[1], abs=1e-3)
    assert both.found.value == pytest.approx(2.0, abs=1e-3) and (both.place[2:] == 0).all()


def test_what_is_not_served_when_it_is_continued_leaves_the_cell():
    found, cell = continued_from([HIGH, LOW], lost=True), looked_at(Hills(), np.array(HIGH, float))
    assert found.place.tolist() == HIGH and found.found.value.tolist() == cell.found.value.tolist()


def test_of_two_looks_at_a_placement_the_better_posture_of_each_target_stays():
    """Served where the other does not, or by more; with all that is known of it, and its configuration."""
    served = [REACHABLE, REACHABLE, UNDECIDED, REACHABLE, REACHABLE, UNDECIDED]
    own = Decided(
        np.array(served, np.int8), np.full(6, 1, np.int8), np.array([1, 2, np.nan, 3, 4, np.nan]), np.zeros(6, bool)
    )
    label = np.array([REACHABLE, REACHABLE, REACHABLE, UNDECIDED, REACHABLE, UNDECIDED], np.int8)
    others = Decided(label, np.full(6, 2, np.int8), np.array([1.5, 1, 0.5, np.nan, 4, np.nan]), np.ones(6, bool))
    first = RefinedPlacement(np.arange(6.0), own, np.zeros((6, 2)), 0.25)
    found = first.with_better(others, np.ones((6, 2)))
    assert found.found.label.tolist() == [REACHABLE] * 5 + [UNDECIDED]
    np.testing.assert_array_equal(found.found.value, [1.5, 2, 0.5, 3, 4, np.nan])
    assert found.found.reason.tolist() == [2, 1, 2, 1, 1, 1]
    assert found.found.proven.tolist() == found.q[:, 0].tolist() == [True, False, True, False, False, False]
    assert found.place is first.place and found.step == 0.25


class Turns(Hills):
    """Each move betters one of both targets, in turn, at the placement itself alone; a fresh look knows neither."""

    calls = 0

    def configurations(self, coordinates, T):
        found, q = super().configurations(coordinates, T)
        return Decided(found.label, found.reason, np.array([0.1, 0.1]), found.proven), q

    def continued(self, coordinates, T, starts):
        label = np.full((len(T), 2), UNDECIDED, np.int8)
        value = np.full(label.shape, np.nan)
        label[0], value[0, self.calls % 2] = REACHABLE, 0.5 + self.calls % 2
        value[0, 1 - self.calls % 2] = 0.05
        self.calls += 1
        return Decided(label, np.zeros_like(label), value, label < 0), starts[:, :, 0]


def test_what_one_move_betters_the_next_does_not_lose():
    planned = plan(in_the_plane())
    found = refined(planned.job, np.ones(2), Turns(), planned.standing.chain, np.array([LOW], float))
    assert found.found.value.tolist() == [0.5, 1.5] and found.place.tolist() == LOW


def test_directions_are_those_of_the_seed():
    first, again, other = (continued_from([LOW], seed).place for seed in (3, 3, 4))
    assert first.tolist() == again.tolist() != other.tolist()


@pytest.mark.parametrize("refine", [True, False])
def test_a_job_is_refined_from_its_best_cells(refine, monkeypatch):
    given = []

    def watched(job, weights, search, chain, cells):
        given.extend(cells)
        return looked_at(search, cells[0])

    monkeypatch.setattr(run, "refined", watched)
    over = {"x_m": [-0.8, 0.8, 0.16], "y_m": [-0.8, 0.8, 0.16]}  # several tops
    document = execute(in_the_plane() | {"refine": refine, "over": over}).document
    places = [[document["best"]["cell"][name] for name in ("x_m", "y_m")], *(cell[:2].tolist() for cell in given)]
    assert len(given) == len({tuple(place) for place in places[1:]})
    if refine:
        assert places[0] == places[1] and 1 < len(given) <= CELLS
    else:
        assert not given


def test_the_summary_says_what_only_a_place_between_the_cells_serves():
    """Two points 1.3 m apart of an arm of .7 m: it must stand in the middle, beside which the cells are."""
    rows = [{"a": 0.4, "limits_deg": [-180, 180]}, {"a": 0.3, "limits_deg": [-180, 180]}]
    table = ws.DHTable(convention="standard", rows=rows)
    document = job(table, [[-0.65, 0, 0], [0.65, 0, 0]], over={"x_m": [-0.2, 0.4, 0.2], "y_m": 0.0})
    between, cells = (execute(document | {"refine": refine}) for refine in (True, False))
    assert between.document["placements"]["serving_all"] == 0 and between.document["best"]["served"] == 2
    assert "serving all targets: 0, but one between them does" in between.summary()
    assert "serving all targets: 0\n" in cells.summary()
