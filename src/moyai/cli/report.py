"""``moyai report``: the report of a result again, without running."""

from __future__ import annotations

import time
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from moyai.cli.console import OK, Spoken, guard, print_json, progress_bars, rich_console, tell
from moyai.core.errors import InputError
from moyai.language import speak

Units = Annotated[
    str | None,
    typer.Option(
        "--units", metavar="SI|tf", help="Units shown: SI, or forces in tf and kgf; those of the case when absent."
    ),
]


Language = Annotated[
    str | None,
    typer.Option(
        "--language", metavar="en|ja", help="Language of report and messages; that of the case, else of the computer."
    ),
]


class ReportCommand(TyperCommand):
    """The command, whose ``--dxf`` may stand without a unit."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the arguments; a bare ``--dxf`` means metres."""
        return super().parse_args(ctx, [word for pair in pairwise([*args, "-"]) for word in _with_unit(*pair)])


def _with_unit(word: str, following: str) -> tuple[str, ...]:
    if word != "--dxf" or following in ("m", "mm"):  # a unit, whatever lies in the folder by that name
        return (word,)
    bare = following.startswith("-") or Path(following).exists() or following.endswith(".nc")
    return (word, "m") if bare else (word,)


def report(
    results: Annotated[
        Path, typer.Argument(metavar="RESULTS", help="results.nc of any command, or its folder.", show_default=False)
    ],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder; that of the results when absent.")
    ] = None,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write report.pdf too.")] = False,
    docx: Annotated[bool, typer.Option("--docx", help="Write report.docx too (Word).")] = False,
    template: Annotated[
        Path | None,
        typer.Option("--template", metavar="DOCX", help="Word document whose styles, heads and feet are taken."),
    ] = None,
    dxf: Annotated[
        str | None,
        typer.Option(
            "--dxf",
            metavar="m|mm",
            help="Write the drawings to scale as DXF too; metres where no unit follows.",
        ),
    ] = None,
    vtk: Annotated[
        bool, typer.Option("--vtk", help="Write structures in space over time as VTK too (ParaView).")
    ] = False,
    gltf: Annotated[
        bool, typer.Option("--gltf", help="Write structures in space as glTF too (.glb, an animation for slides).")
    ] = False,
    xlsx: Annotated[bool, typer.Option("--xlsx", help="The workbook report.xlsx, which is always written.")] = True,
    units: Units = None,
    language: Language = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")] = False,
) -> None:
    """Write the report of a result again, without running: page, workbook and tables; all else on request."""
    with guard(as_json, language):
        if template is not None and not docx:
            raise InputError("a template is for Word", path="--template", remedy="add --docx")
        if dxf is not None:
            from moyai.report.dxf import require_drawing_unit

            require_drawing_unit(dxf)
        from moyai.cli.tables import figure_records, key_figures, print_summary
        from moyai.core.run_folder import prepare_output
        from moyai.report.views import read_result
        from moyai.report.writer import compose_document, write_report

        started = time.perf_counter()
        result = read_result(results)
        if units is not None:
            result = result.shown_in(units)
        if (asked := language or Spoken.language) is not None:
            result = result.said_in(asked)
        elif result.provenance.get("display_language"):
            speak(str(result.provenance["display_language"]))
        folder = prepare_output(output if output is not None else (results if results.is_dir() else results.parent))
        with progress_bars(quiet) as progress:
            progress("report", 0, 1)
            document = compose_document(result)
            files = write_report(
                result, folder, pdf=pdf, docx=docx, template=template, dxf=dxf, vtk=vtk, gltf=gltf, document=document
            )
        endings = {path.suffix for path in files}
        for asked_for, option, ending in ((vtk, "--vtk", ".pvd"), (gltf, "--gltf", ".glb")):
            if asked_for and ending not in endings:
                tell(f"{option}: the report shows no structure in space, no file is written")
        if dxf is not None and ".dxf" not in endings:
            tell("--dxf: the report shows no drawing to scale, no file is written")
        if as_json:
            figures = figure_records(key_figures(result, document))
            print_json({"key_figures": figures, "files": list(map(str, files)), "faults": []})
        elif not quiet:
            print_summary(rich_console(), result, files, time.perf_counter() - started, document)
        raise typer.Exit(OK)
