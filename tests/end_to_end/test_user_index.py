"""An index of the user's own goes everywhere that the catalogue's go."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.simple_robots import planar_arm
from wsrender.indices import index_catalogue


@pytest.fixture(autouse=True)
def spread(monkeypatch):
    monkeypatch.setattr(index_catalogue, "_ADDED", {})
    ws.register_index("spread_of_sigma", lambda sigma, m, n: sigma[0] - sigma[-1], symbol="Δσ", unit="m")


def test_user_index_in_map_volume_pictures_and_files(tmp_path):
    options = {"task": ["x", "y"], "voxel_size_m": 0.05, "keep_map": True, "map_columns": ["configuration"]}
    result = ws.analyze(planar_arm(), ws.Grid(40), ["spread_of_sigma"], device="cpu", **options)
    J = planar_arm().jacobian(result.map.configuration, device="cpu")[:, :2]
    sigma = np.linalg.svd(J, compute_uv=False)
    expected = sigma[:, 0] - sigma[:, 1]
    assert result.map.indices["spread_of_sigma"] == pytest.approx(expected, abs=1e-5)
    assert np.nanmax(result.volume.statistics["maximum"]["spread_of_sigma"]) == pytest.approx(expected.max(), abs=1e-5)
    assert result.document["indices"]["spread_of_sigma"]["unit"] == "m"
    result.save(tmp_path / "out")
    assert (tmp_path / "out" / "plots" / "slices.png").stat().st_size > 1000
    loaded = ws.Result.load(tmp_path / "out")
    assert loaded.map.indices["spread_of_sigma"].tobytes() == result.map.indices["spread_of_sigma"].tobytes()
    assert loaded.document["indices"] == result.document["indices"]
