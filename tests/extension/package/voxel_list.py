"""A format of another package, in one file: the voxels that hold something, as JSON."""

import json
from pathlib import Path

import numpy as np

import wsrender as ws
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels


def write(volume, path):
    voxels = volume.voxels
    plain = {
        "size": volume.voxel_size_m,
        "first": list(map(int, volume.first_voxel)),
        "shape": list(map(int, volume.shape)),
        "units": volume.units,
        "cells": voxels.cells.tolist(),
        "count": voxels.count.tolist(),
        "statistics": {s: {name: _listed(v) for name, v in each.items()} for s, each in voxels.statistics.items()},
        "vectors": {name: _listed(v) for name, v in voxels.vectors.items()},
    }
    Path(path).write_text(json.dumps(plain))


def read(path):
    plain = json.loads(Path(path).read_text())
    statistics = {s: {name: _array(v) for name, v in each.items()} for s, each in plain["statistics"].items()}
    vectors = {name: _array(v) for name, v in plain["vectors"].items()}
    cells, count = (np.array(plain[name], np.int64) for name in ("cells", "count"))
    voxels = Voxels(tuple(plain["shape"]), cells, count, statistics, vectors)
    return VolumeData.of_voxels(plain["size"], tuple(plain["first"]), voxels, plain["units"])


def _listed(values):
    return [values.dtype.name, values.tolist()]


def _array(listed):
    dtype, values = listed
    return np.array(values, dtype)


VOXELS = ws.Format("voxels", "volume", "application/x-voxel-list", write, read)
