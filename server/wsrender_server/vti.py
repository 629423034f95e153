"""Volume data as VTK XML ImageData (.vti), for tools that do not read VTKHDF.

Format: VTK's *VTK XML Formats*, ImageData, appended raw data with 64-bit headers.
"""

from math import prod
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from wsrender.export.atomic import new_file
from wsrender.export.cells import CellNames, cell_arrays, cell_names
from wsrender.volume.volume_data import VolumeData

_TYPES = {"float32": "Float32", "float64": "Float64", "int64": "Int64"}


def write_volume_vti(volume: VolumeData, path: str | Path) -> None:
    """Write volume data as one ImageData: cell arrays ``count`` and ``<statistic>_<index>``, world frame, metres."""
    names = cell_names(volume, taken={"count"})
    with new_file(path) as temporary, temporary.open("wb") as file:
        file.write(_header(volume, names).encode())
        for _name, array in cell_arrays(volume, names):
            data = np.ascontiguousarray(array.T).astype(array.dtype.newbyteorder("<"), copy=False)  # x fastest
            file.write(np.uint64(data.nbytes).astype("<u8").tobytes())
            file.write(data.data)
        file.write(b"</AppendedData></VTKFile>\n")


def _header(volume: VolumeData, names: CellNames) -> str:
    voxels = volume.voxels
    types = {"count": voxels.count.dtype}
    types |= {name: voxels.statistics[statistic][index].dtype for (statistic, index), name in names.items()}
    extent = " ".join(f"0 {size}" for size in volume.shape)
    origin = " ".join(repr(float(value)) for value in volume.origin_m)
    spacing = " ".join([repr(float(volume.voxel_size_m))] * 3)
    lines, offset = [], 0
    for name, dtype in types.items():
        lines.append(
            f'<DataArray type="{_TYPES[dtype.name]}" Name={quoteattr(name)} format="appended" offset="{offset}"/>'
        )
        offset += 8 + dtype.itemsize * prod(volume.shape)
    return (
        '<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
        f'<ImageData WholeExtent="{extent}" Origin="{origin}" Spacing="{spacing}"><Piece Extent="{extent}">'
        f"<CellData>{''.join(lines)}</CellData></Piece></ImageData>"
        '<AppendedData encoding="raw">_'
    )
