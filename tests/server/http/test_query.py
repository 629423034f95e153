"""Query parameters that a route does not have are refused by every route."""

import re

import pytest
from fastapi.routing import APIRoute, APIWebSocketRoute
from starlette.testclient import WebSocketDenialResponse
from starlette.websockets import WebSocketDisconnect
from wsrender_server.app import ROUTERS
from wsrender_server.query import parameters_of

import wsrender as ws
from tests.server.http.idle_server import DOCUMENT, HOST, problem_of

ROUTES = [route for router in ROUTERS for route in router.routes]
OPERATIONS = [(method, route) for route in ROUTES if isinstance(route, APIRoute) for method in sorted(route.methods)]
SOCKETS = [route for route in ROUTES if isinstance(route, APIWebSocketRoute) and route.path.endswith("/session")]
DOCUMENTATION = ("/openapi.json", "/docs", "/")


def path_of(route):
    """A path that the route matches."""
    return re.sub(r"\{[^}]*\}", "robot", route.path)


def test_every_operation_of_the_interface_is_tried(client):
    tried = {(route.path_format, method.lower()) for method, route in OPERATIONS if route.include_in_schema}
    published = client.get("/openapi.json").json()["paths"]
    assert {(path, method) for path, methods in published.items() for method in methods} <= tried
    for method, route in OPERATIONS:
        declared = published.get(route.path_format, {}).get(method.lower(), {}).get("parameters", [])
        assert not declared or sorted(p["name"] for p in declared if p["in"] == "query") == parameters_of(route)


@pytest.mark.parametrize(("method", "route"), OPERATIONS, ids=lambda each: getattr(each, "path", each))
def test_every_route_refuses_what_it_does_not_declare(client, method, route):
    response = client.request(method, path_of(route), params={"stray": "1"}, content=b"{}")
    allowed = parameters_of(route)
    if method == "HEAD":
        assert response.status_code == 422
        return
    problem = problem_of(response, 422, "invalid_request")
    listed = f"allowed: {', '.join(allowed)}" if allowed else "none is allowed"
    assert problem["errors"] == [{"pointer": "stray", "detail": f"is no query parameter here; {listed}"}]
    assert problem.get("choices", []) == allowed and "stray" in problem["detail"] and listed in problem["detail"]


@pytest.mark.parametrize("path", DOCUMENTATION)
def test_the_documentation_too(client, path):
    assert client.get(path).status_code == 200
    problem_of(client.get(path, params={"stray": "1"}), 422, "invalid_request")


def test_the_live_stream_too(client):
    with (
        pytest.raises(WebSocketDenialResponse) as refused,
        client.websocket_connect("/v1/kinetostatic-stream?stray=1") as _,
    ):
        pass
    assert refused.value.status_code == 422 and "stray" in refused.value.json()["detail"]


@pytest.mark.parametrize("route", SOCKETS, ids=lambda route: route.path)
def test_interactive_sessions_too(client, route):
    with client.websocket_connect(f"{path_of(route)}?stray=1") as socket:
        assert b"stray" in socket.receive_bytes()
        with pytest.raises(WebSocketDisconnect) as closed:
            socket.receive_bytes()
    assert closed.value.code == 1008


def test_a_plane_by_another_name_and_a_state_by_another_name(client, finished):
    assert client.get(f"{finished}/volume/slice", params={"axis": "z"}).status_code == 200
    problem = problem_of(client.get(f"{finished}/volume/slice", params={"z": 0.3}), 422, "invalid_request")
    assert problem["choices"] == ["at", "axis", "format", "index", "statistic", "volume"]
    problem_of(client.get("/v1/jobs", params={"stat": "failed"}), 422, "invalid_request")
    problem_of(client.get(f"{finished}/events", params={"after": 3}), 422, "invalid_request")


def test_a_parameter_given_twice_is_no_choice(client):
    problem = problem_of(client.get("/v1/jobs?limit=2&limit=3"), 422, "invalid_request")
    assert problem["errors"] == [{"pointer": "limit", "detail": "may be given once, not 2 times"}]


def test_files_of_the_documentation_may_carry_a_version(client):
    assert client.get("/docs/files/swagger-ui.css?v=5").status_code == 200


def test_the_client_sends_what_the_server_declares(client, jobs, result_folder):
    with ws.Client(HOST, transport=client._transport) as mine:
        job = mine.submit(DOCUMENT, labels={"study": "wrist"})
        jobs.complete(job.id, result_folder)
        assert [each.id for each in mine.jobs(state="succeeded", analysis="workspace", label=("study", "wrist"))]
        result = job.wait().result()
        assert result.volume is not None and result.files.local("volume.vtkhdf", "npz").exists()
        assert mine.robots() and mine.workers() and mine.analyses()
