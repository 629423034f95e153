"""Functions of one matrix, written out whole for any number of rows and columns.

Warp's own matrix operations stay loops from some 60 numbers on, and the lane loop around them is then not vectorised.
Algorithms that go through a matrix number by number are written out as C++, of one variable per number: Warp's
statements, several calls for each operation on a matrix in memory, would take most of the time to compile a kernel.
"""

from collections.abc import Iterable

import warp as wp

from wsrender_kernels.factories import factory


@factory
def transpose(real, rows: int, columns: int):
    """Device function A (rows, columns) -> A^T."""
    given_type, transposed_type = wp.types.matrix((rows, columns), real), wp.types.matrix((columns, rows), real)

    @wp.func_native(f"""
    wp::mat_t<{columns}, {rows}, wp::{real.__name__}> B;
    #pragma unroll
    for (int i = 0; i < {columns}; ++i) {{
        #pragma unroll
        for (int j = 0; j < {rows}; ++j) {{
            B.data[i][j] = A.data[j][i];
        }}
    }}
    return B;
    """)
    def transposed(A: given_type) -> transposed_type: ...

    return transposed


@factory
def as_it_is(real, rows: int, columns: int):
    """Device function A (rows, columns) -> A."""
    mat = wp.types.matrix((rows, columns), real)

    @wp.func
    def unchanged(A: mat):
        return A

    return unchanged


def written_out(real, *lines: str) -> str:
    """C++ body of a native device function of these lines, in which R is the working precision."""
    return "\n".join([f"using R = wp::{real.__name__};", *lines])


def followed_by(sign: str, terms: Iterable[str]) -> str:
    """C++ of what is added to an expression or subtracted from it, one term after the other."""
    return "".join(f" {sign} {term}" for term in terms)
