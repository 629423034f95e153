"""Volumes of a view hold the numbers of the result's own arrays, whatever these are."""

import json
import zlib

import numpy as np
import pytest

import wsrender as ws
from wsrender.results.drawing.okabe_ito import GREEN, ORANGE, VERMILION
from wsrender.results.result import Result
from wsrender.results.view import view_of
from wsrender.results.view import volumes as of_volumes
from wsrender.results.view.blobs import encoded, fitting
from wsrender.results.view.manifest import MANIFEST
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

DOCUMENT = {"format": 2, "analysis": "workspace", "robot": {"name": "arm"}}


def volume(shape=(7, 5, 4), seed=0, dtype=np.float64, **more):
    """A block with empty voxels, NaN among its values."""
    rng = np.random.default_rng(seed)
    count = rng.integers(0, 3, shape)
    count[0, 0, 0] = count[-1, -1, -1] = 1
    values = np.where(count > 0, rng.random(shape) * 0.2, np.nan).astype(dtype)
    values[-1, -1, -1] = np.nan
    statistics = {"mean": {"height": values + 1}, "maximum": {"manipulability": values}}
    return VolumeData(0.05, (-3, 2, 0), count, statistics, {"manipulability": "m^3", "height": "m"}, **more)


def shown(data, **options):
    view = view_of(Result(DOCUMENT, volume=data), **options)
    MANIFEST.validate_python(view.manifest)
    return view, view.manifest["volumes"][0]


def numbers(view, data):
    return np.frombuffer(view.blobs[data["blob"]], np.dtype(data["type"]).newbyteorder("<"))


@pytest.mark.parametrize("encoding", ["float16", "float32", "uint8"])
def test_a_hundred_voxels_hold_the_numbers_of_the_volume(encoding):
    data = volume()
    view, entry = shown(data, encoding=encoding)
    assert entry["shape"] == [7, 5, 4] and entry["first_voxel"] == [-3, 2, 0] and entry["voxel_size_m"] == 0.05
    assert [(each["statistic"], each["name"]) for each in entry["channels"]] == [
        ("maximum", "manipulability"), ("mean", "height"), ("count", "samples"),
    ]  # fmt: skip
    assert [each["unit"] for each in entry["channels"]] == ["m³", "m", ""]
    occupancy = numbers(view, entry["occupancy"])
    for channel, source in zip(entry["channels"][:2], ("maximum/manipulability", "mean/height"), strict=True):
        statistic, name = source.split("/")
        values, held = data.statistics[statistic][name], numbers(view, channel["data"])
        for i, j, k in np.random.default_rng(2).integers(0, data.shape, (100, 3)).tolist():
            at = i + 7 * (j + 5 * k)
            assert occupancy[at] == (data.count[i, j, k] > 0)
            value = values[i, j, k]
            if encoding == "uint8":
                step = (channel["maximum"] - channel["minimum"]) / 254
                known = channel["minimum"] + (float(held[at]) - 1) * step
                assert (held[at] == 0) == np.isnan(value) and (np.isnan(value) or abs(known - value) <= 0.501 * step)
            else:
                assert np.array_equal(held[at], value.astype(encoding), equal_nan=True)


def test_exact_is_said_of_the_very_numbers_only():
    single = volume(dtype=np.float32)
    assert shown(single, encoding="float32")[1]["exact"] is True
    assert shown(single)[1]["exact"] is False
    assert shown(volume(), encoding="float32")[1]["exact"] is False


@pytest.mark.parametrize(
    ("low", "high", "kept"),
    [(0, 0.2, True), (5, 5, True), (0, 0, True), (-3, 4, True), (0, 7e4, False), (0, 1e-6, False), (1000, 1001, False)],
)
def test_halves_are_taken_where_they_tell_values_apart(low, high, kept):
    assert fitting("float16", low, high) == ("float16" if kept else "float32")
    assert fitting("uint8", low, high) == "uint8"
    values = np.linspace(low, high, 97)
    held = encoded(values, fitting("float16", low, high), low, high).astype(float)
    assert np.abs(held - values).max() <= (high - low) / 256 + 1e-12


