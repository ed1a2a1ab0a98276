"""Run a row of floating units: every water level, every sea state, the analyses that the case names."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.collected import Collected, most_severe
from moyai.core.errors import InputError
from moyai.core.headline import SEAS_LEFT_OUT
from moyai.core.progress import Progress, silent
from moyai.core.results import Result
from moyai.core.store import DatasetStore
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.checks import roll_notices
from moyai.sea.states import IrregularSea, RegularSea, SeaState
from moyai.structures.units.across import across_notices
from moyai.structures.units.anchors import anchored
from moyai.structures.units.assembly import RowAtLevel, assemble, level_notices, steady_load
from moyai.structures.units.bem import MeshPanels, panels_of
from moyai.structures.units.datasets import (
    hydrodynamics_dataset,
    irregular_dataset,
    map_dataset,
    regular_dataset,
    statics_dataset,
    with_damping_band,
)
from moyai.structures.units.doubts import curve_notices, meeting_notices, push_notices
from moyai.structures.units.field import map_points, wave_field
from moyai.structures.units.headlines import governing_seas, greatest_rolls, headlines_of
from moyai.structures.units.hydrodynamics import RowHydrodynamics, solve_row
from moyai.structures.units.mesh import row_mesh
from moyai.structures.units.model import DOFS, UnitSettings, UnitsProblem
from moyai.structures.units.outlines import check_apart
from moyai.structures.units.seas import (
    ENERGY_LEFT_OUT,
    SeaAnswer,
    columns_of,
    frequencies_of,
    headings_of,
    irregular_answer,
    regular_answer,
    spread_of,
)
from moyai.structures.units.section import SectionAnswer, comparable, section_answer
from moyai.structures.units.time.analysis import sea_in_time, water_in_time
from moyai.structures.units.time.band import ABOVE
from moyai.structures.units.time.damping import curves_matter, with_ends_in_time
from moyai.structures.units.variables import VOCABULARY, labelled
from moyai.structures.units.viscous import eddy_notices

if TYPE_CHECKING:
    import xarray as xr

#: Least wave length over the longest side of a panel: less is refused; below the second a notice is given
LEAST_PANELS, FEW_PANELS = 4.0, 6.0
#: Analyses that need the coefficients of the waves
WITH_WAVES = frozenset({"frequency", "map", "time"})
#: Accepted error of the energy balance, over the energy that meets the length of the row
BALANCE = 0.05


def row_panels(at: RowAtLevel, settings: UnitSettings, shortest: float) -> MeshPanels:
    """Return the panels of the row; lids inside of hulls where a standing wave in them comes near the band.

    Parameters
    ----------
    at : RowAtLevel
    settings : Settings
    shortest : float
        Highest frequency [rad/s].

    Raises
    ------
    InputError
        For units that overlap, gaps and waves that the panels do not resolve.
    """
    row = at.row
    mesh = row_mesh(
        at.section, row.length, row.placements, settings.panel_size,
        lid=shortest > 0.5 * irregular_frequency(at), gap_lid=row.gap_damping_lid > 0.0,
    )  # fmt: skip
    return panels_of(mesh, at.centres, row.gap_damping_lid)


def highest_frequency(omega: Array, settings: UnitSettings) -> float:
    """Return the highest frequency [rad/s] that panels meet: in time, of the band of the memory."""
    return float(omega.max()) * (ABOVE if "time" in settings.analyses else 1.0)


def irregular_frequency(at: RowAtLevel) -> float:
    """Return the lowest frequency [rad/s] of a standing wave inside of a hull, of a box [eq:units-irregular]."""
    breadth = at.section.waterplane_breadth
    k = math.pi * math.hypot(1.0 / breadth, 1.0 / at.row.length)
    return math.sqrt(at.water.gravity * k / math.tanh(k * at.draught))


def check_resolution(at: RowAtLevel, panels: MeshPanels, omega: Array) -> tuple[Notice, ...]:
    """Compare the panels with the shortest wave.

    Raises
    ------
    InputError
        When a wave is shorter than four panels.
    """
    from moyai.sea.dispersion import wave_number

    shortest = 2.0 * math.pi / float(wave_number(float(omega.max()), at.water.depth, at.water.gravity))
    side = panels.mesh.longest_side
    if shortest < LEAST_PANELS * side:
        raise InputError(
            f"the shortest wave, {shortest:.3g} m ({2.0 * math.pi / omega.max():.3g} s), is {shortest / side:.2g} "
            f"panels long (longest side {side:.3g} m)",
            parameter="settings.panel_size",
            allowed=f"panels of {shortest / LEAST_PANELS:.3g} m or less",
            remedy="give smaller panels, or leave the short waves out of the frequencies",
        )
    if shortest < FEW_PANELS * side:
        return (
            Notice(
                "few-panels", f"{at.name}: the shortest wave is {shortest / side:.2g} panels long", shortest / side,
                FEW_PANELS, remedy="give smaller panels and compare",
            ),
        )  # fmt: skip
    return ()


def run(problem: UnitsProblem, progress: Progress = silent, *, store: DatasetStore | None = None) -> Result:
    """Run all analyses of a row.

    Parameters
    ----------
    problem : UnitsProblem
    progress : Progress
        Called after every step; KeyboardInterrupt ends the run with what there is and the status ``interrupted``.
    store : DatasetStore or None
        Where coefficients and waves are kept, one file a frequency, and looked for.

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.

    Raises
    ------
    InputError
        When the case is impossible.
    """
    collected = Collected()
    collected.take(_steps(problem, collected, store, progress))
    seas = governing_seas(collected.groups)
    collected.notices.extend(across_notices(collected.groups))
    collected.notices.extend((*curve_notices(seas), *meeting_notices(collected.groups, seas)))
    collected.notices.extend(push_notices(collected.groups, seas))
    return _result(problem, collected)


def _steps(
    problem: UnitsProblem, collected: Collected, store: DatasetStore | None, progress: Progress
) -> Iterator[None]:
    environment = problem.environment
    check_apart(problem.row)
    levels = [assemble(problem.row, environment, name, level) for name, level in environment.water_levels]
    of_file = None
    if problem.coefficients is not None and WITH_WAVES & set(problem.settings.analyses):
        from moyai.structures.units.coefficients_file import read_row

        of_file = read_row(problem.coefficients)
    for index, at in enumerate(levels):
        progress("water levels", index, len(levels))
        yield from _level_steps(problem, at, of_file, collected, store, progress)
    progress("water levels", len(levels), len(levels))


def _level_steps(
    problem: UnitsProblem, at: RowAtLevel, of_file: xr.Dataset | None, collected: Collected,
    store: DatasetStore | None, progress: Progress,
) -> Iterator[None]:  # fmt: skip
    import xarray as xr

    root, settings, environment = f"/{at.name}", problem.settings, problem.environment
    collected.groups[root] = xr.Dataset(attrs={"water_level": at.level, "water_depth": at.water.depth})
    collected.notices.extend(level_notices(at))
    wind, current = steady_load(at, environment)
    collected.groups[f"{root}/statics"] = statics_dataset(at, wind, current)
    yield
    if not WITH_WAVES & set(settings.analyses) or not environment.sea_states:
        return
    omega, headings = frequencies_of(environment, settings), headings_of(environment)
    if of_file is None:
        panels = row_panels(at, settings, highest_frequency(omega, settings))
        collected.notices.extend(check_resolution(at, panels, omega))
        hydro = solve_row(panels, at.water, at.centres, omega, headings, store=store, progress=progress)
    else:
        from moyai.structures.units.coefficients_file import row_from_file

        found = row_from_file(of_file, at, omega, headings)
        hydro = found.hydro
        collected.notices.extend(replace(item, message=f"{at.name}: {item.message}") for item in found.notices)
        # what the file does not have moves nothing
        settings = replace(settings, drift=settings.drift and hydro.drift is not None)
        problem = replace(problem, settings=settings)
    collected.checks.extend(replace(check, name=f"{at.name}: {check.name}") for check in hydro.checks)
    collected.notices.extend(_notices(problem, at))
    collected.groups[f"{root}/hydrodynamics"] = hydrodynamics_dataset(at, hydro)
    yield
    answers: dict[str, list[SeaAnswer]] = {}
    # the same row with its damping at the ends of its band
    band = () if settings.nominal else at.row.damping_band
    others = [replace(at, row=at.row.damped(factor)) for factor in band]
    varied: dict[str, list[list[SeaAnswer]]] = {}

    def answer(row: RowAtLevel, sea: SeaState) -> list[SeaAnswer]:
        if isinstance(sea, RegularSea):
            return regular_answer(row, hydro, sea, wind + current, settings)
        return [irregular_answer(row, hydro, sea, wind + current, settings)]

    def numbers(row: RowAtLevel, sea: SeaState, found: list[SeaAnswer]) -> xr.Dataset:
        if isinstance(sea, RegularSea):
            return regular_dataset(row, sea, found, hydro)
        return irregular_dataset(row, sea, found[0])

    for sea in environment.sea_states:
        progress("seas", len(answers), len(environment.sea_states))
        answers[sea.name] = answer(at, sea)
        varied[sea.name] = [answer(row, sea) for row in others]
        data = with_damping_band(
            numbers(at, sea, answers[sea.name]),
            [numbers(row, sea, found) for row, found in zip(others, varied[sea.name], strict=True)],
        )
        data.attrs["drift"] = "mean" if settings.drift else "none"
        collected.groups[f"{root}/frequency/{sea.name}"] = data
        if data.attrs["status"] != "converged":
            collected.failures.append(f"not settled: {at.name}/frequency/{sea.name}")
        collected.checks.extend(_balance(at, sea, answers[sea.name], hydro))
        collected.notices.extend(() if "time" in settings.analyses else _curve_notices(at))
        yield
    progress("seas", len(answers), len(environment.sea_states))
    if "time" in settings.analyses:
        ends = {name: list(zip(others, found, strict=True)) for name, found in varied.items()}
        yield from _time_steps(problem, at, hydro, wind + current, (answers, ends), collected, store, progress)
    if "map" in settings.analyses:
        section = _section(problem, at, hydro, progress)
        points = map_points(problem.map_area, at)
        field = wave_field(points, hydro, store=store, progress=progress)
        for sea in environment.sea_states:
            collected.groups[f"{root}/map/{sea.name}"] = with_damping_band(
                map_dataset(at, hydro, sea, answers[sea.name], points, problem.map_area, field, section),
                [
                    map_dataset(row, hydro, sea, found, points, problem.map_area, field, None)
                    for row, found in zip(others, varied[sea.name], strict=True)
                ],
            )
        yield


def _time_steps(
    problem: UnitsProblem,
    at: RowAtLevel,
    hydro: RowHydrodynamics,
    steady: Array,
    answered: tuple[dict[str, list[SeaAnswer]], dict[str, list[tuple[RowAtLevel, list[SeaAnswer]]]]],
    collected: Collected,
    store: DatasetStore | None,
    progress: Progress,
) -> Iterator[None]:
    root, (answers, ends) = f"/{at.name}", answered
    water, data, checks, notices = water_in_time(at, hydro, steady, problem.settings, store=store, progress=progress)
    collected.checks.extend(checks)
    collected.notices.extend(notices)
    for name, item in data.items():
        collected.groups[f"{root}/{name}"] = item
    for sea in problem.environment.sea_states:
        found = sea_in_time(water, sea, answers[sea.name], progress)
        frequency = collected.groups[f"{root}/frequency/{sea.name}"]
        if found.status == "converged" and ends[sea.name] and curves_matter(at, frequency, found.groups[""]):
            found = with_ends_in_time(water, sea, found, ends[sea.name], progress)
        for end, item in found.groups.items():
            collected.groups[f"{root}/time/{sea.name}{end}"] = item
        collected.notices.extend(found.notices)
        if found.status == "interrupted":
            raise KeyboardInterrupt
        if found.status != "converged":
            collected.failures.append(f"{at.name}/time/{sea.name}: {found.message}")
        yield


def _section(
    problem: UnitsProblem, at: RowAtLevel, hydro: RowHydrodynamics, progress: Progress
) -> SectionAnswer | None:
    """Return the section in the headings of all seas that it stands for, NaN in others."""
    if not problem.settings.section_compare:
        return None
    each = [spread_of(sea, np.ones(1))[0] for sea in problem.environment.sea_states]
    wanted = [headings for headings in each if comparable(at, headings)]
    if not wanted:
        return None
    headings = np.unique(np.concatenate(wanted))
    return section_answer(at, hydro.omega, headings, progress).placed(columns_of(hydro, headings), len(hydro.headings))


def _balance(
    at: RowAtLevel, sea: RegularSea | IrregularSea, answers: list[SeaAnswer], hydro: RowHydrodynamics
) -> list[IdentityCheck]:
    """Compare what the far waves lose with what damping takes; the surface damped in gaps takes a part unknown here."""
    if at.row.gap_damping_lid > 0.0 or hydro.panels is None:
        return []
    worst = max(float(np.abs(item.far.balance).max()) for item in answers)
    return [
        IdentityCheck(
            f"{at.name}, {sea.name}: energy of the waves far away", worst, BALANCE,
            "what the waves lose is what damping takes, over the energy that meets the length of the row",
        )
    ]  # fmt: skip


def _curve_notices(at: RowAtLevel) -> list[Notice]:
    names = list(dict.fromkeys(j.connector.name for j in at.joints if j.connector.curve is not None))
    if not names:
        return []
    return [
        Notice(
            "linearised-connectors",
            f"{', '.join(names)}: slack, impact and curved force are taken by a linear stiffness of the same work; the "
            "largest loads are the curve at the largest elongation; impacts in time are not computed",
            severity="information",
        )
    ]


def _notices(problem: UnitsProblem, at: RowAtLevel) -> list[Notice]:
    out = []
    row = at.row
    if row.count > 1 and row.gap_damping_lid == 0.0 and problem.coefficients is None:
        out.append(
            Notice(
                "gaps-without-damping",
                "the water in the gaps between units has no damping: near its resonance the waves there are too high",
                severity="information",
                remedy="give a damping lid in the gaps and compare",
            )
        )
    if not problem.settings.drift:
        out.append(
            Notice(
                "drift-left-out",
                f"{at.name}: the drift of the waves is left out: offsets, tensions and closings of gaps are too low, "
                "on chains several times over in an irregular sea",
                severity="warning",
                remedy="do not switch the drift off; coefficients of a file need its drift",
            )
        )
    out.extend(replace(notice, message=f"{at.name}: {notice.message}") for notice in eddy_notices(at))
    surge = DOFS.index("surge")
    drifts = "time" in problem.settings.analyses and any(
        isinstance(sea, IrregularSea) for sea in problem.environment.sea_states
    )
    if row.viscous_factor and drifts and not row.damping_fraction[surge] and not row.linear_damping[surge]:
        out.append(
            Notice(
                "surge-without-damping",
                "edges along the units shed no eddies in surge: slow drift along the row has no damping but that of "
                "the waves, and its offsets are too large",
                remedy="give a fraction of critical damping in surge, or an additional damping",
            )
        )
    roll = DOFS.index("roll")
    if not row.damping_fraction[roll] and not row.linear_damping[roll] and not row.viscous_factor:
        out.append(
            Notice(
                "no-damping",
                "the units have no damping of roll but that of the waves they make: roll at resonance is too large",
                remedy="do not switch the viscous damping off, or give a fraction of critical in roll",
            )
        )
    if any(isinstance(sea, IrregularSea) for sea in problem.environment.sea_states):
        out.append(
            Notice(
                "short-waves-left-out",
                f"the shortest waves of irregular seas, {100.0 * ENERGY_LEFT_OUT:g} % of the energy, are left out",
                severity="information",
            )
        )
    return out


def _result(problem: UnitsProblem, collected: Collected) -> Result:
    attributes = {
        "structure": "units",
        "title": problem.title,
        "case_hash": problem.case_hash,
        "case_text": problem.case_text,
    }
    seeds = [
        int(seed)
        for data in collected.groups.values()
        if "seed_of_realisation" in data
        for seed in data["seed_of_realisation"].values
    ]
    for path, data in [*anchored(collected.groups)]:
        collected.groups[path] = labelled(data)
    found = headlines_of(collected.groups)
    rolls: list[Notice] = []
    for where, roll in greatest_rolls(governing_seas(collected.groups)):
        rest = collected.groups[f"/{where.split(', ')[0]}/statics"]
        sizes = {"freeboard": float(rest["freeboard"]), "draught": float(rest["draught"]), "beam": rest.attrs["beam"]}
        rolls += roll_notices(roll, where=where, **sizes)
    collected.notices.extend(most_severe(rolls))
    return collected.close(
        VOCABULARY,
        attributes,
        seeds,
        fulfilled="all identities hold and all iterations converged",
        headlines=found,
        criteria=problem.criteria,
        left_out=SEAS_LEFT_OUT
        if problem.environment.sea_states and not WITH_WAVES & set(problem.settings.analyses)
        else "",
    )


__all__ = ["check_resolution", "irregular_frequency", "row_panels", "run"]
