"""Files that a case names, in another size: spectra and measured points; others are refused."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from moyai.case.build_sea import spectrum_of
from moyai.case.reader import Case
from moyai.case.schema_environment import SpectrumFile
from moyai.case.yaml_reader import KeyPath, dotted
from moyai.core.errors import InputError
from moyai.design.similarity import Scale
from moyai.sea.water import Water

_HEADING = re.compile(r"^\s*(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*$")


def scaled_files(case: Case, scale: Scale, from_model: bool) -> dict[KeyPath, tuple[str, str]]:
    """Return name and text of every file that a case of the new size needs, by the key that names it.

    Parameters
    ----------
    case : Case
        The case given.
    scale : Scale
        Ratios of prototype to model.
    from_model : bool
        Whether ``case`` is that of the model.

    Raises
    ------
    InputError
        For files whose figures cannot be distinguished by their units: coefficients, records, archives of spectra.
    """
    found: dict[KeyPath, tuple[str, str]] = {}
    prefix = "prototype" if from_model else "model"
    for path, name in _named_files(case.document.data, ()):
        new = f"{prefix}_{Path(name).stem}.csv"
        state = _state(case, path)
        if isinstance(state, SpectrumFile) and state.record is None:
            found[path] = (new, _spectrum(case, state, path, scale, from_model))
        elif path[0] == "measured":
            found[path] = (new, _points(case.folder / name, path, scale, from_model))
        else:
            raise InputError(
                f"'{name}' holds figures of the size given, which do not follow the scale of the case",
                path=dotted(path),
                remedy="scale without this block, and add a file of the new size afterwards",
            )
    return found


def _named_files(data: Any, path: KeyPath) -> Iterator[tuple[KeyPath, str]]:
    entries: Any = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        if key in ("file", "path") and isinstance(value, str):
            yield (*path, key), value
        else:
            yield from _named_files(value, (*path, key))


def _state(case: Case, path: KeyPath) -> Any:
    """Return the sea state that a path lies in, ``None`` for any other."""
    if path[0] != "waves":
        return None
    number = path[1] if len(path) > 2 and isinstance(path[1], int) else 0
    return case.model.waves[number]


def _spectrum(case: Case, state: SpectrumFile, path: KeyPath, scale: Scale, from_model: bool) -> str:
    site = case.model.site
    spectrum = spectrum_of(state, Water(site.water_depth, site.density, site.gravity), case.folder, dotted(path[:-1]))
    time, area = scale.ratio("s"), scale.ratio("m2")
    factor = time if from_model else 1.0 / time
    size = area if from_model else 1.0 / area
    turn = 2.0 * math.pi
    rows = [f"{omega / turn / factor!r},{value * turn * size * factor!r}" for omega, value in _pairs(spectrum)]
    return "# scaled from '" + state.file + "'\nfrequency [Hz],density [m2/Hz]\n" + "\n".join(rows) + "\n"


def _pairs(spectrum: Any) -> list[tuple[float, float]]:
    return [(float(omega), float(value)) for omega, value in zip(spectrum.omega, spectrum.density, strict=True)]


def _points(file: Path, path: KeyPath, scale: Scale, from_model: bool) -> str:
    """Scale every column of a table by the unit in its heading; the rest stands as it was."""
    try:
        lines = file.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError):
        raise InputError(f"{file} cannot be read", path=dotted(path)) from None
    out, factors, delimiter = [], None, ","
    for line in lines:
        if not line.strip() or line.lstrip().startswith("#"):
            out.append(line)
            continue
        if factors is None:
            delimiter = next((mark for mark in (";", "\t", ",") if mark in line), ",")
            factors = [_factor(cell, scale, from_model) for cell in _cells(line, delimiter)]
            out.append(line)
            continue
        cells = _cells(line, delimiter)
        if len(cells) != len(factors):
            raise InputError(f"{file.name}: a row has {len(cells)} cells, the header {len(factors)}", path=dotted(path))
        scaled = [cell if not cell else repr(float(cell) * factor) for cell, factor in zip(cells, factors, strict=True)]
        out.append(delimiter.join(scaled))
    return "\n".join(out) + "\n"


def _cells(line: str, delimiter: str) -> list[str]:
    return [cell.strip() for cell in next(csv.reader(io.StringIO(line), delimiter=delimiter))]


def _factor(heading: str, scale: Scale, from_model: bool) -> float:
    match = _HEADING.match(heading)
    unit = (match["unit"] or "").strip() if match else ""
    ratio = scale.ratio("" if unit in ("-", "1") else unit)
    return ratio if from_model else 1.0 / ratio
