"""The ``moyai app`` command: cases in the browser, on this machine only."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from moyai.cli.console import OK, guard, say


def app(
    start: Annotated[
        Path | None,
        typer.Argument(metavar="FILE|FOLDER", help="Case file, or folder of cases; this folder when absent."),
    ] = None,
    port: Annotated[int, typer.Option("--port", min=0, max=65535, help="Port; 0 takes any that is free.")] = 0,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")] = True,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the results; out in the folder when absent.")
    ] = None,
) -> None:
    """Change cases in the browser and see their results at once; full runs as jobs. Needs the extra moyai[app].

    The page is served on this machine only and needs no network. It ends with Ctrl-C.
    """
    with guard():
        from moyai.app.serve import chosen_folder, require_extra, serve

        require_extra()
        from moyai.cli.runner import run

        def print_line(line: str) -> None:
            say(line)
            sys.stdout.flush()

        folder, first = chosen_folder(start, output)
        serve(folder, first, run, port=port, browser=browser, say=print_line)
        raise typer.Exit(OK)
