"""Aspects against floods of a fine grid whose determinants are finite differences, and against published conditions."""

import numpy as np
import pytest
from scipy.ndimage import label

import wsrender as ws
from tests.reach.test_postures import GENERAL, drawn
from tests.reference.arms_by_axes import RELATIONS, random_arm, reversed_chain
from wsrender.reach.aspects import APART, CONNECTED, OPEN, AspectFinder, certain, displacements
from wsrender.reach.posture_sets import PostureSolver


def orthogonal(d2, d3, d4, r2):
    """Three hinges at right angles, without limits, in the letters of Baili, Wenger, Chablat 2004."""
    rows = [{"a": d2, "alpha_deg": -90}, {"a": d3, "alpha_deg": 90, "d": r2}, {"a": d4}]
    return ws.load_robot(ws.DHTable(convention="standard", name="orthogonal", rows=rows)).chain


def last_without_cusps(d3, r2):
    """The largest d4, over d2 = 1, of the arms with two postures, which have no cusp (ibid.)."""
    a, b, c = np.hypot(d3 + 1, r2), np.hypot(d3 - 1, r2), d3**2 + r2**2
    return np.sqrt((c - (c**2 - d3**2 + r2**2) / (a * b)) / 2)


def finders(chain, with_orientation=True):
    solver = PostureSolver(chain, kind="pose" if with_orientation else "position", device="cpu")
    return solver, AspectFinder(solver.holder, solver.form)


def flooded(chain, cells=400):
    """Components (cells, cells) on the torus of joints 2 and 3, by finite differences."""
    values = (np.arange(cells) + 0.5) / cells * 2 * np.pi - np.pi
    grid = np.stack(np.meshgrid([0.0], values, values, indexing="ij"), axis=-1).reshape(-1, 3)

    def place(q):
        at = chain.poses(q)[:, :3, 3]
        return np.stack([np.hypot(at[:, 0], at[:, 1]), at[:, 2]])

    (a, c), (b, d) = (place(grid + 1e-6 * e) - place(grid - 1e-6 * e) for e in np.eye(3)[1:])
    determinant = (a * d - b * c).reshape(cells, cells)
    found = np.zeros((cells, cells), int)
    for sign in (-1, 1):
        numbers, _ = label(sign * determinant > 0)
        found = np.where(numbers > 0, _joined(numbers) * 2 + (sign > 0), found)
    return found


def component(flood, q):
    """That of each configuration (K, 3)."""
    cells = len(flood)
    at = np.clip(((q[:, 1:] + np.pi) / (2 * np.pi) * cells).astype(int), 0, cells - 1)
    return flood[at[:, 0], at[:, 1]]


def _joined(numbers):
    """Components of which the last cells are next to the first are one."""
    numbers = numbers.copy()
    while True:
        before = numbers.copy()
        for first, last in ((numbers[0], numbers[-1]), (numbers[:, 0], numbers[:, -1])):
            for a, b in {(a, b) for a, b in zip(first, last, strict=True) if a and b and a != b}:
                numbers[numbers == max(a, b)] = min(a, b)
        if (numbers == before).all():
            return numbers


def test_a_cuspidal_arm_and_its_neighbour():
    """The example of Wenger's papers; below a length of the last link, which they give, no arm is cuspidal."""
    assert last_without_cusps(2, 1) == pytest.approx(0.2, abs=0.01)
    for d4, expected in ((1.5, True), (last_without_cusps(2, 1) - 0.01, False)):
        chain = orthogonal(1, 2, d4, 1)
        solver, finder = finders(chain, with_orientation=False)
        T = chain.poses(drawn(chain, 60, seed=3))
        found, flood, cuspidal, decided = solver.solve(T), flooded(chain), 0, 0
        for k in range(60):
            own = found[found.pose == k]
            number, proven = finder.numbered(own)
            truth = component(flood, own)
            if proven:
                decided += 1
                assert ((number[:, None] == number) == (truth[:, None] == truth)).all()
            cuspidal += len(set(number)) < len(own)
        assert (cuspidal > 0) == expected and decided > 50 and "three hinges" in finder.evidence
        assert np.bincount(found.pose).max() == (4 if expected else 2)


