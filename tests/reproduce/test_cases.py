"""Rows hold what the papers print; what is run is what they describe."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from tests.reference.exact_volumes import articulated, spherical_pair
from wsrender import cli
from wsrender.analyses.jobs import parse_job
from wsrender.cli.reproduce_command import NAMES
from wsrender.errors import InputError
from wsrender.indices.index_catalogue import DYNAMIC, KINEMATIC
from wsrender.reproduce import CASES, Row, cases, gao, reproduce, zhang
from wsrender.volume.volume_data import VolumeData

NUMBER = np.repeat([1.0, 2.0], [1, 3])[:, None, None] * np.ones((4, 4, 4))
BLOCK = VolumeData(0.01, (0, 0, 0), NUMBER.astype(np.int64), {"number": {"robots": NUMBER}})
"""Voxels of which the first layer is reached by one robot, the other three by two."""


@pytest.fixture
def documents(monkeypatch):
    """Job documents instead of runs; every value comes out as 0.5 (m³)."""
    seen = []
    refined = {"value": 0.5, "ci95": [0.4, 0.6]}

    def execute(document, progress=None):
        job = parse_job(document)
        seen.append(job)
        several = job.analysis == "shared_workspace"
        volumes = {"any": 0.5, "shared": 0.5, "true": refined}
        volumes["refined"] = {"any": refined, "shared": refined} if several else refined
        levels = [{"refinement": k, "mean_m3": 0.5, "variance_m6": 0.5} for k in range(4)]
        return SimpleNamespace(
            volume=BLOCK,
            document={"volume_m3": volumes, "refinements": levels},
            global_indices={"joint_mean": dict.fromkeys([*KINEMATIC, *DYNAMIC], 0.5)},
        )

    monkeypatch.setattr(zhang, "execute", execute)
    monkeypatch.setattr(gao, "execute", execute)
    return seen


def published(rows, case):
    return [row.published for row in rows if row.case == case]


def test_table_3_is_the_table_of_the_paper(documents):
    rows = reproduce("wsrender-table-3")
    assert published(rows, "phantom_omni") == [0.553, 0.524, 0.525, 0.855, 0.273, 0.860]
    assert published(rows, "puma560") == [0.053, 0.029, 0.036, 0.605, 0.634, 0.655]
    assert published(rows, "stanford_arm") == [0.061, 0.070, 0.072, 0.619, 0.592, 0.722]
    assert [row.quantity.split()[0] for row in rows] == [f"G{k}" for k in [*range(1, 7), *range(7, 13), *range(7, 13)]]
    assert [row.reproduced for row in rows] == [0.5] * 12 + [None] * 6
    noise = [row.quantity.split()[0] for row in rows if row.case == "puma560" and "noise" in row.note]
    assert noise == ["G7", "G8", "G9", "G10", "G12"]
    omni, puma = documents
    assert (omni.sampling.per_joint, omni.convention, omni.precision) == (60, "wsrender_code", "float64")
    assert 'range="-180 180"' in puma.robot.mjcf and puma.sampling.locked["joint5"] == 0.0


def test_table_6_is_the_table_of_the_paper(documents):
    rows = reproduce("wsrender-table-6")
    printed = {(row.case, row.quantity.partition(",")[0]): row.published for row in rows if row.published}
    assert printed == {
        ("articulated", "V_a"): 0.0606, ("articulated", "V_s"): 0.0139, ("articulated", "R = V_s/V_a"): 0.229,
        ("spherical", "V_a"): 0.0646, ("spherical", "V_s"): 0.0204, ("spherical", "R = V_s/V_a"): 0.316,
    }  # fmt: skip
    shapes = {row.quantity: row.reproduced for row in rows if "alpha shape" in row.quantity}
    # Shapes of centres: a layer of half a voxel is missing on each side.
    assert shapes["V_a, alpha shape"] == pytest.approx(0.03**3)
    assert shapes["V_s, alpha shape"] == pytest.approx(0.02 * 0.03**2)
    pairs = [job for job in documents if job.analysis == "shared_workspace"]
    positions = [[robot.robot.placement.position_m for robot in job.robots] for job in pairs]
    assert positions == [[(0.1, 0.0, 0.4), (-0.1, 0.0, 0.4)], [(0.1, 0.4, 0.0), (-0.1, 0.4, 0.0)]]
    assert all(job.voxel_size_m == 0.01 for job in pairs)


def test_exact_volumes_of_table_6():
    """By quadrature here; the articulated pair's to the digits that the paper's readers know."""
    exact = {robot: (*known["exact"], known["alone"]) for robot, known in zhang.PAIRS.items()}
    assert exact["spherical"][:2] == pytest.approx(spherical_pair(), rel=5e-5)
    any_volume, both, alone = exact["articulated"]
    assert alone == pytest.approx(articulated(), rel=1e-5)
    assert any_volume + both == pytest.approx(2 * alone, abs=1e-5)
    assert (any_volume, both) == (pytest.approx(0.0542, abs=5e-5), pytest.approx(0.0128, abs=5e-5))


def test_volumes_of_table_6_hold_what_is_exact(monkeypatch):
    """Run for real, at a coarser tolerance than the command's."""
    monkeypatch.setattr(zhang, "TOLERANCE", 0.02)
    monkeypatch.setattr(zhang, "PER_JOINT", 40)
    rows = [row for row in zhang._pair("articulated", None) if row.low is not None]
    assert [row.quantity for row in rows] == ["V_a, refined", "V_s, refined", "one arm, refined"]
    for row in rows:
        assert row.low <= row.exact <= row.high
        assert row.high - row.low < 0.06 * row.exact
        assert row.from_exact == row.reproduced - row.exact


