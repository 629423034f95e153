"""Denavit–Hartenberg tables: to MJCF, and back from any chain."""

import math
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

from wsrender.documents.robot import DHRow, DHTable
from wsrender.notices import Notice
from wsrender.robots.chain import Chain
from wsrender.robots.plausibility import ANGLE
from wsrender.robots.small_matrices import applied, principal_axes, product

# MuJoCo refuses a moving body without mass: this much stands for "not published".
NEGLIGIBLE = "1e-12"  # kg, kg m²
_COMPILER = {"angle": "radian", "autolimits": "true", "boundmass": NEGLIGIBLE, "boundinertia": NEGLIGIBLE}

# Two axes this close to parallel are meant to be: a quarter turn written as 1.57 in two joints is off by
# 0.0016 rad, and their common normal would meet the axes at a place that means nothing, metres away.
PARALLEL = 2e-3  # sine of the angle between the axes

SHORTEST = 1e-6  # of a capsule, in the table's unit: MuJoCo refuses some that are shorter
WHOLE_TURN = 2 * math.pi * (1 + 1e-9)  # rad; 360° converted may round up

COINCIDENT = 1e-9  # m: a common normal shorter than this has no direction of its own


def doubts(table: DHTable) -> tuple[Notice, ...]:
    """Notice of angles of more than a whole turn, which no table needs: degrees, given as radians."""
    found = [
        f"{name}: {field} {angle:g} rad ({angle / (2 * math.pi):.3g} turns)"
        for name, row in zip(table.joint_names(), table.rows, strict=True)
        for field, angle in (("alpha", row.alpha), ("theta", row.theta))
        if abs(angle) > WHOLE_TURN
    ]
    if not found:
        return ()
    message = f"angles of the table must be in radians, and can only be degrees: {', '.join(found)}"
    return (Notice(ANGLE, message, "give alpha_deg and theta_deg", "robot.dh.rows"),)


def to_mjcf(table: DHTable) -> str:
    """The table as MJCF text, with angles in radians and the world frame as the table's base frame.

    Joint i turns about, or slides along, the z of body ``link<i>``; the site "tool" is the last DH frame.
    Standard rows become modified ones by moving (a, alpha) to the next row, the last pair to the tool.
    Rows without a mass give bodies without ``<inertial>``, which MuJoCo compiles with negligible mass. Of
    ``link_radius`` are capsules from joint to joint, on the fixed body ``base`` and on every link; that of a slide
    reaches back to the link before it wherever it stands. Two that are nearer along the chain than their caps, and so
    always meet, are excluded.
    """
    standard = table.convention == "standard"
    mujoco = ElementTree.Element("mujoco", model=table.name)
    ElementTree.SubElement(mujoco, "compiler", _COMPILER)
    world = parent = ElementTree.SubElement(mujoco, "worldbody")
    links: list[_Link] = []
    if table.link_radius is not None:
        links.append(_Link(ElementTree.SubElement(world, "body", name="base")))
    a, alpha = 0.0, 0.0  # of the link before the joint
    for k, (row, name) in enumerate(zip(table.rows, table.joint_names(), strict=True), start=1):
        if not standard:
            a, alpha = row.a, row.alpha
        pose = _pose(a, alpha, row.d, row.theta)
        parent = ElementTree.SubElement(parent, "body", {"name": f"link{k}", **pose})
        if links:
            _lengthen(links, parent, row, a, alpha)
        if standard:
            a, alpha = row.a, row.alpha
        _add_joint(parent, row, name)
        if row.mass is not None:
            _add_inertial(parent, row, (a, alpha) if standard else (0.0, 0.0))
    tool = _pose(a, alpha, 0.0, 0.0) if standard else {}
    ElementTree.SubElement(parent, "site", {"name": "tool", **tool})
    if links:
        links[-1].next_joint = (a if standard else 0.0, 0.0, 0.0)
        _add_capsules(mujoco, links, float(table.link_radius or 0.0))
    ElementTree.indent(mujoco)
    return ElementTree.tostring(mujoco, encoding="unicode") + "\n"


