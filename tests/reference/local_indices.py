"""The local indices in the three conventions, from float64 NumPy decompositions, as DEFINITIONS prints them."""

import numpy as np

ROWS = ("x", "y", "z", "rx", "ry", "rz")
TASKS = {"linear": ROWS[:3], "angular": ROWS[3:], "full": ROWS}
NAMES = (
    "manipulability",
    "inverse_condition_number",
    "minimum_singular_value",
    "order_independent_manipulability",
    "harmonic_mean_manipulability",
    "isotropy",
)


def task_matrix(J, task, characteristic_length=1.0, R_world_base=None):
    """(N, m, n): the rows of Jacobians (N, 6, n) in base axes, linear ones of a mixed task divided by the length."""
    R = np.eye(3) if R_world_base is None else R_world_base
    J = np.concatenate([R.T @ J[:, :3], R.T @ J[:, 3:]], axis=1)
    rows = sorted(ROWS.index(name) for name in TASKS.get(task, task))
    if min(rows) < 3 <= max(rows):
        J[:, :3] /= characteristic_length
    return J[:, rows]


def penalized(J, q, lower, upper, K):
    """Columns of J times p = (1 - exp(-4 K t)) / (1 - exp(-K)) (WSRender eq. 3)."""
    t = (upper - q) * (q - lower) / (upper - lower) ** 2
    return J * ((1 - np.exp(-4 * K * t)) / (1 - np.exp(-K)))[:, None, :]


def singular_values(A):
    """(N, m) descending, zeros where n < m; values at or below max(m, n) eps sigma_1 count as 0."""
    m, n = A.shape[1:]
    sigma = np.linalg.svd(A, compute_uv=False)
    sigma = np.where(sigma > max(m, n) * np.finfo(float).eps * sigma[:, :1], sigma, 0.0)
    return np.pad(sigma, ((0, 0), (0, m - sigma.shape[1])))


def standard(A):
    """The six indices of task matrices (N, m, n)."""
    sigma = singular_values(A)
    return of_squares(sigma**2, A.shape[1], sigma[:, -1] / positive(sigma[:, 0]), sigma[:, -1])


def of_squares(squares, root, inverse_condition, minimum):
    """The six indices from the eigenvalues of H (N, m) and the convention's own condition and minimum."""
    m = squares.shape[1]
    det = squares.prod(axis=1)
    inverse_trace = (1 / positive(squares)).sum(axis=1)
    regular = (squares > 0).all(axis=1)
    return {
        "manipulability": np.sqrt(det),
        "inverse_condition_number": inverse_condition,
        "minimum_singular_value": minimum,
        "order_independent_manipulability": det ** (1 / root),
        "harmonic_mean_manipulability": np.where(regular, 1 / np.sqrt(inverse_trace), 0.0),
        "isotropy": det ** (1 / root) / positive(squares.sum(axis=1) / m),
    }


def positive(values):
    """The values, 1 where they are 0, for use as a divisor."""
    return np.where(values > 0, values, 1.0)


def table_1(A):
    """[WSR] Table I as printed: singular values of H itself, n-th roots."""
    return table_1_of_squares(singular_values(A) ** 2, A.shape[2])


def table_1_dynamic(A, M):
    """The same of H with H^-1 = (M J⁺)ᵀ(M J⁺); 0 where the task matrix is singular."""
    K = M @ np.linalg.pinv(A)
    inverse_squares = np.linalg.svd(K, compute_uv=False)[:, ::-1] ** 2
    regular = (singular_values(A) > 0).all(axis=1)
    return table_1_of_squares(np.where(regular[:, None], 1 / positive(inverse_squares), 0.0), A.shape[2])


def table_1_of_squares(squares, n):
    return of_squares(squares, n, squares[:, -1] / positive(squares[:, 0]), squares[:, -1])


def wsrender_code(J, M=None):
    """What the original program computes of Jacobians (N, 6, n), or of J M: six values each."""
    n = J.shape[2]
    six = J if M is None else J @ M
    s = np.linalg.svd(six, compute_uv=False)
    # √det(A Aᵀ) as the product of A's singular values: the determinant itself would leave half of the digits.
    core = np.linalg.svd(J[:, :3] if M is None else six, compute_uv=False)
    mu = core.prod(axis=1) if M is None or n >= 6 else np.zeros(len(J))
    if M is None:
        harmonic = np.array([1 / np.sqrt(np.trace(code_pinv(a @ a.T))) for a in six])
    else:  # the same by singular values: J M is so ill-conditioned that its square keeps few digits
        kept = s**2 > 6 * np.spacing(s[:, :1] ** 2)
        harmonic = 1 / np.sqrt(np.where(kept, 1 / s**2, 0).sum(axis=1))
    return {
        "manipulability": mu,
        "inverse_condition_number": s[:, -1] / s[:, 0],
        "minimum_singular_value": s[:, -1],
        "order_independent_manipulability": mu ** (1 / n),
        "harmonic_mean_manipulability": harmonic,
        "isotropy": mu ** (1 / n) / s.mean(axis=1),
    }


def code_pinv(core):
    """Pseudo-inverse as in MATLAB: singular values below 6 eps(norm) are cut, eps(x) the spacing at x."""
    U, s, Vt = np.linalg.svd(core)
    kept = s > 6 * np.spacing(s[0])
    return (Vt.T[:, kept] / s[kept]) @ U.T[kept]


def power_without_root(name, root):
    """The power after which an index has no root left: the product of the singular values is smooth."""
    return root / 2 if name in ("order_independent_manipulability", "isotropy") else 1.0
