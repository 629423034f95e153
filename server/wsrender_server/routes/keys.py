"""API keys, managed by whoever holds one of the scope admin."""

from datetime import datetime
from typing import Annotated

from fastapi import APIRouter, Body, Path, Response
from fastapi.openapi.models import Example
from pydantic import BaseModel, ConfigDict, Field

from wsrender_server.auth import Administrator, Scope
from wsrender_server.parts import Server
from wsrender_server.problems import HttpProblem, problem_responses
from wsrender_server.query import Identifier
from wsrender_server.routes.job_views import Page, View

router = APIRouter(prefix="/v1", tags=["keys"])


class KeyRequest(BaseModel):
    """A key to be made."""

    name: str = Field(pattern=r"^[^\x00-\x1f\x7f]{1,255}$", examples=["ann"])
    """Whose key it is."""
    scopes: list[Scope] = Field(default=["read", "submit"], min_length=1)
    """What it may do."""

    model_config = ConfigDict(use_attribute_docstrings=True, extra="forbid")


_EXAMPLES: dict[str, Example] = {
    "submitter": {"summary": "One that submits jobs", "value": {"name": "ann"}},
    "reader": {"summary": "One that only reads", "value": {"name": "dashboard", "scopes": ["read"]}},
}


class KeyView(View):
    """An API key, without its secret."""

    id: str
    """Its name for revoking."""
    name: str
    """Whose key it is."""
    scopes: list[Scope]
    """What it may do."""
    created_at: datetime
    """When it was made."""
    revoked_at: datetime | None
    """When it was revoked."""


class NewKey(KeyView):
    """An API key that was just made."""

    secret: str
    """The key itself; the server keeps only its hash, and never shows it again."""


def _key_not_found() -> HttpProblem:
    return HttpProblem(404, "there is no such key", "key_not_found")


KeyId = Annotated[str, Identifier(16, _key_not_found), Path(description="Id of a key.")]


@router.get("/keys", summary="List the API keys", response_model=Page[KeyView], responses=problem_responses(401, 403))
def list_keys(server: Server, principal: Administrator) -> Page[KeyView]:
    """All keys of the database, oldest first, revoked ones included; those of a key file are not listed."""
    return Page(items=[KeyView.of(key) for key in server.store.list_keys()])


@router.post(
    "/keys",
    summary="Make an API key",
    status_code=201,
    response_model=NewKey,
    responses=problem_responses(401, 403, 413, 422),
)
def create_key(
    server: Server,
    principal: Administrator,
    response: Response,
    key: Annotated[KeyRequest, Body(openapi_examples=_EXAMPLES)],
) -> NewKey:
    """The answer holds the secret, this once."""
    made, secret = server.store.create_key(key.name, key.scopes)
    response.headers["Cache-Control"] = "no-store"
    return NewKey.of(made, secret=secret)


@router.post(
    "/keys/{key_id:id}:revoke",
    summary="Revoke an API key",
    response_model=KeyView,
    responses=problem_responses(401, 403, 404, 422),
)
def revoke_key(
    server: Server,
    principal: Administrator,
    key_id: KeyId,
) -> KeyView:
    """Requests with it are refused from now on; its jobs stay."""
    key = server.store.revoke_key(key_id)
    if key is None:
        raise _key_not_found()
    return KeyView.of(key)
