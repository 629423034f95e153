"""What golden files say of results: their documents without what differs from run to run, and their data in short.

Numbers are compared to a tolerance, for other processors round otherwise; everything else must be the same.
"""

import json
import math
import re
from collections.abc import Iterator, Mapping
from hashlib import sha256
from typing import Any

import numpy as np

from wsrender.results.export.columns import columns_of

RELATIVE = {"float64": 1e-9, "float32": 1e-5}
NEARLY_ZERO = 1e-12  # what is left where numbers of about one cancel
TURN = 97  # weights of a sum that notices when values change places
ESTIMATE = "estimate"  # its seconds are no time of a run
OF_THE_RUN = frozenset({"timing_s", "artifacts"})
OF_THE_HOST = frozenset({"wsrender", "warp-lang", "mujoco", "numpy", "target", "host", "run", "citation"})
TIMES = ("seconds",)  # how names of times begin
NOISE = ("residual", *TIMES)  # and of numbers that are noise below a tolerance
FACETS = re.compile(r"polytope\w*/faces")  # rounding decides which triangles fill a facet of more than three corners


def facts_of(result: Any, estimate: Mapping[str, float]) -> dict[str, Any]:
    """Estimate, document, data and pictures of a result, as plain JSON values."""
    facts = {
        ESTIMATE: estimate,
        "document": _lasting(result.document),
        "data": {name: _array(array, unit, name) for name, array, unit in arrays_of(result)},
        "pictures": sorted(row.name for row in result.plot.pictures),
    }
    return json.loads(json.dumps(facts, allow_nan=False, default=np.ndarray.tolist))


def _lasting(document: Mapping[str, Any]) -> dict[str, Any]:
    """A document without seconds, versions and host."""
    kept = {name: value for name, value in document.items() if name not in OF_THE_RUN}
    origin = document["provenance"]
    return kept | {"provenance": {name: value for name, value in origin.items() if name not in OF_THE_HOST}}


def arrays_of(result: Any) -> Iterator[tuple[str, np.ndarray, str]]:
    """Every array of a result: a name that says where it stands, the array, its unit."""
    for name, rows in {"map": result.map, "sample": result.sample, **result.tables}.items():
        if rows is not None:
            columns = columns_of(rows)
            units = columns.column_units()
            for column, array in columns.arrays(rows).items():
                yield f"{name}/{column}", array, units[column]
    for name, volume in {"volume": result.volume, **result.volumes}.items():
        if volume is not None:
            yield from _of_volume(name, volume)
    for name, mesh in result.meshes.items():
        yield f"{name}/vertices", np.asarray(mesh.vertices), "m"
        yield f"{name}/faces", np.asarray(mesh.faces), "1"
    if result.skeleton is not None:
        yield "skeleton", np.asarray(result.skeleton), "m"


def _of_volume(name: str, volume: Any) -> Iterator[tuple[str, np.ndarray, str]]:
    yield f"{name}/lattice", np.array([volume.voxel_size_m, *volume.first_voxel]), "m"
    yield f"{name}/count", volume.count, "samples"
    for statistic, by_index in volume.statistics.items():
        for index, values in by_index.items():
            yield f"{name}/{statistic}/{index}", values, volume.units.get(index, "1")
    for vector, values in volume.vectors.items():
        yield f"{name}/{vector}", values, volume.units.get(vector, "1")


def bits_of(result: Any) -> dict[str, Any]:
    """Document, and a hash of each array: the same for two results whose every bit is the same, times apart."""
    hashes = {}
    for name, array, unit in arrays_of(result):
        content = _text_of(array) if array.dtype.kind not in "biuf" else np.ascontiguousarray(array).tobytes()
        if not name.rpartition("/")[2].startswith(TIMES):
            hashes[name] = [list(array.shape), _dtype(array), unit, sha256(content).hexdigest()]
    return json.loads(json.dumps({"document": _untimed(_lasting(result.document)), "arrays": hashes}))


def _untimed(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _untimed(each) for name, each in value.items() if not name.startswith(TIMES)}
    return [_untimed(each) for each in value] if isinstance(value, list | tuple) else value


def _array(values: np.ndarray, unit: str, name: str) -> dict[str, Any]:
    """Shape, dtype and unit of an array, and its sums, or of text its hash."""
    entry = {"shape": list(values.shape), "dtype": _dtype(values), "unit": unit}
    if values.dtype.kind not in "biuf":
        return entry | {"sha256": sha256(_text_of(values)).hexdigest()}
    if name.rpartition("/")[2].startswith(NOISE) or FACETS.search(name):
        return entry
    numbers = values.astype(np.float64).ravel()
    finite = np.isfinite(numbers)
    kept = np.where(finite, numbers, 0.0)
    turned = kept * (1 + np.arange(len(kept)) % TURN)
    sums = {"sum": kept.sum(), "turned_sum": turned.sum(), "size": np.abs(turned).sum()}
    return entry | {name: float(value) for name, value in sums.items()} | {"not_finite": int((~finite).sum())}


def _text_of(values: np.ndarray) -> bytes:
    return "\n".join(map(str, values.ravel().tolist())).encode()


def _dtype(values: np.ndarray) -> str:
    return "text" if values.dtype.kind in "UO" else values.dtype.name


def differences(found: dict[str, Any], golden: dict[str, Any]) -> list[str]:
    """What differs beyond the tolerance of the result's precision, each with its place."""
    precision = golden["document"]["provenance"].get("precision", "float64")
    relative = RELATIVE[precision]
    parts = [_differing(name, found[name], golden[name], relative) for name in (ESTIMATE, "document", "pictures")]
    return [line for part in parts for line in part] + list(_differing_data(found["data"], golden["data"], relative))


def _differing_data(found: Mapping[str, Any], golden: Mapping[str, Any], relative: float) -> Iterator[str]:
    """Sums are compared relative to the sum of magnitudes, for they may cancel."""
    yield from _differing("data", sorted(found), sorted(golden), relative)
    for name in sorted(found.keys() & golden.keys()):
        ours, theirs = dict(found[name]), dict(golden[name])
        size = max(ours.pop("size", 0.0), theirs.pop("size", 0.0))
        for each in ("sum", "turned_sum"):
            a, b = ours.pop(each, 0.0), theirs.pop(each, 0.0)
            if not abs(a - b) <= relative * size + NEARLY_ZERO:
                yield f"data.{name}.{each}: {a!r}, golden {b!r}"
        yield from _differing(f"data.{name}", ours, theirs, relative)


def _differing(place: str, found: Any, golden: Any, relative: float) -> Iterator[str]:
    if isinstance(found, dict) and isinstance(golden, dict):
        for name in sorted(found.keys() | golden.keys()):
            if name not in found or name not in golden:
                yield f"{place}.{name}: {'missing' if name in golden else 'new'}"
            elif place == ESTIMATE or not name.startswith(NOISE):
                yield from _differing(f"{place}.{name}", found[name], golden[name], relative)
    elif isinstance(found, list) and isinstance(golden, list) and len(found) == len(golden):
        for k, (ours, theirs) in enumerate(zip(found, golden, strict=True)):
            yield from _differing(f"{place}.{k}", ours, theirs, relative)
    elif not _same(found, golden, relative):
        yield f"{place}: {found!r}, golden {golden!r}"


def _same(found: Any, golden: Any, relative: float) -> bool:
    """Equal; of numbers with a fraction, to the tolerance."""
    numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in (found, golden))
    if numbers and (isinstance(found, float) or isinstance(golden, float)):
        return math.isclose(found, golden, rel_tol=relative, abs_tol=NEARLY_ZERO)
    return found == golden and type(found) is type(golden)
