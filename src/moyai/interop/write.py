"""Coefficients written for other programs: files of WAMIT, NEMOH and BEMIO, with all digits."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import xarray as xr

from moyai.core.errors import InputError
from moyai.core.files import write_whole
from moyai.core.options import checks_words
from moyai.interop.write_bemio import bemio_files
from moyai.interop.write_nemoh import nemoh_files
from moyai.interop.write_wamit import wamit_files

_WRITERS: dict[str, Callable[[xr.Dataset], dict[str, bytes]]] = {
    "bemio": bemio_files,
    "nemoh": nemoh_files,
    "wamit": wamit_files,
}
"""Programs whose files can be written."""


@checks_words
def write_coefficients(program: str, dataset: xr.Dataset, folder: str | Path, *, replace: bool = False) -> list[Path]:
    """Write coefficients as files of another program.

    Parameters
    ----------
    program : {"bemio", "nemoh", "wamit"}
        Program whose files are written.
        Program whose files are written.
    dataset : xarray.Dataset
        See :mod:`moyai.interop.coefficients`.
    folder : path
        Made if it does not exist.
    replace : bool
        Whether files that exist are replaced.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    InputError
        Unknown program, a file that exists, or what the format needs and the coefficients lack.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> from moyai.interop import from_planar, write_coefficients
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.5, 1.0], modes=rigid_modes((0.0, -0.2)))
    >>> unit = from_planar(found.dataset, length=20.0, centre_of_gravity=(0.0, -0.2))
    >>> [file.name for file in write_coefficients("wamit", unit, mkdtemp())]
    ['unit.gdf', 'unit.pot', 'unit.1', 'unit.3']
    """
    if program not in _WRITERS:
        raise InputError(
            f"unknown program {program!r}", path="--to", allowed=", ".join((*_WRITERS, "orcaflex", "gltf"))
        )
    files = {Path(folder) / name: content for name, content in _WRITERS[program](dataset).items()}
    _require_absent([] if replace else files)
    return [write_whole(path, content) for path, content in files.items()]


def _require_absent(paths: Iterable[Path]) -> None:
    for path in paths:
        if path.exists():
            raise InputError(f"{path} exists", path="output", remedy="choose another folder, or add --force")
