"""Volume data as VTK XML ImageData (.vti), for tools that do not read VTKHDF.

Format: VTK's *VTK XML Formats*, ImageData, appended raw data with 64-bit headers. Units stand in the information key
``UNITS_LABEL`` of each array.
"""

from math import prod
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from wsrender.results.export.atomic import new_file
from wsrender.results.export.cells import Layers, cell_names, cell_units, cells_of, vector_names
from wsrender.volume.volume_data import VolumeData


def write_volume_vti(volume: VolumeData, path: str | Path) -> None:
    """Write volume data as one ImageData, world frame, metres.

    Cell arrays ``count`` and ``<statistic>_<index>``, vectors as arrays of three components, NaN in empty voxels.
    """
    taken = {"count"}
    names, vectors = cell_names(volume, taken), vector_names(volume, taken)
    voxels = volume.voxels
    arrays = {"count": voxels.count}
    arrays |= {name: cells_of(voxels)[statistic][index] for (statistic, index), name in names.items()}
    arrays |= {name: voxels.vectors[vector] for vector, name in vectors.items()}
    layers, cells = Layers(voxels), prod(volume.shape)
    with new_file(path) as temporary, temporary.open("wb") as file:
        file.write(_header(volume, arrays, cell_units(volume, names, vectors)).encode())
        for values in arrays.values():
            file.write(np.array(_size(values, cells), "<u8").tobytes())
            for start in range(0, layers.shape[0], layers.thickness):
                chunk = layers.chunk(values, start)[: cells - start * prod(layers.shape[1:])]
                file.write(chunk.astype(chunk.dtype.newbyteorder("<"), copy=False).data)
        file.write(b"</AppendedData></VTKFile>\n")


def _header(volume: VolumeData, arrays: dict[str, np.ndarray], units: dict[str, str]) -> str:
    extent = " ".join(f"0 {size}" for size in volume.shape)
    origin = " ".join(repr(float(value)) for value in volume.origin_m)
    spacing = " ".join([repr(float(volume.voxel_size_m))] * 3)
    lines, offset = [], 0
    for name, values in arrays.items():
        lines.append(
            f'<DataArray type="{_type(values.dtype)}" Name={quoteattr(name)} '
            f'NumberOfComponents="{prod(values.shape[1:])}" format="appended" offset="{offset}">'
            f'<InformationKey name="UNITS_LABEL" location="vtkDataArray">{escape(units[name])}</InformationKey>'
            "</DataArray>"
        )
        offset += 8 + _size(values, prod(volume.shape))
    return (
        '<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
        f'<ImageData WholeExtent="{extent}" Origin="{origin}" Spacing="{spacing}"><Piece Extent="{extent}">'
        f"<CellData>{''.join(lines)}</CellData></Piece></ImageData>"
        '<AppendedData encoding="raw">_'
    )


def _size(values: np.ndarray, cells: int) -> int:
    """Bytes of the array of so many cells whose values are those of (V,) or (V, 3)."""
    return values.itemsize * prod(values.shape[1:]) * cells


def _type(dtype: np.dtype) -> str:
    """VTK's name of a type of numbers, such as Float32."""
    kinds = {"f": "Float", "i": "Int", "u": "UInt"}
    return f"{kinds[dtype.kind]}{8 * dtype.itemsize}"
