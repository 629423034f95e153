"""Running a job, in the steps that every door uses: plan, run_shard, merge, further shards where there are, finish."""

from wsrender.run.steps import Plan, execute, finish, further, merge, plan, run_shard

__all__ = ["Plan", "execute", "finish", "further", "merge", "plan", "run_shard"]
