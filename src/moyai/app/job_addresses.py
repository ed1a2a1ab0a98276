"""Addresses of jobs: start, cancel, start again, their studies and files."""

from __future__ import annotations

import asyncio

from starlette.requests import Request
from starlette.responses import FileResponse, Response

from moyai.app.answers import Endpoint, body_of, json_answer, text_in, value_in
from moyai.app.documents import stem_of
from moyai.app.folder import within
from moyai.app.job import FILES
from moyai.app.job_process import Order
from moyai.app.security import REPORT_POLICY
from moyai.app.state import App
from moyai.app.study_jobs import refuse_foreign_base
from moyai.report.on_demand import MADE, made, so_far
from moyai.study.cases_so_far import case_text, table_of

_DOWNLOADS = {"results.nc": "application/x-netcdf", "case.yaml": "text/yaml; charset=utf-8"}


async def _jobs(app: App, request: Request) -> Response:
    return json_answer({"jobs": app.jobs.records(app.folder.root)})


async def _start(app: App, request: Request) -> Response:
    """Start a full run of an open case, a study or fit of the folder, or a paper."""
    content = await body_of(request)
    root, output = app.folder.root, app.folder.output
    if paper := text_in(content, "paper"):
        from moyai.reproduce import paper as known

        key = known(paper).key
        order = Order("paper", key, app.jobs.folder_for(output, key), root, root / key, language=app.language)
    elif name := text_in(content, "file"):
        file = app.folder.inside(name)
        kind = await asyncio.to_thread(refuse_foreign_base, app.folder, file)
        shown, target = file.relative_to(root).as_posix(), app.jobs.folder_for(output, file.stem)
        order = Order(kind, shown, target, root, file, language=app.language)
    else:
        document = app.documents[text_in(content, "case")]
        folder = app.jobs.folder_for(output, stem_of(document.name))
        file, saved = root / document.name, not document.unsaved
        order = Order("run", document.name, folder, root, file, document.text, saved, app.language)
    return json_answer(app.jobs.add(order).record(root))


async def _cancel(app: App, request: Request) -> Response:
    return json_answer(app.jobs.cancel(request.path_params["key"]).record(app.folder.root))


async def _again(app: App, request: Request) -> Response:
    return json_answer(app.jobs.again(request.path_params["key"]).record(app.folder.root))


async def _study(app: App, request: Request) -> Response:
    """Hand out the cases of a study that have ended."""
    return json_answer(await asyncio.to_thread(table_of, app.jobs[request.path_params["key"]].order.folder))


async def _study_case(app: App, request: Request) -> Response:
    """Open a case of a study next to its base case."""
    content, root = await body_of(request), app.folder.root
    index = value_in(content, "case", -1)
    folder = app.jobs[request.path_params["key"]].order.folder
    text, base = await asyncio.to_thread(case_text, folder, root, index)
    stem = base.relative_to(root).with_suffix("").as_posix()
    return json_answer(app.documents.open_text(f"{stem}_case_{index}", text).record())


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


_GET, _POST = ["GET"], ["POST"]
ADDRESSES: list[tuple[str, Endpoint, list[str]]] = [
    ("/api/jobs", _jobs, _GET),
    ("/api/jobs", _start, _POST),
    ("/api/jobs/{key}/cancel", _cancel, _POST),
    ("/api/jobs/{key}/again", _again, _POST),
    ("/api/jobs/{key}/study", _study, _GET),
    ("/api/jobs/{key}/cases", _study_case, _POST),
    ("/results/{key}/{name}", _result, _GET),
]
