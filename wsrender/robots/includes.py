"""Files that an MJCF file includes, put in their places: for files of the user's own."""

from pathlib import Path
from xml.etree.ElementTree import Element

from wsrender.errors import ModelError
from wsrender.robots import xml_source

MAX_FILES = 100


def put_in(root: Element, folder: Path, field: str) -> list[bytes]:
    """Replaces every ``<include>`` below ``root`` by the elements of its file; returns the files' contents.

    File names are relative to ``folder``, that of the main file, as MuJoCo's are. Raises ModelError for a file that is
    not there, is no XML, or is included twice.
    """
    inclusion = _Inclusion(folder, field)
    inclusion.into(root)
    return list(inclusion.contents.values())


class _Inclusion:
    def __init__(self, folder: Path, field: str):
        self._folder, self._field = folder, field
        self.contents: dict[Path, bytes] = {}  # by path, in the order of inclusion

    def into(self, parent: Element) -> None:
        for child in list(parent):
            if child.tag == "include":
                included = self._read(child)
                at = list(parent).index(child)
                parent[at : at + 1] = list(included)
            else:
                self.into(child)

    def _read(self, include: Element) -> Element:
        name = include.get("file", "")
        path = self._folder / name.replace("\\", "/")
        if not name or not path.is_file():
            raise ModelError(self._field, f"the included file {name!r} is not in {str(self._folder)!r}")
        if path.resolve() in self.contents:
            raise ModelError(self._field, f"{name!r} is included twice")
        if len(self.contents) == MAX_FILES:
            raise ModelError(self._field, f"more than {MAX_FILES} files are included")
        content = self.contents[path.resolve()] = xml_source.read(path, self._field)
        included = xml_source.parse(content, self._field)
        self.into(included)
        return included
