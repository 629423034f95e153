"""A click on a picture opens it in its full size; wide ones, such as three planes side by side, get room to be read."""

import re
from functools import cache, partial
from pathlib import Path
from typing import Any

from PIL import Image
from sphinx.application import Sphinx

_PICTURE = re.compile(r'<img\b[^>]*\bsrc="((?:\.\./)*_images/([^"/]+\.png))"[^>]*>')
_APART = re.compile(r"_thumb\.|only-light|only-dark")  # those within links, and those of which one theme shows one
_WIDE = 9  # inches: at the width of a column its letters would be half as large as those of the text


def linked(app: Sphinx, pagename: str, templatename: str, context: dict[str, Any], doctree: Any) -> None:
    """Put each picture of a page into a link to itself; wide ones of the class ``wide``."""
    if body := context.get("body"):
        context["body"] = _PICTURE.sub(partial(_link, Path(app.srcdir)), body)


def _link(source: Path, found: re.Match[str]) -> str:
    if _APART.search(found[0]):
        return found[0]
    return f'<a class="picture{" wide" if _is_wide(source, found[2]) else ""}" href="{found[1]}">{found[0]}</a>'


@cache
def _is_wide(source: Path, name: str) -> bool:
    with Image.open(next(source.rglob(name))) as picture:
        dots = picture.info.get("dpi")  # to an inch; matplotlib says it, pictures of a screen do not
        return bool(dots) and picture.width > _WIDE * dots[0]


def setup(app: Sphinx) -> dict:
    """Change pages as they are written."""
    app.connect("html-page-context", linked)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