@pytest.mark.parametrize("value", [0.0, 3.5, -1e-300, 1e300])
def test_a_channel_of_one_value(value):
    data = VolumeData(0.1, (0, 0, 0), np.ones((3, 3, 3), int), {"maximum": {"scara": np.full((3, 3, 3), value)}})
    for encoding in ("uint8", "float16", "float32"):
        view, entry = shown(data, encoding=encoding)
        channel = entry["channels"][0]
        assert channel["minimum"] == channel["maximum"] == value
        assert np.isfinite(numbers(view, channel["data"])).all() or value == 1e300
    assert set(view.blobs["volume0.channel0.uint8"]) == {1}


def test_counts_are_told_as_whole_numbers():
    counts = np.array([np.nan, 1.0, 2.0, 7.0]).reshape(4, 1, 1)
    statistics = {"number": {"robots": counts}, "mean": {"share": counts / 2, "of": np.full((4, 1, 1), 0.5)}}
    _, entry = shown(VolumeData(0.1, (0, 0, 0), np.arange(1, 5).reshape(4, 1, 1), statistics))
    whole = {channel["name"]: channel.get("whole") for channel in entry["channels"]}
    assert whole == {"robots": True, "share": None, "of": None, "samples": True}


def test_values_that_are_not_finite_are_none():
    values = np.array([np.inf, -np.inf, np.nan, 1.0, 2.0]).reshape(5, 1, 1)
    data = VolumeData(0.1, (0, 0, 0), np.ones((5, 1, 1), int), {"maximum": {"odd": values}})
    view, entry = shown(data)
    channel = entry["channels"][0]
    assert (channel["minimum"], channel["maximum"]) == (1.0, 2.0)
    assert np.isnan(numbers(view, channel["data"])).tolist() == [True, True, True, False, False]
    assert view.blobs["volume0.channel0.uint8"] == bytes([0, 0, 0, 1, 255])
    none = VolumeData(0.1, (0, 0, 0), np.ones((5, 1, 1), int), {"maximum": {"odd": np.full((5, 1, 1), np.nan)}})
    assert shown(none)[1]["channels"][0]["maximum"] == 0.0


def test_large_volumes_come_in_larger_voxels_first(monkeypatch):
    monkeypatch.setattr(of_volumes, "FINE", 100)
    data = volume()
    view, entry = shown(data)
    assert [level["voxel_size_m"] for level in entry["coarser"]] == pytest.approx([0.2, 0.1])
    for level, factor in zip(entry["coarser"], (4, 2), strict=True):
        held = numbers(view, level["channels"][0]["data"]).reshape(level["shape"], order="F")
        fine = data.statistics["maximum"]["manipulability"]
        for i, j, k in np.argwhere(np.isfinite(fine)).tolist():
            cell = (np.array((i, j, k)) + data.first_voxel) // factor - level["first_voxel"]
            assert held[tuple(cell)] >= fine[i, j, k] - 1e-4
        assert np.nanmax(held) == pytest.approx(np.nanmax(fine), abs=1e-4)


def test_too_large_volumes_are_reduced_which_is_said():
    view, entry = shown(volume((40, 30, 20)), most_voxels=1000)
    assert np.prod(entry["shape"]) <= 1000 and entry["exact"] is False
    assert entry["reduced"].startswith("40 x 30 x 20 voxels of 0.05 m are shown in voxels 4 times as long, of 0.2 m")
    assert len(numbers(view, entry["occupancy"])) == np.prod(entry["shape"])
    assert "reduced" not in shown(volume((10, 10, 10)), most_voxels=1000)[1]


def test_a_sparse_block_of_a_billion_voxels_takes_little_memory():
    at = np.array([[0, 0, 0], [1500, 1500, 1500]])
    start, held = Voxels.at_places(at, np.ones(2, int), {"maximum": {"reach": np.array([1.0, 2.0])}})
    view, entry = shown(VolumeData.of_voxels(0.01, start, held))
    assert np.prod(entry["shape"]) <= of_volumes.MOST_VOXELS and "reduced" in entry
    assert numbers(view, entry["occupancy"]).sum() == 2


def test_labels_are_names():
    label = np.array([1.0, -1.0, 0.0]).reshape(3, 1, 1)
    units = {"label": "1 reachable, 0 unreachable, -1 undecided"}
    data = VolumeData(0.1, (0, 0, 0), np.zeros((3, 1, 1), int), {"center": {"label": label}}, units)
    view, entry = shown(data)
    (channel, *_) = entry["channels"]
    assert [(each["value"], each["name"]) for each in channel["categories"]] == [
        (1, "Reachable"), (0, "Unreachable"), (-1, "Undecided"),
    ]  # fmt: skip
    assert [each["color"] for each in channel["categories"]] == [GREEN, VERMILION, ORANGE] and channel["unit"] == ""
    assert set(numbers(view, entry["occupancy"])) == {1}
    assert numbers(view, channel["data"]).tolist() == [1.0, -1.0, 0.0]


