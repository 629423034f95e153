"""Inverse kinematics in closed form: which arms have one, and the numbers that kernels solve them by."""

from wsrender.robots.closed_form.closed_form import ClosedForm
from wsrender.robots.closed_form.free_joint import FreeJointForm
from wsrender.robots.closed_form.nearly_closed import NearlyClosedForm
from wsrender.robots.closed_form.open_wrist import OpenWristForm
from wsrender.robots.closed_form.singular_families import Families, families
from wsrender.robots.kinematics import Kinematics

Form = ClosedForm | FreeJointForm | OpenWristForm | NearlyClosedForm


def form_of(chain: Kinematics, kind: str = "pose") -> Form | None:
    """What decides targets of a ``kind``: a closed form, a search along a joint, or the form of a chain nearby."""
    for form in (ClosedForm, FreeJointForm, OpenWristForm, NearlyClosedForm):
        if found := form.of(chain, kind):
            return found
    return None


__all__ = [
    "ClosedForm",
    "Families",
    "Form",
    "FreeJointForm",
    "NearlyClosedForm",
    "OpenWristForm",
    "families",
    "form_of",
]
