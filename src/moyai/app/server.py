"""The addresses of the app. Answers are JSON with a version; drafts are lines of JSON, one a message."""

from __future__ import annotations

import asyncio
import gzip
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import asdict
from functools import cache, wraps
from importlib import resources
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, Response, StreamingResponse
from starlette.routing import Route

from moyai.app.changes import changed
from moyai.app.documents import Documents, OpenCase, stem_of
from moyai.app.downloads import MADE, made
from moyai.app.draft import Run
from moyai.app.folder import Folder, within
from moyai.app.form import form_of
from moyai.app.gallery import gallery
from moyai.app.job_process import Order
from moyai.app.jobs import FILES, Jobs
from moyai.app.security import REPORT_POLICY, BodyTooLarge, Guard, Secrets
from moyai.app.study_jobs import case_text, refuse_foreign_base, so_far, table_of
from moyai.app.words import marked, page_words
from moyai.app.worker import DraftWorker, message
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError, Fault, InputError, MoyaiError
from moyai.core.kinds import structure_kinds
from moyai.language import require_language, spoken_in
from moyai.language.faults import spoken_fault
from moyai.report.encoding import page_json

_SCRIPTS = (
    "page", "case", "gallery", "editor", "plain_text", "code_text", "codemirror",
    "form", "sliders", "live", "jobs", "server",
)  # fmt: skip
_OWN = ("app.css", *(f"{name}.js" for name in _SCRIPTS))
_TYPES = {"css": "text/css", "js": "text/javascript", "html": "text/html"}
_DOWNLOADS = {"results.nc": "application/x-netcdf", "case.yaml": "text/yaml; charset=utf-8"}

Endpoint = Callable[["App", Request], Awaitable[Response]]


class App:
    """State of one start: the folder, open cases, jobs, the process of the drafts.

    Parameters
    ----------
    folder : Folder
    run : callable
        Runs a case; a function of a module.
    secrets_ : Secrets
    first : str
        Case file that the page opens at once, relative to the folder; empty for the gallery.
    language : str
        Of the page and its messages, and of reports whose case names none.
    """

    def __init__(self, folder: Folder, run: Run, secrets_: Secrets, first: str = "", language: str = "en") -> None:
        self.folder = folder
        self.secrets = secrets_
        self.first = first
        self.language = require_language(language)
        self.documents = Documents(folder)
        self.jobs = Jobs(run, folder=folder)
        self.worker = DraftWorker(run, language)


def _json(content: dict[str, Any], status: int = 200) -> Response:
    return Response(message("answer", **content), status, media_type="application/json")


def _refused(status: int, *faults: Fault) -> Response:
    return _json({"faults": [asdict(spoken_fault(fault)) for fault in faults]}, status)


def _endpoint(function: Endpoint) -> Any:
    """Turn what a user can mend into an answer with its errors, and what is not there into 404."""

    @wraps(function)
    async def answered(request: Request) -> Response:
        app = request.app.state.app
        with spoken_in(app.language):
            try:
                return await function(app, request)
            except BodyTooLarge:
                return _refused(413, Fault("the request is too large"))
            except CaseError as error:
                return _refused(422, *error.faults)
            except MoyaiError as error:
                return _refused(422, error.fault)
            except KeyError:
                return _refused(404, Fault("there is no such case, job or file"))
            except (ValueError, OSError, RecursionError) as error:
                return _refused(400, Fault(f"the request cannot be answered: {error}"))

    return answered


async def _body(request: Request) -> dict[str, Any]:
    content = json.loads(await request.body() or b"{}")
    if not isinstance(content, dict):
        raise ValueError("an object is expected")
    return content


def _text(content: dict[str, Any], key: str) -> str:
    value = content.get(key, "")
    if not isinstance(value, str):
        raise ValueError(f"{key!r} is text")
    return value


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


async def _gallery(app: App, request: Request) -> Response:
    return _json(gallery(app.folder, app.documents))


async def _open(app: App, request: Request) -> Response:
    """Open a template, a file of the folder, or the one of the command line."""
    content = await _body(request)
    if template := _text(content, "template"):
        return _json(app.documents.open_template(template).record())
    return _json(app.documents.open_file(_text(content, "file") or app.first).record())


