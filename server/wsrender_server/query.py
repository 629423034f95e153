"""Query parameters: what a route does not declare is refused, never ignored."""

from collections import Counter
from collections.abc import Iterator

from fastapi import Request
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute, APIWebSocketRoute
from starlette.requests import HTTPConnection

from wsrender_server.problems import HttpProblem


async def known_parameters(connection: HTTPConnection) -> None:
    """The dependency of every HTTP route: raises HttpProblem for a parameter that its route does not have."""
    if isinstance(connection, Request):
        check_parameters(connection)


def check_parameters(connection: HTTPConnection) -> None:
    """Raise HttpProblem 422 for query parameters that the matched route does not declare, or that come twice."""
    allowed = parameters_of(connection.scope["route"])
    faults = []
    for name, times in Counter(name for name, _ in connection.query_params.multi_items()).items():
        if name not in allowed:
            faults.append((name, f"is no query parameter here; {_listed(allowed)}"))
        elif times > 1:
            faults.append((name, f"may be given once, not {times} times"))
    if faults:
        detail = "; ".join(f"{name}: {text}" for name, text in faults)
        title, choices = "A parameter is not valid", {"choices": allowed} if allowed else {}
        raise HttpProblem(422, detail, "invalid_request", errors=faults, title=title, extra=choices)


def parameters_of(route: APIRoute | APIWebSocketRoute) -> list[str]:
    """Names of the query parameters of a route and of what it depends on."""
    return sorted(set(_declared(route.dependant)))


def _declared(dependant: Dependant) -> Iterator[str]:
    yield from (field.alias for field in dependant.query_params)
    for each in dependant.dependencies:
        yield from _declared(each)


def _listed(allowed: list[str]) -> str:
    return f"allowed: {', '.join(allowed)}" if allowed else "none is allowed"
