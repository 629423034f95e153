"""``wsrender cite``: how the software is cited."""

from typing import Annotated

import typer

from wsrender.origin import Style, citation


def cite(
    style: Annotated[Style, typer.Option("--format", help="A line, BibTeX entries or a CITATION.cff.")] = "text",
) -> None:
    """Print how wsrender is cited, and with BibTeX and CFF the paper that it follows."""
    typer.echo(citation(style))
