"""The viewer's module as it was built, and the pages around it that no server gives."""

import base64
import hashlib
import json
import zlib
from dataclasses import replace
from functools import cache
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from wsrender.results.view.view import View

# A report holds module and view as zlib streams, so that it stays small; the module is imported from a blob, since a
# page from a disk may load nothing else.
_LOADER = """
const stream = (root, part) => {
  const text = atob(root.querySelector(`script[data-part="${part}"]`).textContent);
  const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")));
};
for (const root of document.querySelectorAll("div.view")) {
  const text = await stream(root, "module").text();
  const address = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  const { mountFile } = await import(address);
  URL.revokeObjectURL(address);
  mountFile(root.querySelector("div.shown"), await stream(root, "view").arrayBuffer());
}
"""

_DRAWN = ("robots", "skeletons", "volumes", "meshes", "points", "glyphs", "curves", "maps")
MOST_EMBEDDED = 2_000_000  # bytes that a view adds to a page
_MARKUP = 20_000  # bytes: of what else is written, and of the manifest's lines about what is left out

LOCAL_PAGE = """<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>{title}</title>
<link rel="icon" href="icon.svg" type="image/svg+xml"></head>
<body><div id="wsrender"></div><script type="module" src="local.js"></script></body>
</html>
"""
LOCAL_SCRIPT = """import { mountLocal } from "./viewer.js";
mountLocal(document.getElementById("wsrender"));
"""


@cache
def built(name: str) -> bytes:
    """A file of the built page. It lies in the server's package, which every installation has."""
    return (files("wsrender_server") / "static" / "viewer" / name).read_bytes()


def local_page(title: str) -> bytes:
    """The page of `wsrender view`."""
    return LOCAL_PAGE.format(title=escape(title)).encode()


def loader_policy() -> str:
    """What a Content-Security-Policy must allow for `embedded`: the loader, by its hash, and the module it makes."""
    digest = base64.b64encode(hashlib.sha256(_LOADER.encode()).digest()).decode()
    return f"script-src 'sha256-{digest}' blob:"


def shows_something(view: "View") -> bool:
    """Whether there is anything to be drawn."""
    return any(view.manifest[part] for part in _DRAWN)


def embedded(view: "View") -> str:
    """HTML of at most `MOST_EMBEDDED` bytes that shows a view in a page that loads nothing; what does not fit is named.

    Its pictures are left to the page.
    """
    view = replace(view, manifest={**view.manifest, "pictures": []})
    module = _part("module", built("viewer.js"))
    room = (MOST_EMBEDDED - len(module) - len(_LOADER) - _MARKUP) * 3 // 4  # base64 takes four bytes for three
    room -= len(zlib.compress(json.dumps(view.manifest).encode(), 9))
    content = view.to_file_bytes(max(0, room))
    return (
        f'<div class="view"><div class="shown"></div>{module}{_part("view", content)}</div>\n'
        f'<script type="module">{_LOADER}</script>'
    )


def _part(name: str, data: bytes) -> str:
    text = base64.b64encode(zlib.compress(data, 9)).decode()
    return f'<script type="application/octet-stream" data-part="{name}">{text}</script>'
