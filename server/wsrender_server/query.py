"""Query parameters: what a route does not declare is refused, never ignored; names of formats are the table's."""

import re
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

from fastapi import Request
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute, APIWebSocketRoute
from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema
from starlette.requests import HTTPConnection

from wsrender.results.export.formats import one_of
from wsrender_server.problems import HttpProblem


async def known_parameters(connection: HTTPConnection) -> None:
    """The dependency of every HTTP route: raises HttpProblem for a parameter that its route does not have."""
    if isinstance(connection, Request):
        check_parameters(connection)


def check_parameters(connection: HTTPConnection) -> None:
    """Raise HttpProblem 422 for query parameters that the matched route does not declare, or that come twice."""
    if not connection.scope["query_string"]:
        return
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


class OneOf:
    """Marks text that must be one of some suffixes, which are asked for anew: formats may be added later."""

    def __init__(self, suffixes: Callable[[], list[str]]):
        self._suffixes = suffixes

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self._checked, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "enum": sorted(self._suffixes())}

    def _checked(self, suffix: str) -> str:
        if suffix not in self._suffixes():
            choices = one_of(f"'{each}'" for each in sorted(self._suffixes()))
            raise PydanticCustomError("format", "Input should be {choices}", {"choices": choices})
        return suffix


class Identifier:
    """Marks text that is an id of so many hexadecimal digits; what is no id is the id of nothing: ``absent()``, 404."""

    def __init__(self, digits: int, absent: Callable[[], HttpProblem]):
        self._pattern = f"^[0-9a-f]{{{digits}}}$"
        self._absent = absent

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self._checked, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "pattern": self._pattern}

    def _checked(self, text: str) -> str:
        if re.fullmatch(self._pattern, text) is None:
            raise self._absent()
        return text
