"""The analysis ``two_arm_placement`` beside every pair of placements of arms whose reach is a ring."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.journeys import from_the_command_line
from wsrender.analyses.two_arm_placement import run
from wsrender.run import execute, plan

LENGTHS = {"first": (0.4, 0.3), "second": (0.3, 0.1)}  # of the two links: rings from 0.1 to 0.7 m, from 0.2 to 0.4 m
OVER = {"first": {"x_m": [-0.5, 0.5, 0.2], "y_m": [-0.4, 0.4, 0.2]}, "second": {"x_m": [-1, 1, 0.25], "y_m": 0.1}}
RANDOM = np.random.default_rng(5)
POINTS = RANDOM.uniform([-1, -0.8, 0], [1, 0.8, 0], (11, 3))
WEIGHTS = RANDOM.integers(1, 5, 11) / 2


def arm(side, **over):
    rows = [{"a": length, "limits_deg": [-180, 180]} for length in LENGTHS[side]]
    return {"robot": {"dh": {"convention": "standard", "rows": rows}}, "over": over}


def job(points=POINTS, **fields):
    targets = [{"position_m": p, "weight": w} for p, w in zip(points.tolist(), WEIGHTS.tolist(), strict=True)]
    arms = {side: arm(side, **OVER[side]) for side in LENGTHS}
    return {"analysis": "two_arm_placement", "targets": targets, **arms, "device": "cpu"} | fields


def served(side, x, y):
    """Which points the arm reaches from a base."""
    far, (a, b) = np.hypot(*(POINTS[:, :2] - [x, y]).T), LENGTHS[side]
    assert np.minimum(abs(far - abs(a - b)), abs(far - a - b)).min() > 1e-6
    return (far > abs(a - b)) & (far < a + b)


def centres(side):
    """Bases in the order of the table, (P, 2)."""
    x = np.arange(OVER[side]["x_m"][0], OVER[side]["x_m"][1] - 1e-9, OVER[side]["x_m"][2]) + OVER[side]["x_m"][2] / 2
    y = np.array([0.1]) if side == "second" else np.array([-0.3, -0.1, 0.1, 0.3])
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


def test_every_pair_of_placements(monkeypatch):
    monkeypatch.setattr(run, "BLOCK", 20)  # several blocks of pairs
    result = execute(job())
    reached = {side: np.array([served(side, *place) for place in centres(side)]) for side in LENGTHS}
    either = np.array([[(a | b) @ WEIGHTS for b in reached["second"]] for a in reached["first"]])
    both = np.array([[(a & b) @ WEIGHTS for b in reached["second"]] for a in reached["first"]])
    pairs = [(-either[k, m], -both[k, m], k, m) for k, m in np.ndindex(*either.shape)]
    _, _, k, m = min(pairs)
    best, about = result.document["best"], result.document["targets"]
    assert (best["first"]["placement"], best["second"]["placement"]) == (k, m)
    assert best["first"]["x_m"] == pytest.approx(centres("first")[k, 0])
    assert best["second"]["T_world_base"][0][3] == pytest.approx(centres("second")[m, 0])
    a, b = reached["first"][k], reached["second"][m]
    expected = np.select([a & b, a, b], ["both", "first", "second"], "none")
    assert (result.tables["targets"]["label"] == expected).all() and len(set(expected)) >= 3
    for name in ("both", "first", "second", "none"):
        assert about[name] == (expected == name).sum()
        assert about["share"][name] == pytest.approx(WEIGHTS[expected == name].sum() / WEIGHTS.sum())
    assert result.document["pairs"]["most_weight"] == pytest.approx(either.max())
    for axis, side in enumerate(LENGTHS):
        table = result.tables[side]
        assert table["weight_together"] == pytest.approx(either.max(axis=1 - axis))
        chosen = np.take_along_axis(either if axis == 0 else either.T, table["partner"][:, None], axis=1)[:, 0]
        assert chosen == pytest.approx(table["weight_together"])
    assert len(bodies_of(result.plot.shares())) == 0


def bodies_of(figure):
    """Colours (3,) of the bodies that a picture shows, and which of its lines are no marks."""
    shown = [np.asarray(image.get_array()) for image in figure.axes[0].get_images()]
    return [picture[picture[..., 3] > 0][:, :3].mean(axis=0) for picture in shown]


def test_arms_at_a_hand_over_are_drawn_as_bodies_in_their_colours():
    """Blue and purple, as the targets that each serves; sticks of arms without bodies alone."""
    over = {"first": {"x_m": -0.6}, "second": {"x_m": 0.6, "yaw_deg": 180}}
    poses = {"points_m": [[0, 0, 0.5]], "orientations": 20, "second_in_first": {"rpy_deg": [180, 0, 0]}}
    asked = {"analysis": "two_arm_placement", "points_m": [[0, 0, 0.4]], "hand_over": poses, "device": "cpu"}
    sides = {side: {"robot": {"library": "ur5e"}, "over": place} for side, place in over.items()}
    figure = execute(asked | sides).plot.shares()
    first, second = bodies_of(figure)
    assert first[2] > 1.5 * first[0] and second[0] > 1.1 * second[1]
    said = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert said[-3:] == ["first arm, hand-over", "second arm, hand-over", "tip"]


def test_pairs_that_serve_all_are_counted():
    """By masks of which some together are whole; the pair of which both serve most is taken, then the first."""
    left = np.array([[1, 1, 0, 0], [1, 1, 1, 0], [0, 0, 0, 0]], bool)
    right = np.array([[0, 0, 1, 1], [0, 1, 1, 1], [0, 1, 1, 1]], bool)
    found = run.best_pairs(left, right, np.array([1.0, 1.0, 1.0, 0.3]))
    assert found.serving_all == 6 and found.pair == (1, 1)
    assert found.partner[0].tolist() == [1, 1, 1] and found.partner[1].tolist() == [1, 1, 1]
    assert found.weight[0] == pytest.approx([3.3, 3.3, 2.3]) and found.weight[1] == pytest.approx([3.3, 3.3, 3.3])


def test_one_arm_stays_and_constraints_are_of_both(tmp_path, capsys):
    """A region takes what lies outside from either arm; by itself each serves what `base_placement` says."""
    region = {"region": {"box": {"lower_m": [-1, -1, -1], "upper_m": [0, 1, 1]}}}
    fixed = {"first": arm("first", x_m=-0.2, y_m=0.1), "constraints": region}
    result = from_the_command_line(job(**fixed), tmp_path)
    assert "targets served" in capsys.readouterr().out
    label, inside = result.tables["targets"]["label"], POINTS[:, 0] <= 0
    mine = np.isin(label, ("first", "both"))
    assert (mine == (served("first", -0.2, 0.1) & inside)).all() and not np.isin(label[~inside], ("second",)).any()
    alone = {"analysis": "base_placement", "device": "cpu", "refine": False, "constraints": region}
    placed = execute(alone | arm("second", **OVER["second"]) | {"targets": job()["targets"]})
    assert (placed.tables["placements"]["served_bits"] == result.tables["second"]["served_bits"]).all()


@pytest.mark.parametrize(
    ("change", "field", "message"),
    [
        ({"first": {"robot": "ur5e"}}, "first.over", "required"),
        ({"second": {"robot": "ur5e", "over": {"roll_deg": 10}, "mounting": "wall"}}, "second.mounting", "tilts"),
        ({"second": {"robot": "ur5e", "over": {"x_m": [0, 1, 1e-8]}}}, "second.over", "at most 50,000,000"),
        ({"second": arm("second", x_m=[0, 1, 1e-6]), "first": arm("first", x_m=[0, 1, 1e-4])}, "first.over", "pairs"),
        ({"targets": None}, "points_m", "must be given"),
        ({"second": {"robot": "ur5e", "tip": "nose", "over": {}}}, "second.tip", "nose"),
    ],
)  # fmt: skip
def test_bad_jobs_are_refused_by_name(change, field, message):
    with pytest.raises((ws.DocumentError, ws.InputError), match=f"{field}.*{message}"):
        plan(job() | change)
