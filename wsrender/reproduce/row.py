"""One value of a reproduction."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """A quantity with its value as published, as reproduced here and exact, each None where there is none.

    ``low`` and ``high`` are the ends of the 95 % interval of a reproduced value, where it has one. A computing time,
    in seconds, has no difference from a published one: that of another computer is no reference.
    """

    case: str
    quantity: str
    unit: str
    reproduced: float | None
    published: float | None = None
    exact: float | None = None
    low: float | None = None
    high: float | None = None
    note: str = ""

    @property
    def from_published(self) -> float | None:
        """Reproduced minus published."""
        if self.reproduced is None or self.published is None or self.unit == "s":
            return None
        return self.reproduced - self.published

    @property
    def from_exact(self) -> float | None:
        """Reproduced minus exact."""
        return None if self.reproduced is None or self.exact is None else self.reproduced - self.exact