@pytest.mark.parametrize("kind", ["library", *RELATIONS[:4]])
def test_the_factors_are_those_of_the_determinant(kind):
    chains = [random_arm(kind, 5), reversed_chain(random_arm(kind, 6))] if kind != "library" else []
    for chain in chains or [ws.load_robot(name).chain for name in ("puma560", "ur5e", "gao_6r")]:
        _, finder = finders(chain)
        q = drawn(chain, 200)
        determinant = np.linalg.det(finder.holder.jacobians(q))
        if finder.proof == "three parallel axes":
            arm = finder._parallel
            product = arm.offsets(np.stack([displacements(axis, q) for axis in arm.axes[1:4]], axis=1))
            sines = arm.sines
        else:
            assert finder.proof == "spherical wrist"
            arm = finder._plane
            product = arm.values(np.stack([displacements(axis, q) for axis in arm.axes[1:]], axis=1))
            sines = [sine for sine in (finder._wrist, arm.elbow) if sine]
        for sine in sines:
            d = displacements(sine.axis, q)
            product = product * (sine.cosine * np.cos(d) + sine.sine * np.sin(d))
            value, turned = sine.cosine * np.cos(d) + sine.sine * np.sin(d), sine.between(q)
            assert (np.sign(value) == np.sign(value[0]) * (-1.0) ** (turned - turned[0])).all()
        clear = np.abs(determinant) > 1e-6 * np.abs(determinant).max()
        ratio = determinant[clear] / product[clear]
        assert ratio == pytest.approx(np.full(clear.sum(), ratio[0]), rel=1e-6)


@pytest.mark.parametrize("name", ["puma560", "ur5e"])
def test_postures_of_usual_arms_stand_in_aspects_of_their_own(name):
    """They are not cuspidal (Wenger 1992), and that is proven; samples of ways do not say otherwise."""
    chain = ws.load_robot(name).chain
    solver, finder = finders(chain)
    found = solver.solve(chain.poses(drawn(chain, 25, seed=1)))
    for k in range(25):
        number, proven = finder.numbered(found[found.pose == k])
        assert proven and len(set(number)) == len(number)
    sampled = AspectFinder(finder.holder, None)
    number, proven = sampled.numbered(found[found.pose == 0])
    assert not proven and "not proven" in sampled.evidence
    pairs = sampled._by_samples(found[found.pose == 0])
    signs = np.sign(np.linalg.det(chain.jacobians(found[found.pose == 0])))
    assert (pairs[signs[:, None] != signs] == APART).all()


def test_whole_turns_cross_singularities_or_do_not():
    """Of the first joint they do not, of a wrist's middle joint they do; what lies near each other connects."""
    chain = ws.load_robot("ur5e").chain
    _, finder = finders(chain)
    q = np.array([[0.3, -1.0, 0.8, -0.5, 0.9, 0.2]])
    turn = 2 * np.pi * np.eye(6)
    rows = np.concatenate([q, q - turn[0], q - turn[5], q - turn[4], q + 0.05, q * [1, 1, -1, 1, 1, 1]])
    number, _ = finder.numbered(rows)
    assert number[0] == number[1] == number[2] == number[4]
    assert number[3] != number[0] and number[5] != number[0]


def test_neighbours_and_turns_of_outer_joints_connect():
    """Of a spherical wrist; and of three hinges alone, whose postures are all apart, which is proven."""
    chain = ws.load_robot("puma560").chain
    _, finder = finders(chain)
    q = np.array([[0.3, -1.0, 0.8, -0.5, 0.9, 0.2]])
    number, proven = finder.numbered(np.concatenate([q, q + 0.05, q + 0.9 * np.eye(6)[3], q * [-1, 1, 1, 1, 1, 1]]))
    assert proven and (number == 0).all()
    rows = [{"a": 0, "alpha_deg": -90}, {"a": 0.4, "d": 0.2}, {"a": 0.3}]
    arm = ws.load_robot(ws.DHTable(convention="standard", name="elbow", rows=rows)).chain
    solver, alone = finders(arm, with_orientation=False)
    found = solver.solve(arm.poses(drawn(arm, 20)))
    assert np.bincount(found.pose).max() == 4
    for k in range(20):
        number, proven = alone.numbered(found[found.pose == k])
        assert proven and len(set(number)) == len(number)


def test_next_to_a_stretched_elbow_ways_lead_to_its_own_side():
    """Of cells that the zero of the elbow's sine crosses, whichever side of it is the nearer one."""
    chain = ws.load_robot("puma560").chain
    _, finder = finders(chain)
    q = np.tile([0.3, -1.0, 0.8, -0.5, 0.9, 0.2], (5, 1))
    elbow = finder._plane.elbow
    zeros = np.arctan2(-elbow.cosine, elbow.sine) + np.pi * np.arange(-2, 3)
    zeros = (zeros - elbow.axis.offset) * elbow.axis.sign
    (zero,) = zeros[(chain.lower_limits[2] < zeros) & (zeros < chain.upper_limits[2])]
    q[:, 2] = zero + np.array([-0.2, -1e-5, 1e-5, 2e-4, 0.2])
    number, proven = finder.numbered(q)
    assert proven and number.tolist() == [0, 0, 1, 1, 1]


