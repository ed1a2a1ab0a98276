"""Planar coefficients of a unit out of the files of a three-dimensional program."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.structures.breakwater.model import BreakwaterProblem


def planar_coefficients(problem: BreakwaterProblem) -> tuple[Callable[[Any], Any] | None, tuple[Notice, ...]]:
    """Return what gives the coefficients of a unit at a level, None without a file, and what speaks against them.

    Raises
    ------
    InputError
        When the file cannot be read, or holds for another depth.
    """
    given = problem.breakwater.coefficients_file
    if given is None:
        return None, ()
    from moyai.interop.checks import import_notices
    from moyai.interop.limits import match_site
    from moyai.interop.planar import to_planar
    from moyai.interop.read import read_body

    options = dict(given.options)
    sea, origin = options.pop("sea"), options.pop("origin")
    try:
        dataset = read_body(given.program, given.path, options)
    except InputError as error:
        raise error.at("coefficients_file") from None

    notices = list(import_notices(dataset))
    environment = problem.environment
    for _, level in environment.water_levels:
        notices += match_site(dataset, environment.water_at(level))[1]

    def of_unit(unit: Any) -> Any:
        matched, _ = match_site(dataset, unit.water)
        return to_planar(
            matched, length=problem.breakwater.length, centre_of_gravity=unit.centre, sea=sea, origin=origin
        )

    return of_unit, tuple(notices)
