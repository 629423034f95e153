import numpy as np
import pytest

from wsrender.errors import MissingExtraError, RenderError
from wsrender.results.render import Subject
from wsrender.results.render.process import drawn
from wsrender.results.render.scene import Camera, DrawnScene
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.volume_data import VolumeData


@pytest.fixture(scope="session")
def opengl():
    """Skips where nothing can draw, and says why."""
    camera = Camera(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]), 1.0)
    try:
        drawn(DrawnScene(camera, (8, 8)))
    except (MissingExtraError, RenderError) as error:
        pytest.skip(str(error))


@pytest.fixture
def block():
    """A full block of 12 × 10 × 8 voxels whose index grows along z: 1, 2, … 8; an arm of three points in it."""
    shape = (12, 10, 8)
    value = np.broadcast_to(np.arange(1.0, 9.0), shape)
    volume = VolumeData(0.1, (-6, -5, 2), np.full(shape, 100), {"maximum": {"reach": value.copy()}}, {"reach": "m^2"})
    centers = np.stack(np.meshgrid(*map(volume.centers, range(3)), indexing="ij"), axis=-1).reshape(-1, 3)
    samples = DistributionMap(centers, {"reach": value.ravel().copy()}, {"reach": "m^2"})
    arm = np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, 0.5], [0.3, 0.0, 0.5]]])
    return Subject("block", samples, volume, arm)
