"""Elementary functions of the kernels against NumPy's in float64."""

import numpy as np
import warp as wp
from hypothesis import given, settings
from hypothesis import strategies as st
from wsrender_kernels.elementary import elementary
from wsrender_kernels.options import MODULE_OPTIONS

from wsrender.tolerances import TOLERANCES, epsilon

REAL = {"float32": wp.float32, "float64": wp.float64}
CASES = settings(derandomize=True, max_examples=40, deadline=None, database=None)


def evaluated(name, precision, *columns, device="cpu"):
    """Columns of results (outputs, N) of a device function at columns of arguments (N,)."""
    x = wp.array(np.stack(columns, axis=1).astype(precision), dtype=REAL[precision], device=device)
    out = wp.empty((len(columns[0]), 2), dtype=REAL[precision], device=device)
    wp.launch(KERNELS[precision, name], len(columns[0]), [x], [out], device=device)
    return out.numpy().T


def kernels_of(precision):
    real, functions = REAL[precision], elementary(REAL[precision])
    sincos, log2, exp2, power = functions.sincos, functions.log2, functions.exp2, functions.power
    two_thirds_power, scales = functions.two_thirds_power, functions.scales
    inverse_root, root_and_reciprocal = functions.inverse_root, functions.root_and_reciprocal
    # With the flags of the product's kernels: reducing an angle relies on fused multiply-add.
    options = {"module": "unique", "module_options": MODULE_OPTIONS, "enable_backward": False}

    @wp.kernel(**options)
    def both(x: wp.array2d(dtype=real), out: wp.array2d(dtype=real)):
        i = wp.tid()
        s, c = sincos(x[i, 0])
        out[i, 0] = s
        out[i, 1] = c

    @wp.kernel(**options)
    def logarithms(x: wp.array2d(dtype=real), out: wp.array2d(dtype=real)):
        i = wp.tid()
        out[i, 0] = log2(x[i, 0])
        out[i, 1] = two_thirds_power(x[i, 0])

    @wp.kernel(**options)
    def powers(x: wp.array2d(dtype=real), out: wp.array2d(dtype=real)):
        i = wp.tid()
        out[i, 0] = exp2(x[i, 0])
        out[i, 1] = power(x[i, 0], x[i, 1])

    @wp.kernel(**options)
    def binades(x: wp.array2d(dtype=real), out: wp.array2d(dtype=real)):
        i = wp.tid()
        unit, scale = scales(x[i, 0])
        out[i, 0] = unit
        out[i, 1] = scale

    @wp.kernel(**options)
    def inverse_roots(x: wp.array2d(dtype=real), out: wp.array2d(dtype=real)):
        i = wp.tid()
        out[i, 0] = inverse_root(x[i, 0])

    @wp.kernel(**options)
    def roots(x: wp.array2d(dtype=real), out: wp.array2d(dtype=real)):
        i = wp.tid()
        root, reciprocal = root_and_reciprocal(x[i, 0])
        out[i, 0] = root
        out[i, 1] = reciprocal

    kernels = {"inverse roots": inverse_roots, "roots": roots}
    kernels |= {"sincos": both, "log2": logarithms, "powers": powers, "scales": binades}
    return {(precision, name): kernel for name, kernel in kernels.items()}


KERNELS = kernels_of("float32") | kernels_of("float64")


def test_sine_and_cosine(precision, device):
    # Angles up to the largest a joint takes; the error of reducing by k pi/2 grows with k.
    generator = np.random.default_rng(0)
    angle = np.concatenate([np.linspace(-40, 40, 20001), generator.uniform(-7, 7, 20000), [0.0, np.pi, -np.pi / 2]])
    angle = angle.astype(precision).astype(np.float64)
    s, c = evaluated("sincos", precision, angle, device=device)
    limit = TOLERANCES[precision].elementary
    assert np.abs(s - np.sin(angle)).max() <= limit
    assert np.abs(c - np.cos(angle)).max() <= limit
    assert np.abs(s**2 + c**2 - 1).max() <= limit
    assert s[-3] == 0 and c[-3] == 1


def test_small_angles_keep_their_relative_precision(precision, device):
    angle = np.logspace(-20, -1, 500).astype(precision).astype(np.float64)
    s, _ = evaluated("sincos", precision, angle, device=device)
    assert np.abs(s / np.sin(angle) - 1).max() <= TOLERANCES[precision].elementary


