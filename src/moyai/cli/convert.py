"""``moyai convert``: decks of MoorDyn to case files of networks, and back; coefficients of a result to other programs.

And what lets ``moyai run`` take a deck.
"""

from __future__ import annotations

import re
from dataclasses import replace as with_fields
from pathlib import Path
from typing import Annotated

import typer

from moyai.cli.console import guard, print_json, tell
from moyai.core.errors import CaseError, Fault, InputError


def motions_of(options: list[str]) -> dict[int | str, Path]:
    """Return the files of ``--motion 3=surge.csv`` or ``--motion body1=surge.csv`` by point, body or rod.

    Raises
    ------
    InputError
        For an option of another form.
    """
    found: dict[int | str, Path] = {}
    for option in options:
        target, sign, name = option.partition("=")
        what = re.fullmatch(r"\s*(point|body|rod)?\s*([0-9]+)\s*", target.lower())
        if not sign or what is None or not name.strip():
            raise InputError(
                f"'{option}' is no motion of a point", path="--motion",
                allowed="the ID of a coupled point, or body or rod and its ID = a file",
                remedy="for instance --motion 3=surge.csv, --motion body1=surge.csv",
            )  # fmt: skip
        number = int(what[2])
        found[f"{what[1]} {number}" if what[1] in ("body", "rod") else number] = Path(name.strip()).resolve()
    return found


def case_of_deck(
    deck: Path,
    target: Path,
    motions: list[str],
    duration: float | None,
    output_step: float | None,
    *,
    replace: bool,
    depth: float | None = None,
) -> Path:
    """Write the case file of a deck and return its path; what a user should know goes to standard error."""
    from moyai.cli.files import write_text
    from moyai.interop.moordyn_case import case_text
    from moyai.interop.moordyn_reader import read_deck

    read, moved = read_deck(deck).in_depth(depth), motions_of(motions)
    text = case_text(read, motions=moved, duration=duration, output_step=output_step, folder=deck.parent)
    for name, file in moved.items():
        if not file.is_file():
            raise InputError(f"there is no file '{file}', which {name} follows", path="--motion")
    write_text(target, text, replace=replace)
    return target


Motion = Annotated[
    list[str] | None,
    typer.Option(
        "--motion",
        metavar="POINT=FILE",
        help="Motion of a coupled point, body (body1=FILE) or rod of a deck: time, x, y, z; repeat.",
    ),
]
Depth = Annotated[
    float | None,
    typer.Option("--depth", help="Water depth of a deck [m], which decks of OpenFAST take from elsewhere.", min=1e-6),
]
Duration = Annotated[float | None, typer.Option("--duration", help="Length of the run of a deck [s].", min=0.0)]


