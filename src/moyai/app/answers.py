"""Answers of the app: JSON with a version, errors that a user can correct, what is not there."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable
from dataclasses import asdict
from functools import wraps
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from moyai.app.messages import message
from moyai.app.security import BodyTooLarge
from moyai.app.state import App
from moyai.core.errors import CaseError, Fault, MoyaiError, system_words
from moyai.language import spoken_in
from moyai.language.faults import spoken_fault

Endpoint = Callable[[App, Request], Awaitable[Response]]


def json_answer(content: dict[str, Any], status: int = 200) -> Response:
    return Response(message("answer", **content), status, media_type="application/json")


def refused(status: int, *faults: Fault) -> Response:
    return json_answer({"faults": [asdict(spoken_fault(fault)) for fault in faults]}, status)


def answering(function: Endpoint) -> Any:
    """Turn what a user can correct into an answer with its errors, and what is not there into 404."""

    @wraps(function)
    async def answered(request: Request) -> Response:
        app = request.app.state.app
        with spoken_in(app.language):
            try:
                return await function(app, request)
            except BodyTooLarge:
                return refused(413, Fault("the request is too large"))
            except CaseError as error:
                return refused(422, *error.faults)
            except MoyaiError as error:
                return refused(422, error.fault)
            except KeyError:
                return refused(404, Fault("there is no such case, job or file"))
            except OSError as error:
                return refused(422, Fault(system_words(error)))
            except (ValueError, RecursionError) as error:
                return refused(400, Fault(f"the request cannot be answered: {error}"))

    return answered


async def body_of(request: Request) -> dict[str, Any]:
    content = json.loads(await request.body() or b"{}")
    if not isinstance(content, dict):
        raise ValueError("an object is expected")
    return content


def value_in(content: dict[str, Any], key: str, default: Any) -> Any:
    """Return a value of a request, of the type that it has by default."""
    value = content.get(key, default)
    if type(value) is not type(default):
        raise ValueError(f"{key!r} is of another type")
    return value


def text_in(content: dict[str, Any], key: str) -> str:
    value = str(value_in(content, key, ""))
    value.encode()  # half a character is refused
    return value
