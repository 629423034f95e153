"""Webhooks: where a key's owner is told of the states of their jobs."""

from datetime import datetime
from typing import Annotated

from fastapi import APIRouter, Body, Path, Response
from fastapi.openapi.models import Example
from pydantic import BaseModel, ConfigDict, Field

from wsrender_server.auth import Reader, Submitter
from wsrender_server.jobs.records import ENDED, JobState
from wsrender_server.jobs.webhooks.targets import LONGEST_URL, AllowedTargets
from wsrender_server.parts import Server
from wsrender_server.problems import HttpProblem, problem_responses
from wsrender_server.query import Identifier
from wsrender_server.routes.job_views import Page, View

router = APIRouter(prefix="/v1", tags=["webhooks"])


class WebhookRequest(BaseModel):
    """A webhook to be made."""

    url: str = Field(
        pattern=r'^https?://[A-Za-z0-9\[][!"$-~]*$',
        max_length=LONGEST_URL,
        examples=["https://hooks.example.org/wsrender"],
    )
    """Where messages are posted to: of an origin that the server's administrator allows, at a public address."""
    states: list[JobState] = Field(default=list(ENDED), min_length=1, max_length=len(JobState))
    """States of jobs that are told; by default those in which a job has ended."""

    model_config = ConfigDict(use_attribute_docstrings=True, extra="forbid")


_EXAMPLES: dict[str, Example] = {
    "ended": {"summary": "Of jobs that have ended", "value": {"url": "https://hooks.example.org/wsrender"}},
    "chosen": {
        "summary": "Of chosen states",
        "value": {"url": "https://hooks.example.org/wsrender", "states": ["running", "succeeded", "failed"]},
    },
}


class WebhookView(View):
    """A webhook, without its secret."""

    id: str = Field(pattern="^[0-9a-f]{32}$")
    """Its name."""
    url: str
    """Where messages are posted to."""
    states: list[JobState]
    """States of jobs that are told."""
    created_at: datetime
    """When it was made."""
    disabled_at: datetime | None
    """When its receiver answered 410, and wanted nothing any more; null: it is told."""
    waiting: int = Field(ge=0)
    """Messages that it has not got yet."""
    delivered: int = Field(ge=0)
    """Messages that it has got."""
    given_up: int = Field(ge=0)
    """Messages that it will not get: they failed for too long, or too many waited."""
    last_delivered_at: datetime | None
    """When it got the newest."""
    last_error_at: datetime | None
    """When an attempt failed last."""
    last_error: str | None
    """Why that failed."""


class NewWebhook(WebhookView):
    """A webhook that was just made."""

    secret: str = Field(pattern="^whsec_")
    """What messages are signed with (Standard Webhooks 1.0); never shown again."""


class WebhookTest(View):
    """A message that was put among those that are to be delivered."""

    message: str = Field(examples=["msg_3f2b8c1d9e4a4b5c8d7e6f5a4b3c2d1e"])
    """Its id, the header webhook-id."""


def _webhook_not_found() -> HttpProblem:
    return HttpProblem(404, "there is no such webhook, or it is not yours", "webhook_not_found")


WebhookId = Annotated[str, Identifier(32, _webhook_not_found), Path(description="Id of a webhook.")]


@router.get(
    "/webhooks", summary="List webhooks", response_model=Page[WebhookView], responses=problem_responses(401, 403)
)
def list_webhooks(server: Server, principal: Reader) -> Page[WebhookView]:
    """All of one's own, oldest first."""
    return Page(items=[WebhookView.of(webhook) for webhook in server.store.list_webhooks(principal.owner)])


@router.post(
    "/webhooks",
    summary="Make a webhook",
    status_code=201,
    response_model=NewWebhook,
    responses=problem_responses(401, 403, 409, 413, 422),
)
def create_webhook(
    server: Server,
    principal: Submitter,
    response: Response,
    webhook: Annotated[WebhookRequest, Body(openapi_examples=_EXAMPLES)],
) -> NewWebhook:
    """From now on the states of one's jobs are posted there, signed with the secret, which the answer holds this once.

    A message comes at least once, and each time with the same webhook-id; its type is job. and the state, and its
    timestamp tells the order. Answers other than 2xx are tried again later; redirects are not followed; 410 ends it.
    """
    AllowedTargets(server.settings.webhook_targets, server.settings.webhook_networks).check(webhook.url)
    made, secret = server.store.create_webhook(principal.owner, webhook.url, webhook.states)
    response.headers["Cache-Control"] = "no-store"
    return NewWebhook.of(made, secret=secret)


@router.get(
    "/webhooks/{webhook_id:id}",
    summary="Look at a webhook",
    response_model=WebhookView,
    responses=problem_responses(401, 403, 404),
)
def get_webhook(server: Server, principal: Reader, webhook_id: WebhookId) -> WebhookView:
    """What it has got, what waits, and why an attempt failed."""
    webhook = server.store.webhook(principal.owner, webhook_id)
    if webhook is None:
        raise _webhook_not_found()
    return WebhookView.of(webhook)


@router.delete(
    "/webhooks/{webhook_id:id}",
    summary="Delete a webhook",
    status_code=204,
    response_class=Response,
    responses=problem_responses(401, 403, 404),
)
def delete_webhook(server: Server, principal: Submitter, webhook_id: WebhookId) -> Response:
    """What it has not got yet is forgotten."""
    if not server.store.delete_webhook(principal.owner, webhook_id):
        raise _webhook_not_found()
    return Response(status_code=204)


@router.post(
    "/webhooks/{webhook_id:id}:test",
    summary="Test a webhook",
    status_code=202,
    response_model=WebhookTest,
    responses=problem_responses(401, 403, 404, 409),
)
def test_webhook(server: Server, principal: Submitter, webhook_id: WebhookId) -> WebhookTest:
    """Post a message of the type webhook.test; look at the webhook to see what came of it."""
    message = server.store.test_webhook(principal.owner, webhook_id)
    if message is None:
        raise _webhook_not_found()
    return WebhookTest(message=message)
