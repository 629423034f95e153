"""Legs of known types written as MJCF chains."""

import numpy as np

FREE = 'type="hinge" limited="false"'


def mjcf(body: str) -> str:
    return f'<mujoco><compiler angle="radian" autolimits="true"/><worldbody>{body}</worldbody></mujoco>'


def text(vector) -> str:
    return " ".join(map(repr, map(float, vector)))


def ups(leg: dict) -> dict:
    """The serial leg of a UPS leg's document: universal joint, slide along z with the leg's limits."""
    low, high = leg["length_m"]
    body = (
        f'<body pos="{text(leg["base_m"])}"><joint name="a" {FREE} axis="1 0 0"/><joint name="b" {FREE} axis="0 1 0"/>'
        f'<body><joint name="length" type="slide" axis="0 0 1" range="{low!r} {high!r}"/><geom size=".01"/>'
        '<site name="tool"/></body></body>'
    )
    robot = {"mjcf": mjcf(body)}
    return {"type": "serial", "robot": robot, "attachment": {"position_m": leg["platform_m"]}, "actuated": ["length"]}


def crank(leg) -> dict:
    """The serial leg of a RUS or delta leg: crank, universal joint, link."""
    axis, zero = (np.array(v) / np.linalg.norm(v) for v in (leg.axis, leg.zero))
    low, high = np.deg2rad(leg.angle_deg)
    body = (
        f'<body pos="{text(leg.base_m)}"><joint name="crank" type="hinge" axis="{text(axis)}" range="{low} {high}"/>'
        f'<geom size=".01"/><body pos="{text(leg.crank_m * zero)}"><joint name="a" {FREE} axis="{text(axis)}"/>'
        f'<joint name="b" {FREE} axis="{text(np.cross(axis, zero))}"/><geom size=".01"/>'
        f'<site name="tool" pos="{text(leg.link_m * zero)}"/></body></body>'
    )
    robot = {"mjcf": mjcf(body)}
    return {"type": "serial", "robot": robot, "attachment": {"position_m": leg.platform_m}, "actuated": ["crank"]}
