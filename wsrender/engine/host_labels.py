"""Labels of samples by functions of the host."""

from typing import Any

import numpy as np
import warp as wp

from wsrender.engine.drawn_configurations import drawn_or_given
from wsrender.engine.evaluation import device_array
from wsrender.engine.memory import device_memory, fetched
from wsrender.pipeline.constraints.collision import labelling
from wsrender.pipeline.constraints.host_function import on_host
from wsrender.pipeline.pipeline import Pipeline

AT_A_TIME = 1 << 14  # configurations that a function is asked about


class HostLabels:
    """As `Collisions`: labels of chunks of at most ``chunk`` samples, where ``before`` has not labelled them."""

    def __init__(self, pipeline: Pipeline, before: Any, device: wp.Device, chunk: int):
        self.pipeline, self.before, self.device = pipeline, before, device
        self.labels = before.labels if before else device_memory(chunk, wp.uint8, device)
        self.numbered = list(enumerate(on_host(pipeline.constraints), len(labelling(pipeline.constraints)) + 1))

    def label(self, space: Any, first: int, count: int, tasks: int) -> wp.array:
        """See `Collisions.label`."""
        found = np.zeros(count, np.uint8)
        if self.before:
            self.before.label(space, first, count, tasks)
            found[:] = fetched(self.labels, 0, count)
        for start in range(0, count, AT_A_TIME):
            self._decide(found[start : start + AT_A_TIME], first + start)
        wp.copy(self.labels, device_array(found, wp.uint8, self.device), count=count)
        return self.labels

    def _decide(self, labels: np.ndarray, first: int) -> None:
        """Label those of samples from ``first`` on, (N,) uint8, that have none."""
        open_ = np.flatnonzero(labels == 0)
        q = drawn_or_given(self.pipeline, first + open_)
        poses = self.pipeline.evaluation.chain.poses(q)
        for number, constraint in self.numbered:
            if len(open_):
                admitted = constraint.host(q, poses) == 0
                labels[open_[~admitted]] = number
                open_, q, poses = open_[admitted], q[admitted], poses[admitted]
