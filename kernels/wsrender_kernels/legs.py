"""Legs of parallel mechanisms: whether each has a solution within its limits for a place of its platform joint.

The closed forms are those of `wsrender.mechanisms.inverse_kinematics`, without the angle itself: a crank angle lies in
its range where the cosine of its distance from the middle is large enough.
"""

from types import SimpleNamespace

import numpy as np
import warp as wp

from wsrender_kernels.factories import factory

KINDS = ("UPS", "PUS", "crank")
# Numbers of a leg, in this order: base, axis, zero and across (axis x zero), platform joint and axis of its cone in the
# platform's frame, axis of the base-side cone (3 each); lengths, limits, the middle of an angle's range and the cosine
# of half its width, whether the branches count, cosines of the cones, kind (1 each).
LEG_STRIDE = 3 * 7 + 12
_AT = {"base": 0, "axis": 3, "zero": 6, "across": 9, "platform": 12, "platform_cone": 15, "base_cone": 18}
_CRANK, _LINK, _LOWER, _UPPER, _MIDDLE_COS, _MIDDLE_SIN = range(21, 27)
_HALF_COS, _MINUS, _PLUS, _BASE_COS, _PLATFORM_COS, _KIND = range(27, LEG_STRIDE)
PLATFORM, PLATFORM_CONE = _AT["platform"], _AT["platform_cone"]


def pack_legs(legs) -> np.ndarray:
    """The numbers of legs (fields as of `wsrender.mechanisms.mechanism.Mechanism`) for the kernels, (L, LEG_STRIDE)."""
    rows = np.zeros((len(legs.kinds), LEG_STRIDE))
    vectors = {
        "base": legs.base,
        "axis": legs.axis,
        "zero": legs.zero,
        "across": np.cross(legs.axis, legs.zero),
        "platform": legs.platform,
        "platform_cone": legs.platform_cone_axis,
        "base_cone": legs.base_cone_axis,
    }
    for name, vector in vectors.items():
        rows[:, _AT[name] : _AT[name] + 3] = vector
    middle, half = (legs.lower + legs.upper) / 2, (legs.upper - legs.lower) / 2
    rows[:, _CRANK], rows[:, _LINK], rows[:, _LOWER], rows[:, _UPPER] = legs.crank, legs.link, legs.lower, legs.upper
    rows[:, _MIDDLE_COS], rows[:, _MIDDLE_SIN] = np.cos(middle), np.sin(middle)
    rows[:, _HALF_COS] = np.where(half < np.pi, np.cos(np.minimum(half, np.pi)), -2.0)  # a full turn: any angle
    rows[:, [_MINUS, _PLUS]] = legs.branches
    rows[:, _BASE_COS], rows[:, _PLATFORM_COS] = legs.base_cone_cosine, legs.platform_cone_cosine
    rows[:, _KIND] = [KINDS.index(kind_of(kind)) for kind in legs.kinds]
    return rows


def kind_of(kind: str) -> str:
    """The kernels' name of a kind of leg: those with a crank are solved alike."""
    return kind if kind in KINDS else "crank"


