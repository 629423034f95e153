"""Inverse kinematics in closed form: which arms have one, and the numbers that kernels solve them by."""

from wsrender.robots.closed_form.closed_form import ClosedForm
from wsrender.robots.closed_form.free_joint import FreeJointForm

__all__ = ["ClosedForm", "FreeJointForm"]
