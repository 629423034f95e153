"""Reading the XML of robot models from strangers: no entities, no outside files, bounded size and depth."""

import codecs
import io
import math
import re
from pathlib import Path
from xml.etree import ElementTree
from xml.sax import SAXException
from xml.sax.handler import ContentHandler
from xml.sax.xmlreader import InputSource

from wsrender.errors import MissingExtraError, ModelError

MAX_BYTES = 16 * 2**20
MAX_ELEMENTS = 20_000  # the largest robots have 4,000
MAX_DEPTH = 200  # MuJoCo compiles bodies recursively
LONGEST_BEGINNING = 1 << 16  # characters of a model, in which its name stands
NAMED_BY = {"mujoco": "model", "robot": "name", "model": "name"}  # attributes of elements
MOST_SHOWN = 100  # characters of a text in an error

_ENCODING = re.compile(rb"""<\?xml[^>]*\sencoding\s*=\s*["']([A-Za-z0-9._-]+)["']""")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_DIGITS = re.compile(r"\d{1,9}", re.ASCII)


def parse(text: str | bytes, field: str = "model") -> ElementTree.Element:
    """Root element of the XML ``text``; names keep their prefixes, comments are dropped.

    Raises ModelError for text that is empty, too large, not well-formed, nested deeper than MAX_DEPTH, of
    more than MAX_ELEMENTS elements, or that declares a document type, an entity or an external reference.
    """
    try:
        from defusedxml import DefusedXmlException
        from defusedxml.sax import make_parser
    except ImportError as error:
        raise MissingExtraError("defusedxml", "engine") from error
    if len(text) > MAX_BYTES:
        raise ModelError(field, f"the model has {len(text)} characters; at most {MAX_BYTES} are allowed")
    if not text.strip():
        raise ModelError(field, "the model is empty")
    parser, builder = make_parser(), _BoundedBuilder(field)
    parser.forbid_dtd = True
    parser.setContentHandler(builder)
    try:
        parser.parse(_input_source(text))
    except DefusedXmlException as error:
        raise ModelError(field, "document types, entities and external references are refused") from error
    except (SAXException, UnicodeError, LookupError, ValueError) as error:
        if isinstance(error, ModelError):
            raise
        raise ModelError(field, f"not well-formed XML: {_reason(error)}") from error
    return builder.root()


def title(text: str) -> str | None:
    """What a model that `parse` takes calls itself, told from its beginning; None: it does not."""
    beginning = ElementTree.XMLPullParser(["start"])
    beginning.feed(text[:LONGEST_BEGINNING])
    for event in beginning.read_events():
        element = event[-1]
        if isinstance(element, ElementTree.Element) and element.tag in NAMED_BY:
            return element.get(NAMED_BY[element.tag])
    return None


def read(path: Path, field: str = "model") -> bytes:
    """The bytes of a model file. Raises ModelError for one that is not there, unreadable or too large."""
    if not path.is_file():
        raise ModelError(field, f"there is no file {str(path)!r}")
    if (size := path.stat().st_size) > MAX_BYTES:
        raise ModelError(field, f"{path.name} has {size} bytes; at most {MAX_BYTES} are allowed")
    try:
        return path.read_bytes()
    except OSError as error:
        raise ModelError(field, f"cannot read {str(path)!r}: {error.strerror}") from error


def number(text: str, field: str, where: str) -> float:
    """The finite number written as ``text``; ``where`` names it in the ModelError raised otherwise."""
    text = text.strip()
    value = float(text) if _NUMBER.fullmatch(text) else math.nan
    if not math.isfinite(value):
        raise ModelError(field, f"{where} is {_shown(text)}; a finite number is needed")
    return value


def numbers(text: str, count: int, field: str, where: str) -> list[float]:
    """The ``count`` finite numbers of ``text``, separated by white space."""
    words = text.split()
    if len(words) != count:
        raise ModelError(field, f"{where} is {_shown(text)}; {count} numbers are needed")
    return [number(word, field, where) for word in words]


def plain_digits(text: str, field: str, where: str) -> int:
    """The count written as ``text`` in up to nine digits and nothing else: no two programs read those differently.

    ``where`` names it in the ModelError raised otherwise.
    """
    if not _DIGITS.fullmatch(text):
        raise ModelError(field, f"{where} is {_shown(text)}; up to nine plain digits are needed")
    return int(text)


def _shown(text: str) -> str:
    """A text in quotation marks, of a long one the beginning."""
    return repr(text) if len(text) <= MOST_SHOWN else repr(text[:MOST_SHOWN]) + "…"


def _input_source(text: str | bytes) -> InputSource:
    source = InputSource()
    if isinstance(text, bytes):
        text = _declared(text.removeprefix(codecs.BOM_UTF8).lstrip())
    if isinstance(text, str):
        source.setCharacterStream(io.StringIO(text.lstrip("\ufeff \t\r\n")))
    else:
        source.setByteStream(io.BytesIO(text))
    return source


def _declared(text: bytes) -> str | bytes:
    """Text in an encoding that it declares and the parser may not know (Shift_JIS, GBK), decoded."""
    found = _ENCODING.match(text)
    return text.decode(found[1].decode()) if found else text


def _reason(error: Exception) -> str:
    where = ""
    if (line := getattr(error, "getLineNumber", lambda: None)()) is not None:
        where = f" (line {line})"
    return str(getattr(error, "getMessage", lambda: error)()) + where


class _BoundedBuilder(ContentHandler):
    """Builds an element tree and stops at the first element too many."""

    def __init__(self, field: str):
        super().__init__()
        self._field = field
        self._tree = ElementTree.TreeBuilder()
        self._depth = self._count = 0

    def root(self) -> ElementTree.Element:
        return self._tree.close()

    def startElement(self, name, attrs):  # noqa: N802 (the name SAX calls)
        self._depth += 1
        self._count += 1
        if self._depth > MAX_DEPTH:
            raise ModelError(self._field, f"elements are nested deeper than {MAX_DEPTH}")
        if self._count > MAX_ELEMENTS:
            raise ModelError(self._field, f"more than {MAX_ELEMENTS} elements")
        self._tree.start(name, dict(attrs.items()))

    def endElement(self, name):  # noqa: N802
        self._depth -= 1
        self._tree.end(name)

    def characters(self, content):
        self._tree.data(content)
