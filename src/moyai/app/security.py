"""Who may talk to the app: the page that it opened itself, on this machine, and nobody else."""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs

from moyai.language import said

Scope = MutableMapping[str, Any]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]

LARGEST_BODY = 20_000_000
HEADER = "x-moyai-token"
PAGE_POLICY = (
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self' data:; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Styles stand in drawings and figures; pictures of figures are made in the page and saved from there."""
REPORT_POLICY = (
    "sandbox allow-scripts allow-downloads allow-modals; default-src 'none'; script-src 'unsafe-inline'; "
    "style-src 'unsafe-inline'; img-src data: blob:; connect-src data: blob:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'"
)
"""A report brings its scripts in itself; it has no origin and reaches nothing."""
_SAFE_METHODS = ("GET", "HEAD")


@dataclass(frozen=True)
class Secrets:
    """Three secrets of one start: of the address, of the cookie, of the header on changing requests."""

    address: str = field(default_factory=lambda: secrets.token_urlsafe(24))
    cookie: str = field(default_factory=lambda: secrets.token_urlsafe(24))
    header: str = field(default_factory=lambda: secrets.token_urlsafe(24))


class Guard:
    """ASGI layer that refuses every request that does not come from the page.

    Parameters
    ----------
    app : callable
        What stands behind it.
    secrets_ : Secrets
    port : int
    """

    def __init__(self, app: Any, secrets_: Secrets, port: int) -> None:
        self._app = app
        self._secrets = secrets_
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}
        self._cookie = f"moyai_{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or pass it on."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        if scope["type"] != "http":
            return
        headers = [(name.decode("latin-1").lower(), value.decode("latin-1")) for name, value in scope["headers"]]
        refused = self._refusal(scope, headers)
        if refused is not None:
            await _answer(send, *refused)
            return
        if (given := parse_qs(scope["query_string"].decode("latin-1")).get("token")) is not None:
            await self._welcome(send, scope, given)
            return
        if not self._has_cookie(headers):
            await _answer(send, 403, "Open the address that 'moyai app' printed in the terminal.")
            return
        await self._app(scope, _limited(receive), _with_headers(send))

    def _refusal(self, scope: Scope, headers: list[tuple[str, str]]) -> tuple[int, str] | None:
        given = dict(headers)
        hosts = [value for name, value in headers if name == "host"]
        if len(hosts) != 1 or hosts[0].lower() not in self._hosts:
            return 421, "This address is not that of the app."
        origins = [value for name, value in headers if name == "origin"]
        if any(origin.lower() != f"http://{hosts[0].lower()}" for origin in origins):
            return 403, "Requests of other pages are refused."
        if given.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return 403, "Requests of other pages are refused."
        if scope["method"] not in (*_SAFE_METHODS, "POST"):
            return 405, "Only GET and POST are answered."
        length = given.get("content-length", "0")
        if not length.isdigit() or int(length) > LARGEST_BODY:
            return 413, f"More than {LARGEST_BODY // 1_000_000} MB."
        if scope["method"] == "POST":
            if not self._has_cookie(headers) or not _same(given.get(HEADER, ""), self._secrets.header):
                return 403, "The request has no valid token; open the address of the terminal again."
            if given.get("content-type", "").split(";")[0].strip() != "application/json":
                return 415, "Requests are JSON."
        return None

    def _has_cookie(self, headers: list[tuple[str, str]]) -> bool:
        found: SimpleCookie = SimpleCookie()
        for name, value in headers:
            if name == "cookie":
                try:
                    found.load(value)
                except CookieError:
                    return False
        return self._cookie in found and _same(found[self._cookie].value, self._secrets.cookie)

    async def _welcome(self, send: Send, scope: Scope, given: list[str]) -> None:
        if scope["method"] != "GET" or scope["path"] != "/" or not _same(given[0], self._secrets.address):
            await _answer(send, 403, "This address is not valid any more; look into the terminal.")
            return
        cookie = f"{self._cookie}={self._secrets.cookie}; Path=/; HttpOnly; SameSite=Strict"
        await _answer(send, 303, "", [("location", "/"), ("set-cookie", cookie)])


def _same(given: str, secret: str) -> bool:
    return hmac.compare_digest(given.encode("utf-8", "surrogateescape"), secret.encode())


def _limited(receive: Receive) -> Receive:
    """Return a receiver that takes no more than the largest body, whatever the header said."""
    taken = [0]

    async def limited() -> MutableMapping[str, Any]:
        message = await receive()
        taken[0] += len(message.get("body", b""))
        if taken[0] > LARGEST_BODY:
            raise BodyTooLarge
        return message

    return limited


class BodyTooLarge(Exception):
    """A body grew beyond :data:`LARGEST_BODY`."""


def _with_headers(send: Send) -> Send:
    async def sending(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            known = {name.lower() for name, _ in message["headers"]}
            added = [(b"content-security-policy", PAGE_POLICY.encode()), *_COMMON]
            message["headers"] = [*message["headers"], *((name, value) for name, value in added if name not in known)]
        await send(message)

    return sending


_COMMON = [
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cache-control", b"no-store"),
]


async def _answer(send: Send, status: int, text: str, headers: list[tuple[str, str]] | None = None) -> None:
    body = said(text).encode()
    lines = [("content-type", "text/plain; charset=utf-8"), ("content-length", str(len(body))), *(headers or [])]
    coded = [(name.encode(), value.encode()) for name, value in lines]
    policy = (b"content-security-policy", b"default-src 'none'; frame-ancestors 'none'")
    await send({"type": "http.response.start", "status": status, "headers": [*coded, *_COMMON, policy]})
    await send({"type": "http.response.body", "body": body})