@dataclass
class _Link:
    """A body, and the points [m] in its frame to which it reaches from its origin."""

    body: ElementTree.Element
    next_joint: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rod: tuple[float, float] = (0.0, 0.0)  # of a slide: how far it reaches along its axis [m]

    @property
    def length(self) -> float:
        """Largest way along it, from where the link before ends to the next joint."""
        return math.hypot(*self.next_joint) + max(-self.rod[0], self.rod[1])


def _lengthen(links: list[_Link], body: ElementTree.Element, row: DHRow, a: float, alpha: float) -> None:
    """The last link reaches to the next joint; a slide back to the link before, from wherever it may stand."""
    c, s = _cosine_sine(alpha)
    links.append(_Link(body))
    if row.joint == "revolute":
        links[-2].next_joint = (a, -row.d * s, row.d * c)
    else:
        links[-2].next_joint = (a, 0.0, 0.0)
        lower, upper = row.limits or (0.0, 0.0)
        links[-1].rod = min(-row.d - upper, 0.0), max(-row.d - lower, 0.0)


def _add_capsules(mujoco: ElementTree.Element, links: list[_Link], radius: float) -> None:
    contact = ElementTree.SubElement(mujoco, "contact")
    for k, link in enumerate(links):
        lines = ((0.0, 0.0, 0.0), link.next_joint), ((0.0, 0.0, link.rod[0]), (0.0, 0.0, link.rod[1]))
        for start, end in lines:
            if math.dist(start, end) > SHORTEST:
                capsule = {"type": "capsule", "size": _text(radius), "fromto": _text(*start, *end), "mass": "0"}
                ElementTree.SubElement(link.body, "geom", capsule)
        way = 0.0  # along the chain, from this link to the later one
        for later in links[k + 1 :]:
            if way <= 2 * radius:
                names = {"body1": link.body.get("name", ""), "body2": later.body.get("name", "")}
                ElementTree.SubElement(contact, "exclude", names)
            way += later.length


def modified_dh(chain: Chain) -> np.ndarray:
    """Modified DH parameters of a chain: rows (a, alpha, d, theta) [m, rad, m, rad], shape (L + 2, 4).

    The product of Rx(alpha) Tx(a) Rz(theta + turn) Tz(d + slide) over the rows, with the displacement of each
    joint added to its row, is the pose of the end effector (tool included) in the base frame. Row 0 leads
    along the base's z to the common normal with the first axis, rows 1 … L to the joints, and row L + 1 to
    the end effector, whose z counts as an axis.

    ``a`` is the length of the common normal of two axes, never negative. ``d`` is the offset along the joint
    axis from one common normal to the next. Parallel axes have many: the one through the origin of the former
    joint's frame in the Chain is taken, so that ``d`` is the signed offset between the two origins. A slide's
    axis is the line through the origin of its joint frame. Axes within 0.002 rad of parallel count as such
    (``alpha`` is then 0 or pi). Convention: Craig 1986, chapter 3.
    """
    links = [*chain.T_joint, chain.T_tip @ chain.T_tip_tool]
    rows = np.zeros((len(links) + 1, 4))
    x = np.array([1.0, 0.0, 0.0])  # of the DH frame before, in the frame of the current axis
    for k, T in enumerate(links):
        normal = _common_normal(T, x)
        rows[k, 2] += normal.leaves
        rows[k, 3] = _angle_about_z(x, normal.x)
        rows[k + 1] = normal.length, normal.twist, -normal.arrives, 0.0
        x = T[:3, :3].T @ normal.x
    rows[-1, 3] = _angle_about_z(x, np.array([1.0, 0.0, 0.0]))
    return rows


def structural_length(chain: Chain) -> float:
    """Sum of |a| + |d| over the modified DH rows of a chain [m]; a slide counts with its largest |d|.

    Length sum of Waldron 1979, from the base frame to the tool.
    """
    rows = modified_dh(chain)
    offsets = np.abs(rows[:, 2])
    limits = np.stack([chain.lower_limits, chain.upper_limits])[:, chain.joint_source]
    slides = chain.joint_scale * limits + chain.joint_offset  # (2, L)
    largest = np.abs(rows[1:-1, 2] + slides).max(axis=0)
    offsets[1:-1] = np.where(chain.joint_is_revolute, offsets[1:-1], largest)
    return float(np.abs(rows[:, 0]).sum() + offsets.sum())


