"""Write a result as a report: one HTML file, a workbook, tables as CSV; PDF, Word and DXF on request."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Iterable
from dataclasses import replace
from pathlib import Path

from moyai.core.errors import CaseError, InputError
from moyai.core.files import write_whole
from moyai.core.kinds import kind_of_result
from moyai.core.options import checks_words
from moyai.core.results import Result
from moyai.core.vocabulary import MEASURED_GROUP
from moyai.language import require_language, spoken_in, spoken_language
from moyai.report.document import Document
from moyai.report.encoding import slug, table_csv, unique_slugs
from moyai.report.first_page import units_of, with_first_page
from moyai.report.general_page import compose as general_page
from moyai.report.general_page import composing_only
from moyai.report.language import in_the_language, with_words_in_system
from moyai.report.systems import displayed_in


def compose_document(
    result: Result, units: str | None = None, language: str | None = None, only: Collection[str] | None = None
) -> Document:
    """Turn a result into a document.

    Parameters
    ----------
    result : Result
        Of any kind and status.
    units : {"SI", "tf"}, optional
        System of units of the document; that of the case when left out, else SI.
    language : {"en", "ja"}, optional
        Language that the document is shown in; that of the case when left out, else the one in force, English.
    only : collection of str, optional
        Keys of the sections that are wanted, for a draft; the others are left out.

    Returns
    -------
    Document
        With English texts: they are translated where it is rendered.

    Raises
    ------
    InputError
        For units or a language of another name.

    Examples
    --------
    >>> import xarray as xr
    >>> from moyai.core import Result
    >>> from moyai.report import compose_document
    >>> tension = xr.DataArray([1.0, 2.0], dims="time", attrs=dict(units="N", long_name="tension"))
    >>> result = Result(xr.DataTree.from_dict({"/line": xr.Dataset(dict(tension=tension), dict(time=[0.0, 1.0]))}))
    >>> document = compose_document(result, units="SI", language="en")
    >>> [section.key for section in document.sections]
    ['summary', 'group-/line', 'checks']
    """
    if units is not None:
        result = replace(result, provenance={**result.provenance, "display_units": units})
    measured = MEASURED_GROUP.strip("/") in result.held.children
    with displayed_in(units_of(result)) as units, composing_only(None if measured else only):
        language = require_language(language or str(result.provenance.get("display_language") or spoken_language()))
        document = replace(_composed(result), units=units, language=language)
        if measured:
            from moyai.report.overlay import with_measured_points

            document = with_measured_points(document, result)
        if only is not None:
            document = replace(document, sections=tuple(one for one in document.sections if one.key in only))
        return document if units == "SI" else with_words_in_system(document)


def _composed(result: Result) -> Document:
    kind = kind_of_result(str(result.held.attrs.get("structure", "")))
    if kind is not None:
        return with_first_page(kind.compose(result), result)
    # A kind that is not known gets a plain listing of all groups
    return with_first_page(general_page(result), result)


@checks_words
def write_report(
    result: Result,
    directory: str | os.PathLike[str],
    *,
    pdf: bool = False,
    docx: bool = False,
    template: Path | None = None,
    dxf: str | None = None,
    vtk: bool = False,
    gltf: bool = False,
    name: str = "report",
    units: str | None = None,
    language: str | None = None,
    document: Document | None = None,
) -> list[Path]:
    """Write the report of a result.

    Every file is written under a partial name and renamed, so that a file under its final name is always complete.

    Parameters
    ----------
    result : Result
        Of any status; what is absent is left out.
    directory : path
        Made if it does not exist.
    pdf : bool
        Write ``<name>.pdf`` too.
    docx : bool
        Write ``<name>.docx`` too; needs the extra ``moyai[docx]``.
    template : Path, optional
        Word document whose styles, heads and feet are taken.
    dxf : {"m", "mm"}, optional
        Write every drawing to scale as ``<name>_drawings/<key>.dxf`` in this unit; needs the extra ``moyai[dxf]``.
    vtk : bool
        Write every structure in space over time as ``<name>_vtk/<key>.pvd`` with a file a moment; nothing where the
        report shows none.
    gltf : bool
        Write every structure in space as ``<name>_gltf/<key>.glb``, an animation for slides; nothing where the report
        shows none.
    name : str
        Name of the files without ending; the tables go to ``<name>_tables``.
    units : {"SI", "tf"}, optional
        System of units that is shown; that of the case when left out, else SI.
    language : {"en", "ja"}, optional
        Language of the report; that of the case when left out, else English.
    document : Document, optional
        The result composed before; composed here when left out.

    Returns
    -------
    list of Path
        The files written: HTML first, PDF, Word and DXF where they are asked for, the workbook, the tables.

    Raises
    ------
    InputError
        When the folder cannot be written or ``name`` is no file name. When PDF, Word, DXF, VTK or glTF cannot be made
        (a package or font is missing, the template or unit is none): after everything else is written.
    CaseError
        When this holds for several of them.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> import xarray as xr
    >>> from moyai.core import Result
    >>> from moyai.report import write_report
    >>> tension = xr.DataArray([1.0, 2.0], dims="time", attrs=dict(units="N", long_name="tension"))
    >>> result = Result(xr.DataTree.from_dict({"/line": xr.Dataset(dict(tension=tension), dict(time=[0.0, 1.0]))}))
    >>> [file.name for file in write_report(result, mkdtemp())]
    ['report.html', 'report.xlsx', 'provenance.csv']
    """
    if not name or name in {".", ".."} or re.search(r'[\\/:*?"<>|\x00-\x1f]', name):
        raise InputError(f"{name!r} is no file name", path="name", remedy="leave out slashes and the like")
    from moyai.report.html import render_html
    from moyai.report.workbook import render_workbook

    folder = Path(directory)
    document = document or compose_document(result, units, language)
    written = [write_whole(folder / f"{name}.html", render_html(document).encode("utf-8"))]
    faults: list[InputError] = []

    def further(files: Callable[[], Iterable[tuple[str, bytes]]]) -> None:
        # what is missing for one kind of file does not stop the rest
        try:
            written.extend([write_whole(folder / file, data) for file, data in files()])
        except InputError as error:
            faults.append(error)

    if pdf:
        further(lambda: [(f"{name}.pdf", _pdf(document))])
    if docx:
        further(lambda: [(f"{name}.docx", _docx(document, template))])
    if dxf is not None:
        further(lambda: ((f"{name}_drawings/{slug(key)}.dxf", data) for key, data in _dxf(document, dxf)))
    if vtk:
        further(lambda: ((f"{name}_vtk/{key}", data) for key, data in _vtk(document)))
    if gltf:
        further(lambda: ((f"{name}_gltf/{key}", data) for key, data in _gltf(document)))
    written.append(write_whole(folder / f"{name}.xlsx", render_workbook(document)))
    with displayed_in(document.units), spoken_in(document.language):
        tables = in_the_language(document).tables()
        for key, table in zip(unique_slugs(table.key for table in tables), tables, strict=True):
            # the byte order mark makes spreadsheets read the file as UTF-8
            data = table_csv(table).encode("utf-8-sig")
            written.append(write_whole(folder / f"{name}_tables" / f"{key}.csv", data))
    if len(faults) > 1:
        raise CaseError([error.fault for error in faults])
    if faults:
        raise faults[0]
    return written


def _pdf(document: Document) -> bytes:
    from moyai.report.pdf import render_pdf

    return render_pdf(document)


def _docx(document: Document, template: Path | None) -> bytes:
    from moyai.report.word import render_docx

    return render_docx(document, template)


def _dxf(document: Document, unit: str) -> Iterable[tuple[str, bytes]]:
    from moyai.report.dxf import document_dxf

    return document_dxf(document, unit)


def _vtk(document: Document) -> Iterable[tuple[str, bytes]]:
    from moyai.report.vtk import document_vtk

    return document_vtk(document)


def _gltf(document: Document) -> Iterable[tuple[str, bytes]]:
    from moyai.report.gltf import document_gltf

    return document_gltf(document)
