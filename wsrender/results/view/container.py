"""A view as one file: blobs deflated, as many as a budget of bytes allows, in the order of what a person would miss."""

import copy
import json
import struct
import zlib
from collections.abc import Iterable, Mapping
from typing import Any, cast

from wsrender.results.view.manifest import Data, Manifest, Volume

STEP = 1 << 16  # bytes that are deflated before one looks whether they fit


def message(header: Mapping[str, Any], blobs: Mapping[str, bytes]) -> bytes:
    """One binary message: uint32 little-endian length of the header, the header with its blobs' sizes, the blobs.

    The header is JSON, padded by spaces, so that the blobs begin at a multiple of 4 bytes.
    """
    listed = [{"name": name, "bytes": len(blob)} for name, blob in blobs.items()]
    text = json.dumps({**header, "blobs": listed}, allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    return b"".join([struct.pack("<I", len(text)), text, *blobs.values()])


def within(manifest: Manifest, blobs: Mapping[str, bytes], budget: int) -> tuple[Manifest, dict[str, bytes]]:
    """The manifest and deflated blobs of what fits in ``budget`` bytes; what does not is named in ``omitted``.

    Occupancy and one channel of each volume go first, in larger voxels where they do not fit, then robots, surfaces and
    the rest, then further channels.
    """
    packer = _Packer(blobs, budget)
    kept = cast(Any, copy.deepcopy(manifest))
    kept["volumes"] = [found for each in kept["volumes"] if (found := packer.volume(each))]
    for robot in kept["robots"]:
        robot["links"] = packer.those(robot["links"], ("geometry",), f"body of {robot['name']}")
    kept["meshes"] = packer.those(kept["meshes"], ("geometry",), "mesh")
    kept["glyphs"] = packer.those(kept["glyphs"], ("origins", "vectors"), "arrows")
    kept["points"] = packer.those(kept["points"], ("positions",), "points")
    for part in ("volumes", "maps", "points"):
        for entry in kept[part]:
            waiting = [each for each in entry["channels"] if each["data"]["compression"] is None]
            packed = packer.those(waiting, ("data",), f"channel of {entry['name']}")
            entry["channels"] = [each for each in entry["channels"] if each not in waiting or each in packed]
    kept["maps"] = [each for each in kept["maps"] if each["channels"]]
    kept["omitted"] += packer.omitted
    return kept, packer.packed


def _deflated(content: bytes, most: int) -> bytes | None:
    """The content deflated; None as soon as that takes more than ``most`` bytes."""
    packer, parts, size = zlib.compressobj(9), [], 0
    for start in range(0, len(content), STEP):
        parts.append(packer.compress(content[start : start + STEP]))
        size += len(parts[-1])
        if size > most:
            return None
    parts.append(packer.flush())
    return b"".join(parts) if size + len(parts[-1]) <= most else None


class _Packer:
    """Deflates blobs while they fit; ``omitted`` says which did not."""

    def __init__(self, blobs: Mapping[str, bytes], budget: int):
        self._blobs, self._left = blobs, budget
        self.packed: dict[str, bytes] = {}
        self.omitted: list[str] = []

    def _fits(self, data: Iterable[Data]) -> bool:
        """Keep all of some blobs, or where they do not fit together none."""
        entries, deflated, left = list(data), {}, self._left
        for each in entries:
            content = _deflated(self._blobs[each["blob"]], left)
            if content is None:
                return False
            deflated[each["blob"]] = content
            left -= len(content)
        self._left = left
        self.packed |= deflated
        for each in entries:
            each["compression"] = "deflate"
        return True

    def volume(self, volume: Volume) -> Volume | None:
        """A volume with its first channel, in the smallest voxels that fit; the file needs no larger ones beside."""
        levels = [volume, *reversed(volume.pop("coarser", []))]
        for level in levels:
            if self._fits([level["occupancy"], *(each["data"] for each in level["channels"][:1])]):
                if level is not volume:
                    level["reduced"] = (
                        f"voxels of {level['voxel_size_m']:g} m stand for those of {volume['voxel_size_m']:g} m, which "
                        "are too many for this file"
                    )
                return level
        self.omitted.append(f"volume {volume['name']}: it does not fit in the file")
        return None

    def those(self, entries: list[Any], members: tuple[str, ...], what: str) -> list[Any]:
        """The entries whose data fit."""
        kept = []
        for each in entries:
            if self._fits([each[member] for member in members]):
                kept.append(each)
            else:
                statistic = f"{each['statistic']} " if each.get("statistic") else ""
                self.omitted.append(f"{what}: {statistic}{each['name']}, which does not fit in the file")
        return kept
