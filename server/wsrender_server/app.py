"""The application: routes, errors, documentation and the life of the parts behind them."""

import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path
from typing import Any

from fastapi import Depends, FastAPI, Request
from fastapi.openapi.docs import get_swagger_ui_html
from fastapi.routing import APIRoute
from starlette.concurrency import run_in_threadpool
from starlette.convertors import StringConvertor, register_url_convertor
from starlette.middleware.cors import CORSMiddleware
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import compile_path
from starlette.staticfiles import StaticFiles

from wsrender import __version__
from wsrender_server.auth import Authenticator, check_binding
from wsrender_server.connections import BodyLayer
from wsrender_server.hosts import HostLayer, address
from wsrender_server.jobs.service import JobService
from wsrender_server.logs import configure_logs
from wsrender_server.openapi import openapi_document
from wsrender_server.parts import Jobs, Parts
from wsrender_server.problems import answer_errors
from wsrender_server.query import known_parameters
from wsrender_server.requests import RequestLayer
from wsrender_server.routes.files import content_response
from wsrender_server.settings import Settings

STATIC = Path(__file__).parent / "static"
# Everything comes from the server itself; styles are set by the page's own script, which no policy forbids.
VIEWER_POLICY = {
    "default-src": "'none'",
    "script-src": "'self'",
    "style-src": "'self'",
    "img-src": "'self' blob: data:",
    "connect-src": "'self'",
    "frame-ancestors": "'none'",
    "base-uri": "'none'",
    "form-action": "'none'",
}
VIEWER_HEADERS = {
    "Content-Security-Policy": "; ".join(f"{name} {sources}" for name, sources in VIEWER_POLICY.items()),
    "Cache-Control": "no-cache",
    "Referrer-Policy": "no-referrer",
    "X-Frame-Options": "DENY",
}
# What pages of other origins may do, where any may: ask with a key, never with cookies, and read what clients read.
CORS: dict[str, Any] = {
    "allow_methods": ("GET", "HEAD", "POST", "DELETE"),
    "allow_headers": (
        *("Authorization", "Content-Type", "Idempotency-Key", "Last-Event-ID"),
        *("Range", "If-Range", "If-None-Match", "X-Request-Id"),
    ),
    "expose_headers": (
        *("Location", "ETag", "Content-Range", "Retry-After", "X-Request-Id"),
        *("X-Shape", "X-Origin-M", "X-Voxel-Size-M", "X-At-M", "X-Array"),
    ),
}
DESCRIPTION = """Workspace analysis of robotic manipulators. Submit a job document, follow the job, fetch its result.

Errors are problem documents (RFC 9457) with a stable `code`, JSON pointers to the bad fields, and `retryable`."""


class _IdConvertor(StringConvertor):
    """A part of a path that is an id: no colon, so that ``{id}:cancel`` is another path than ``{id}``."""

    regex = "[^/:]+"


register_url_convertor("id", _IdConvertor())
# After the convertor is known: routes are compiled when their modules are imported.
from wsrender_server.routes import (  # noqa: E402
    artifacts,
    catalogue,
    events,
    keys,
    kinetostatic_stream,
    numbers,
    operation,
    view,
    view_session,
    webhooks,
)
from wsrender_server.routes import jobs as job_routes  # noqa: E402

ROUTERS = [
    module.router
    for module in (
        *(job_routes, events, artifacts, numbers, view, view_session),
        *(catalogue, keys, webhooks, kinetostatic_stream, operation),
    )
]


def create_app(settings: Settings, jobs: Jobs | None = None) -> FastAPI:
    """The server's application; it starts and stops with itself what computes the jobs (by default on Dask).

    Logs become JSON lines unless logging was set up before.

    Raises InputError where the settings would let other machines in without an API key, StoreUnavailable for a
    database that does not answer.
    """
    if not logging.getLogger().handlers:
        configure_logs()
    parts = Parts(settings, jobs or JobService(settings))
    authenticator = Authenticator(settings, parts.store)
    check_binding(settings.host, authenticator.required)
    app = FastAPI(
        title="wsrender",
        version=__version__,
        description=DESCRIPTION,
        license_info={"name": "Apache-2.0", "identifier": "Apache-2.0"},
        openapi_url=None,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        generate_unique_id_function=lambda route: route.name,
        lifespan=_life,
        dependencies=[Depends(known_parameters)],
    )
    app.state.parts = parts
    app.state.authenticator = authenticator
    app.state.keys_at_work = {}
    for router in ROUTERS:
        app.include_router(router)
    _add_documentation(app)
    _add_viewer(app)
    app.state.methods_by_path = [
        (compile_path(route.path)[0], route.methods)
        for router in ROUTERS
        for route in router.routes
        if isinstance(route, APIRoute)
    ]
    answer_errors(app)
    if settings.cors_origins:
        app.add_middleware(CORSMiddleware, allow_origins=settings.cors_origins, **CORS)
    app.add_middleware(HostLayer, settings=settings)
    app.add_middleware(RequestLayer, metrics=parts.metrics, settings=settings)
    app.add_middleware(BodyLayer, settings=settings)
    document = cache(lambda keys_needed: openapi_document(app, keys_needed))
    app.openapi = lambda: document(authenticator.required)
    return app


@asynccontextmanager
async def _life(app: FastAPI) -> AsyncIterator[None]:
    parts: Parts = app.state.parts
    await run_in_threadpool(parts.jobs.start)
    try:
        yield
    finally:
        await run_in_threadpool(parts.jobs.stop)
        await run_in_threadpool(parts.streams.close)
        await run_in_threadpool(parts.view_sessions.close)
        await run_in_threadpool(parts.side_process.close)
        await run_in_threadpool(parts.estimates.close)
        await run_in_threadpool(parts.admissions.close)


def _add_documentation(app: FastAPI) -> None:
    """``/docs`` by files of our own: it works without internet. Routes of the app, as all others are."""
    app.mount("/docs/files", StaticFiles(directory=STATIC / "swagger-ui"), name="swagger-ui")

    @app.get("/openapi.json", include_in_schema=False)
    def openapi(request: Request) -> Response:
        servers = {"servers": [{"url": address("")}]} if address("") else {}
        content = JSONResponse(app.openapi() | servers).body
        return content_response(request, bytes(content), "application/json")

    @app.get("/docs", include_in_schema=False)
    async def docs() -> Response:
        return get_swagger_ui_html(
            openapi_url="openapi.json",
            title="wsrender",
            swagger_js_url="docs/files/swagger-ui-bundle.js",
            swagger_css_url="docs/files/swagger-ui.css",
            swagger_favicon_url="docs/files/favicon-32x32.png",
        )


def _add_viewer(app: FastAPI) -> None:
    """The page at ``/``, whose files are at ``/viewer``; it names them relatively, so that it works behind a prefix."""
    app.mount("/viewer", _ViewerFiles(directory=STATIC / "viewer"), name="viewer")

    @app.get("/", include_in_schema=False)
    async def home() -> Response:
        app.state.parts.views.warm()
        return FileResponse(STATIC / "viewer" / "index.html", headers=VIEWER_HEADERS)


class _ViewerFiles(StaticFiles):
    """The files of the page, with its headers."""

    def file_response(self, *arguments: Any, **options: Any) -> Response:
        """A file, or 304 where the client has it."""
        response = super().file_response(*arguments, **options)
        response.headers.update(VIEWER_HEADERS)
        return response
