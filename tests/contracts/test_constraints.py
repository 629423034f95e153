"""Of every analysis: constraints and surroundings are taken, or refused by a message that names what takes them."""

import re

import pytest

from tests.golden.files import analyses, job_of
from wsrender.analyses.jobs import parse_job
from wsrender.analyses.registry import job_classes
from wsrender.documents.constraints import Constraints
from wsrender.documents.environment import Environment
from wsrender.errors import DocumentError

ASKED = {"constraints": {"self_collision": True}, "environment": {"items": [{"shape": "half_space"}]}}


def takes(analysis, field):
    """Whether the job of an analysis has constraints of configurations, or what stands around, as such a field."""
    found = job_classes()[analysis].model_fields.get(field)
    return found is not None and any(kind.__name__ in str(found.annotation) for kind in (Constraints, Environment))


@pytest.mark.parametrize("field", ASKED)
@pytest.mark.parametrize("analysis", analyses())
def test_constraints_are_taken_or_refused_by_what_takes_them(analysis, field):
    document = job_of(analysis) | {field: ASKED[field]}
    if takes(analysis, field):
        assert getattr(parse_job(document), field) is not None
        return
    with pytest.raises(DocumentError) as refusal:
        parse_job(document)
    ((named, message),) = refusal.value.problems
    others = re.findall(r'"(\w+)"', message.split(", not {")[0])
    own = set(job_classes()[analysis].model_fields) | {"bodies"}
    assert named == field and others
    told = {"mechanism"} if "bodies" in others else set()  # whose bodies another analysis takes instead
    for name in others:
        fields = job_classes()[name].model_fields if name in job_classes() else ()
        assert (takes(name, field) or told & set(fields)) if fields else name in own, message


def test_these_analyses_take_them():
    """What must not fall out of the test above: those that the guides tell of."""
    taking = {name for name in analyses() if takes(name, "constraints") and takes(name, "environment")}
    least = {
        "workspace",
        "indices_at",
        "reachability",
        "postures",
        "capability",
        "shared_workspace",
        "robot_comparison",
    }
    assert taking >= least | {"base_placement", "inverse_reachability", "kinetostatic_field", "two_arm_placement"}


@pytest.mark.parametrize("side", ["master", "slave"])
def test_each_side_of_a_mapping_takes_its_own(side):
    document = job_of("master_slave_mapping")
    job = parse_job(document | {side: {"robot": "ur5e", **ASKED}})
    assert getattr(job, side).constraints.self_collision and getattr(job, side).environment.items


def test_a_design_takes_those_of_its_job():
    inner = job_of("workspace") | ASKED
    parameter = {"name": "floor", "pointers": "/environment/items/0/point_m/2", "bounds": [-1, 0]}
    document = {"design": inner, "parameters": [parameter], "objectives": [{"value": "/samples/admitted"}]}
    assert parse_job({"analysis": "design_optimization"} | document).design.constraints.self_collision
