"""Tutorials: Markdown that jupytext reads as notebooks. Pages show what their cells print and draw when they are run.

``tutorials_run`` names those that are run; None: all. A picture needs a line ``# Picture: …``, as in the gallery.
"""

import base64
from collections.abc import Iterator
from pathlib import Path
from shutil import copytree
from tempfile import TemporaryDirectory

import jupytext
import nbformat
from gallery_shown import described
from nbclient import NotebookClient
from nbformat import NotebookNode
from sphinx.application import Sphinx

_PATIENCE_S = 240  # for a cell


def executed(text: str, examples: Path) -> NotebookNode:
    """The notebook of a tutorial's text after its run, in an empty folder beside ``docs/examples``.

    Raises nbclient's CellExecutionError where a cell does.
    """
    notebook = jupytext.reads(text, fmt="md")
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    with TemporaryDirectory() as folder:
        copytree(examples, Path(folder) / "docs" / "examples")
        settings = {"timeout": _PATIENCE_S, "resources": {"metadata": {"path": folder}}, "store_widget_state": False}
        return NotebookClient(notebook, **settings).execute()


def run(app: Sphinx, name: str, content: list[str]) -> None:
    """Put what cells print and draw into the text of a page, and the notebook that was run beside it."""
    folder, _, stem = name.rpartition("/")
    chosen = app.config.tutorials_run
    if folder != "tutorials" or stem == "index" or (chosen is not None and stem not in chosen):
        return
    source = Path(app.srcdir)
    notebook = executed(content[0], source / "examples")
    written = source / "generated" / "tutorials"
    written.mkdir(parents=True, exist_ok=True)
    nbformat.write(notebook, written / f"{stem}.ipynb")
    content[0] = "\n\n".join(_parts(notebook, written / stem))


def _parts(notebook: NotebookNode, place: Path) -> Iterator[str]:
    """Markdown of the cells and of what they put out; pictures are written to ``<place>_<number>.png``."""
    pictures = 0
    for cell in notebook.cells:
        if cell.cell_type != "code":
            yield cell.source
            continue
        yield f"```python\n{cell.source}\n```"
        for output in cell.outputs:
            data = output.get("data", {})
            if "image/png" in data:
                pictures += 1
                path = place.with_name(f"{place.name}_{pictures}.png")
                path.write_bytes(base64.b64decode(data["image/png"]))
                yield f"![{described(cell.source, place.name)}](/generated/tutorials/{path.name})"
            else:
                text = output.text if output.output_type == "stream" else data["text/plain"]
                yield f"```text\n{text.rstrip()}\n```"
    yield f"{{download}}`This page as the notebook that was run </generated/tutorials/{place.name}.ipynb>`"


def setup(app: Sphinx) -> dict:
    """Run a tutorial when its page is read; all are read again where the choice has changed."""
    app.add_config_value("tutorials_run", None, "env", (list, type(None)))
    app.connect("source-read", run)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
