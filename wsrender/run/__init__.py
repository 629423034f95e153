"""Running a job, in the steps that every door uses: plan, run_shard, merge, further shards where there are, finish.

>>> from wsrender import run
>>> plan = run.plan({"analysis": "indices_at", "robot": {"library": "ur5e"}, "configurations": [[0, 0, 0, 0, 1, 0]]})
>>> result = run.finish(plan, run.run_shard(plan, 0))  # what `execute` does where there is one shard
>>> result.map.position.shape
(1, 3)
"""

from wsrender.run.steps import Plan, execute, finish, further, merge, plan, run_shard

__all__ = ["Plan", "execute", "finish", "further", "merge", "plan", "run_shard"]
