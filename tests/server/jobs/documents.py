"""Canonical job documents."""

import json

from wsrender.analyses.jobs import canonical_json, parse_job


def canonical(**fields):
    """A canonical document of a small ``workspace`` job."""
    document = {"analysis": "workspace", "robot": "scara", "sampling": {"method": "grid", "per_joint": 3}}
    return json.loads(canonical_json(parse_job(document | fields)))


def design_optimization(**fields):
    """A canonical document of a ``design_optimization`` job."""
    return json.loads(canonical_json(parse_job({"analysis": "design_optimization"} | fields)))


def indices_at(**fields):
    """A canonical document of an ``indices_at`` job."""
    return json.loads(canonical_json(parse_job({"analysis": "indices_at", "robot": "scara"} | fields)))
