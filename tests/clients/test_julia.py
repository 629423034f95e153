"""The Julia snippet, which is not run here: its grammar, and its requests, read from its syntax, at a live server."""

from pathlib import Path

import httpx2
import pytest
from wsrender_server.local_server import LocalServer

tree_sitter = pytest.importorskip("tree_sitter")
julia = pytest.importorskip("tree_sitter_julia")

SNIPPET = Path(__file__).parent.parent.parent / "clients" / "julia" / "walk.jl"


def parsed(text):
    return tree_sitter.Parser(tree_sitter.Language(julia.language())).parse(text).root_node


def found(node, kind):
    """All nodes of a kind, in their order."""
    if node.type == kind:
        yield node
    for child in node.children:
        yield from found(child, kind)


def calls(node, name):
    return [each for each in found(node, "call_expression") if each.children[0].text.decode() == name]


def value(node):
    """A literal, a vector or a Dict of such as Python has it."""
    match node.type:
        case "string_literal":
            return node.text.decode()[1:-1]
        case "integer_literal" | "float_literal":
            return float(node.text)
        case "unary_expression":
            return float(node.text)
        case "vector_expression":
            return [value(each) for each in node.named_children]
        case "call_expression" if node.children[0].text == b"Dict":
            return {value(pair.children[0]): value(pair.children[-1]) for pair in node.children[1].named_children}
    raise AssertionError(f"{node.type}: {node.text}")


def test_the_snippet_is_julia():
    text = SNIPPET.read_bytes()
    assert text.startswith(b"# Not run here.") and not parsed(text).has_error
    assert parsed(text.replace(b"end\n", b"", 1)).has_error


def test_its_requests_are_answered_as_it_reads_them(tmp_path):
    root = parsed(SNIPPET.read_bytes())
    (job,) = [each for each in calls(root, "run_job") if each.parent.type == "assignment"]
    document = value(job.children[1].named_children[0])
    run = next(each for each in found(root, "function_definition") if b"run_job" in each.text.split(b"\n")[0])
    asked = [[value(each) for each in call.children[1].named_children[:2]] for call in calls(run, "ask")]
    assert [method for method, _ in asked] == ["POST", "GET", "GET"]
    with LocalServer(tmp_path / "data") as server, httpx2.Client(base_url=server.url, timeout=120) as http:
        submit, wait, result = (path for _, path in asked)
        record = http.post(submit, json=document).raise_for_status().json()
        states = {"queued", "running", "canceling"}
        assert {value(each) for each in found(run, "string_literal")} > states
        while record["state"] in states:
            record = http.get(wait.replace('$(job["id"])', record["id"])).raise_for_status().json()
        assert record["state"] == "succeeded"
        answer = http.get(result.replace('$(job["id"])', record["id"])).raise_for_status().json()
        problem = http.post(submit, json={}).json()
    printed = calls(root, "println")[0].children[1]
    names = [value(each.named_children[0]) for each in found(printed, "vector_expression")]
    for name in names:
        answer = answer[name]
    assert names == ["indices", "manipulability", "maximum"] and answer > 0
    ask = next(each for each in found(root, "function_definition") if each.text.startswith(b"function ask"))
    assert {value(each.named_children[-1].named_children[0]) for each in found(ask, "index_expression")} <= set(problem)
