"""Spatial arms of the tests, of three joints that move the end point."""

import wsrender as ws
from wsrender.geometry.spatial.spatial_boundary import solid_arm, spatial_boundary
from wsrender.reach.moving_joints import moving_joints


def robot(rows, name, convention="modified", **options):
    return ws.load_robot(
        ws.DHTable(convention=convention, rows=[ws.DHRow(**row) for row in rows], name=name), **options
    )


def turning(*limits_deg, **row):
    return {"limits_deg": limits_deg or None, **row}


def sliding(*limits, **row):
    return {"joint": "prismatic", "limits": limits, **row}


# θ1 ±90°, elevation −30 … 60° (the second joint less 90°), d 2 … 4
SPHERICAL = [turning(-90, 90), turning(60, 150, alpha_deg=90), sliding(2, 4, alpha_deg=90)]
BOX = [
    sliding(0.1, 0.4),
    sliding(0.2, 0.6, alpha_deg=90, theta_deg=90),
    sliding(-0.2, 0.5, alpha_deg=90, theta_deg=90),
]
SCARA = [turning(-60, 60, a=0.3), turning(20, 150, a=0.2, alpha_deg=180), sliding(0.2, 0.4)]  # standard convention


def arm_of(subject):
    return solid_arm(moving_joints(subject.chain)[0])


def boundary_of(subject, cells=24):
    return spatial_boundary(arm_of(subject), cells, lambda points: None)


def spherical():
    return robot(SPHERICAL, "spherical")


def box():
    return robot(BOX, "box")


def scara():
    return robot(SCARA, "scara", "standard")


def elbow(upper=1.0, lower=0.6):
    rows = [turning(alpha_deg=90), turning(a=upper), turning(a=lower)]
    return robot(rows, "elbow", "standard")


def lipped(beyond_deg):
    """An RPR arm whose last joint turns so far beyond singular postures: it draws lips 0.3 (1 − cos) m thick."""
    limits = (-90 - beyond_deg, 90 + beyond_deg)
    rows = [turning(-120, 120, a=0.3, alpha_deg=90), sliding(0.2, 0.6), turning(*limits, a=0.3)]
    return robot(rows, "lipped", "standard")


def general(limits=(None, None, None)):
    """Offset, skew axes: its boundary is neither of planes nor of tori."""
    rows = [
        {"a": 0.3, "alpha_deg": 90, "d": 0.1, "limits_deg": limits[0]},
        {"a": 0.7, "alpha_deg": 90, "d": 0.2, "limits_deg": limits[1]},
        {"a": 0.5, "d": 0.1, "limits_deg": limits[2]},
    ]
    return robot(rows, "general", "standard")
