"""ZIP archives of models with the files that they lead to, from strangers too: read in memory, never unpacked."""

import os
import posixpath
import re
import stat
import zipfile
from contextlib import suppress
from functools import cached_property
from io import BytesIO
from pathlib import Path, PurePosixPath
from xml.etree.ElementTree import Element

from wsrender.errors import InputError, ModelError
from wsrender.robots import xml_source
from wsrender.robots.mesh_files import ADDRESS, MAX_MESH_BYTES

SUFFIX = ".zip"
MODEL_FILES = (".xml", ".mjcf", ".urdf", ".sdf")  # what a model in an archive ends in
PACKAGE = "package.xml"  # what says that a folder is a package of ROS, and is no model
MAX_PACKAGE_BYTES = 2**16
OTHER_FILES = (
    ".stl",
    ".obj",
    ".dae",
    ".ply",
    ".off",
    ".glb",
    ".gltf",
    ".bin",
    ".3mf",
    ".3dxml",
    ".zae",
    ".msh",
    ".config",
)
MOST_FILES = 5_000
MOST_SEEN = 50_000  # files of a folder, whatever they are
MOST_LOOKED_AT = 50  # models, for the one that no other includes
MAX_ARCHIVE_BYTES = 512 * 2**20  # packed, and unpacked
_LONGEST_NAME = 500
_KINDS = {zipfile.ZIP_STORED: "stored", zipfile.ZIP_DEFLATED: "deflated"}
_ENTRY_OF_DIRECTORY = b"PK\x01\x02"  # with which each begins (APPNOTE.TXT 4.3.12)
_INCLUDED = re.compile(rb"""<include\s[^>]{0,200}?file\s{0,9}=\s{0,9}["']([^"'<]{1,500})["']""")


def is_archive(content: bytes) -> bool:
    """Whether bytes begin as a ZIP does."""
    return content[:4] in (b"PK\x03\x04", b"PK\x05\x06")


def files_named(model: Element) -> list[str]:
    """Meshes and other files that a model's text leads to, each once: where it was uploaded alone they are missing."""
    found: dict[str, None] = {}
    for element in model.iter():
        name = ""
        if model.tag == "mujoco" and element.tag in ("mesh", "hfield", "include"):
            name = element.get("file", "")
        elif element.tag == "mesh":
            name = element.get("filename") or element.findtext("uri") or ""
        if name := name.strip():
            found[name] = None
    return list(found)


class Archive:
    """A checked archive, and which of its files is the model.

    ``entry``: its name in the archive; None: the only model, of those least deep, that no other of them includes.
    Raises ModelError for what is no ZIP, for links, encrypted files, names that are absolute, climb, or come twice, and
    for what is too large or too much; InputError for ``entry`` where it is not there, or several would do.
    """

    def __init__(self, content: bytes, entry: str | None, field: str):
        self._field = field
        self._zip = check(content, field)
        self._files = {each.filename: each for each in self._zip.infolist() if not each.is_dir()}
        self.entry = self._entry(entry)
        """Name of the model in the archive."""

    def model(self) -> bytes:
        """The text of the model. Raises ModelError where it is damaged, or larger than a model may be."""
        if (size := self._files[self.entry].file_size) > xml_source.MAX_BYTES:
            message = f"{self.entry} has {size} bytes; at most {xml_source.MAX_BYTES} are allowed"
            raise ModelError(self._field, message)
        return self._content(self.entry)

    def read(self, name: str) -> bytes | None:
        """The bytes of a file as the model names it, None where it is not there: nothing outside is looked for."""
        for place in self._places(name.replace("\\", "/")):
            normal = posixpath.normpath(place)
            if normal in self._files and self._files[normal].file_size <= MAX_MESH_BYTES:
                return self._content(normal)
        return None

    def _places(self, name: str) -> list[str]:
        scheme = ADDRESS.match(name)
        if scheme is None:
            return [posixpath.join(posixpath.dirname(self.entry), name)]
        package, _, rest = name[scheme.end() :].partition("/")
        folders = {str(folder) for file in self._files for folder in PurePosixPath(file).parents}
        named = sorted(folder for folder in folders if posixpath.basename(folder) == package)
        if package in self._packages:
            named.append(self._packages[package])
        return [posixpath.join(folder, rest) for folder in named]

    @cached_property
    def _packages(self) -> dict[str, str]:
        """Folders whose package.xml says that they are a package of ROS, by its name."""
        found: dict[str, str] = {}
        manifests = sorted(name for name in self._files if posixpath.basename(name) == PACKAGE)
        for name in manifests[:MOST_LOOKED_AT]:
            if self._files[name].file_size <= MAX_PACKAGE_BYTES:
                with suppress(ModelError):
                    package = (xml_source.parse(self._content(name)).findtext("name") or "").strip()
                    found.setdefault(package, posixpath.dirname(name))
        return found

    def _content(self, name: str) -> bytes:
        try:
            return self._zip.read(name)
        except Exception as error:  # zlib's errors among them
            raise ModelError(self._field, f"{name} cannot be unpacked: {error}") from error

    def _entry(self, entry: str | None) -> str:
        models = sorted(filter(_is_model, self._files))
        if entry is not None:
            if entry not in self._files:
                raise InputError("entry", f"{entry!r} is not in the archive; its models: {_listed(models)}")
            return entry
        least = min(name.count("/") for name in models)
        models = [name for name in models if name.count("/") == least]
        if 1 < len(models) <= MOST_LOOKED_AT:
            models = self._outermost(models) or models
        if len(models) > 1:
            raise InputError("entry", f"must name one of the models in the archive: {_listed(models)}")
        return models[0]

    def _outermost(self, models: list[str]) -> list[str]:
        """Those that no other includes."""
        included: set[str] = set()
        for name in models:
            if self._files[name].file_size <= xml_source.MAX_BYTES:
                found = _INCLUDED.findall(self._content(name))
                places = (posixpath.join(posixpath.dirname(name), each.decode("utf-8", "replace")) for each in found)
                included |= {place for each in places if (place := posixpath.normpath(each)) != name}
        return [name for name in models if name not in included]


