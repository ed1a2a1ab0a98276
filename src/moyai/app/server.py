"""The application: its state, the page and its parts, the table of addresses."""

from __future__ import annotations

import gzip
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import cache
from importlib import resources

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from moyai.app import case_addresses, job_addresses
from moyai.app.answers import answering
from moyai.app.security import Guard
from moyai.app.state import App
from moyai.app.words import marked, page_words
from moyai.report.encoding import page_json

_SCRIPTS = (
    "page", "case", "drafts", "gallery", "editor", "plain_text", "code_text", "codemirror",
    "form", "sliders", "pins", "tabs", "live", "sections", "renew", "jobs", "server",
)  # fmt: skip
_OWN = ("app.css", *(f"{name}.js" for name in _SCRIPTS))
_TYPES = {"css": "text/css", "js": "text/javascript", "html": "text/html"}


@cache
def _asset(name: str) -> str:
    from moyai.report.html import SCRIPTS, asset, plotly_archive

    if name == "plotly.js":
        return gzip.decompress(plotly_archive()).decode("utf-8")
    if name == "report.css" or name in SCRIPTS:
        return asset(name)
    if name not in (*_OWN, "index.html"):
        raise KeyError(name)
    return (resources.files("moyai.app") / "assets" / name).read_text(encoding="utf-8")


async def _page(app: App, request: Request) -> Response:
    """The page in its language, with the token of its requests."""
    text = marked(_asset("index.html"))
    for name, value in (("token", app.secrets.header), ("first", "1" if app.first else ""), ("language", app.language)):
        text = text.replace(f"{{{{{name}}}}}", value)
    return Response(text.replace("{{words}}", page_json(page_words())), media_type="text/html")


async def _static(app: App, request: Request) -> Response:
    name = request.path_params["name"]
    return Response(_asset(name), media_type=_TYPES[name.rpartition(".")[2]])


def create(app: App, port: int) -> Guard:
    """Return the ASGI application, guarded.

    Parameters
    ----------
    app : App
    port : int
        On 127.0.0.1.
    """
    table = [
        ("/", _page, ["GET"]),
        ("/assets/{name}", _static, ["GET"]),
        *case_addresses.ADDRESSES,
        *job_addresses.ADDRESSES,
    ]

    @asynccontextmanager
    async def life(_: Starlette) -> AsyncIterator[None]:
        app.worker.start()
        try:
            yield
        finally:
            app.worker.close()
            app.jobs.close()

    routes = [Route(path, answering(function), methods=methods) for path, function, methods in table]
    inner = Starlette(routes=routes, lifespan=life)
    inner.state.app = app
    return Guard(inner, app.secrets, port)
