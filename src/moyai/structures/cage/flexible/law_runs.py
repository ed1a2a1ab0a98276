"""The governing waves of a flexible cage under the lowest and the highest valid law of nets, on the coarser mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.morison.net_law_base import NetLaw
from moyai.morison.net_law_choice import LawChoice
from moyai.structures.cage.flexible.build import build_cage, panel_law
from moyai.structures.cage.flexible.equilibrium import solve_rest
from moyai.structures.cage.flexible.laws import choice_of
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.problem import FlexibleSettings
from moyai.structures.cage.flexible.sensitivity import coarse_model, coarse_run, largest_numbers
from moyai.structures.cage.flexible.time import CageRun, drag_rows, go_on
from moyai.structures.cage.flexible.variables import described
from moyai.structures.cage.settling import BLOCK, BLOCKS, limit_of

if TYPE_CHECKING:
    import xarray as xr

#: Name of the groups of these runs.
IN_WAVES = "laws_in_waves"


@dataclass(eq=False)
class WaveCase:
    """A wave that was run: enough to run it again."""

    #: Of the water level in the result.
    root: str
    sea: str
    label: str
    model: FlexibleCage
    run: CageRun
    #: On the coarser mesh, where it was run already.
    coarse: CageRun | None = None
    #: In the current of the site, where there is one [N].
    drag_by_law: Mapping[str, float] | None = None

    @property
    def path(self) -> str:
        """Where its runs under other laws stand in the result."""
        return f"{self.root}/{IN_WAVES}/{self.sea}/{self.label}"


class Governing:
    """The wave with the worst of every number of the first page."""

    def __init__(self) -> None:
        self._worst: dict[str, tuple[float, WaveCase]] = {}

    def add(self, case: WaveCase, series: xr.Dataset) -> None:
        """Take a wave up where a number of it is the worst so far."""
        for name, value in worst_values(series, case.run).items():
            if name not in self._worst or value > self._worst[name][0]:
                self._worst[name] = value, case

    @property
    def cases(self) -> tuple[WaveCase, ...]:
        """Each governing wave once, in the order of the numbers."""
        return tuple(dict.fromkeys(case for _, case in self._worst.values()))


def worst_values(series: xr.Dataset, run: CageRun) -> dict[str, float]:
    """Return what decides which wave governs, larger being worse: volume lost, drag, lines, anchors, offset, net."""
    late = series["time"].values >= float(series.attrs["ramp"]) - 1e-9
    built = run.rest.built
    calm = np.array([built.network.nodes.position[cage.collar[0]].mean(axis=0) for cage in built.cages])
    moved = np.linalg.norm((series["collar_place"].values[late] - calm)[..., :2], axis=-1)
    found = {
        "volume": -float(series["volume_minimum"].values.min()),
        "drag": float(np.linalg.norm(series["drag"].values.sum(axis=1), axis=1).max()),
        "offset": float(moved.max()),
        "net": float(series["net_tension_peak_since_row"].values[late].max()),
    }
    if "utilisation" in series:
        found["lines"] = float(series["utilisation"].values.max())
        anchors = [number for number, part in enumerate(built.lines) if part.kind == "anchor"]
        if anchors:
            found["anchors"] = float(series["line_tension_maximum_lower"].values[anchors].max())
    if "collar_stress_largest" in series:
        found["stress"] = float(series["collar_stress_largest"].values[late].max())
    return found


def laws_in_wave(
    case: WaveCase, speed: float, settings: FlexibleSettings, progress: Progress = silent
) -> tuple[xr.Dataset, list[str]]:
    """Return the numbers of a wave under the law of the case, the lowest and the highest, and which of them failed.

    Runs in regular waves go on from the end of that under the law of the case for nine periods, which tell their limit;
    a sea is run again over the six periods about its governing moment, from the rest under each law. All on the coarser
    mesh: what counts is the ratio.

    Parameters
    ----------
    case : WaveCase
    speed : float
        At which laws are valid or not [m/s].
    settings : FlexibleSettings
    progress : Progress
    """
    choice = choice_of(case.model, speed)
    names, missing = [choice.chosen.name], [law.name for law in choice.others]
    base = _base(case, settings)
    if base is None:
        return _dataset(case, names, [_settled_numbers(case.model, case.run)], choice, missing), missing
    model, missing = coarse_model(case.model), []
    numbers = [_settled_numbers(model, base)]
    wanted = extreme_laws(case, model, base, choice)
    for number, law in enumerate(wanted):
        progress(f"laws of nets, {case.sea}", number, len(wanted))
        other = under(model, law)
        try:
            rest = solve_rest(other, build_cage(other), base.rest.current, start=base.rest.state)
            run = go_on(rest, base, settings)
        except (ConvergenceError, InputError):
            missing.append(law.name)
            continue
        if run.history.status == "interrupted":
            raise KeyboardInterrupt
        if run.history.status != "converged":
            missing.append(law.name)
            continue
        names.append(law.name)
        numbers.append(_settled_numbers(other, run))
    progress(f"laws of nets, {case.sea}", len(wanted), len(wanted))
    return _dataset(case, names, numbers, choice, missing), missing


def _base(case: WaveCase, settings: FlexibleSettings) -> CageRun | None:
    """Return the wave on the coarser mesh under the law of the case; None where that fails."""
    if case.coarse is None:
        try:
            case.coarse = coarse_run(case.model, case.run, settings)
        except (ConvergenceError, InputError):
            return None
    return case.coarse if case.coarse.history.status == "converged" else None


def _dataset(
    case: WaveCase, names: list[str], numbers: list[dict[str, float]], choice: LawChoice, missing: list[str]
) -> xr.Dataset:
    import xarray as xr

    return described(
        xr.Dataset(
            {"value": (("law", "quantity"), np.array([list(entry.values()) for entry in numbers]))},
            coords={"law": names, "quantity": list(numbers[0])},
            attrs={
                "wave": case.run.wave.name, "valid": choice.named, "reynolds": choice.reynolds,
                "missing": ", ".join(missing), "regular": int(case.run.wave.regular),
            },
        )
    )  # fmt: skip


def _settled_numbers(model: FlexibleCage, run: CageRun) -> dict[str, float]:
    """Return where the numbers of the last periods of regular waves lead, or those of a short sea."""
    if not run.wave.regular:
        return _numbers(model, run)
    end, whole = float(run.history.time[-1]), run.wave.period
    parts = [
        _numbers(model, part_of(run, end - (number + 1) * BLOCK * whole, end - number * BLOCK * whole))
        for number in reversed(range(BLOCKS))
    ]
    led = limit_of(np.array([list(part.values()) for part in parts]))
    return dict(zip(parts[0], (float(value) for value in led), strict=True))


def _numbers(model: FlexibleCage, run: CageRun) -> dict[str, float]:
    history, built = run.history, run.rest.built
    late = history.time >= run.ramp - 1e-9
    lines = {
        line_quantity(part.name): float(history.tension_peak[late][:, run.rest.network.strands[part.strand].bars].max())
        for part in built.lines
    }
    return {**largest_numbers(model, run), **lines}


def part_of(run: CageRun, begin: float, end: float) -> CageRun:
    """Return the rows of a run between two times [s]."""
    time = run.history.time
    rows = (time > begin - 1e-9) & (time <= end + 1e-9)
    history = replace(
        run.history, time=time[rows], position=run.history.position[rows], tension=run.history.tension[rows],
        tension_peak=run.history.tension_peak[rows],
    )  # fmt: skip
    return replace(run, history=history, ramp=float(time[rows][0]))


def extreme_laws(case: WaveCase, model: FlexibleCage, base: CageRun, choice: LawChoice) -> list[NetLaw]:
    """Return the laws other than that of the case that give least and most drag.

    At rest in the current of the site, which a net that gives way tells best; without a current on the net as it moves
    under the law of the case.

    Parameters
    ----------
    case : WaveCase
    model : FlexibleCage
        On the coarser mesh.
    base : CageRun
        Of that, under the law of the case.
    choice : LawChoice
    """
    if len(choice.others) < 3:
        return list(choice.others)
    laws, rest = (choice.chosen, *choice.others), base.rest
    if case.drag_by_law is not None:
        drags = [case.drag_by_law[law.name] for law in laws]
    else:
        own = rest.network.panels
        assert own is not None
        drags, history = [], base.history
        begin = float(history.time[-1]) - 6.0 * base.wave.period
        rows = np.flatnonzero(history.time >= begin)[:: max(1, round(base.wave.period / 12.0 / history.time[1]))]
        for law in laws:
            # the panels of the other law in the shelter of the one of the case
            panels = replace(own, laws=(panel_law(under(model, law)),))
            moved = replace(base, rest=replace(rest, network=replace(rest.network, panels=panels)))
            drags.append(float(np.linalg.norm(drag_rows(moved, rows).sum(axis=1), axis=1).max()))
    ends = dict.fromkeys((int(np.argmin(drags)), int(np.argmax(drags))))
    return [laws[number] for number in ends if number]


def line_quantity(name: str) -> str:
    """Return the quantity of one line."""
    return f"highest tension of {name} [N]"


def under(model: FlexibleCage, law: NetLaw) -> FlexibleCage:
    """Return a cage under another law."""
    return replace(model, design=replace(model.design, net=replace(model.design.net, law=law)))
