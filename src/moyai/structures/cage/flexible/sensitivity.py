"""Uncertainty of the peaks of a flexible cage: the same sea with another step, mesh and damping."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.at_once import each_at_once
from moyai.core.progress import Progress, silent
from moyai.structures.cage.flexible.build import build_cage
from moyai.structures.cage.flexible.equilibrium import (
    CageEquilibrium,
    collar_forces,
    horizontal_balance,
    solve_cage_equilibrium,
)
from moyai.structures.cage.flexible.grid_mooring import GridMooring
from moyai.structures.cage.flexible.model import CageMesh, FlexibleCage
from moyai.structures.cage.flexible.problem import FlexibleSettings
from moyai.structures.cage.flexible.time import CageRun, drag_rows, run_cage
from moyai.structures.cage.rigid.waves import RigidCageWave
from moyai.structures.cage.settling import BLOCK

if TYPE_CHECKING:
    import xarray as xr

#: Name of the group of a cage at rest.
REST = "at rest"
#: What is changed, in the order of the result.
COARSER = "coarser mesh"
VARIANTS = ("as given", "half the step", COARSER, "twice the damping of the mesh")
#: Quantities that the first page moves with the mesh; tensions are those of each kind of line.
OFFSET, LEAST_VOLUME, STRESS, DRAG = (
    "largest offset of a collar [m]", "smallest volume share [-]", "highest stress of the collar [Pa]",
    "largest drag [N]",
)  # fmt: skip
VOLUME_IN_CURRENT, DRAG_IN_CURRENT = "volume share in the current [-]", "drag in the current [N]"
NET_TENSION, NET_TENSION_IN_CURRENT = "highest tension of the net [N/m]", "tension of the net in the current [N/m]"


#: Kinds of line.
KINDS = ("anchor", "bridle", "frame", "buoy")


def coarser(mesh: CageMesh, sinkers: int = 1) -> CageMesh:
    """Return a mesh that is coarser by a third, around up to a half or not at all so that each sinker has a knot."""
    every = math.lcm(4, sinkers)
    kept = [around for around in range(every, mesh.around, every) if 0.5 <= around / mesh.around <= 0.75]
    around = min(kept, key=lambda count: abs(count - mesh.around * 2.0 / 3.0), default=0)
    around = max(8, around or 4 * round(mesh.around * 2.0 / 3.0 / 4.0))
    around = mesh.around if sinkers > around else around
    return CageMesh(
        around, max(1, round(mesh.down * 2 / 3)), max(1, round(mesh.bottom * 2 / 3)), 1.5 * mesh.rope_length
    )


def _damped(model: FlexibleCage) -> FlexibleCage:
    net = replace(model.design.net, damping=2.0 * model.design.net.damping)
    mooring = model.mooring
    if isinstance(mooring, GridMooring):
        mooring = replace(mooring, damping=2.0 * mooring.damping)
    return replace(model, design=replace(model.design, net=net), mooring=mooring)


def tension_of(kind: str) -> str:
    """Return the quantity of a kind of line: anchor, bridle, frame or buoy."""
    return f"highest tension, {kind} [N]"


def largest_numbers(model: FlexibleCage, run: CageRun, most_rows: int = 100) -> dict[str, float]:
    """Return the highest tension of each kind of line, the smallest volume and the highest stress."""
    history, built = run.history, run.rest.built
    steady = history.time >= run.ramp - 1e-9
    out = {}
    for kind in KINDS:
        bars = [built.network.strands[part.strand].bars for part in built.lines if part.kind == kind]
        if bars:
            out[tension_of(kind)] = float(history.tension_peak[steady][:, np.concatenate(bars)].max())
    volume = [cage.volume(history.position[steady]) / cage.rest_volume for cage in built.cages]
    out[LEAST_VOLUME] = float(np.min(volume))
    calm = built.network.nodes.position
    moved = [
        np.linalg.norm((history.position[steady][:, cage.collar[0]] - calm[cage.collar[0]]).mean(axis=1)[:, :2], axis=1)
        for cage in built.cages
    ]
    out[OFFSET] = float(np.max(moved))
    out[NET_TENSION] = float(built.net_tension(history.tension_peak[steady]).max())
    out |= _in_current(run.rest)
    out[DRAG] = _largest_drag(run)
    if built.cages[0].collar_bars and not model.design.collar.rigid:
        rows = np.flatnonzero(steady)[:: max(1, int(steady.sum()) // most_rows)]
        out[STRESS] = float(
            max(
                ring["stress"].max()
                for row in rows
                for rings in collar_forces(model, run.rest, history.position[row], history.tension[row])
                for ring in rings
            )
        )
    return out


def _largest_drag(run: CageRun) -> float:
    """Return the largest drag of all parts, of regular waves in the last periods [N]."""
    time, period = run.history.time, run.wave.period
    begin = max(run.ramp, float(time[-1]) - BLOCK * period) if run.wave.regular else run.ramp
    rows = np.flatnonzero(time >= min(begin, float(time[-1])) - 1e-9)
    rows = rows[:: max(1, round(period / 12.0 * (time.size - 1) / max(float(np.ptp(time)), 1e-9)))]
    return float(np.linalg.norm(drag_rows(run, rows).sum(axis=1), axis=1).max())


def _in_current(rest: CageEquilibrium) -> dict[str, float]:
    """Return volume, drag and tension of the net of a cage at rest in a current."""
    place, cages = rest.state.position, rest.built.cages
    return {
        VOLUME_IN_CURRENT: float(np.min([cage.volume(place) / cage.rest_volume for cage in cages])),
        NET_TENSION_IN_CURRENT: float(rest.built.net_tension(rest.tension).max()),
        DRAG_IN_CURRENT: float(np.linalg.norm(horizontal_balance(rest)[0].sum(axis=0)[:2])),
    }


def rest_mesh_dataset(model: FlexibleCage, rest: CageEquilibrium) -> xr.Dataset:
    """Return the numbers at rest on the mesh of the case and on one that is coarser by a third.

    Parameters
    ----------
    model : FlexibleCage
    rest : CageRest
        As the case gives it.
    """
    other = coarse_model(model)
    again = solve_cage_equilibrium(other, build_cage(other), rest.current)
    return _dataset((VARIANTS[0], COARSER), [_at_rest(model, rest), _at_rest(other, again)])


def _at_rest(model: FlexibleCage, rest: CageEquilibrium) -> dict[str, float]:
    """Return volume, drag, net, the highest tension of each kind of line, offset and stress at rest in a current."""
    place, built = rest.state.position, rest.built
    out = _in_current(rest)
    for kind in KINDS:
        bars = [built.network.strands[part.strand].bars for part in built.lines if part.kind == kind]
        if bars:
            out[tension_of(kind)] = float(rest.tension[np.concatenate(bars)].max())
    calm = built.network.nodes.position
    rings = [cage.collar[0] for cage in built.cages]
    out[OFFSET] = max(float(np.linalg.norm((place[own] - calm[own]).mean(axis=0)[:2])) for own in rings)
    if built.cages[0].collar_bars and not model.design.collar.rigid:
        forces = collar_forces(model, rest, place, rest.tension)
        out[STRESS] = max(float(ring["stress"].max()) for rings in forces for ring in rings)
    return out


def sensitivity_dataset(
    model: FlexibleCage,
    rest: CageEquilibrium,
    wave: RigidCageWave,
    settings: FlexibleSettings,
    progress: Progress = silent,
) -> xr.Dataset:
    """Run one wave with half the step, a coarser mesh and more damping; return peaks of each run.

    Parameters
    ----------
    model : FlexibleCage
    rest : CageRest
        In the current of the site.
    wave : Wave
    settings : FlexibleSettings
    progress : Progress
    """
    short = replace(settings, ramp_periods=min(settings.ramp_periods, 2.0))
    found: list[dict[str, float]] = []
    first = run_cage(model, rest, wave, short)
    found.append(largest_numbers(model, first))
    progress("sensitivity", 1, len(VARIANTS))
    found.append(largest_numbers(model, run_cage(model, rest, wave, short, step=0.5 * first.history.step)))
    for number, other in enumerate((coarse_model(model), _damped(model))):
        progress("sensitivity", 2 + number, len(VARIANTS))
        start = solve_cage_equilibrium(other, build_cage(other), rest.current)
        found.append(largest_numbers(other, run_cage(other, start, wave, short)))
    progress("sensitivity", len(VARIANTS), len(VARIANTS))
    return _dataset(VARIANTS, found, first)


def coarse_model(model: FlexibleCage) -> FlexibleCage:
    """Return a cage on a mesh that is coarser by a third."""
    sinkers = model.design.sinkers
    return replace(model, mesh=coarser(model.mesh, 1 if sinkers is None else sinkers.count))


def coarse_run(model: FlexibleCage, run: CageRun, settings: FlexibleSettings, progress: Progress = silent) -> CageRun:
    """Return the run of a cage on the coarser mesh through the wave of another run, as long as that.

    Parameters
    ----------
    model : FlexibleCage
        As the case gives it.
    run : CageRun
        Of a sea the first six periods are run, or those that its wave is (:func:`governing_part`).
    settings : FlexibleSettings
    progress : Progress
    """
    other = coarse_model(model)
    wave = run.wave if run.wave.regular else governing_part(run)
    rest = solve_cage_equilibrium(other, build_cage(other), run.rest.current)
    return run_cage(other, rest, wave, settings, progress=progress)


def governing_part(run: CageRun) -> RigidCageWave:
    """Return the six periods of a sea about the highest use of a line, as a wave that begins with them.

    Without lines those about the highest surface over the middle; a sea of six periods is returned as it is.
    """
    wave, history, built = run.wave, run.history, run.rest.built
    length = 6.0 * wave.period
    if wave.duration <= length * (1.0 + 1e-9):
        return wave
    late = history.time >= run.ramp - 1e-9
    if built.lines:
        used = [
            history.tension_peak[late][:, run.rest.network.strands[part.strand].bars].max(axis=1) / part.breaking_load
            for part in built.lines
        ]
        measure = np.max(used, axis=0)
    else:
        measure = np.asarray(wave.components.elevation(history.time[late]))
    moment = float(history.time[late][int(np.argmax(measure))])
    shift = min(max(moment - run.ramp - 5.0 * wave.period, 0.0), wave.duration - length)
    parts = wave.components
    return replace(wave, components=replace(parts, phase=parts.phase - parts.omega * shift), duration=length)


def mesh_dataset(
    model: FlexibleCage,
    run: CageRun,
    settings: FlexibleSettings,
    progress: Progress = silent,
    coarse: CageRun | BaseException | None = None,
) -> tuple[xr.Dataset, CageRun]:
    """Run the wave of a run on a mesh that is coarser by a third; return the numbers of both, and that run.

    Of an irregular sea both are run over the six periods about its governing moment.

    Parameters
    ----------
    model : FlexibleCage
    run : CageRun
        As the case gives it.
    settings : FlexibleSettings
    progress : Progress
    coarse : CageRun or exception, optional
        Run on the coarser mesh, or why it failed, where it was tried already.

    Raises
    ------
    ConvergenceError, InputError
        When the coarser mesh fails.
    """
    if isinstance(coarse, BaseException):
        raise coarse
    if coarse is None:
        whole = run

        def on_mesh(coarser: bool, heard: Progress) -> CageRun:
            if coarser:
                return coarse_run(model, whole, settings, heard)
            if whole.wave.regular:
                return whole
            return run_cage(model, whole.rest, governing_part(whole), settings, progress=heard)

        run, coarse = each_at_once(on_mesh, (False, True), progress)
    if "interrupted" in (run.history.status, coarse.history.status):
        raise KeyboardInterrupt
    progress("coarser mesh", 1.0, 1.0)
    numbers = [largest_numbers(model, run), largest_numbers(coarse_model(model), coarse)]
    return _dataset((VARIANTS[0], COARSER), numbers, run), coarse


def _dataset(variants: tuple[str, ...], found: list[dict[str, float]], first: CageRun | None = None) -> xr.Dataset:
    import xarray as xr

    names = list(found[0])
    values = np.array([[numbers[name] for name in names] for numbers in found])
    return xr.Dataset(
        {"value": (("variant", "quantity"), values, {"units": "1", "long_name": "see the quantity"})},
        coords={"variant": list(variants), "quantity": names},
        attrs={} if first is None else {"wave": first.wave.name, "step": first.history.step},
    )
