"""The public robot: forward kinematics, Jacobian, inertia matrix and local indices, in batches."""

from wsrender.robot.indices import evaluate_indices
from wsrender.robot.links import LinkShape, link_shapes
from wsrender.robot.model_robot import Robot, load_robot, robot_of_spec
from wsrender.robot.user_robot import UserRobot, as_robot, model_chain, robot_with_model

__all__ = [
    "LinkShape",
    "Robot",
    "UserRobot",
    "as_robot",
    "evaluate_indices",
    "link_shapes",
    "load_robot",
    "model_chain",
    "robot_of_spec",
    "robot_with_model",
]