def test_forces_are_arrows_from_the_centres_of_voxels():
    force = np.zeros((7, 5, 4, 3))
    force[2, 1, 3] = (1, 2, -3)
    view, _ = shown(volume(vectors={"force": force}))
    (arrows,) = view.manifest["glyphs"]
    assert numbers(view, arrows["origins"]) == pytest.approx([(-3 + 2.5) * 0.05, (2 + 1.5) * 0.05, 3.5 * 0.05])
    assert numbers(view, arrows["vectors"]).tolist() == [1, 2, -3]


def test_points_are_quantised_and_hostile_names_are_text():
    rng = np.random.default_rng(0)
    name = "</script><script>alert(1)</script>"
    position = rng.normal(size=(50, 3))
    position[7] = np.nan
    indices = {name: rng.random(50)}
    own = VolumeData(0.1, (0, 0, 0), np.ones((2, 1, 1), int), {name: {name: np.ones((2, 1, 1))}}, {name: "m"})
    result = Result(
        {**DOCUMENT, "robot": {"name": name}},
        sample=DistributionMap(position, indices, {name: "m"}),
        volume=own,
        tables={name: Table({"position": position, "label": np.array(["a", name] * 25)})},
        volumes={name: volume()},
    )
    view = view_of(result)
    plain = set("abcdefghijklmnopqrstuvwxyz0123456789.")
    assert name in view.manifest["title"] and all(set(blob) <= plain for blob in view.blobs)
    samples, table = view.manifest["points"]
    kept = np.isfinite(position).all(axis=1)
    held = numbers(view, samples["positions"]).reshape(-1, 3)
    low, high = np.array(samples["lower"]), np.array(samples["upper"])
    assert samples["count"] == 49 and np.abs(low + held / 65535 * (high - low) - position[kept]).max() < 1e-4
    assert np.array_equal(numbers(view, samples["channels"][0]["data"]), indices[name][kept].astype(np.float16))
    assert [each["name"] for each in table["channels"][0]["categories"]] == [name, "A"]
    (histogram,) = view.manifest["plots"]
    assert sum(histogram["y"][0]["values"]) == 50 and len(histogram["x"]["values"]) == 40


def test_a_file_holds_what_fits_and_names_the_rest():
    data = volume((30, 30, 30))
    view = view_of(Result(DOCUMENT, volume=data, volumes={"other": data}))
    whole = view.for_file(10**7)
    assert whole.manifest["omitted"] == [] and MANIFEST.validate_python(whole.manifest)
    (entry, _) = whole.manifest["volumes"]
    for held in (entry["occupancy"], *(each["data"] for each in entry["channels"])):
        assert held["compression"] == "deflate"
        assert zlib.decompress(whole.blobs[held["blob"]]) == view.blobs[held["blob"]]
    budget = sum(map(len, whole.blobs.values())) * 2 // 3
    some = view.for_file(budget)
    assert 0 < sum(map(len, some.blobs.values())) <= budget and MANIFEST.validate_python(some.manifest)
    assert all(each["channels"] for each in some.manifest["volumes"])
    assert "channel of volume: mean height, which does not fit in the file" in some.manifest["omitted"]
    least = sum(map(len, whole.blobs.values()))
    assert view.for_file(least).blobs == whole.blobs and len(view.for_file(least - 1).manifest["omitted"]) == 1
    assert view.for_file(10).manifest["volumes"] == [] and len(view.for_file(10).manifest["omitted"]) == 2
    assert view.manifest["volumes"][0]["occupancy"]["compression"] is None
    content = whole.to_file_bytes(10**7)
    length = int.from_bytes(content[:4], "little")
    header = json.loads(content[4 : 4 + length])
    assert header["manifest"] == whole.manifest and length % 4 == 0
    assert sum(each["bytes"] for each in header["blobs"]) == len(content) - 4 - length
    with pytest.raises(ws.InputError, match="budget"):
        view.for_file(-1)
