"""Device code of a set of indices, from the traced functions of the catalogue."""

import hashlib
import linecache
from collections.abc import Mapping, Sequence
from typing import Any

import warp as wp
from wsrender_kernels.elementary import elementary
from wsrender_kernels.factories import factory
from wsrender_kernels.spectrum import spectrum_length

from wsrender.indices.expression import Expression, trace
from wsrender.indices.index_catalogue import find, is_dynamic

_INFIX = {"add": "+", "subtract": "-", "multiply": "*", "divide": "/", "less": "<"}
_CALLS = {
    "sqrt": "wp.sqrt",
    "absolute": "wp.abs",
    "floor": "wp.floor",
    "minimum": "wp.min",
    "maximum": "wp.max",
    "where": "wp.where",
    "exp2": "exp2",
    "log2": "log2",
    "power": "power",
    "sin": "sine",
    "cos": "cosine",
}


class _Writer:
    """Statements of a function body: one assignment per distinct operation."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self._names: dict[str, str] = {}
        self._written: dict[tuple[Expression, str], str] = {}

    def operand(self, value: Expression | float, spectrum: str) -> str:
        """Text of a value: a literal, an input or the name that holds it."""
        if not isinstance(value, Expression):
            return f"real({value!r})" if value >= 0 else f"(-real({-value!r}))"
        if value.operation == "input":
            return f"{spectrum}[{int(value.operands[0])}]"  # type: ignore[arg-type]
        if (value, spectrum) not in self._written:
            operands = [self.operand(o, spectrum) for o in value.operands]
            self._written[value, spectrum] = self._assign(_code(value, operands))
        return self._written[value, spectrum]

    def _assign(self, code: str) -> str:
        if code not in self._names:
            self._names[code] = f"v{len(self._names)}"
            self.lines.append(f"{self._names[code]} = {code}")
        return self._names[code]


def _code(value: Expression, operands: list[str]) -> str:
    operation = value.operation
    if operation in _INFIX:
        return f"{operands[0]} {_INFIX[operation]} {operands[1]}"
    if operation == "negative":
        return f"-{operands[0]}"
    if operation == "power" and value.operands[1] == 2.0 / 3.0:  # det(H)^(1/m) for three task rows
        return f"two_thirds_power({operands[0]})"
    return f"{_CALLS[operation]}({', '.join(operands)})"


def index_source(
    names: tuple[str, ...],
    rows: tuple[int, ...],
    n: int,
    convention: str,
    options: Mapping[str, Mapping[str, Any]],
) -> str:
    """Body of the device function of these indices, as text: equal texts share a kernel; options are literals in it."""
    length = spectrum_length(n, rows, convention)
    expressions = [
        0.0
        if find(name).given or find(name).of_chain
        else trace(find(name).function_for(convention, options.get(name)), length, len(rows), n)
        for name in names
    ]
    return source_of(expressions, ["dynamic" if is_dynamic(name) else "kinematic" for name in names])


def source_of(expressions: Sequence[Expression | float], inputs: Sequence[str] = ("kinematic",)) -> str:
    """Body of the device function of expressions, each of the named one of its two inputs."""
    writer = _Writer()
    results = [writer.operand(expression, of) for expression, of in zip(expressions, inputs, strict=True)]
    body = [*writer.lines, f"return result_type({', '.join(results)})"]
    return "\n".join("    " + line for line in body)


@factory
def function_of_source(body: str, n_results: int, length: int, real) -> wp.Function:
    """Warp function (kinematic, dynamic), (length,) each -> results (n_results,), of a `source_of`."""
    source = f"def indices(kinematic: spectrum_type, dynamic: spectrum_type):\n{body}\n"
    filename = f"<wsrender indices {hashlib.sha256(source.encode()).hexdigest()[:16]}>"
    # Warp reads the source of a function through linecache; an entry without a time stamp is kept.
    linecache.cache[filename] = (len(source), None, source.splitlines(keepends=True), filename)
    functions = elementary(real)
    namespace = {
        "wp": wp,
        "real": real,
        "spectrum_type": wp.types.vector(length, real),
        "result_type": wp.types.vector(n_results, real),
        "exp2": functions.exp2,
        "log2": functions.log2,
        "power": functions.power,
        "two_thirds_power": functions.two_thirds_power,
        "sine": functions.sine,
        "cosine": functions.cosine,
        "__name__": __name__,
    }
    exec(compile(source, filename, "exec"), namespace)  # text made above, from traced arithmetic alone
    function: Any = wp.func(namespace["indices"])
    return function
