"""Inverse kinematics in closed form: which arms have one, and the numbers that kernels solve them by."""

from wsrender.robots.closed_form.closed_form import ClosedForm

__all__ = ["ClosedForm"]
