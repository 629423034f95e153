"""The functions that an index may use, besides arithmetic: on NumPy arrays and, traced, in the kernels.

Every function takes numbers, arrays or `Expression`s; an Expression results where an argument is one.

>>> x = np.array([0.25, 4.0])
>>> ws.math.where(ws.math.greater(x, 1.0), ws.math.sqrt(x), 0.0).tolist()
[0.0, 2.0]
>>> index = ws.register_index("anisotropy", lambda sigma, m, n: ws.math.log(sigma[0] / sigma[-1]), unit="1")
"""

from typing import Any

from wsrender.indices.expression import apply

__all__ = [
    "absolute", "cos", "divide", "exp", "exp2", "floor", "greater", "less", "log", "log2", "maximum", "minimum",
    "power", "prod", "sin", "sqrt", "where",
]  # fmt: skip


def sqrt(x: Any) -> Any:
    """Square root."""
    return apply("sqrt", x)


def absolute(x: Any) -> Any:
    """Absolute value."""
    return apply("absolute", x)


def floor(x: Any) -> Any:
    """Largest integer not above x."""
    return apply("floor", x)


def exp2(x: Any) -> Any:
    """2 to the power x."""
    return apply("exp2", x)


def exp(x: Any) -> Any:
    """E to the power x."""
    return exp2(x * 1.4426950408889634)


def log2(x: Any) -> Any:
    """Binary logarithm of a positive number."""
    return apply("log2", x)


def log(x: Any) -> Any:
    """Natural logarithm of a positive number."""
    return log2(x) * 0.6931471805599453


def sin(x: Any) -> Any:
    """Sine [rad]."""
    return apply("sin", x)


def cos(x: Any) -> Any:
    """Cosine [rad]."""
    return apply("cos", x)


def power(x: Any, exponent: Any) -> Any:
    """Non-negative x to a real power; 0 where x is 0."""
    return apply("power", x, exponent)


def minimum(a: Any, b: Any) -> Any:
    """Smaller of two values."""
    return apply("minimum", a, b)


def maximum(a: Any, b: Any) -> Any:
    """Larger of two values."""
    return apply("maximum", a, b)


def less(a: Any, b: Any) -> Any:
    """Whether a < b, for use in `where`."""
    return apply("less", a, b)


def greater(a: Any, b: Any) -> Any:
    """Whether a > b, for use in `where`."""
    return apply("less", b, a)


def where(condition: Any, a: Any, b: Any) -> Any:
    """The value of a where the condition holds, else of b; both are evaluated."""
    return apply("where", condition, a, b)


def divide(a: Any, b: Any) -> Any:
    """The quotient a / b of non-negative values, 0 where b is 0."""
    positive = greater(b, 0.0)
    return where(positive, a / where(positive, b, 1.0), 0.0)


def prod(values: Any) -> Any:
    """Product of a sequence."""
    result = values[0]
    for value in values[1:]:
        result = result * value
    return result