@dataclass(frozen=True)
class _CommonNormal:
    """The common normal from one axis (z of frame 1) to the next (z of frame 2)."""

    x: np.ndarray  # (3,) its direction, in frame 1
    length: float  # m
    twist: float  # angle from the first axis to the next about it [rad]
    leaves: float  # where it leaves the first axis, along z from the origin of frame 1 [m]
    arrives: float  # where it meets the next axis, along z from the origin of frame 2 [m]


def _common_normal(T: np.ndarray, x_before: np.ndarray) -> _CommonNormal:
    """The common normal to the z of a frame T (4, 4); along x_before where it may have any direction."""
    p, z = T[:3, 3], T[:3, 2]
    cross = np.array([-z[1], z[0], 0.0])  # first axis × next axis
    sine = float(np.hypot(cross[0], cross[1]))
    if sine <= PARALLEL:
        length = float(np.hypot(p[0], p[1]))
        x = np.array([p[0], p[1], 0.0]) / length if length > COINCIDENT else x_before
        same_way = z[2] > 0
        twist = 0.0 if same_way else math.pi
        return _CommonNormal(x, length, twist, 0.0, float(-p[2] if same_way else p[2]))
    x = cross / sine
    length = float(p @ x)
    if length < -COINCIDENT:
        x, length = -x, -length
    arrives = -float(p[:2] @ z[:2]) / sine**2  # nearest point of the next axis to the first one
    leaves = float(p[2] + arrives * z[2])
    twist = math.atan2(float(x @ cross), z[2])
    return _CommonNormal(x, max(length, 0.0), twist, leaves, arrives)


def _angle_about_z(x_from: np.ndarray, x_to: np.ndarray) -> float:
    cross = x_from[0] * x_to[1] - x_from[1] * x_to[0]
    return math.atan2(cross, x_from[0] * x_to[0] + x_from[1] * x_to[1])


def _pose(a: float, alpha: float, d: float, theta: float) -> dict[str, str]:
    """MJCF attributes of Rx(alpha) Tx(a) Rz(theta) Tz(d)."""
    c, s = _cosine_sine(alpha)
    return {"pos": _text(a, -d * s, d * c), "euler": _text(alpha, 0.0, theta)}


def _cosine_sine(angle: float) -> tuple[float, float]:
    """Cosine and sine, 0 rather than 6e-17 at a quarter turn."""
    c, s = math.cos(angle), math.sin(angle)
    return (c if abs(c) > 1e-15 else 0.0), (s if abs(s) > 1e-15 else 0.0)


def _add_joint(body: ElementTree.Element, row: DHRow, name: str) -> None:
    kind = "hinge" if row.joint == "revolute" else "slide"
    joint = ElementTree.SubElement(body, "joint", name=name, type=kind, axis="0 0 1")
    if row.limits is not None:
        joint.set("range", _text(*row.limits))
    if row.armature:
        joint.set("armature", _text(row.armature))
    if row.effort_limit is not None:
        joint.set("actuatorfrcrange", _text(-row.effort_limit, row.effort_limit))


def _add_inertial(body: ElementTree.Element, row: DHRow, to_dh_frame: tuple[float, float]) -> None:
    """The link's inertia, told in its DH frame, which is Rx(alpha) Tx(a) from the body's frame."""
    a, alpha = to_dh_frame
    c, s = _cosine_sine(alpha)
    R = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    center = np.add(applied(R, row.center_of_mass), [a, 0.0, 0.0])
    I = product(R, row.inertia_matrix(), R.T)  # noqa: E741 - the field's symbol
    inertial = ElementTree.SubElement(body, "inertial", pos=_text(*center), mass=_text(row.mass or 0.0))
    if np.count_nonzero(I - np.diag(np.diag(I))) == 0:
        inertial.set("diaginertia", _text(*np.diag(I)))
        return
    # Principal axes rather than fullinertia, which MuJoCo refuses for a rod (one moment zero).
    moments, axes = principal_axes(I)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    inertial.set("diaginertia", _text(*np.maximum(moments, 0.0)))
    inertial.set("xyaxes", _text(*axes[:, 0], *axes[:, 1]))


def _text(*numbers: float) -> str:
    """Numbers with every digit, as MJCF writes them."""
    return " ".join(f"{float(number) + 0.0!r}".removesuffix(".0") for number in numbers)
