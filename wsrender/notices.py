"""What a user should know of a model or a number: plain facts that go into results and onto every door."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any


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

    def entry(self) -> dict[str, Any]:
        """The notice as result documents hold it."""
        return asdict(self)


def entries(notices: Iterable[Notice]) -> list[dict[str, Any]]:
    """The distinct notices, in their order, as result documents hold them."""
    return [notice.entry() for notice in dict.fromkeys(notices)]
