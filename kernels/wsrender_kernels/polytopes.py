"""The facets of zonotopes {A x: |x_k| <= b_k} of one to three rows, written out as C++ (see `matrices`).

Every facet is spanned by one column less than there are rows, so that all normals are known. A normal that rounding
has turned, as of columns that are all but parallel, is harmless: in every direction the polytope reaches at least as
far as the largest ball within it.
"""

import warp as wp

from wsrender_kernels.matrices import written_out
from wsrender_kernels.singular_values import epsilon

PARALLEL = 16.0  # machine epsilons: columns of a smaller angle count as parallel


def over_facets(real, rows: int, n: int, *body: str) -> list[str]:
    """C++ that runs ``body`` for one normal ``u[rows]`` of each pair of facets of A (rows, n), b (n,).

    The body knows ``square``, that of the normal, ``held``, how far the zonotope reaches along it, and ``sure``, false
    where it is none; around it are ``size``, how far the zonotope reaches at most, and ``none``, 0 or what counts as 0.
    """
    columns = {
        3: ["for (int i = 0; i < N; ++i) {", "#pragma unroll", "for (int j = i + 1; j < N; ++j) {"],
        2: ["for (int i = 0; i < N; ++i) {"],
        1: ["{"],
    }[rows]
    normal = {
        3: [
            "const R u[3] = {A.data[1][i] * A.data[2][j] - A.data[2][i] * A.data[1][j],",
            "A.data[2][i] * A.data[0][j] - A.data[0][i] * A.data[2][j],",
            "A.data[0][i] * A.data[1][j] - A.data[1][i] * A.data[0][j]};",
            f"const R least_square = R({(PARALLEL * epsilon(real)) ** 2}) * lengths[i] * lengths[j];",
        ],
        2: ["const R u[2] = {-A.data[1][i], A.data[0][i]};", "const R least_square = R(0);"],
        1: ["const R u[1] = {R(1)};", "const R least_square = R(0);"],
    }[rows]
    along = " + ".join(f"u[{r}] * A.data[{r}][k]" for r in range(rows))
    return [
        f"constexpr int N = {n};",
        "R lengths[N]; R size = R(0);",
        "#pragma unroll",
        "for (int k = 0; k < N; ++k) {",
        f"lengths[k] = {' + '.join(f'A.data[{r}][k] * A.data[{r}][k]' for r in range(rows))};",
        "size += wp::sqrt(lengths[k]) * b.c[k];",
        "}",
        f"const R none = R({max(rows, n) * epsilon(real)}) * size;",
        *(["#pragma unroll"] if rows > 1 else []),
        *columns,
        *normal,
        f"const R square = {' + '.join(f'u[{r}] * u[{r}]' for r in range(rows))};",
        "const bool sure = square > least_square;",
        "R held = R(0);",
        "#pragma unroll",
        f"for (int k = 0; k < N; ++k) held += wp::abs({along}) * b.c[k];",
        *body,
        "}" * (2 if rows == 3 else 1),
    ]


def largest_ball(real, rows: int, n: int):
    """Device function A (rows, n), b (n,), s (rows,) -> radius of the largest ball about 0 in s + {A x: |x_k| <= b_k}.

    0 where 0 is not in it, or it has less dimensions than rows (Chiacchio et al. 1997; Bowling and Khatib 2005).
    """
    shift = " + ".join(f"u[{r}] * s.c[{r}]" for r in range(rows))
    body = f"""const R radius = (held - wp::abs({shift})) / wp::sqrt(square);
    least = sure && radius < least ? radius : least;"""
    code = written_out(
        real,
        "R least = R(1e38);",
        *over_facets(real, rows, n, body),
        "return least > none && least < R(1e38) ? least : R(0);",
    )
    mat, vec_n, vec_m = wp.types.matrix((rows, n), real), wp.types.vector(n, real), wp.types.vector(rows, real)

    @wp.func_native(code)
    def ball(A: mat, b: vec_n, s: vec_m) -> real: ...

    return ball


def longest_ray(real, rows: int, n: int):
    """Device function A, b, s, d (rows,) -> the largest l with l d in s + {A x: |x_k| <= b_k}; 0 as for the ball."""
    shift, part = (" + ".join(f"u[{r}] * {v}.c[{r}]" for r in range(rows)) for v in "sd")
    body = [
        f"const R shift = {shift}, part = {part}, length = wp::sqrt(square);",
        "const R deep = (held - wp::abs(shift)) / length;",
        "least = sure && deep < least ? deep : least;",
        "const R ray = (part > R(0) ? held + shift : held - shift) / wp::abs(part);",
        "longest = sure && ray < longest ? ray : longest;",
    ]
    code = written_out(
        real,
        "R least = R(1e38), longest = R(1e38);",
        *over_facets(real, rows, n, *body),
        "return least > none && least < R(1e38) ? longest : R(0);",
    )
    mat, vec_n, vec_m = wp.types.matrix((rows, n), real), wp.types.vector(n, real), wp.types.vector(rows, real)

    @wp.func_native(code)
    def ray(A: mat, b: vec_n, s: vec_m, d: vec_m) -> real: ...

    return ray
