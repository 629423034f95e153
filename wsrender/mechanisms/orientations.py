"""Platform orientations on a grid of angles, with the share of the rotation group that each stands for."""

from dataclasses import dataclass

import numpy as np

from wsrender.documents.orientations import EulerRanges, TiltRanges

WEIGHT_BITS = 30


@dataclass(frozen=True, eq=False)
class OrientationSet:
    """``angles`` (N, 3) [rad] named ``names``, their ``rotations`` (N, 3, 3), and ``weights`` (N,) that add up to 1.

    Weights follow the invariant (Haar) measure of rotations, so that shares do not depend on the choice of angles:
    cos β of Rx(α) Ry(β) Rz(γ), sin θ of azimuth, tilt and torsion. ``levels``: of each angle, the last one fastest.
    """

    names: tuple[str, str, str]
    angles: np.ndarray
    rotations: np.ndarray
    weights: np.ndarray
    levels: tuple[int, ...]

    @property
    def whole_weights(self) -> np.ndarray:
        """The weights as whole numbers (N,) int32, none 0, whose sum is about 2^30: sums of them are exact."""
        return np.maximum(np.round(self.weights * 2**WEIGHT_BITS), 1).astype(np.int32)

    @property
    def quat_wxyz(self) -> np.ndarray:
        """The rotations as quaternions with w not negative, (N, 4)."""
        from scipy.spatial.transform import Rotation

        return Rotation.from_matrix(self.rotations).as_quat(canonical=True, scalar_first=True)


def orientation_set(spec: EulerRanges | TiltRanges) -> OrientationSet:
    """The orientations of a document."""
    return _euler(spec) if isinstance(spec, EulerRanges) else _tilts(spec)


def finer(spec: EulerRanges | TiltRanges) -> EulerRanges | TiltRanges:
    """The same ranges with every step halved; the orientations that there were are among the new ones."""
    if isinstance(spec, EulerRanges):
        return spec.model_copy(update={"per_angle": tuple(_halved(count) for count in spec.per_angle)})
    halved = {name: _halved(getattr(spec, name)) for name in ("tilts", "torsions")}
    return spec.model_copy(update={**halved, "azimuths": 2 * spec.azimuths})


def _halved(levels: int) -> int:
    return 2 * levels - 1 if levels > 1 else 2


def random_orientations(spec: EulerRanges | TiltRanges, count: int, seed: int) -> np.ndarray:
    """Independent orientations of the ranges, uniform by the invariant measure of rotations, (count, 3, 3)."""
    random = np.random.Generator(np.random.Philox(key=seed))
    u, v, w = random.random((3, count))
    if isinstance(spec, EulerRanges):
        (a0, a1), (b0, b1), (c0, c1) = np.deg2rad(spec.euler_xyz_deg)
        return _turn(0, a0 + u * (a1 - a0)) @ _turn(1, _by_cosine(v, b0, b1)) @ _turn(2, c0 + w * (c1 - c0))
    azimuth, tilt = 2 * np.pi * u, np.arccos(1 - v * (1 - np.cos(np.deg2rad(spec.tilt_deg))))
    low, high = np.deg2rad(spec.torsion_deg)
    torsion = low + w * (high - low)
    return _turn(2, azimuth) @ _turn(1, tilt) @ _turn(2, torsion - azimuth)


def _by_cosine(share: np.ndarray, low: float, high: float) -> np.ndarray:
    """Angles of low … high whose density is that of |cos|, from shares (N,) of it."""
    angles = np.linspace(low, high, 4097)
    total = np.concatenate([[0.0], np.cumsum(np.abs(np.cos((angles[1:] + angles[:-1]) / 2)))])
    return np.interp(share, total / total[-1], angles) if high > low else np.full(len(share), low)


def _euler(spec: EulerRanges) -> OrientationSet:
    axes = [_levels(*limits, count) for limits, count in zip(spec.euler_xyz_deg, spec.levels, strict=True)]
    ends = [_trapezoid(count) for count in spec.levels]
    angles = _grid(axes)
    weights = _grid(ends).prod(axis=1) * np.abs(np.cos(angles[:, 1]))
    x, y, z = (_turn(axis, angles[:, axis]) for axis in range(3))
    return OrientationSet(("alpha", "beta", "gamma"), angles, x @ y @ z, _shares(weights), spec.levels)


def _tilts(spec: TiltRanges) -> OrientationSet:
    azimuths, tilts, torsions = spec.levels
    axes = [2 * np.pi * np.arange(azimuths) / azimuths, _levels(0, spec.tilt_deg, tilts)]
    angles = _grid([*axes, _levels(*spec.torsion_deg, torsions)])
    weights = _grid([np.ones(azimuths), _trapezoid(tilts), _trapezoid(torsions)]).prod(axis=1)
    azimuth, tilt, torsion = angles.T
    rotations = _turn(2, azimuth) @ _turn(1, tilt) @ _turn(2, torsion - azimuth)
    return OrientationSet(
        ("azimuth", "tilt", "torsion"), angles, rotations, _shares(weights * np.sin(tilt)), spec.levels
    )


def _levels(low_deg: float, high_deg: float, count: int) -> np.ndarray:
    """Equal steps from end to end [rad]; one level is the upper end, the middle of a range of no width."""
    return np.deg2rad(np.linspace(low_deg, high_deg, count) if count > 1 else np.array([high_deg]))


def _trapezoid(count: int) -> np.ndarray:
    weights = np.ones(count)
    if count > 1:
        weights[[0, -1]] = 0.5
    return weights


def _grid(axes: list[np.ndarray]) -> np.ndarray:
    """All combinations, the last axis fastest, (N, 3)."""
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))


def _shares(weights: np.ndarray) -> np.ndarray:
    """The weights as shares; equal ones where all are 0, at a tilt of 0 or β = 90° alone."""
    total = weights.sum()
    return weights / total if total > 1e-12 else np.full(len(weights), 1 / len(weights))


def _turn(axis: int, angle: np.ndarray) -> np.ndarray:
    """Rotations about x, y or z (axis 0, 1, 2), (N, 3, 3)."""
    j, k = (axis + 1) % 3, (axis + 2) % 3
    R = np.zeros((len(angle), 3, 3))
    R[:, axis, axis] = 1
    R[:, j, j] = R[:, k, k] = np.cos(angle)
    R[:, k, j] = np.sin(angle)
    R[:, j, k] = -R[:, k, j]
    return R
