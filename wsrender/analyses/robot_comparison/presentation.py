"""How comparisons of robots are shown."""

from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"
PRESENTATION = Presentation(
    (
        Picture("comparison", f"{_HERE}:comparison", needs=("volumes",)),
        Picture("side_by_side", f"{_HERE}:comparison", needs=("volumes",), saved=False),
    ),
)