def check(content: bytes, field: str) -> zipfile.ZipFile:
    """The archive, harmless as far as its directory tells: nothing is unpacked. Raises ModelError as `Archive` does."""
    if len(content) > MAX_ARCHIVE_BYTES:
        raise ModelError(field, f"the archive has {len(content)} bytes; at most {MAX_ARCHIVE_BYTES} are allowed")
    if content.count(_ENTRY_OF_DIRECTORY) > MOST_FILES:
        raise ModelError(field, f"the archive has more than {MOST_FILES} files")
    try:
        archive = zipfile.ZipFile(BytesIO(content))
    except Exception as error:  # of whatever its reader stumbles over
        raise ModelError(field, f"is no ZIP archive that can be read: {error}") from error
    seen: set[str] = set()
    for each in archive.infolist():
        if said := _fault(each):
            raise ModelError(field, f"the archive's file {each.orig_filename[:_LONGEST_NAME]!r} {said}")
        if (name := posixpath.normpath(each.filename)) in seen:
            raise ModelError(field, f"the archive has two files {name!r}")
        seen.add(name)
    if (size := sum(each.file_size for each in archive.infolist())) > MAX_ARCHIVE_BYTES:
        raise ModelError(field, f"the archive unpacks to {size} bytes; at most {MAX_ARCHIVE_BYTES} are allowed")
    if not any(map(_is_model, archive.namelist())):
        others = f"{', '.join(MODEL_FILES)} but {PACKAGE}; a xacro file is loaded by its own path"
        raise ModelError(field, f"the archive has no model: no file that ends in {others}")
    return archive


def _is_model(name: str) -> bool:
    return name.lower().endswith(MODEL_FILES) and posixpath.basename(name) != PACKAGE


def _fault(info: zipfile.ZipInfo) -> str:
    """What is wrong with a file of an archive; empty where nothing is."""
    name, kind = info.filename, stat.S_IFMT(info.external_attr >> 16)
    if len(name) > _LONGEST_NAME:
        return f"has a name of {len(name)} characters; at most {_LONGEST_NAME} are allowed"
    if not name.isprintable() or name != info.orig_filename or "\\" in name or ":" in name:
        return "has a name with control characters, \\ or :"
    parts = name.removesuffix("/").split("/")
    if ".." in parts or "." in parts or "" in parts:
        return "has a name that is not relative to the archive, or leads out of it"
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        return "is a link, or no plain file"
    if info.flag_bits & 0x1:
        return "is encrypted"
    if info.compress_type not in _KINDS:
        return f"is packed by method {info.compress_type}; allowed: {', '.join(_KINDS.values())}"
    return ""


def of_folder(folder: Path, field: str) -> bytes:
    """A ZIP of the models and meshes in a folder of the user's own: the same bytes for the same files.

    Raises ModelError for a link that leads out of it, and where there is too much in it.
    """
    names, size, seen = [], 0, 0
    for at, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        seen += 1 + len(files)
        for file in (Path(at, name) for name in sorted(files)):
            if not file.name.lower().endswith((*MODEL_FILES, *OTHER_FILES)):
                continue
            if not file.resolve().is_relative_to(folder.resolve()):
                raise ModelError(field, f"{file} is a link that leads out of {folder}")
            names.append(file.relative_to(folder).as_posix())
            size += file.stat().st_size
        if seen > MOST_SEEN or len(names) > MOST_FILES or size > MAX_ARCHIVE_BYTES:
            most = f"{MOST_FILES} models and meshes among {MOST_SEEN} files, {MAX_ARCHIVE_BYTES} bytes"
            raise ModelError(field, f"the folder '{folder}' has too much in it; allowed: {most}")
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(names):
            info = zipfile.ZipInfo(name)  # of a date that does not change
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, (folder / name).read_bytes())
    return packed.getvalue()


def of_path(path: Path, field: str) -> bytes:
    """The archive of a ZIP file or a folder of the user's own. Raises ModelError where there is none."""
    if path.is_dir():
        return of_folder(path, field)
    if not path.is_file():
        raise ModelError(field, f"there is no file {str(path)!r}")
    if (size := path.stat().st_size) > MAX_ARCHIVE_BYTES:
        raise ModelError(field, f"{path.name} has {size} bytes; at most {MAX_ARCHIVE_BYTES} are allowed")
    return path.read_bytes()


def is_path(path: Path) -> bool:
    """Whether a path is that of an archive, or of a folder, which is read as one."""
    return path.suffix.lower() == SUFFIX or path.is_dir()


def _listed(names: list[str]) -> str:
    return ", ".join(names[:20]) + (", …" if len(names) > 20 else "") or "none"
