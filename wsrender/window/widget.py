"""A view in a notebook, by anywidget: data go as messages, so that none of them is kept in the notebook's file."""

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

from wsrender.errors import InputError, MissingExtraError
from wsrender.results.view.page import built
from wsrender.window.local import Answering, Viewed, refused


def widget_of(view: Viewed, answering: Answering) -> Any:
    """A widget that shows ``view``. Raises MissingExtraError without the extra ``notebook``."""
    return _widget_class()(view, answering)


@cache
def _widget_class() -> Any:
    try:
        import anywidget
    except ImportError as error:
        raise MissingExtraError("anywidget", "notebook") from error

    class ViewWidget(anywidget.AnyWidget):
        """A view of wsrender. ``close()`` frees it."""

        _esm = built("viewer.js").decode()

        def __init__(self, view: Viewed, answering: Answering):
            super().__init__()
            self._view, self._answering = view, answering
            self.on_msg(self._on_message)

        def _on_message(self, _: Any, content: Any, buffers: Sequence[memoryview]) -> None:
            header, blobs = reply(self._view, self._answering, content)
            listed = [{"name": name, "bytes": len(data)} for name, data in blobs.items()]
            self.send({**header, "blobs": listed}, buffers=list(blobs.values()))

    return ViewWidget


def reply(view: Viewed, answering: Answering, content: Mapping[str, Any]) -> tuple[dict[str, Any], Mapping[str, bytes]]:
    """Header and blobs that answer a message of the page: it asks for the manifest, for a blob, or as `Answering`."""
    own, asked = {"id": content.get("id")}, content.get("ask")
    try:
        if asked == "manifest":
            return {**own, "answer": view.manifest}, {}
        if asked == "blob":
            name = str(content.get("name"))
            if name not in view.blobs:
                raise InputError("name", f"there is no {name!r} in this view")
            return {**own, "answer": {}}, {name: view.blobs[name]}
        header, blobs = answering.answer({key: value for key, value in content.items() if key != "id"})
        return {**own, "answer": header}, blobs
    except Exception as error:
        return {**own, "refused": refused(error)}, {}
