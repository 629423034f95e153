"""How shared workspaces are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Presentation


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The share of what any robot reaches that all reach."""
    if "shared_ratio" in document:
        yield "shared / any", f"{document['shared_ratio']:.4g}"


PRESENTATION = Presentation(facts=facts, measured="shared")