def convert(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="Deck of MoorDyn, case file of a network, or results.nc with --to.")
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="File to write, FILE with another ending when absent; coefficients, gltf: the folder.",
        ),
    ] = None,
    to: Annotated[
        str | None,
        typer.Option(
            "--to",
            metavar="wamit|nemoh|bemio|orcaflex|gltf",
            help="Write coefficients of a result as files of this program; "
            "orcaflex: unit and lines of a breakwater's result, lines, buoys and bodies of a network's case or a deck; "
            "gltf: structures in space, moving.",
        ),
    ] = None,
    sea: Annotated[
        str,
        typer.Option(
            metavar="beam|head",
            help="With --to: the section as sway, heave, roll in waves at 90 degrees, or surge, heave, pitch at 0.",
        ),
    ] = "beam",
    motion: Motion = None,
    duration: Duration = None,
    depth: Depth = None,
    water_level: Annotated[
        str | None, typer.Option(help="Water level of the deck or the coefficients; the first when absent.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that exists.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
) -> None:
    """Turn a deck of MoorDyn into a case file of a network, or a case file into a deck; write coefficients."""
    with guard(as_json):
        if to == "orcaflex":
            target = _model_file(file, output)
            if file.is_dir() or file.suffix.lower() == ".nc":
                _write_vessel(file, target, water_level, force=force, as_json=as_json)
            else:
                _write_lines(file, target, water_level, depth, force=force, as_json=as_json)
            return
        if to == "gltf":
            _write_scenes(file, output, force=force, as_json=as_json)
            return
        if to is not None:
            _write_coefficients(file, to, output, water_level, sea, force=force, as_json=as_json)
            return
        from moyai.interop.moordyn_case import is_deck
        from moyai.interop.moordyn_deck import write_deck
        from moyai.structures.network.case.line_deck import deck_of_case

        if not file.is_file():
            raise InputError(f"no such file: {file}", path="FILE")
        notes: tuple[str, ...] = ()
        if is_deck(file):
            target = case_of_deck(
                file, output or file.with_suffix(".yaml"), motion or [], duration, None, replace=force, depth=depth
            )
            following = f"moyai run {target}"
        else:
            from moyai.case.reader import load_case

            target = output or file.with_suffix(".txt")
            if target.exists() and not force:
                raise InputError(f"{target} exists", path="output", remedy="choose another name, or add --force")
            made = deck_of_case(load_case(file), water_level)
            write_deck(made, target)
            notes = made.notes
            following = "the motions of coupled points are given to MoorDyn by the program that runs it"
        if as_json:
            print_json({"file": str(target), "notes": list(notes), "faults": []})
        else:
            for note in notes:
                tell(note)
            tell(f"wrote {target}; {following}")


def _write_coefficients(
    file: Path, program: str, folder: Path | None, water_level: str | None, sea: str, *, force: bool, as_json: bool
) -> None:
    """Write the coefficients of a result as files of another program and say which."""
    from moyai.core.results import read_result
    from moyai.interop.whole_body import coefficients_of_result
    from moyai.interop.write import write_coefficients

    found = coefficients_of_result(read_result(file), water_level=water_level, sea=sea)  # type: ignore[arg-type]
    files = write_coefficients(program, found, file.parent / program if folder is None else folder, replace=force)
    facts = {name: float(found[name]) for name in ("rho", "g", "water_depth")}
    points = found["reference_point"].values.tolist()
    several = "body" in found.dims
    if as_json:
        print_json({"files": list(map(str, files)), **facts, "reference_point": points, "faults": []})
        return
    for path in files:
        tell(f"wrote {path}")
    tell(f"{'all units' if several else 'whole unit'}, density {facts['rho']:g} kg/m3")
    for name, point in zip(found["body"].values if several else [""], points if several else [points]):
        tell(f"{name} moments about x, y, z = {', '.join(f'{x:g}' for x in point)} m".strip())
    if program == "bemio" and "infinite_frequency_added_mass" not in found:
        tell("the added mass at infinite frequency was found from the damping of the band")
    if several and program == "nemoh":
        tell("files of NEMOH have no place for mean drift")


def _write_scenes(file: Path, output: Path | None, *, force: bool, as_json: bool) -> None:
    """Write the structures in space of a result as glTF and say which."""
    from moyai.core.files import write_whole
    from moyai.report.gltf import document_gltf
    from moyai.report.views import read_result

    folder = output if output is not None else (file if file.is_dir() else file.parent) / "gltf"
    made = list(document_gltf(read_result(file).document))
    if not made:
        raise InputError(
            "the report shows no structure in space", path="--to", allowed="results of networks and flexible cages"
        )
    if there := [folder / name for name, _ in made if (folder / name).exists() and not force]:
        raise InputError(f"{there[0]} exists", path="output", remedy="choose another folder, or add --force")
    files = [write_whole(folder / name, data) for name, data in made]
    if as_json:
        print_json({"files": list(map(str, files)), "faults": []})
        return
    for path in files:
        tell(f"wrote {path}")


def _write_vessel(file: Path, target: Path, water_level: str | None, *, force: bool, as_json: bool) -> None:
    """Write the unit of a result as a vessel of OrcaFlex, on its lines."""
    from moyai.core.results import read_result
    from moyai.interop.whole_body import level_of_result
    from moyai.interop.write_orcaflex_vessel import orcaflex_vessel

    result = read_result(file)
    _require_orcaflex(str(result.tree.attrs.get("structure", "")), "breakwater")
    moorings = None
    if result.tree.attrs.get("structure") == "breakwater":
        from moyai.structures.breakwater.case.moorings import moorings_of_result

        moorings = moorings_of_result(result, level_of_result(result, water_level))
    _write_model(target, *orcaflex_vessel(result, water_level, moorings), force=force, as_json=as_json)


def _write_lines(
    file: Path, target: Path, water_level: str | None, depth: float | None, *, force: bool, as_json: bool
) -> None:
    """Write the lines of a deck or of a case of a network as a text data file of OrcaFlex."""
    from moyai.interop.moordyn_case import is_deck
    from moyai.interop.moordyn_reader import read_deck
    from moyai.interop.write_orcaflex import orcaflex_text
    from moyai.interop.write_orcaflex_vessel import orcaflex_network

    if not file.is_file():
        raise InputError(f"no such file: {file}", path="FILE")
    if is_deck(file):
        written = orcaflex_text(read_deck(file).in_depth(depth))
    else:
        from moyai.case.reader import load_case
        from moyai.structures.network.case.line_deck import deck_and_boxes

        try:
            case = load_case(file)
            _require_orcaflex(case.kind, "network")
            deck, boxes = deck_and_boxes(case, water_level, floating=True)
        except CaseError as error:
            raise CaseError([_for_orcaflex(fault) for fault in error.faults]) from None
        written = orcaflex_network(deck, boxes) if boxes else orcaflex_text(deck)
    _write_model(target, *written, force=force, as_json=as_json)


def _require_orcaflex(kind: str, wanted: str) -> None:
    """Refuse what has no file of OrcaFlex: sheets, nets and members, and a network or breakwater in the wrong form."""
    if kind in (wanted, "units"):
        return
    form = {"network": "the case file of a network", "breakwater": "the results of a breakwater"}
    if kind in form:
        message, remedy = f"a file of OrcaFlex is written from {form[kind]}", f"name {form[kind]} to 'moyai convert'"
    else:
        message, remedy = (
            f"a structure of kind '{kind}' is not written for OrcaFlex: sheets and nets have no place there",
            "",
        )
    raise InputError(
        message, path="--to", allowed="results of a breakwater, cases of a network, decks of MoorDyn", remedy=remedy
    )


def _model_file(file: Path, output: Path | None) -> Path:
    """Return the text data file to write: FILE.yml next to it, or in the folder that is named."""
    if output is None:
        return file / "results.yml" if file.is_dir() else file.with_suffix(".yml")
    if output.suffix.lower() in (".yml", ".yaml", ".dat"):
        return output
    return output / f"{'results' if file.is_dir() else file.stem}.yml"


def _for_orcaflex(fault: Fault) -> Fault:
    """Return a fault of a deck in the words of the file that was asked for."""
    return with_fields(fault, message=fault.message.replace("a deck of MoorDyn", "a file of OrcaFlex"))


def _write_model(target: Path, text: str, notes: tuple[str, ...], *, force: bool, as_json: bool) -> None:
    """Write a text data file of OrcaFlex and say what it leaves out."""
    from moyai.cli.files import write_text

    write_text(target, text, replace=force)
    if as_json:
        print_json({"file": str(target), "notes": list(notes), "faults": []})
        return
    for note in notes:
        tell(note)
    tell(f"wrote {target}")