def _case(app: App, request: Request) -> OpenCase:
    return app.documents[request.path_params["key"]]


async def _show(app: App, request: Request) -> Response:
    return _json(_case(app, request).record())


async def _draft(app: App, request: Request) -> Response:
    """Take a text with changed numbers; answer with the check, then with the draft."""
    document, content = _case(app, request), await _body(request)
    text, gesture, sequence = _text(content, "text"), _text(content, "gesture"), content.get("sequence", 0)
    edits = content.get("edits", {})
    if not isinstance(edits, dict) or not all(isinstance(item, str) for pair in edits.items() for item in pair):
        raise ValueError("'edits' are numbers by path, both as text")
    if not isinstance(sequence, int):
        raise ValueError("'sequence' is a whole number")
    shown = content.get("shown", [])
    if not isinstance(shown, list) or not all(isinstance(item, str) for item in shown):
        raise ValueError("'shown' is a list of sections")
    if not edits:
        document.change(text, gesture)
    wish = document.wish(app.folder, text, edits, tuple(shown), _text(content, "level"))
    head = f'{{"sequence":{sequence},'.encode()

    async def lines() -> AsyncIterator[bytes]:
        async for line in app.worker.ask(document.key, wish):
            if edits and b'"message":"checked"' in line[:60]:
                checked = json.loads(line)
                if not checked["faults"] or checked["text"] != text:
                    document.change(checked["text"], gesture)
            yield head + line[1:]

    return StreamingResponse(lines(), media_type="application/x-ndjson")


async def _form(app: App, request: Request) -> Response:
    """Hand out the form of an open case as it is now."""
    document = _case(app, request)
    return _json({"form": await asyncio.to_thread(_form_of, document.text, document.name)})


def _form_of(text: str, name: str) -> dict[str, Any]:
    data = parse_yaml(text, name).data
    structure = data.get("structure") if isinstance(data, dict) else None
    kind = structure.get("kind") if isinstance(structure, dict) else None
    if kind not in structure_kinds():
        raise InputError(
            "the form needs the kind of the structure", path="structure.kind", remedy="write it in the text"
        )
    return form_of(data, kind)


async def _change(app: App, request: Request) -> Response:
    """Change one value or key of a text; the record of the case holds the new text."""
    document, content = _case(app, request), await _body(request)
    text = _text(content, "text")
    after = await asyncio.to_thread(lambda: changed(parse_yaml(text, document.name), content).text)
    document.change(text, "typing")
    document.change(after, f"form {content['path']}")
    return _json(document.record())


async def _undo(app: App, request: Request) -> Response:
    document = _case(app, request)
    document.undo()
    return _json(document.record())


async def _pin(app: App, request: Request) -> Response:
    document = _case(app, request)
    document.pinned = "" if document.pinned else document.text
    return _json(document.record())


async def _save(app: App, request: Request) -> Response:
    document, content = _case(app, request), await _body(request)
    app.documents.save(document, _text(content, "name"))
    return _json(document.record())


async def _take_case(app: App, request: Request) -> Response:
    document = _case(app, request)
    name = f"{stem_of(document.name)}.yaml".replace('"', "")
    safe = name if name.isascii() and name.isprintable() else "case.yaml"
    headers = {"content-disposition": f'attachment; filename="{safe}"'}
    return Response(document.text, media_type="text/yaml", headers=headers)


async def _jobs(app: App, request: Request) -> Response:
    return _json({"jobs": app.jobs.records(app.folder.root)})


async def _start(app: App, request: Request) -> Response:
    """Start a full run of an open case, a study or fit of the folder, or a paper."""
    content = await _body(request)
    root, output = app.folder.root, app.folder.output
    if paper := _text(content, "paper"):
        from moyai.reproduce import paper as known

        key = known(paper).key
        order = Order("paper", key, app.jobs.folder_for(output, key), root, root / key, language=app.language)
    elif name := _text(content, "file"):
        file = app.folder.inside(name)
        kind = await asyncio.to_thread(refuse_foreign_base, app.folder, file)
        shown, target = file.relative_to(root).as_posix(), app.jobs.folder_for(output, file.stem)
        order = Order(kind, shown, target, root, file, language=app.language)
    else:
        document = app.documents[_text(content, "case")]
        folder = app.jobs.folder_for(output, stem_of(document.name))
        file, saved = root / document.name, document.text == document.saved
        order = Order("run", document.name, folder, root, file, document.text, saved, app.language)
    return _json(app.jobs.add(order).record(root))


