"""Which server a command talks to."""

from typing import Annotated

import typer

SERVER = "http://127.0.0.1:8000"

Server = Annotated[str, typer.Option(envvar="WSRENDER_SERVER", help="Address of the server.", metavar="URL")]
Token = Annotated[
    str | None,
    typer.Option(envvar="WSRENDER_TOKEN", help="API key, where the server asks for one.", show_envvar=True),
]