def test_gao_is_the_value_of_the_paper(documents):
    rows = {(row.case, row.quantity): row for row in reproduce("gao")}
    assert rows["two arms", "V3, mean"].published == 3.3577e-3
    assert rows["two arms", "V3, variance"].published == 9.2569e-10
    assert (rows["two arms", "true volume"].exact, rows["one arm", "volume"].exact) == (6.2190e-3, 0.403721)
    assert rows["two arms", "V0, mean"].published is None
    job = documents[0]
    assert (job.samples, job.seeds, job.cells, job.refinements, job.neighbours) == (200_000, 10, (20, 20, 20), 3, 4)


def test_five_bar_holds_what_is_exact():
    """Run for real: it takes seconds."""
    rows = reproduce("five-bar")
    known = [row for row in rows if row.exact is not None]
    assert len(known) == 4 + 4 + 4 + 6 + 4
    for row in known:
        assert abs(row.from_exact) < 1e-9
    assert all(row.published is None for row in rows)
    areas = [row.reproduced for row in rows if row.case == "working mode +-" and row.unit == "m²"]
    assert areas[0] == pytest.approx(sum(areas[1:]), abs=1e-7)


def test_shah_holds_what_is_published_and_exact():
    """Run for real: it takes seconds."""
    rows = reproduce("shah")
    published = {(row.case, row.quantity): row for row in rows if row.published is not None}
    assert len(published) == 4 + 3 + 3 + 6 + 3 + 1
    for (case, quantity), row in published.items():
        if quantity == "time":
            assert row.reproduced > 0
        else:  # three digits in print, of 1.264 and the sweep fewer
            least = {"largest volume": 5e-3, "least volume": 5e-3}.get(
                quantity, 2e-3 if case == "their optimum" else 6e-4
            )
            assert abs(row.from_published) < least, (case, quantity)
    for row in (row for row in rows if row.exact is not None):
        grid = row.case in ("method A", "method B")
        assert abs(row.from_exact / row.exact) < (5e-3 if grid else 1e-3 if row.case == "method D" else 1e-8)
    by_grid = {row.reproduced for row in rows if row.case in ("method A", "method B") and row.quantity == "volume"}
    assert len(by_grid) == 1


def test_alciatore_is_the_paper_and_the_closed_forms():
    """Run for real: it takes a second."""
    rows = {(row.case, row.quantity): row for row in reproduce("alciatore")}
    assert [rows["1: RP", f"arc R{r}, R"].published for r in (5, 8)] == [5.04, 7.92]
    assert [rows["2: RR", f"circle R{r}, R"].published for r in (13, 3)] == [12.91, 3.05]
    printed = [rows["3: PR", f"segment 6, {end} {k}"].published for end in ("start", "end") for k in "xy"]
    assert printed == [-1.64, 7.10, 1.96, 5.57]
    misprinted = [n for n in range(1, 9) if "arc of R2" in rows["3: PR", f"segment {n}, start x"].note]
    assert misprinted == [2, 4, 8]
    assert [rows["3: PR", f"{kind}s"].exact for kind in ("line", "arc")] == [4, 4]
    sweeps = [row for row in rows.values() if row.quantity == "area, exact sweep"]
    assert len(sweeps) == 4
    for row in sweeps:
        assert row.reproduced == pytest.approx(row.exact, rel=1e-9)
    for row in rows.values():
        if row.quantity.endswith(", R"):
            assert row.reproduced == pytest.approx(row.published, rel=0.03)


def test_differences():
    row = Row("arm", "V", "m³", 0.6, published=0.5, exact=0.8)
    assert (row.from_published, row.from_exact) == (pytest.approx(0.1), pytest.approx(-0.2))
    assert Row("arm", "V", "m³", None, published=0.5).from_published is None
    assert Row("method A", "time", "s", 0.1, published=29.0).from_published is None  # another computer


@pytest.fixture
def case(monkeypatch):
    rows = [Row("arm", "volume", "m³", 0.6, 0.5, 0.8, 0.55, 0.65, "noise"), Row("arm", "G7", "1", None, 0.1)]
    monkeypatch.setitem(CASES, "paper", lambda progress: rows)


def run(capsys, *arguments):
    with pytest.raises(SystemExit) as ended:
        cli.main(["reproduce", *arguments])
    written = capsys.readouterr()
    return ended.value.code, written.out, written.err


def test_command_prints_a_table(case, capsys):
    code, out, _ = run(capsys, "paper")
    head, _, first, second = (line.split() for line in out.splitlines())
    assert code == 0
    assert head == [
        "case",
        "quantity",
        "published",
        "reproduced",
        "exact",
        "−",
        "published",
        "−",
        "exact",
        "unit",
        "note",
    ]
    assert first == [
        "arm",
        "volume",
        "0.5",
        "0.6",
        "0.8",
        "+0.1",
        "(+20",
        "%)",
        "-0.2",
        "(-25",
        "%)",
        "m³",
        "95",
        "%:",
        "0.55",
        "…",
        "0.65;",
        "noise",
    ]
    assert second == ["arm", "G7", "0.1", "–", "–", "–", "–"]


def test_command_prints_json(case, capsys):
    _, out, _ = run(capsys, "paper", "--json")
    first, second = json.loads(out)
    assert first["from_published"] == pytest.approx(0.1) and first["low"] == 0.55
    assert second["reproduced"] is None


def test_the_help_names_every_case():
    assert tuple(CASES) == NAMES


def test_unknown_names_list_what_there_is(capsys):
    with pytest.raises(InputError, match="allowed: wsrender-table-3, wsrender-table-6, "):
        cases.reproduce("table-9")
    code, _, err = run(capsys, "table-9")
    assert (code, err.startswith("error: NAME: 'table-9' is not a reproduction")) == (2, True)
