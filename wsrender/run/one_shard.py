"""What plans that cannot be divided have in common."""

from typing import Any

from wsrender.analyses.cost import Costed


class OneShard(Costed):
    """A plan of one shard. What planning settled are its device and target; a plan that settles more adds to that."""

    job: Any
    # Fields or properties of the plan.
    device: Any
    target: Any
    shards: Any

    def resolved(self) -> dict[str, Any]:
        """What is settled once: the device that "auto" means, target, shards."""
        return {"device": self.device, "target": self.target, "shards": [list(shard) for shard in self.shards]}

    def merge(self, a: Any, b: Any) -> Any:
        """There is one shard: nothing to merge."""
        raise ValueError(f"{self.job.analysis} has one shard")
