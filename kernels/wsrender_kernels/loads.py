"""What joints take to hold what is beyond them, and while the tip accelerates in any direction."""

from collections.abc import Iterable
from typing import Any

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.gravity import gravity_pulls
from wsrender_kernels.inertia import BODY_STRIDE, inertia
from wsrender_kernels.kinematics import frames_type, kinematics
from wsrender_kernels.matrices import followed_by, written_out


@factory
def loads(real, n: int, sources: tuple[int, ...], plain: bool, rows: tuple[int, ...], size: int, offset: int, at: int):
    """Device function ``(model, frames) -> pulls (n,), more (n,)`` [N m or N]: |τ_i| is |pulls_i| + more_i at most.

    ``rows``: those of the linear task in which the tip accelerates; none at rest. Numbers of ``model.limits`` (size,):
    from ``offset`` on gravity in the world (3,) [m/s²] and the acceleration [m/s²], from ``at`` on `pack_inertia` of
    the chain with what it carries.
    """
    L = len(sources)
    vec_n, Frames = wp.types.vector(n, real), frames_type(real, L)
    dyn, jacobian = inertia(real, n, sources, plain), kinematics(real, n, sources, plain, True).jacobian
    inertia_matrix = dyn.inertia_matrix
    M_ROWS = max(len(rows), 1)
    ROWS, rows_type = wp.types.vector(M_ROWS, wp.int32)(*(rows or (0,))), wp.types.matrix((M_ROWS, n), real)
    solve, weights = dyn.solve(M_ROWS), gravity_pulls(real, n, sources, plain, size, offset, at)
    ACCELERATION = offset + 3
    bodies_of = bodies_among(real, L, size, at)

    @wp.func_native(_norms_in_cpp(real, n, M_ROWS))
    def norms(Q: rows_type, X: rows_type) -> vec_n: ...

    @wp.func
    def at_rest(model: Any, frames: Frames):
        return weights(model.limits, model.chain, frames), vec_n()

    @wp.func
    def accelerated(model: Any, frames: Frames):
        M = inertia_matrix(model.chain, bodies_of(model.limits), frames)
        J = jacobian(model.chain, frames)
        Q = rows_type()
        for r in range(M_ROWS):
            for c in range(n):
                for k in range(3):
                    Q[r, c] += model.base_axes[ROWS[r], k] * J[k, c]
        held = norms(Q, solve(M, Q))
        for i in range(n):
            held[i] *= model.limits[ACCELERATION]
        return weights(model.limits, model.chain, frames), held

    return accelerated if rows else at_rest


@factory
def bodies_among(real, joints: int, size: int, at: int):
    """Device function ``limits`` (size,) -> `pack_inertia` of so many joints, which stand there from ``at`` on."""
    limits_type, bodies_type = wp.types.vector(size, real), wp.types.vector(joints * BODY_STRIDE, real)
    copied = "".join(f"bodies.c[{k}] = limits.c[{at + k}]; " for k in range(joints * BODY_STRIDE))

    @wp.func_native(written_out(real, f"wp::vec_t<{joints * BODY_STRIDE}, R> bodies;", copied, "return bodies;"))
    def bodies_of(limits: limits_type) -> bodies_type: ...

    return bodies_of


def _norms_in_cpp(real, n: int, m: int) -> str:
    """(J_v, J_v M^-1) -> norms of the rows of J_v' Λ, Λ = (J_v M^-1 J_v')^-1 (Khatib 1987), (n,).

    With J_v = R Q, R triangular and Q M^-1 Q' = 1, by Gram and Schmidt, they are Q' R^-1, whose error grows with the
    condition of J_v and not with its square. Not a number, or all but infinite, where J_v is singular.
    """
    lines = []
    for r in range(m):
        lines += [f"R q{r}_{c} = Q.data[{r}][{c}], x{r}_{c} = X.data[{r}][{c}];" for c in range(n)]
        for s in range(r):
            lines.append(f"const R R{r}_{s} = {_sum(f'q{r}_{c} * x{s}_{c}' for c in range(n))};")
            lines += [f"q{r}_{c} -= R{r}_{s} * q{s}_{c}; x{r}_{c} -= R{r}_{s} * x{s}_{c};" for c in range(n)]
        lines.append(f"const R P{r} = R(1) / wp::sqrt({_sum(f'q{r}_{c} * x{r}_{c}' for c in range(n))});")
        lines += [f"q{r}_{c} *= P{r}; x{r}_{c} *= P{r};" for c in range(n)]
    for c in range(n):
        for r in reversed(range(m)):
            less = followed_by("-", (f"y{s}_{c} * R{s}_{r}" for s in range(r + 1, m)))
            lines.append(f"const R y{r}_{c} = (q{r}_{c}{less}) * P{r};")
        lines.append(f"norms.c[{c}] = wp::sqrt({_sum(f'y{r}_{c} * y{r}_{c}' for r in range(m))});")
    return written_out(real, f"wp::vec_t<{n}, R> norms;", *lines, "return norms;")


def _sum(terms: Iterable[str]) -> str:
    return " + ".join(terms)
