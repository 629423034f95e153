"""Tracing of an index function: the arithmetic that it does on its arguments, recorded as a tree.

The engine turns the tree into device code, so the same Python function serves NumPy and the kernels.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.errors import InputError


def _numpy_power(x, exponent):
    positive = np.greater(x, 0)
    return np.where(positive, np.power(np.where(positive, x, 1.0), exponent), 0.0)


NUMPY_OPERATIONS = {
    "add": np.add,
    "subtract": np.subtract,
    "multiply": np.multiply,
    "divide": np.divide,
    "negative": np.negative,
    "sqrt": np.sqrt,
    "absolute": np.absolute,
    "floor": np.floor,
    "exp2": np.exp2,
    "log2": np.log2,
    "sin": np.sin,
    "cos": np.cos,
    "power": _numpy_power,
    "minimum": np.minimum,
    "maximum": np.maximum,
    "less": np.less,
    "where": np.where,
}


def apply(operation: str, *arguments: Any) -> Any:
    """The operation on numbers and arrays, or its record where an argument is an Expression."""
    if not any(isinstance(a, Expression) for a in arguments):
        return NUMPY_OPERATIONS[operation](*arguments)
    if operation == "where":
        return _choice(*arguments)
    return Expression(operation, tuple(_as_number(a) for a in arguments))


def _choice(condition: Any, a: Any, b: Any) -> Any:
    """``where``, decided at once where the condition does not depend on the singular values."""
    if not isinstance(condition, Expression):
        return a if condition else b
    if condition.operation != "less":
        raise TypeError("the condition of where must be a comparison by < or >")
    return Expression("where", (condition, _as_number(a), _as_number(b)))


def _as_number(value: Any) -> "Expression | float":
    operand = _as_operand(value)
    if isinstance(operand, Expression) and operand.operation == "less":
        raise TypeError("an index function cannot calculate with a comparison: use wsrender.math.where")
    return operand


def _as_operand(value: Any) -> "Expression | float":
    if isinstance(value, Expression):
        return value
    if isinstance(value, (int, float, np.integer, np.floating)) and np.isfinite(value):
        return float(value)
    raise TypeError(f"an index function may use finite numbers, arithmetic and wsrender.math only, not {value!r}")


@dataclass(frozen=True, eq=False)
class Expression:
    """An operation and its operands (Expressions or floats); ``input`` leaves carry their position."""

    operation: str
    operands: tuple["Expression | float", ...]

    __array_ufunc__ = None  # NumPy functions raise instead of looping over the object

    def __add__(self, other):
        return apply("add", self, other)

    def __radd__(self, other):
        # Python's sum starts from 0, which no compiler may leave out: 0 + -0 is 0.
        return self if isinstance(other, int) and other == 0 else apply("add", other, self)

    def __sub__(self, other):
        return apply("subtract", self, other)

    def __rsub__(self, other):
        return apply("subtract", other, self)

    def __mul__(self, other):
        return apply("multiply", self, other)

    def __rmul__(self, other):
        return apply("multiply", other, self)

    def __truediv__(self, other):
        return apply("divide", self, other)

    def __rtruediv__(self, other):
        return apply("divide", other, self)

    def __neg__(self):
        return apply("negative", self)

    def __abs__(self):
        return apply("absolute", self)

    def __pow__(self, exponent):
        """As NumPy's: of a negative number whole powers alone."""
        if isinstance(exponent, Expression) or exponent != int(exponent):
            # The kernels' own power of what is negative is 0.
            return apply("where", self < 0.0, apply("sqrt", self), apply("power", self, exponent))
        count = abs(int(exponent))
        if count > 8:
            size = apply("power", abs(self), float(count))
            result = apply("where", self < 0.0, -size, size) if count % 2 else size
        else:
            result = self if count else 1.0
            for _ in range(count - 1):
                result = result * self
        return 1.0 / result if exponent < 0 else result

    def __lt__(self, other):
        return apply("less", self, other)

    def __gt__(self, other):
        return apply("less", other, self)

    def __eq__(self, other):
        raise TypeError("an index function may compare by < or > only: rounding decides whether values are equal")

    __ne__ = __le__ = __ge__ = __eq__
    __hash__ = object.__hash__

    def __bool__(self):
        raise TypeError("an index function cannot branch on a value: use wsrender.math.where")

    def __float__(self):
        raise TypeError("an index function may use arithmetic and wsrender.math only (not the math module)")


def trace(function, length: int, *arguments: Any) -> Expression | float:
    """Expression of ``function(sigma, *arguments)`` for a spectrum of ``length`` values.

    Raises InputError where the function takes more values than there are, TypeError for what cannot be traced.
    """
    sigma = tuple(Expression("input", (float(i),)) for i in range(length))
    try:
        return _as_number(function(sigma, *arguments))
    except IndexError as error:
        raise InputError("indices", f"an index function takes more than the {length} values of this task") from error