async def _cancel(app: App, request: Request) -> Response:
    return _json(app.jobs.cancel(request.path_params["key"]).record(app.folder.root))


async def _again(app: App, request: Request) -> Response:
    return _json(app.jobs.again(request.path_params["key"]).record(app.folder.root))


async def _study(app: App, request: Request) -> Response:
    """Hand out the cases of a study that have ended."""
    return _json(await asyncio.to_thread(table_of, app.jobs[request.path_params["key"]].order.folder))


async def _study_case(app: App, request: Request) -> Response:
    """Open a case of a study beside its base case."""
    content, root = await _body(request), app.folder.root
    index = content.get("case")
    if not isinstance(index, int) or isinstance(index, bool):
        raise ValueError("'case' is the number of a case")
    folder = app.jobs[request.path_params["key"]].order.folder
    text, base = await asyncio.to_thread(case_text, folder, root, index)
    stem = base.relative_to(root).with_suffix("").as_posix()
    return _json(app.documents.open_text(f"{stem}_case_{index}", text).record())


async def _result(app: App, request: Request) -> Response:
    """Hand out a file of a job: the report for a frame, the others for download."""
    job, name = app.jobs[request.path_params["key"]], request.path_params["name"]
    if name == "so_far.html":
        text = await asyncio.to_thread(so_far, job.order.folder)
        return Response(text, media_type="text/html", headers={"content-security-policy": REPORT_POLICY})
    if name in MADE:
        await asyncio.to_thread(made, job.order.folder, name)
    elif name not in FILES:
        raise KeyError(name)
    path = within(job.order.folder.resolve(), job.order.folder / name, name)
    if not path.is_file():
        raise KeyError(name)
    if name == "report.html" and "download" not in request.query_params:
        return FileResponse(path, media_type="text/html", headers={"content-security-policy": REPORT_POLICY})
    return FileResponse(path, media_type=_DOWNLOADS.get(name), filename=f"{job.order.folder.name}_{name}")


def create(app: App, port: int) -> Guard:
    """Return the ASGI application, guarded.

    Parameters
    ----------
    app : App
    port : int
        On 127.0.0.1.
    """
    get, post = ["GET"], ["POST"]
    table: list[tuple[str, Endpoint, list[str]]] = [
        ("/", _page, get),
        ("/assets/{name}", _static, get),
        ("/api/gallery", _gallery, get),
        ("/api/cases", _open, post),
        ("/api/cases/{key}", _show, get),
        ("/api/cases/{key}/draft", _draft, post),
        ("/api/cases/{key}/form", _form, get),
        ("/api/cases/{key}/change", _change, post),
        ("/api/cases/{key}/undo", _undo, post),
        ("/api/cases/{key}/pin", _pin, post),
        ("/api/cases/{key}/save", _save, post),
        ("/api/cases/{key}/case.yaml", _take_case, get),
        ("/api/jobs", _jobs, get),
        ("/api/jobs", _start, post),
        ("/api/jobs/{key}/cancel", _cancel, post),
        ("/api/jobs/{key}/again", _again, post),
        ("/api/jobs/{key}/study", _study, get),
        ("/api/jobs/{key}/cases", _study_case, post),
        ("/results/{key}/{name}", _result, get),
    ]

    @asynccontextmanager
    async def life(_: Starlette) -> AsyncIterator[None]:
        app.worker.start()
        try:
            yield
        finally:
            app.worker.close()
            app.jobs.close()

    routes = [Route(path, _endpoint(function), methods=methods) for path, function, methods in table]
    inner = Starlette(routes=routes, lifespan=life)
    inner.state.app = app
    return Guard(inner, app.secrets, port)