@factory
def leg_solver(real, kinds: tuple[str, ...], cones: bool) -> SimpleNamespace:
    """Device functions for legs of these ``kinds`` (of KINDS); ``cones``: whether any joint has one.

    ``solve(leg, joint, cone) -> (1 or 0, elbow)``: whether the leg reaches its platform joint (3,), with the axis of
    the platform's cone as it stands, and the base-side end of its link.
    """
    vec3, leg_type = wp.types.vector(3, real), wp.types.vector(LEG_STRIDE, real)
    BASE, AXIS, ZERO_AXIS, ACROSS, BASE_CONE = (_AT[name] for name in ("base", "axis", "zero", "across", "base_cone"))
    CRANK, LINK, LOWER, UPPER, HALF_COS = _CRANK, _LINK, _LOWER, _UPPER, _HALF_COS
    MIDDLE_COS, MIDDLE_SIN, MINUS, PLUS = _MIDDLE_COS, _MIDDLE_SIN, _MINUS, _PLUS
    BASE_COS, PLATFORM_COS, KIND = _BASE_COS, _PLATFORM_COS, _KIND
    ONE, ZERO, TWO, HALF = real(1.0), real(0.0), real(2.0), real(0.5)
    TINY = real(1e-30 if real is wp.float32 else 1e-200)
    SLIDER, TURNING = real(KINDS.index("PUS")), real(KINDS.index("crank"))
    HAS_UPS, HAS_PUS, HAS_CRANK = (kind in kinds for kind in KINDS)
    MIXED, CONES = len(kinds) > 1, cones

    @wp.func
    def at(leg: leg_type, first: wp.int32):
        return vec3(leg[first], leg[first + 1], leg[first + 2])

    @wp.func
    def in_cones(leg: leg_type, link: vec3, base_axis: vec3, cone: vec3):
        if wp.static(CONES):
            length = wp.sqrt(wp.dot(link, link))
            base = wp.dot(link, base_axis) >= leg[BASE_COS] * length
            return base and wp.dot(link, cone) >= leg[PLATFORM_COS] * length
        return True

    @wp.func
    def ups(leg: leg_type, joint: vec3, cone: vec3):
        base = at(leg, BASE)
        reach = joint - base
        square = wp.dot(reach, reach)
        fits = square >= leg[LOWER] * leg[LOWER] and square <= leg[UPPER] * leg[UPPER]
        return fits and in_cones(leg, reach, at(leg, BASE_CONE), cone), base

    @wp.func
    def pus(leg: leg_type, joint: vec3, cone: vec3):
        base = at(leg, BASE)
        axis = at(leg, AXIS)
        reach = joint - base
        along = wp.dot(reach, axis)
        off = reach - along * axis
        square = leg[LINK] * leg[LINK] - wp.dot(off, off)
        root = wp.sqrt(wp.max(square, ZERO))
        less = along - root
        more = along + root
        cone_axis = at(leg, BASE_CONE)
        fits_less = leg[MINUS] > HALF and square >= ZERO and less >= leg[LOWER] and less <= leg[UPPER]
        fits_more = leg[PLUS] > HALF and square >= ZERO and more >= leg[LOWER] and more <= leg[UPPER]
        fits_less = fits_less and in_cones(leg, reach - less * axis, cone_axis, cone)
        fits_more = fits_more and in_cones(leg, reach - more * axis, cone_axis, cone)
        return fits_less or fits_more, base + wp.where(fits_more, more, less) * axis

    @wp.func
    def crank_fits(leg: leg_type, reach: vec3, cosine: real, sine: real, cone: vec3):
        fits = cosine * leg[MIDDLE_COS] + sine * leg[MIDDLE_SIN] >= leg[HALF_COS]
        arm = leg[CRANK] * (cosine * at(leg, ZERO_AXIS) + sine * at(leg, ACROSS))
        if wp.static(CONES):
            axis = at(leg, AXIS)
            still = at(leg, BASE_CONE)
            turned = cosine * still + sine * wp.cross(axis, still) + (ONE - cosine) * wp.dot(axis, still) * axis
            fits = fits and in_cones(leg, reach - arm, turned, cone)
        return fits, arm

    @wp.func
    def crank(leg: leg_type, joint: vec3, cone: vec3):
        base = at(leg, BASE)
        reach = joint - base
        a = wp.dot(reach, at(leg, ZERO_AXIS))
        b = wp.dot(reach, at(leg, ACROSS))
        r = leg[CRANK]
        c = (wp.dot(reach, reach) + r * r - leg[LINK] * leg[LINK]) / (TWO * r)
        size = a * a + b * b
        square = size - c * c
        root = wp.sqrt(wp.max(square, ZERO))
        per = ONE / wp.max(size, TINY)
        fits_less, arm_less = crank_fits(leg, reach, (a * c + b * root) * per, (b * c - a * root) * per, cone)
        fits_more, arm_more = crank_fits(leg, reach, (a * c - b * root) * per, (b * c + a * root) * per, cone)
        fits_less = fits_less and leg[MINUS] > HALF and square >= ZERO
        fits_more = fits_more and leg[PLUS] > HALF and square >= ZERO
        return fits_less or fits_more, base + wp.where(fits_more, arm_more, arm_less)

    @wp.func
    def solve(leg: leg_type, joint: vec3, cone: vec3):
        fits = False
        elbow = vec3()
        if wp.static(HAS_UPS):
            fits, elbow = ups(leg, joint, cone)
        if wp.static(HAS_PUS):
            fits_pus, elbow_pus = pus(leg, joint, cone)
            here = wp.static(not MIXED) or leg[KIND] == SLIDER
            fits = wp.where(here, fits_pus, fits)
            elbow = wp.where(here, elbow_pus, elbow)
        if wp.static(HAS_CRANK):
            fits_crank, elbow_crank = crank(leg, joint, cone)
            here = wp.static(not MIXED) or leg[KIND] == TURNING
            fits = wp.where(here, fits_crank, fits)
            elbow = wp.where(here, elbow_crank, elbow)
        return wp.where(fits, 1, 0), elbow

    return SimpleNamespace(solve=solve, at=at, vec3=vec3, leg_type=leg_type)
