"""What a user should know of a model or a number: plain facts that go into results and onto every door."""

import sys
import warnings
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any, Self

OWN_PACKAGES = ("wsrender", "wsrender_kernels", "wsrender_server")


@dataclass(frozen=True)
class Notice:
    """One warning: what kind it is (``code``), what was found, what to do about it, and which field decides it.

    ``field`` is the field of the job document, dotted, or None. In result documents it stands in ``warnings``.
    """

    code: str
    message: str
    remedy: str = ""
    field: str | None = None

    def __str__(self) -> str:
        return f"{self.message}; {self.remedy}" if self.remedy else self.message

    def within(self, path: str) -> Self:
        """The same notice, its field below ``path`` of the job document."""
        return replace(self, field=f"{path}.{self.field}") if path and self.field else self

    def entry(self) -> dict[str, Any]:
        """The notice as result documents hold it."""
        return asdict(self)


def entries(notices: Iterable[Notice]) -> list[dict[str, Any]]:
    """The distinct notices, in their order, as result documents hold them."""
    return [notice.entry() for notice in dict.fromkeys(notices)]


def warn(notices: Iterable[Notice], category: type[Warning]) -> None:
    """One warning per notice, at the line of the caller: that of the first frame outside these packages."""
    frame, passed = sys._getframe(1), (*OWN_PACKAGES, "functools")  # of cached properties
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] in passed:
        frame = frame.f_back
    module, registry = frame.f_globals.get("__name__"), frame.f_globals.setdefault("__warningregistry__", {})
    for notice in notices:
        warnings.warn_explicit(
            str(notice), category, frame.f_code.co_filename, frame.f_lineno, module=module, registry=registry
        )
