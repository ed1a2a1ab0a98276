"""Variations of the case that redraw the figures of P3: damping, chain slack, number of lines."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.structures.breakwater.assembly import FloatingUnit, assemble
from moyai.structures.breakwater.frequency.model import FrequencyModel, make_model
from moyai.structures.breakwater.frequency.regular import regular_sea
from moyai.structures.breakwater.hydrodynamics import UnitHydrodynamics
from moyai.structures.breakwater.model import Breakwater, BreakwaterProblem, MooringLine, MooringSpring, RegularSea
from moyai.structures.breakwater.variables import labelled

if TYPE_CHECKING:
    import xarray as xr


SHOWN = (
    "motion_ratio",
    "reflection_coefficient",
    "transmission_coefficient",
    "drift_coefficient",
    "mean_offset",
    "mooring_stiffness",
    "line_tension_maximum",
)


def first_regular_sea(problem: BreakwaterProblem) -> RegularSea | None:
    """Return the first regular sea of the case: variations are shown for it."""
    for sea in problem.environment.sea_states:
        if isinstance(sea, RegularSea):
            return sea
    return None


def sensitivity_datasets(
    problem: BreakwaterProblem, unit: FloatingUnit, hydro: UnitHydrodynamics, model: FrequencyModel
) -> tuple[dict[str, xr.Dataset], tuple[Notice, ...]]:
    """Return the groups under ``sensitivity`` of a water level.

    Line variations keep the coefficients of the case: draught and section hardly change with the pull of the lines.
    """

    settings, sea = problem.settings.sensitivity, first_regular_sea(problem)
    asked = settings.damping_fractions or settings.line_slacks or settings.line_counts
    if not asked:
        return {}, ()
    if sea is None:
        return {}, (
            Notice("sensitivity-needs-regular-waves", "variations are shown for regular waves and the case has none"),
        )
    out: dict[str, xr.Dataset] = {}
    notices: list[Notice] = []
    if settings.damping_fractions:
        cases = [
            regular_sea(make_model(unit, hydro, model.steady, model.with_drift, float(zeta)), sea).dataset
            for zeta in settings.damping_fractions
        ]
        out["damping"] = _joined(cases, "damping_fraction", np.asarray(settings.damping_fractions, dtype=float))
    for name, values, varied in (
        ("line_slack", settings.line_slacks, with_slack),
        ("number_of_lines", settings.line_counts, with_count),
    ):
        done, cases = [], []
        for value in values:
            try:
                other = assemble(replace(problem, breakwater=varied(problem, unit, value)), unit.name, unit.level)
                cases.append(regular_sea(make_model(other, hydro, model.steady, model.with_drift), sea).dataset)
                done.append(float(value))
            except InputError as error:
                notices.append(Notice("variation-impossible", f"{name} = {value:g}: {error.fault.message}"))
        if cases:
            out["line_count" if name == "number_of_lines" else name] = _joined(cases, name, np.array(done))
    return out, tuple(notices)


def _joined(cases: list[xr.Dataset], name: str, values: Array) -> xr.Dataset:
    import xarray as xr

    kept = [case[[variable for variable in SHOWN if variable in case]] for case in cases]
    joined = xr.concat(kept, dim=name, combine_attrs="drop").assign_coords({name: values})
    return labelled(joined.sortby(name))


def with_slack(problem: BreakwaterProblem, unit: FloatingUnit, slack: float) -> Breakwater:
    """Return the breakwater with every line's upper segment cut so that it is ``slack`` [m] longer than its chord."""
    lines: list[MooringLine | MooringSpring] = []
    for line, placed in zip(problem.breakwater.lines, unit.lines):
        if not isinstance(line, MooringLine):
            lines.append(line)
            continue
        chord = float(np.linalg.norm(np.asarray(placed.fairlead) - np.asarray(placed.anchor)))
        others = sum(segment.length for segment in line.segments[:-1])
        length = chord + slack - others
        if length <= 0.0:
            raise InputError(
                f"line {line.name!r} has no upper segment left at a slack of {slack:g} m", parameter="line_slacks"
            )
        lines.append(replace(line, segments=(*line.segments[:-1], replace(line.segments[-1], length=length))))
    return replace(problem.breakwater, lines=tuple(lines))


def with_count(problem: BreakwaterProblem, unit: FloatingUnit, count: float) -> Breakwater:
    """Return the breakwater with ``count`` lines in all, shared among the kinds in proportion."""
    lines = problem.breakwater.lines
    now = sum(line.count for line in lines)
    shares = [line.count * count / now for line in lines]
    if any(abs(share - round(share)) > 1e-9 or round(share) < 1 for share in shares):
        raise InputError(
            f"{count:g} lines cannot be shared among the {len(lines)} kinds in their proportion",
            parameter="settings.sensitivity.line_counts",
            allowed="multiples that keep the proportion",
        )
    return replace(
        problem.breakwater, lines=tuple(replace(line, count=round(share)) for line, share in zip(lines, shares))
    )
