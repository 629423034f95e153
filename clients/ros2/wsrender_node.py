#!/usr/bin/env python3
"""A ROS 2 action that runs jobs on a wsrender server: not run here, but for its callback against a stub of rclpy.

ros2 run wsrender_ros wsrender_node.py --ros-args -p server:=http://127.0.0.1:8000
"""

import json
import os

import rclpy
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from wsrender_ros.action import RunJob

import wsrender as ws

FEEDBACK_S = 1.0


class WsrenderNode(Node):
    """The action ``run_job``: a goal is a job, canceled with it; the key comes from WSRENDER_TOKEN."""

    def __init__(self):
        super().__init__("wsrender")
        self.client = ws.Client(
            self.declare_parameter("server", "http://127.0.0.1:8000").value, os.environ.get("WSRENDER_TOKEN")
        )
        self.action = ActionServer(
            self,
            RunJob,
            "run_job",
            execute_callback=self.execute,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def execute(self, goal):
        """Run a goal's job to its end."""
        result = RunJob.Result()
        try:
            job = self.client.submit(json.loads(goal.request.document))
            result.job = job.id
            self._follow(job, goal)
            if job.state == "succeeded":
                result.result = json.dumps(job.result().document)
                goal.succeed()
            elif job.state == "canceled" and goal.is_cancel_requested:
                goal.canceled()
            else:
                result.problem = json.dumps(job.error or {"code": job.state})
                goal.abort()
        except (ws.WsrenderError, ValueError) as error:
            result.problem = str(error)
            goal.abort()
        return result

    def _follow(self, job, goal):
        asked_to_stop = False
        while not job.finished:
            if goal.is_cancel_requested and not asked_to_stop:
                asked_to_stop = True
                job.cancel()
            try:
                job.wait(timeout=FEEDBACK_S)
            except ws.WaitTimeoutError:
                said = job.progress
                feedback = RunJob.Feedback()
                feedback.fraction, feedback.message = float(said.get("fraction") or 0), str(said.get("message") or "")
                goal.publish_feedback(feedback)


def main():
    """Serve until the node is stopped; goals are canceled while others run, so it takes several threads."""
    rclpy.init()
    rclpy.spin(WsrenderNode(), executor=MultiThreadedExecutor())


if __name__ == "__main__":
    main()
