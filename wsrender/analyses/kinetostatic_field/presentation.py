"""How kinetostatic fields are shown."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.results.presentation import Picture, Presentation

_HERE = f"{__name__.rpartition('.')[0]}.pictures"


def facts(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Forces, characteristic length, and passivity."""
    found = document["kinetostatic_field"]
    length, passivity = found["characteristic_length"], found["passivity"]
    yield "force", f"{found['mean_force_n']:.4g} N on average, {found['largest_force_n']:.4g} N at most"
    yield "characteristic length", f"{length['length_m']:.4g} m ({length['method']})"
    share, bound = passivity["share_of_postures_within_bound"], passivity["stiffness_bound_n_per_m"]
    yield "passive stiffness", f"{100 * share:.3g} % of postures are below {bound:.4g} N/m"
    bound = passivity.get("loop_work_bound_j")  # since version 0.2
    bounded = "" if bound is None else f", bound {bound:.3g} J"
    yield "work of closed paths", f"{passivity['largest_loop_work_j']:.3g} J at most{bounded}"


PRESENTATION = Presentation(
    (Picture("posture", f"{_HERE}:posture", needs=("tables.posture", "tables.ellipsoids")),), facts, measured=""
)
