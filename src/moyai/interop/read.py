"""The only entry point for files of all programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from moyai.core.errors import InputError
from moyai.interop.aqwa import read_aqwa
from moyai.interop.bemio import read_bemio
from moyai.interop.bodies import one_body
from moyai.interop.capytaine import read_capytaine
from moyai.interop.limits import FEWEST_FREQUENCIES, complete_limits
from moyai.interop.nemoh import read_nemoh
from moyai.interop.wamit import read_wamit

_READERS: dict[str, Callable[..., xr.Dataset]] = {
    "aqwa": read_aqwa,
    "bemio": read_bemio,
    "capytaine": read_capytaine,
    "nemoh": read_nemoh,
    "wamit": read_wamit,
}


def read_coefficients(program: str, path: str | Path, options: Mapping[str, Any] | None = None) -> xr.Dataset:
    """Read hydrodynamic coefficients of one or several three-dimensional bodies [eq:interop-kramers-kronig].

    Where the file has no infinite-frequency added mass it is found from the damping (:mod:`moyai.interop.limits`), if
    the frequencies are enough.

    Parameters
    ----------
    program : {"aqwa", "bemio", "capytaine", "nemoh", "wamit"}
        Program that wrote the files.
    path : path
        File or folder.
    options : mapping, optional
        Arguments of the program's reader, for instance ``density`` and ``reference_point``.

    Returns
    -------
    xarray.Dataset
        Added mass [kg, kg m, kg m2], damping, forces per unit wave amplitude [N/m, N m/m] about ``reference_point``;
        see :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Unknown program or option; everything that the readers refuse.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> from moyai.interop import from_planar, read_coefficients, write_coefficients
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.5, 1.0], modes=rigid_modes((0.0, -0.2)))
    >>> unit = from_planar(found.dataset, length=20.0, centre_of_gravity=(0.0, -0.2))
    >>> folder = mkdtemp()
    >>> _ = write_coefficients("nemoh", unit, folder)
    >>> again = read_coefficients("nemoh", folder)
    >>> float(abs(again.excitation_force / unit.excitation_force - 1.0).max()) < 1e-6
    True
    """
    if program not in _READERS:
        raise InputError(f"unknown program {program!r}", path="program", allowed=", ".join(_READERS))
    reader = _READERS[program]
    try:
        dataset = reader(path, **dict(options or {}))
    except TypeError as error:
        if f"{reader.__name__}()" not in str(error):
            raise
        raise InputError(str(error).replace(f"{reader.__name__}()", program), path="options") from error
    return complete_limits(dataset) if dataset.sizes["omega"] >= FEWEST_FREQUENCIES else dataset


def read_body(program: str, path: str | Path, options: Mapping[str, Any] | None = None) -> xr.Dataset:
    """Read the coefficients of one body; of a file with several ``options`` name it by ``body``.

    Raises
    ------
    InputError
        Several bodies and none named; everything that :func:`read_coefficients` refuses.
    """
    return one_body(read_coefficients(program, path, options))
