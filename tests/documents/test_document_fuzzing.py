"""Whatever a document holds: a job that survives its own text, or a DocumentError; nothing else."""

from hypothesis import given, settings
from hypothesis import strategies as st

from wsrender.analyses.indices_at.job import IndicesAtJob
from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.analyses.workspace.job import WorkspaceJob
from wsrender.errors import DocumentError

FIELDS = sorted({*WorkspaceJob.model_fields, *IndicesAtJob.model_fields})
KEYS = st.sampled_from(["method", "per_joint", "count", "locked", "library", "dh", "rows"]) | st.text(max_size=3)
WORDS = st.sampled_from(["workspace", "indices_at", "grid", "random", "all", "full", "x", "cpu", "ur5e"])
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4) | WORDS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS, inner, max_size=4),
    max_leaves=8,
)


def parsed_or_refused(document):
    try:
        job = parse_job(document)
    except DocumentError as error:
        assert all(isinstance(field, str) and field and message for field, message in error.problems)
        str(error).encode()
    else:
        assert parse_job(canonical_json(job)) == job


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.sampled_from(["workspace", "indices_at"]), st.sampled_from(FIELDS), VALUES)
def test_any_value_of_a_field(analysis, field, value):
    parsed_or_refused({"analysis": analysis, "robot": "ur5e", field: value})


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.dictionaries(st.sampled_from(FIELDS) | KEYS, VALUES, max_size=5) | st.text() | st.binary())
def test_any_document(document):
    parsed_or_refused(document)
