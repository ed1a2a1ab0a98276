"""Addresses of open cases: open, draft, form, change, undo, pin, save, take away."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Any
from urllib.parse import quote

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse

from moyai.app.answers import Endpoint, body_of, json_answer, text_in, value_in
from moyai.app.documents import OpenCase, stem_of
from moyai.app.gallery import gallery
from moyai.app.messages import STALE, Wish
from moyai.app.pins import renamed, with_pin
from moyai.app.state import App
from moyai.case.form import form_of
from moyai.case.text_changes import with_key, with_scalar, without_key
from moyai.case.yaml_reader import CaseDocument, parse_yaml
from moyai.core.errors import InputError
from moyai.core.kinds import kind_named


async def _gallery(app: App, request: Request) -> Response:
    return json_answer(gallery(app.folder, app.documents))


async def _open(app: App, request: Request) -> Response:
    """Open a template, a file of the folder, or the one of the command line."""
    content = await body_of(request)
    if template := text_in(content, "template"):
        return json_answer(app.documents.open_template(template).record())
    return json_answer(app.documents.open_file(text_in(content, "file") or app.first).record())


def _case(app: App, request: Request) -> OpenCase:
    return app.documents[request.path_params["key"]]


async def _show(app: App, request: Request) -> Response:
    return json_answer(app.documents.look(_case(app, request)).record())


async def _draft(app: App, request: Request) -> Response:
    """Take a text, or numbers to put into the text of now; answer with the check, then with the draft."""
    document, content = _case(app, request), await body_of(request)
    gesture, sequence = text_in(content, "gesture"), value_in(content, "sequence", 0)
    edits, shown = value_in(content, "edits", {}), value_in(content, "shown", [])
    if not all(isinstance(item, str) for item in (*edits.values(), *shown)):
        raise ValueError("'edits' and 'shown' hold texts")
    level, asking = text_in(content, "level"), f"{document.key} {text_in(content, 'tab')}"
    if "text" in content:
        document.change(text_in(content, "text"), "typing" if edits else gesture)
    turn = document.turn

    def wish() -> Wish:
        nonlocal turn
        turn = document.turn
        file = app.folder.root / document.name
        return Wish(document.text, file, app.folder.root, edits, document.pins, tuple(shown), level)

    async def lines() -> AsyncIterator[bytes]:
        async for line in app.worker.ask(asking, wish, patient=content.get("patient") is True):
            if edits and b'"message":"checked"' in line[:60]:
                if document.turn == turn:
                    document.change(json.loads(line)["text"], gesture)
                else:
                    line = STALE  # the text was changed meanwhile: these numbers are asked for again
            state = {"sequence": sequence, "unsaved": document.unsaved, "can_undo": bool(document.earlier)}
            yield json.dumps(state).encode()[:-1] + b"," + line[1:]

    return StreamingResponse(lines(), media_type="application/x-ndjson")


async def _form(app: App, request: Request) -> Response:
    """Hand out the form of an open case as it is now."""
    document = _case(app, request)
    return json_answer({"form": await asyncio.to_thread(_form_of, document.text, document.name)})


def _form_of(text: str, name: str) -> dict[str, Any]:
    data = parse_yaml(text, name).data
    if kind := kind_named(data):
        return form_of(data, kind)
    raise InputError("the form needs the kind of the structure", path="structure.kind", remedy="write it in the text")


async def _change(app: App, request: Request) -> Response:
    """Change one value or key of a text; the record of the case holds the new text."""
    document, content = _case(app, request), await body_of(request)
    if "text" in content:
        document.change(text_in(content, "text"), "typing")
    turn = document.turn
    after = await asyncio.to_thread(lambda: _changed(parse_yaml(document.text, document.name), content).text)
    if document.turn != turn:
        raise InputError("the text was changed meanwhile", path="text", remedy="do it again")
    document.change(after, f"form {content['path']}")
    return json_answer(document.record())


def _changed(document: CaseDocument, wish: dict[str, Any]) -> CaseDocument:
    """Return the document after a change that the page asks for.

    Parameters
    ----------
    document : Document
    wish : dict
        ``change`` (``set``, ``add`` or ``remove``), ``path``, and what the change needs: ``value``, ``quoted``,
        ``after``.

    Raises
    ------
    InputError
        When it is no change of this case.
    ValueError
        When the wish is malformed.
    """
    path, value, after = wish.get("path"), wish.get("value"), wish.get("after", "")
    steps = isinstance(path, list) and all(isinstance(step, str | int) and not isinstance(step, bool) for step in path)
    if not path or not steps or not isinstance(after, str):
        raise ValueError("'path' is a list of keys and numbers")
    where = tuple(path)
    if wish.get("change") == "set" and isinstance(value, str):
        return with_scalar(document, where, value.strip(), as_text=wish.get("quoted") is True)
    if wish.get("change") == "add":
        return with_key(document, where, value, after=after)
    if wish.get("change") == "remove":
        return without_key(document, where)
    raise ValueError("a change is 'set', 'add' or 'remove'")


async def _undo(app: App, request: Request) -> Response:
    document = _case(app, request)
    document.undo()
    return json_answer(document.record())


async def _pin(app: App, request: Request) -> Response:
    """Pin the state of a case; ``id`` names a pin that gets another name, or goes where there is none."""
    document, content = _case(app, request), await body_of(request)
    key, name = text_in(content, "id"), text_in(content, "name")
    if key and not any(pin.key == key for pin in document.pins):
        raise KeyError(key)
    if not key:
        document.pins = with_pin(document.pins, name, document.text)
    elif name:
        document.pins = renamed(document.pins, key, name)
    else:
        document.pins = tuple(pin for pin in document.pins if pin.key != key)
    return json_answer(document.record())


async def _save(app: App, request: Request) -> Response:
    document, content = _case(app, request), await body_of(request)
    app.documents.save(document, text_in(content, "name"))
    return json_answer(document.record())


async def _settle(app: App, request: Request) -> Response:
    """Take what another program has written to the file, or keep the text of the page."""
    document, content = _case(app, request), await body_of(request)
    app.documents.settle(document, content.get("take") is True)
    return json_answer(document.record())


async def _take_case(app: App, request: Request) -> Response:
    document = _case(app, request)
    headers = {"content-disposition": f"attachment; filename*=utf-8''{quote(stem_of(document.name))}.yaml"}
    return Response(document.text, media_type="text/yaml", headers=headers)


_GET, _POST = ["GET"], ["POST"]
ADDRESSES: list[tuple[str, Endpoint, list[str]]] = [
    ("/api/gallery", _gallery, _GET),
    ("/api/cases", _open, _POST),
    ("/api/cases/{key}", _show, _GET),
    ("/api/cases/{key}/draft", _draft, _POST),
    ("/api/cases/{key}/form", _form, _GET),
    ("/api/cases/{key}/change", _change, _POST),
    ("/api/cases/{key}/undo", _undo, _POST),
    ("/api/cases/{key}/pin", _pin, _POST),
    ("/api/cases/{key}/save", _save, _POST),
    ("/api/cases/{key}/file", _settle, _POST),
    ("/api/cases/{key}/case.yaml", _take_case, _GET),
]