def test_limits_part_aspects():
    """A joint that may not pass between two regions of one sign keeps them apart; wide limits join them."""
    wide = orthogonal(1, 2, 1.5, 1)
    solver, finder = finders(wide, with_orientation=False)
    q = drawn(wide, 300, seed=4)
    numbers, _ = finder.numbered(q)
    joined = finder._by_factors(q) == CONNECTED
    for joint, cut in ((1, 1.0), (2, 0.5)):
        ends = [[-np.pi, np.pi]] * 3
        ends[joint] = [-cut, cut]
        rows = [{"a": 1, "alpha_deg": -90}, {"a": 2, "alpha_deg": 90, "d": 1}, {"a": 1.5}]
        rows = [row | {"limits": end} for row, end in zip(rows, ends, strict=True)]
        narrow = ws.load_robot(ws.DHTable(convention="standard", name="narrow", rows=rows)).chain
        _, limited = finders(narrow, with_orientation=False)
        inside = np.abs(q[:, joint]) < cut
        pairs = limited._by_factors(q[inside])
        assert joined[np.ix_(inside, inside)][pairs == CONNECTED].all()  # narrower limits join nothing more
        assert (pairs == CONNECTED).mean() < joined[np.ix_(inside, inside)].mean() + 1e-12
    assert numbers.max() >= 1 and solver.form is not None


def test_a_way_is_certain_or_not():
    def sine(x):
        return np.sin(x[..., 0])

    slopes = np.ones(1)
    assert certain(sine, slopes, np.array([0.001]), np.array([3.14]), 1.0)
    assert not certain(sine, slopes, np.array([0.1]), np.array([3.2]), 1.0)
    assert not certain(sine, slopes, np.array([0.1]), np.array([6.4]), 1.0)  # both ends are above 0
    assert not certain(sine, slopes, np.array([0.1]), np.array([3.0]), -1.0)


def test_arms_that_do_not_factor_are_sampled():
    chain = ws.load_robot(GENERAL).chain
    solver, finder = finders(chain)
    found = solver.solve(chain.poses(drawn(chain, 4, seed=3)))
    assert finder.proof is None and finder.evidence == "signs of the determinant, and ways by samples, not proven"
    for k in range(4):
        own = found[found.pose == k]
        number, proven = finder.numbered(own)
        signs = np.sign(np.linalg.det(chain.jacobians(own)))
        assert not proven and all(
            number[i] != number[j] for i in range(len(own)) for j in range(i) if signs[i] != signs[j]
        )
    near = np.concatenate([own[:1], own[:1] + 1e-3])
    assert finder._by_samples(near)[0, 1] == CONNECTED and OPEN not in finder._by_samples(own[:1])


def test_a_job_tells_aspects():
    rows = [{"a": 1, "alpha_deg": -90}, {"a": 2, "alpha_deg": 90, "d": 1}, {"a": 1.5}]
    chain = orthogonal(1, 2, 1.5, 1)
    q = drawn(chain, 12, seed=3)
    job = {"analysis": "postures", "robot": {"dh": {"convention": "standard", "rows": rows}}, "aspects": True}
    job |= {"position_m": chain.poses(q)[:, :3, 3].tolist(), "device": "cpu"}
    result = ws.execute(job)
    table, poses, entry = result.tables["postures"], result.tables["poses"], result.document["postures"]["aspects"]
    for k in range(12):
        own = table["aspect"][table["pose"] == k]
        assert poses["aspects"][k] == len(set(own)) and poses["cuspidal"][k] == (len(set(own)) < len(own))
    assert (
        entry["cuspidal_poses"] == poses["cuspidal"].sum() > 0 and entry["proven"] == poses["aspects_proven"].sum() > 0
    )
    assert "two postures in one aspect (cuspidal)" in result.summary()
    wound = {"robot": "ur5e", "position_m": [[0.4, 0.2, 0.3]], "quat_wxyz": [[0, 1, 0, 0]], "windings": 8}
    turns = ws.execute(job | wound)
    assert turns.tables["postures"]["winding"].max() == 7 and not turns.tables["poses"]["cuspidal"].any()
    assert turns.tables["poses"]["aspects"][0] < len(turns.tables["postures"])  # turns of a posture share one
    assert "aspect" not in ws.execute(job | {"aspects": False}).tables["postures"].columns
    with pytest.raises(ws.InputError, match="aspects: must be false: 7 joints move, and the pose has 6 freedoms"):
        ws.execute({**job, "robot": "franka_panda", "quat_wxyz": [[1, 0, 0, 0]] * 12})