def test_binary_logarithm(precision, device):
    span = 120 if precision == "float32" else 1000
    x = (2.0 ** np.random.default_rng(1).uniform(-span, span, 20000)).astype(precision).astype(np.float64)
    x = np.append(x, [1.0, 2.0, 0.5, 1 + epsilon(precision), 1 - epsilon(precision) / 2])
    found, _ = evaluated("log2", precision, x, device=device)
    assert np.abs(found - np.log2(x)).max() <= epsilon(precision) * span
    near_one = np.abs(x - 1) < 0.3
    assert np.abs(found - np.log2(x))[near_one].max() <= TOLERANCES[precision].elementary
    assert found[-5] == 0 and found[-4] == 1 and found[-3] == -1


def test_powers_of_two(precision, device):
    span = 120 if precision == "float32" else 1000
    x = np.random.default_rng(2).uniform(-span, span, 20000).astype(precision).astype(np.float64)
    found, _ = evaluated("powers", precision, x, np.ones_like(x), device=device)
    assert np.abs(found / 2.0**x - 1).max() <= TOLERANCES[precision].elementary
    whole = np.arange(-span, span + 1.0)
    assert (evaluated("powers", precision, whole, whole, device=device)[0] == 2.0**whole).all()


def test_powers_beyond_the_range(precision, device):
    far = 200.0 if precision == "float32" else 2000.0
    found, _ = evaluated("powers", precision, np.array([-far, -1e30]), np.ones(2), device=device)
    assert (found == 0).all()


@CASES
@given(st.floats(1e-6, 1e6), st.sampled_from([1 / 6, 0.2, 0.25, 1 / 3, 0.4, 0.5, 2 / 3, 1.0, 2.0, 3.0]))
def test_real_powers(x, exponent):
    for precision in REAL:
        argument, e = np.array([x]).astype(precision), np.array([exponent]).astype(precision)
        _, found = evaluated("powers", precision, argument, e)
        exact = argument.astype(np.float64) ** e.astype(np.float64)
        # The error of the exponent e log2 x, at most 60, becomes a relative one.
        assert abs(found[0] / exact[0] - 1) <= 64 * epsilon(precision)


def test_two_thirds_power(precision, device):
    span = 120 if precision == "float32" else 1000
    x = (2.0 ** np.random.default_rng(5).uniform(-span, span, 20000)).astype(precision).astype(np.float64)
    found = evaluated("log2", precision, x, device=device)[1]
    assert np.abs(found / np.cbrt(x) ** 2 - 1).max() <= TOLERANCES[precision].elementary
    nothing = evaluated("log2", precision, np.array([0.0, -0.0, -1.0, 1e-320]), device=device)[1]
    assert (nothing == 0).all()


def test_power_of_nothing_is_nothing(precision, device):
    x = np.array([0.0, -0.0, -1.0, 1e-320])
    found = evaluated("powers", precision, x, np.full(4, 1 / 3), device=device)[1]
    assert (found == 0).all()


def test_scales_are_powers_of_four_and_the_roots_of_their_reciprocals(precision, device):
    span = 125 if precision == "float32" else 1020
    x = (2.0 ** np.random.default_rng(6).uniform(-span, span, 20000)).astype(precision).astype(np.float64)
    unit, scale = evaluated("scales", precision, x, device=device).astype(np.float64)
    mantissa, _ = np.frexp(scale)
    assert (mantissa == 0.5).all() and (unit * scale**2 == 1).all()
    assert (x * unit >= 0.5).all() and (x * unit < 2).all()
    unit, scale = evaluated("scales", precision, np.zeros(1), device=device)
    assert scale == 0 and np.isfinite(unit)


def test_roots_and_reciprocals(precision, device):
    span = 125 if precision == "float32" else 1000
    x = (2.0 ** np.random.default_rng(7).uniform(-span, span, 20000)).astype(precision).astype(np.float64)
    x = np.append(x, [1.0, 2.0, 4.0, 0.5, np.nextafter(1, 0), np.nextafter(4, 0)]).astype(precision).astype(np.float64)
    limit = 4 * epsilon(precision)
    inverse, _ = evaluated("inverse roots", precision, x, device=device)
    root, reciprocal = evaluated("roots", precision, x, device=device)
    assert np.abs(inverse * np.sqrt(x) - 1).max() <= limit
    assert np.abs(root / np.sqrt(x) - 1).max() <= limit
    assert np.abs(reciprocal * x - 1).max() <= limit
