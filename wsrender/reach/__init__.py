"""What a robot can reach, decided by inverse kinematics.

`reachable` decides targets. `refined_volume(chain, tolerance)` gives the reachable volume with a 95 % interval, and
`refined_volumes(chains, events, tolerance)` those of the points that so many of several placed chains reach:

    found = refined_volumes(
        [left.chain, right.chain],
        {"any": Inside(1, 2), "all": Inside(2, 2), "exactly_1": Inside(1, 1, precise=False)},
        tolerance=0.005,
    )
    found.volumes["all"].value, found.volumes["all"].low, found.volumes["all"].high  # m³

`refined_measure(chain, tolerance)` gives the area of an arm that moves in a plane and the length of one that moves on a
line too, and says why where a set has no measure; `refined_measures` is the same of several chains.
"""

from wsrender.reach.inverse_solver import InverseSolver, Solutions
from wsrender.reach.measure_refinement import RefinedMeasure, refined_measure, refined_measures
from wsrender.reach.posture_sets import Postures, postures
from wsrender.reach.targets import Reachability, reachable, reachable_labels
from wsrender.reach.volume_estimate import Inside, VolumeEstimate, estimate_volumes
from wsrender.reach.volume_refinement import RefinedVolumes, refined_volume, refined_volumes

__all__ = [
    "Inside",
    "InverseSolver",
    "Postures",
    "Reachability",
    "RefinedMeasure",
    "RefinedVolumes",
    "Solutions",
    "VolumeEstimate",
    "estimate_volumes",
    "postures",
    "reachable",
    "reachable_labels",
    "refined_measure",
    "refined_measures",
    "refined_volume",
    "refined_volumes",
]
