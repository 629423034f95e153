"""Floating-point operations and bytes of one sample, counted by hand from the kernels in wsrender_kernels.

An addition, subtraction, multiplication, division or square root counts as one operation, a fused multiply-add as
two; comparisons, selections, sign changes and integer work (the random bits) count as none, and neither does what
the compiler removes (angular rows of a linear task). The counts are for a chain of n uncoupled joints, random
sampling, the task "linear" and the standard convention. n = 6, float32: 682 kinematic, 2,285 twelve.
"""

FLOAT_BYTES = {"float32": 4, "float64": 8}


def operations(n: int, precision: str, dynamic: bool, voxels: bool) -> int:
    """Operations of one sample with the six kinematic indices, or all twelve."""
    count = draw(n, precision) + forward(n, precision) + jacobian(n) + three_singular_values(n, precision)
    count += six_indices(precision) + totals(12 if dynamic else 6)
    if dynamic:
        count += inertia(n) + solve(3, n) + largest_columns(n)
        count += three_singular_values(n, precision) + six_indices(precision)
    return count + (3 if voxels else 0)  # a division per axis finds the cell


def draw(n: int, precision: str) -> int:
    """Uniform numbers from random bits (3 each in float64), then lower + u * step."""
    return n * ((0 if precision == "float32" else 3) + 2)


def sincos(precision: str) -> int:
    """Rounding to quarter turns 4, reduction 5, square 1, two polynomials, their ends 3 + 4."""
    terms = 2 if precision == "float32" else 5
    return 10 + 4 * terms + 7


def forward(n: int, precision: str) -> int:
    """Per joint: lever 15; the tip in the world 18."""
    return n * (sincos(precision) + 15) + 18


def jacobian(n: int) -> int:
    """Linear columns: 2 each, 1 of the middle joint; 12 per joint on the way there, 6 for the first of those before."""
    before, after = (n - 1) // 2, n // 2
    steps = before * (before - 1) // 2 + after * (after - 1) // 2
    return 12 * steps + 8 * before + 2 * after + 1


def three_singular_values(n: int, precision: str) -> int:
    """Dot products and orthogonalised rows, 8 (2n - 1) + 2 + 6n, and the closed form."""
    scaled = 8
    pivots = 1 + 2 + 2 + 1 + 1 + 2 + 2 + 12  # reciprocals, row factors, last product, minor, determinant, minors
    root = 2 if precision == "float32" else 20  # with the reciprocal: a root and a division, or an inverse root
    deviators = 3 + 3 + 12 + root + 9 + 3 + 5 + 2 + 5  # mean, entries, square of the norm; of the square
    angle = 2 + 10 + 12 + 6  # along, across, its norm
    third = 4 * 9 + 7 if precision == "float32" else 4 * 10 + 22 + 7  # polynomials, Newton's step, reflection
    eigenvalues = 1 + 3 + root + 1 + 2 + 1 + 2 + 1 + 2 + 1 + 2 + root + 1 + 1 + 3
    return 8 * (2 * n - 1) + 2 + 6 * n + scaled + pivots + deviators + angle + third + eigenvalues


def six_indices(precision: str) -> int:
    """Product 2, quotient 1, power 2/3 (9 per step), harmonic mean 7, isotropy 7."""
    steps = 2 if precision == "float32" else 3
    return 2 + 1 + (9 * steps + 1) + 7 + 7


def totals(indices: int) -> int:
    """Fixed-point sums over all samples: scaling."""
    return indices


def inertia(n: int) -> int:
    """Composite inertias 85 per step towards the base, momenta and velocities 36 per step to where they meet.

    In its first step a momentum takes 20, a velocity 8. Of what reaches the base only the moment about its axis counts:
    19, in a first step 8. A momentum along a velocity is 11.
    """
    middle = (n - 1) // 2
    after = n - 1 - middle
    momenta = 20 * after + 36 * after * (after - 1) // 2
    momenta += sum(8 if k == 1 else 20 + 36 * (k - 2) + 19 for k in range(1, middle))
    velocities = 8 * middle + 36 * middle * (middle - 1) // 2
    return 85 * (n - 1) + n + momenta + velocities + 11 * middle * (n - middle)


def solve(m: int, n: int) -> int:
    """A M^-1 for m rows by L D L^T."""
    pivots = 3 * n * (n - 1) // 2 + n
    columns = sum((n - 1 - j) * 2 * j for j in range(n))
    return pivots + columns + m * (2 * n * (n - 1) + n)


def largest_columns(n: int) -> int:
    """Rotation of the three rows by the two largest columns."""
    return 5 * n + 10 + 16 * n + 21 + 9 + 10 * n


def bytes_moved(precision: str, dynamic: bool, voxels: bool) -> int:
    """Bytes read and written per sample in voxel records (64-bit count and maxima, padded to a power of two)."""
    if not voxels:
        return 0
    width = FLOAT_BYTES[precision]
    integers = 8 // width + (12 if dynamic else 6)
    return 2 * width * 2 ** (integers - 1).bit_length()


def inverse_step(n: int, precision: str, pose: bool) -> int:
    """Operations of one step of inverse kinematics: chain, Jacobian, residual, damped solution, next step."""
    m = 6 if pose else 3
    residual = 8 + (53 if pose else 0)
    slopes = n * (6 * m + 3 + (1 if pose else 0))
    normal = n * m * (m + 1) + 3 * m
    solution = m * (m + 1) * (m - 1) // 3 + 2 * m * m + 3 * m
    orientation = 45 + 9 * n if pose else 0
    in_world = n * (sincos(precision) + 51) + 18 + 9 * n
    return in_world + orientation + residual + slopes + normal + solution + n * (2 * m + 6) + 20
