"""The largest mass that the joints hold, at rest or while it accelerates in any direction."""

from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.gravity import gravity_pulls
from wsrender_kernels.inertia import BODY_STRIDE, inertia
from wsrender_kernels.kinematics import kinematics
from wsrender_kernels.loads import bodies_among
from wsrender_kernels.matrices import written_out
from wsrender_kernels.polytopes import over_facets
from wsrender_kernels.task_rows import linear_rows


@factory
def payload_capacity(
    real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], size: int, offset: int
):
    """Device function of the index.

    ``rows``: those of the linear task in which the mass accelerates, all in which it moves; none at rest. Its numbers:
    gravity in the world (3,) [m/s²], the value at which it is cut [kg], where the mass is in the tip's frame (3,) [m],
    its acceleration [m/s²], the joints' limits back and forth (n,) each [N m or N], `pack_inertia` of the chain, and of
    the same without any mass but 1 kg there.
    """
    CUT, BACK, FORTH, BODIES = offset + 3, offset + 8, offset + 8 + n, offset + 8 + 2 * n
    UNIT = BODIES + len(sources) * BODY_STRIDE
    forward = kinematics(real, n, sources, plain, bool(rows)).forward
    weights = gravity_pulls(real, n, sources, plain, size, offset, BODIES)
    unit_weights = gravity_pulls(real, n, sources, plain, size, offset, UNIT)
    vec_n, ZERO = wp.types.vector(n, real), real(0.0)
    if rows:
        return _accelerated(real, n, sources, plain, rows, size, offset, BODIES, weights)

    @wp.func
    def capacity(model: Any, q: vec_n):
        _tip, _x, _y, _z, frames = forward(model.chain, q)
        pulls = weights(model.limits, model.chain, frames)
        more = unit_weights(model.limits, model.chain, frames)
        least = model.limits[CUT]
        for i in range(n):
            back = model.limits[BACK + i] - pulls[i]
            forth = model.limits[FORTH + i] + pulls[i]
            mass = wp.where(more[i] > ZERO, back, forth) / wp.abs(more[i])
            least = wp.where(more[i] != ZERO and mass < least, mass, least)
            least = wp.where(wp.min(back, forth) >= ZERO, least, ZERO)
        return least

    return capacity


def _accelerated(real, n: int, sources: Any, plain: bool, rows: Any, size: int, offset: int, at: int, weights: Any):
    m = len(rows)
    CUT, COM, ACCELERATION, BACK, FORTH = offset + 3, offset + 4, offset + 7, offset + 8, offset + 8 + n
    dyn, bodies_of = inertia(real, n, sources, plain), bodies_among(real, len(sources), size, at)
    inertia_matrix, solve = dyn.inertia_matrix, dyn.solve(m)
    forward, rows_of = linear_rows(real, n, sources, plain, rows, False)
    vec_n, vec_m, vec3 = wp.types.vector(n, real), wp.types.vector(m, real), wp.types.vector(3, real)
    mat_mn, mat_mm = wp.types.matrix((m, n), real), wp.types.matrix((m, m), real)
    ROWS, HALF = wp.types.vector(m, wp.int32)(*rows), real(0.5)

    @wp.func_native(_mass_in_cpp(real, m, n))
    def mass_of(A: mat_mn, b: vec_n, s: vec_m, W: mat_mm, g: vec_m, a: real, cut: real) -> real: ...

    @wp.func
    def capacity(model: Any, q: vec_n):
        axes, frames = forward(model, q)
        J = rows_of(model, frames, axes * vec3(model.limits[COM], model.limits[COM + 1], model.limits[COM + 2]))
        A = solve(inertia_matrix(model.chain, bodies_of(model.limits), frames), J)
        pulls = weights(model.limits, model.chain, frames)
        most = vec_n()
        shift = vec_m()
        gravity = vec_m()
        W = mat_mm()
        for i in range(n):
            back = model.limits[BACK + i]
            forth = model.limits[FORTH + i]
            most[i] = HALF * (forth + back)
            for r in range(m):
                shift[r] += A[r, i] * (HALF * (forth - back) + pulls[i])
        for r in range(m):
            for k in range(3):
                gravity[r] += model.base_axes[ROWS[r], k] * model.limits[offset + k]
            for c in range(m):
                for i in range(n):
                    W[r, c] += A[r, i] * J[c, i]
        return mass_of(A, most, shift, W, gravity, model.limits[ACCELERATION], model.limits[CUT])

    return capacity


def _mass_in_cpp(real, m: int, n: int) -> str:
    """The largest mass with which the ball of accelerations a about 0 is in the polytope of what the joints give.

    Without it that is P = s + {A x: |x_k| <= b_k}; with a mass M, by Sherman, Morrison and Woodbury, of all y with
    (1 + M W) y - M W g in P, W = J M^-1 J'. A facet u'x <= h of P holds the ball's while a |u + M W u| <= h + M g'W u:
    what is left of it is concave in M, and its first zero that of a quadratic.
    """
    body = [
        f"const R per = R(1) / wp::sqrt(square); R v[{m}], w[{m}];",
        *(f"v[{r}] = per * u[{r}];" for r in range(m)),
        *(f"w[{r}] = {' + '.join(f'W.data[{r}][{c}] * v[{c}]' for c in range(m))};" for r in range(m)),
        f"const R shift = {_dot('v', 's.c', m)}, ww = {_dot('w', 'w', m)}, vw = {_dot('v', 'w', m)};",
        f"const R slope = {_dot('w', 'g.c', m)}, reach = per * held, deep = reach - wp::abs(shift);",
        "least = sure && deep < least ? deep : least;",
        "#pragma unroll",
        "for (int side = -1; side < 2; side += 2) {",
        "const R h = reach + R(side) * shift, k = R(side) * slope;",
        "const R C = h * h - a * a, B = h * k - a * a * vw, D = k * k - a * a * ww;",
        "const R root = wp::sqrt(wp::max(B * B - D * C, R(0)));",
        "const R mass = B > R(0) ? (D < R(0) ? (B + root) / -D : cut) : (root > B ? C / (root - B) : cut);",
        "mass_least = sure && mass < mass_least ? mass : mass_least;",
        "}",
    ]
    return written_out(
        real,
        "R least = R(1e38), mass_least = cut;",
        *over_facets(real, m, n, *body),
        "return least > none && least >= a && least < R(1e38) ? wp::max(mass_least, R(0)) : R(0);",
    )


def _dot(a: str, b: str, m: int) -> str:
    return " + ".join(f"{a}[{r}] * {b}[{r}]" for r in range(m))
