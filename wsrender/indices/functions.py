"""The six local indices as functions of the singular values ([WSR] Table I; Zhang, Cursi, Yang, *WSRender*, 2019).

``sigma``: the m singular values of the task matrix A, descending; ``n`` joints. With H = A Aᵀ, det H = Π σ².
In the convention ``wsrender_code``, ``sigma`` is mu = √det of the original program followed by its values s.
"""

from wsrender.errors import InputError
from wsrender.indices import math


def manipulability(sigma, m, n):
    """√det H = Π σ (Yoshikawa 1985)."""
    return math.prod(sigma)


def inverse_condition_number(sigma, m, n):
    """σ_m / σ_1 (Salisbury & Craig 1982)."""
    return math.divide(sigma[-1], sigma[0])


def minimum_singular_value(sigma, m, n):
    """σ_m (Klema & Laub 1980)."""
    return sigma[-1]


def order_independent_manipulability(sigma, m, n):
    """det(H)^(1/m) (Kim & Khosla 1991)."""
    if m <= 3:
        return math.power(math.prod(sigma), 2.0 / m)
    # In units of the largest value: products of six leave the range of float32.
    return math.power(math.prod(_relative(sigma)), 2.0 / m) * sigma[0] * sigma[0]


def harmonic_mean_manipulability(sigma, m, n):
    """1 / √tr H⁻¹ = 1 / √Σ σ⁻² (Kim & Khosla 1991)."""
    # In units of the smallest value, whose square would underflow in float32; its own ratio is 1.
    ratios = [math.divide(sigma[-1], s) for s in sigma[:-1]]
    return sigma[-1] / math.sqrt(sum((r * r for r in ratios), 1.0))


def isotropy(sigma, m, n):
    """det(H)^(1/m) / (tr(H) / m) (Kim & Khosla 1991)."""
    if m > 3:
        sigma = _relative(sigma)
    return math.divide(m * order_independent_manipulability(sigma, m, n), sum(s * s for s in sigma))


def _relative(sigma):
    """The values over the largest."""
    return [math.divide(s, sigma[0]) for s in sigma]


def table_1_inverse_condition_number(sigma, m, n):
    """Smallest over largest singular value of H itself."""
    ratio = inverse_condition_number(sigma, m, n)
    return ratio * ratio


def table_1_minimum_singular_value(sigma, m, n):
    """Smallest singular value of H itself."""
    return sigma[-1] * sigma[-1]


def table_1_order_independent_manipulability(sigma, m, n):
    """det(H)^(1/n)."""
    return math.power(math.prod(sigma), 2.0 / n)


def table_1_isotropy(sigma, m, n):
    """det(H)^(1/n) over the mean singular value of H."""
    return math.divide(m * table_1_order_independent_manipulability(sigma, m, n), sum(s * s for s in sigma))


def code_manipulability(sigma, m, n):
    """The original program's mu."""
    return sigma[0]


def code_inverse_condition_number(sigma, m, n):
    """Min s / max s."""
    return math.divide(sigma[-1], sigma[1])


def code_minimum_singular_value(sigma, m, n):
    """Min s."""
    return sigma[-1]


def code_order_independent_manipulability(sigma, m, n):
    """Mu^(1/n)."""
    return math.power(sigma[0], 1.0 / n)


def code_harmonic_mean_manipulability(sigma, m, n):
    """√(1 / tr pinv(J Jᵀ)), pinv cutting singular values s² of J Jᵀ at 6 eps(s_max²)."""
    largest = sigma[1] * sigma[1]
    known = math.greater(largest, 0.0)
    spacing = math.exp2(math.floor(math.log2(math.where(known, largest, 1.0))) - 52.0)
    total = 0.0
    for s in sigma[1:]:
        kept = math.greater(s * s, 6.0 * spacing)
        total = total + math.where(kept, 1.0 / math.where(kept, s * s, 1.0), 0.0)
    return math.where(known, math.divide(1.0, math.sqrt(total)), 0.0)


def code_isotropy(sigma, m, n):
    """Mu^(1/n) over the mean of s."""
    s = sigma[1:]
    return math.divide(len(s) * code_order_independent_manipulability(sigma, m, n), sum(s[1:], s[0]))


def of_chain(sigma, m, n, **options):
    """Of an index of the whole chain: kernels compute it themselves. Raises InputError."""
    raise InputError("indices", "must not ask for indices of joints and what they hold: they are those of a serial arm")


def given_by_shapes(sigma, m, n, limit_m):
    """Of an index that is no function of singular values: the engine asks the robot's shapes. Raises InputError."""
    raise InputError("indices", "must not ask for clearance: it is that of the shapes of a serial arm")
