"""Open arms of six hinges, whose last three axes do not meet: well-known ones by their tables, and random ones."""

import numpy as np

import wsrender as ws
from tests.reference.arms_by_axes import (
    RELATIONS,
    across,
    axes_of,
    chain_of,
    direction,
    frame,
    random_arm,
    reversed_chain,
)

# Rows (a [m], alpha [°], d [m], theta [°], lower [°], upper [°]), after Denavit and Hartenberg, of the makers' models
# as ssik 8.2 ships them, angles that these round to five digits made exact.
TABLES = {
    "CRX-10iA": [
        (0, 90, 0.245, 0, -190, 190),
        (0.54, 180, 0, 90, -179.9, 179.9),
        (0, 90, 0, 180, -71, 251),
        (0, 90, -0.54, 180, -190, 190),
        (0, 90, 0.15, 180, -179.9, 179.9),
        (0, 0, -0.16, 0, -225, 225),
    ],
    "CRX-10iA/L": [
        (0, 90, 0.245, 0, -180, 180),
        (0.71, 180, 0, 90, -180, 180),
        (0, 90, 0, 180, -270, 270),
        (0, 90, -0.54, 180, -190, 190),
        (0, 90, 0.15, 180, -180, 180),
        (0, 0, -0.16, 0, -190, 190),
    ],
    "xArm6": [
        (0, 90, 0.267, 0, -360, 360),
        (0.289487, 0, 0, 100.6501, -118, 120),
        (-0.0775, 90, 0, -100.6501, -225, 11),
        (0, 90, 0.3425, 180, -360, 360),
        (-0.076, 90, 0, 180, -97, 180),
        (0, 0, -0.097, 0, -360, 360),
    ],
    "Jaco2": [
        (0, 90, 0.2755, 0, -180, 180),
        (0.41, 180, 0, 90, 47, 313),
        (0, 90, -0.0098, 90, 19, 341),
        (0, 60, -0.250061, 0, -180, 180),
        (0, 60, -0.085519, 180, -180, 180),
        (0, 0, -0.16, 0, -180, 180),
    ],
    "Piper": [
        (0, 90, 0.123, 0, -150, 124.2),
        (0.28503, 0, 0, 5.784, 0, 179.9),
        (-0.021984, 90, 0, -100.7833, -170, 0),
        (0, 90, 0.25075, 180, -100, 100),
        (0.000088, 90, 0, 180, -69.9, 69.9),
        (0, 0, 0.091, 0, -120, 120),
    ],
    "HC10": [
        (0, 90, 0.275, 0, -180, 180),
        (0.7, 180, 0, 90, -180, 180),
        (0, 90, 0, 90, -5, 355),
        (0, 90, -0.5, 180, -180, 180),
        (0, 90, -0.162, 180, -180, 180),
        (0, 0, 0.13, 0, -180, 180),
    ],
}


def open_arm(name):
    """The chain of a table, or "backwards" held at its tip, or a random arm by its seed."""
    if name.startswith("random "):
        return random_open_arm(int(name.split()[1]))
    if name.endswith(", backwards"):
        return reversed_chain(open_arm(name.removesuffix(", backwards")))
    rows = [
        ws.DHRow(a=a, alpha_deg=alpha, d=d, theta_deg=theta, limits_deg=(low, high))
        for a, alpha, d, theta, low, high in TABLES[name]
    ]
    table = ws.DHTable(convention="standard", rows=tuple(rows), name="open")
    chain = ws.load_robot(table).chain.geometry
    assert chain
    return chain


def random_open_arm(seed):
    """Axes 1 and 2 meet, or are parallel; 4 and 5 meet; the others stand anywhere. Every second arm the other way."""
    random = np.random.default_rng(seed)
    first = random_arm(RELATIONS[seed % 2], seed)
    h, o, _ = axes_of(first)
    h[3] = across(random, h[2])
    h[4] = across(random, h[3])
    h[5] = across(random, h[4])
    o[3:] = random.uniform(-0.5, 0.5, (3, 3))
    o[4] = o[3]
    T_tip = frame(direction(random), random.uniform(-0.5, 0.5, 3))
    chain = chain_of(h, o, T_tip, first.lower_limits, first.upper_limits)
    return reversed_chain(chain) if seed % 4 > 1 else chain


ARMS = (*TABLES, "CRX-10iA, backwards", "Jaco2, backwards", *(f"random {seed}" for seed in range(4)))
