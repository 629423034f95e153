"""Small maps and volumes with awkward names, and comparison of every field."""

import numpy as np

from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.volume_data import VolumeData

ODD_NAMES = ("manipulability", "x", 'a/b "c", d', "..", "file")


def random_map(rows=1000, kind=np.float32, names=ODD_NAMES) -> DistributionMap:
    """Samples of a 3-joint robot whose first joint is called x, with odd index names."""
    rng = np.random.default_rng(1)
    return DistributionMap(
        position=rng.normal(size=(rows, 3)).astype(kind),
        indices={name: rng.random(rows).astype(kind) for name in names},
        units={"manipulability": "m³", "x": "rad"},
        configuration=rng.normal(size=(rows, 3)).astype(kind),
        joint_names=("x", "elbow", "wrist, 'roll'"),
        quat_wxyz=rng.normal(size=(rows, 4)).astype(kind),
    )


def random_volume(shape, kind=np.float32, statistics=("maximum", "mean"), names=ODD_NAMES, vectors=()) -> VolumeData:
    """A volume with about half its voxels occupied, not symmetric in any axis."""
    rng = np.random.default_rng(2)
    count = rng.integers(0, 3, shape)
    count.flat[0] = 5

    def values():
        return np.where(count > 0, rng.random(shape), np.nan).astype(kind)

    return VolumeData(
        voxel_size_m=0.05,
        first_voxel=(-7, 3, 11),
        count=count,
        statistics={statistic: {name: values() for name in names} for statistic in statistics},
        units={"manipulability": "m³", "x": "1"} | dict.fromkeys(vectors, "N"),
        vectors={name: np.stack([values(), values(), values()], axis=3) for name in vectors},
    )


def assert_same_map(a: DistributionMap, b: DistributionMap) -> None:
    assert list(a.indices) == list(b.indices)
    assert (a.units, a.joint_names) == (b.units, b.joint_names)
    pairs = [(a.position, b.position), (a.configuration, b.configuration), (a.quat_wxyz, b.quat_wxyz)]
    pairs += [(a.indices[name], b.indices[name]) for name in a.indices]
    for left, right in pairs:
        assert (left is None) == (right is None)
        if left is not None:
            assert left.dtype == right.dtype
            np.testing.assert_array_equal(left, right)


def assert_same_volume(a: VolumeData, b: VolumeData) -> None:
    assert (a.voxel_size_m, a.first_voxel, a.units) == (b.voxel_size_m, b.first_voxel, b.units)
    assert a.count.dtype == b.count.dtype
    np.testing.assert_array_equal(a.count, b.count)
    assert list(a.statistics) == list(b.statistics)
    for statistic, by_index in a.statistics.items():
        assert list(by_index) == list(b.statistics[statistic])
        for name, values in by_index.items():
            assert values.dtype == b.statistics[statistic][name].dtype
            np.testing.assert_array_equal(values, b.statistics[statistic][name])
    assert list(a.vectors) == list(b.vectors)
    for name, values in a.vectors.items():
        assert values.dtype == b.vectors[name].dtype
        np.testing.assert_array_equal(values, b.vectors[name])
