"""What a robot can reach, decided by inverse kinematics."""

from wsrender.reachability.inverse_solver import InverseSolver, Solutions
from wsrender.reachability.targets import Reachability, reachable

__all__ = ["InverseSolver", "Reachability", "Solutions", "reachable"]
