"""Running a job, in the four steps that every door uses: plan, run_shard, merge, finish."""

from wsrender.run.steps import Plan, execute, finish, merge, plan, run_shard

__all__ = ["Plan", "execute", "finish", "merge", "plan", "run_shard"]
