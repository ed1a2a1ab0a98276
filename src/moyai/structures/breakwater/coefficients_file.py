"""Planar coefficients of a unit out of the files of a three-dimensional program."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from moyai.core.validity import Notice
from moyai.structures.breakwater.model import BreakwaterProblem


def planar_coefficients(problem: BreakwaterProblem) -> tuple[Callable[[Any], Any] | None, tuple[Notice, ...]]:
    """Return what gives the coefficients of a unit at a level, None without a file, and what speaks against them.

    Raises
    ------
    InputError
        When the file cannot be read.
    """
    given = problem.breakwater.coefficients_file
    if given is None:
        return None, ()
    from moyai.interop.checks import import_notices
    from moyai.interop.planar import to_planar
    from moyai.interop.read import read_coefficients

    options = dict(given.options)
    sea, origin = options.pop("sea"), options.pop("origin")
    dataset = read_coefficients(given.program, given.path, options)

    def of_unit(unit: Any) -> Any:
        return to_planar(
            dataset, length=problem.breakwater.length, centre_of_gravity=unit.centre, sea=sea, origin=origin
        )

    return of_unit, import_notices(dataset)
