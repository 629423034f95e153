import numpy as np
import pytest

from wsrender.design.evaluations import EvaluationFile, Evaluations
from wsrender.design.search import Space, evolve, front, grid, pareto, refine
from wsrender.errors import InputError

ONE = np.array([1.0])


def square(constrained: bool = False) -> Space:
    """[0, 4]², and x + y ≤ 3 if constrained."""
    matrix = np.ones((int(constrained), 2))
    return Space(np.zeros(2), np.full(2, 4.0), matrix, np.full(len(matrix), -np.inf), np.full(len(matrix), 3.0))


def product(designs):
    """Largest on x + y = 3 at (1.5, 1.5)."""
    return (designs[:, 0] * designs[:, 1])[:, None]


def test_evolution_and_refinement_meet_a_constraint_in_its_closed_form():
    space, evaluations = square(constrained=True), Evaluations(product, ONE)
    ended = evolve(space, evaluations, population=10, generations=40, tolerance=1e-3, seed=1)
    assert ended.startswith("differential evolution: ") and not ended.endswith(".")
    designs, values = evaluations.rows()
    ended = refine(space, evaluations, designs[values[:, 0].argmax()], lambda design: design[::-1])
    assert ended.startswith("SLSQP: ") and not ended.endswith(".")
    designs, values = evaluations.rows()
    allowed = space.allows(designs)
    assert values[allowed].max() == pytest.approx(2.25, rel=1e-7)
    assert designs[allowed][values[allowed].argmax()] == pytest.approx([1.5, 1.5], abs=1e-3)


def test_the_same_seed_gives_the_same_designs():
    runs = []
    for seed in (5, 5, 6):
        evaluations = Evaluations(product, ONE)
        evolve(square(), evaluations, population=5, generations=3, tolerance=1e-9, seed=seed)
        runs.append(evaluations.rows()[0].tolist())
    assert runs[0] == runs[1] != runs[2]


def test_a_grid_has_both_bounds_and_leaves_out_what_is_not_allowed():
    assert grid(square(), (3, 1)).tolist() == [[0, 2], [2, 2], [4, 2]]
    assert grid(square(constrained=True), (3, 3)).tolist() == [[0, 0], [0, 2], [2, 0]]


def test_known_designs_are_not_evaluated_again_and_new_ones_are_kept():
    asked, kept, told = [], [], []

    def evaluate(designs):
        asked.extend(designs.tolist())
        return product(designs)

    evaluations = Evaluations(
        evaluate, ONE, [((1.0, 2.0), (7.0,))], told.append, lambda d, v: kept.append((d.tolist(), v.tolist())), batch=2
    )
    designs = np.array([[1.0, 2.0], [2.0, 2.0], [2.0, 2.0], [3.0, 1.0], [0.5, 2.0]])
    assert evaluations.values(designs)[:, 0].tolist() == [7, 4, 4, 3, 1]
    assert asked == [[2, 2], [3, 1], [0.5, 2]]
    assert kept == [([[2, 2], [3, 1]], [[4], [3]]), ([[0.5, 2]], [[1]])]
    assert len(evaluations) == 4 and told == [2, 3]


def test_a_design_without_a_value_is_worse_than_any():
    evaluations = Evaluations(lambda designs: np.where(designs[:, :1] > 1, np.nan, designs[:, :1]), -ONE)
    assert evaluations.scores(np.array([[0.5], [2.0]])).tolist() == [-0.5, -np.inf]


def test_the_front_is_what_no_design_beats():
    values = np.array([[1.0, 5.0], [2.0, 4.0], [2.0, 3.0], [3.0, 3.0], [np.nan, 9.0], [0.0, 5.0]])
    assert front(values, np.array([1.0, 1.0])).tolist() == [0, 1, 3]
    assert front(values, np.array([-1.0, 1.0])).tolist() == [5]


def test_a_pareto_search_finds_a_front_in_closed_form():
    """Of x and 16 − x − y² the best have y = 0, any x: their sum is 16."""
    evaluations = Evaluations(lambda d: np.stack([d[:, 0], 16 - d[:, 0] - d[:, 1] ** 2], axis=1), np.array([1.0, 1.0]))
    pareto(square(), evaluations, population=40, generations=40, seed=2)
    designs, values = evaluations.rows()
    kept = front(values, np.ones(2))
    assert len(kept) > 15 and np.ptp(designs[kept, 0]) > 3
    assert values[kept].sum(axis=1) == pytest.approx(np.full(len(kept), 16.0), abs=0.05)


def test_files_of_evaluations_are_read_back_exactly_and_survive_a_crash(tmp_path):
    path = tmp_path / "designs.csv"
    file = EvaluationFile(path, ["a", "b", "value"])
    designs, values = np.array([[0.1, 1 / 3], [2.0, 1e-17]]), np.array([[np.pi], [np.nan]])
    file.append(designs, values)
    for cut in ("1", "0.5,0.25", "0.5,0.25,3.1"):  # the last of 3.14: it looks whole
        with path.open("a") as crashed:
            crashed.write(cut)
        rows = EvaluationFile(path, ["a", "b", "value"]).rows()
        np.testing.assert_array_equal(rows, np.hstack([designs, values]))
    again = EvaluationFile(path, ["a", "b", "value"])
    again.append(np.array([[2.5, 0.5]]), np.array([[4.0]]))
    np.testing.assert_array_equal(again.rows()[2:], [[2.5, 0.5, 4.0]])
    with pytest.raises(InputError, match="must have the columns a, c, value, not a, b, value"):
        EvaluationFile(path, ["a", "c", "value"]).rows()
    with pytest.raises(InputError, match="cannot be written"):
        EvaluationFile(tmp_path / "missing" / "designs.csv", ["a"])
    path.write_text("a,b,value\n1,2,three\n")
    with pytest.raises(InputError, match="must hold numbers"):
        EvaluationFile(path, ["a", "b", "value"]).rows()
