import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled
from wsrender.analyses.cost import Cost
from wsrender.analyses.partial_result import PartialResult
from wsrender.volume.table import Table


class MiddleTipAnalysis(Analysis):
    def prepare(self, device, target):
        return Settled(device, target, ((0, 1),))

    @property
    def cost(self):
        return Cost(1, 1e3, 1e4, 0.01)

    def compute(self, shard, execution, tell):
        tip = self.robot.forward_kinematics(self._middle)[0, :3, 3]
        tell(1)
        return PartialResult({"tip": tip[2:] if self.job.upwards else tip}, {"joints": list(self.robot.joint_names)})

    def result(self, partial, execution):
        table = Table({"tip": np.atleast_2d(partial["tip"])}, {"tip": "m"})
        entry = {"position_m": partial["tip"].tolist(), "joints": partial.facts["joints"]}
        return Draft({"middle_tip": entry}, tables={"tip": table}, skeleton=self.robot.skeleton(self._middle))

    @property
    def _middle(self):
        return (self.robot.lower_limits + self.robot.upper_limits) / 2
