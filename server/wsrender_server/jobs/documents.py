"""Job documents as the store keeps them: short ones in their row, long ones in files that rows and tasks refer to."""

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Self

from wsrender.analyses.jobs import canonical_text
from wsrender.documents.arm import OF_POINTS, ArmPath, dotted, local_paths, models_in
from wsrender.errors import InputError
from wsrender.robots import xml_source
from wsrender_server.jobs.files import DataFolder

LONGEST_IN_ROW = 1 << 14  # characters; there is a task for each of up to hundreds of shards
MOST_NAMED = 16  # robots of a job that are listed
LONGEST_NAMED = 100  # characters


@dataclass(frozen=True)
class CanonicalDocument:
    """A canonical document (all defaults present) with what the store asks of it: plain data, read once.

    ``text`` is None where the document is long: then a file of the data folder holds it, named by its hash.
    """

    sha256: str
    """Of its text."""
    analysis: str
    device: str
    """What it asks to be computed on."""
    libraries: tuple[str | None, ...]
    """Library robots of its models; None for each that is none."""
    uploads: tuple[tuple[str, str], ...]
    """Dotted path and SHA-256 of what was uploaded."""
    robots: str = ""
    """Names of its robots and mechanisms, a line each, no more than `MOST_NAMED`."""
    text: str | None = None
    """Its JSON."""

    @classmethod
    def of(cls, document: Mapping[str, Any], models: Sequence[tuple[ArmPath, dict[str, Any]]] | None = None) -> Self:
        """A canonical document. Raises InputError for a file given by a path: a server reads none for its users.

        ``models`` are those of `models_in`, where whoever calls has looked for them and for paths: it may be long.
        """
        if models is None:
            for path in local_paths(document):
                raise InputError(dotted(path), "is for local runs; send the points, or upload the model")
            models = [*models_in(document)]
        text = canonical_text(dict(document))
        return cls(
            hashlib.sha256(text.encode()).hexdigest(),
            document["analysis"],
            document.get("device", "auto"),
            tuple(model.get("library") for _, model in models),
            tuple(_uploads(models)),
            "\n".join(_names(document, models)),
            text,
        )

    @classmethod
    def of_row(cls, text: str, facts: Mapping[str, Any] | None) -> Self:
        """That of a row; those of earlier versions have no ``facts``."""
        if facts is None:
            return cls.of(json.loads(text))
        kept = {**facts, "libraries": tuple(facts["libraries"]), "uploads": tuple(map(tuple, facts["uploads"]))}
        return cls(**kept, text=text or None)

    @property
    def facts(self) -> dict[str, Any]:
        """All but its text, as JSON."""
        return {each.name: getattr(self, each.name) for each in fields(self) if each.name != "text"}

    @property
    def is_short(self) -> bool:
        """Whether its row holds it."""
        return self.text is not None and len(self.text) <= LONGEST_IN_ROW

    def read(self, files: DataFolder, computation: str) -> Any:
        """The document of a computation; raises InputError where its file is gone, or not what was written."""
        if self.text is not None:
            return json.loads(self.text)
        try:
            content = files.document(computation, self.sha256).read_bytes()
        except FileNotFoundError:
            raise InputError("document", "is lost from the server's disk; submit the job again") from None
        if hashlib.sha256(content).hexdigest() != self.sha256:
            raise InputError("document", "is damaged on the server's disk; submit the job again")
        return json.loads(content)

    def kept(self, files: DataFolder, computation: str, written: Path | None = None) -> Self:
        """As a computation's row holds it: of a long one the text goes into a file.

        It is ``written`` already where a process did so. Raises DiskFull.
        """
        if written is None and (self.text is None or self.is_short):
            return self
        files.put_document(computation, self.sha256, written or (self.text or "").encode())
        return replace(self, text=None)


def uploads_in(document: Any) -> Iterator[tuple[str, str]]:
    """Dotted path and SHA-256 of every upload that a canonical document names."""
    return _uploads(models_in(document))


def _names(document: Mapping[str, Any], models: Iterable[tuple[ArmPath, dict[str, Any]]]) -> list[str]:
    """What the mechanisms and robots of a canonical document are called, each once."""
    holders = (document, *(document.get(name) for name in OF_POINTS))
    found = [
        each["mechanism"] for each in holders if isinstance(each, dict) and isinstance(each.get("mechanism"), dict)
    ]
    names = [each.get("library") or each.get("name") or "" for each in found]
    names += [_robot_name(robot) for path, robot in models if path[-1] == "robot"]
    lines = ("".join(each if each.isprintable() else " " for each in name[:LONGEST_NAMED]).strip() for name in names)
    return [*dict.fromkeys(line for line in lines if line)][:MOST_NAMED]


def _robot_name(robot: Mapping[str, Any]) -> str:
    if robot.get("library") is not None:
        return robot["library"]
    if robot.get("dh") is not None:
        return robot["dh"]["name"]
    for kind in ("mjcf", "urdf"):
        if robot.get(kind) is not None:
            return xml_source.title(robot[kind]) or kind.upper()
    upload = (robot.get("model") or "")[:8]  # nobody reads it before its job does
    return Path(robot["entry"]).stem if robot.get("entry") else f"model {upload}"


def _uploads(models: Iterable[tuple[ArmPath, dict[str, Any]]]) -> Iterator[tuple[str, str]]:
    for path, model in models:
        if model.get("model") is not None:
            yield dotted(path, "model"), model["model"]
