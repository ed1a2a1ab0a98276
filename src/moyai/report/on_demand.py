"""Files of a job that are made when they are asked for: the report as PDF and for Word, the tables as CSV."""

from __future__ import annotations

import io
import zipfile
from importlib.util import find_spec
from pathlib import Path

from moyai.core.files import write_whole

_RESULTS = ("results.nc", "study.nc", "fit.nc")
_TABLES = "report_tables"
MADE = ("report.pdf", "report.docx", "tables.zip")


def makeable(folder: Path) -> list[str]:
    """Return the names of what can be made of the results in a folder."""
    if not any((folder / name).is_file() for name in _RESULTS):
        return []
    needed = {"report.pdf": "typst", "report.docx": "docx"}
    return [
        name
        for name in MADE
        if (find_spec(needed[name]) is not None if name in needed else (folder / _TABLES).is_dir())
    ]


def made(folder: Path, name: str) -> Path:
    """Return such a file, made of the results when it is not there yet.

    Raises
    ------
    KeyError
        When the folder has no results that it could be made of.
    """
    if name not in makeable(folder):
        raise KeyError(name)
    path = folder / name
    if path.is_file():
        return path
    if name == "tables.zip":
        held = io.BytesIO()
        with zipfile.ZipFile(held, "w", zipfile.ZIP_DEFLATED) as archive:
            for file in sorted((folder / _TABLES).glob("*.csv")):
                archive.write(file, file.name)
        return write_whole(path, held.getvalue())
    from moyai.core.results import read_result
    from moyai.report.writer import compose_document

    source = next(folder / one for one in _RESULTS if (folder / one).is_file())
    document = compose_document(read_result(source))
    if name == "report.pdf":
        from moyai.report.pdf import render_pdf

        return write_whole(path, render_pdf(document))
    from moyai.report.word import render_docx

    return write_whole(path, render_docx(document))


def so_far(folder: Path) -> str:
    """Return the report of a study that runs, of what was gathered until now.

    Raises
    ------
    KeyError
        Where nothing was gathered yet.
    """
    from moyai.core.results import read_result
    from moyai.report.html import render_html
    from moyai.report.writer import compose_document

    path = folder / "study.nc"
    if not path.is_file():
        raise KeyError("study.nc")
    return str(render_html(compose_document(read_result(path))))
