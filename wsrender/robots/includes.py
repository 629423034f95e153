"""Files that an MJCF file includes, put in their places."""

import posixpath
from collections.abc import Callable
from xml.etree.ElementTree import Element

from wsrender.errors import ModelError
from wsrender.robots import xml_source

MAX_FILES = 100

ReadFile = Callable[[str], bytes | None]  # name relative to the main file → its bytes, None where it is not there


def put_in(root: Element, read: ReadFile, place: str, field: str) -> list[bytes]:
    """Replaces every ``<include>`` below ``root`` by the elements of its file; returns the files' contents.

    File names are relative to the main file, as MuJoCo's are; ``place`` is what errors call its folder. Raises
    ModelError for a file that is not there, is no XML, or is included twice, and for a model that is too large or too
    deep as a whole, as `wsrender.robots.xml_source.parse` does.
    """
    inclusion = _Inclusion(read, place, field)
    inclusion.into(root, 1)
    return list(inclusion.contents.values())


class _Inclusion:
    def __init__(self, read: ReadFile, place: str, field: str):
        self._read_file, self._place, self._field = read, place, field
        self._elements = 0
        self.contents: dict[str, bytes] = {}  # by name, in the order of inclusion

    def into(self, parent: Element, depth: int) -> None:
        """``depth`` of ``parent`` in the model as a whole."""
        self._elements += 1
        if self._elements > xml_source.MAX_ELEMENTS:
            raise ModelError(self._field, f"more than {xml_source.MAX_ELEMENTS} elements, with the files it includes")
        if depth > xml_source.MAX_DEPTH:
            raise ModelError(self._field, f"elements are nested deeper than {xml_source.MAX_DEPTH}")
        for child in list(parent):
            if child.tag == "include":
                included = self._read(child, depth)
                at = list(parent).index(child)
                parent[at : at + 1] = list(included)
            else:
                self.into(child, depth + 1)

    def _read(self, include: Element, depth: int) -> Element:
        name = include.get("file", "").replace("\\", "/")
        content = self._read_file(name) if name else None
        if content is None:
            raise ModelError(self._field, f"the included file {name!r} is not in {self._place}")
        if (key := posixpath.normpath(name)) in self.contents:
            raise ModelError(self._field, f"{name!r} is included twice")
        if len(self.contents) == MAX_FILES:
            raise ModelError(self._field, f"more than {MAX_FILES} files are included")
        self.contents[key] = content
        included = xml_source.parse(content, self._field)
        self.into(included, depth)
        return included
