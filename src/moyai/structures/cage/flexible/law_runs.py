"""The governing waves of a flexible cage under the lowest and the highest valid law of nets, on the coarser mesh."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.at_once import each_at_once
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.flexible.flow import Current
from moyai.morison.net_law_base import NetLaw
from moyai.morison.net_law_choice import LawChoice
from moyai.sea.current import uniform
from moyai.structures.cage.flexible.build import build_cage
from moyai.structures.cage.flexible.equilibrium import horizontal_balance, solve_cage_equilibrium
from moyai.structures.cage.flexible.laws import choice_of
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.problem import FlexibleSettings
from moyai.structures.cage.flexible.sensitivity import coarse_model, coarse_run, largest_numbers
from moyai.structures.cage.flexible.time import CageRun, go_on
from moyai.structures.cage.flexible.variables import described
from moyai.structures.cage.settling import BLOCKS, LAW_BLOCK, limit_of

if TYPE_CHECKING:
    import xarray as xr

#: Name of the groups of these runs.
IN_WAVES = "laws_in_waves"


@dataclass(frozen=True, eq=False)
class WaveCase:
    """A wave that was run: enough to run it again."""

    #: Of the water level in the result.
    root: str
    sea: str
    label: str
    model: FlexibleCage
    run: CageRun

    @property
    def path(self) -> str:
        """Where its runs under other laws stand in the result."""
        return f"{self.root}/{IN_WAVES}/{self.sea}/{self.label}"


class GoverningWaves:
    """The wave with the worst of every number of the first page."""

    def __init__(self) -> None:
        self._worst: dict[str, tuple[float, WaveCase]] = {}
        self._coarse: dict[str, CageRun] = {}

    def add(self, case: WaveCase, series: xr.Dataset) -> None:
        """Take a wave up where a number of it is the worst so far."""
        for name, value in worst_values(series, case.run).items():
            if name not in self._worst or value > self._worst[name][0]:
                self._worst[name] = value, case

    def keep(self, case: WaveCase, coarse: CageRun) -> None:
        """Keep the run of a wave on the coarser mesh as long as the wave governs."""
        self._coarse[case.path] = coarse
        paths = {one.path for one in self.cases}
        self._coarse = {path: run for path, run in self._coarse.items() if path in paths}

    def coarse_of(self, case: WaveCase) -> CageRun | None:
        """Return the run of a wave on the coarser mesh, where there was one."""
        return self._coarse.get(case.path)

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
        found["anchors"] = float(series["anchor_tension_maximum"].values.max())
    if "collar_stress_largest" in series:
        found["stress"] = float(series["collar_stress_largest"].values[late].max())
    return found


def laws_in_wave(
    case: WaveCase,
    speed: float,
    settings: FlexibleSettings,
    coarse: CageRun | None = None,
    drag_by_law: Mapping[str, float] | None = None,
    progress: Progress = silent,
) -> tuple[xr.Dataset, list[str]]:
    """Return the numbers of a wave under the law of the case, the lowest and the highest, and which of them failed.

    Runs in regular waves go on from the end of that under the law of the case for six periods, which give their limit;
    a sea is run again over the six periods about its governing moment, from the rest under each law. All on the coarser
    mesh: what counts is the ratio.

    Parameters
    ----------
    case : WaveCase
    speed : float
        At which laws are valid or not [m/s].
    settings : FlexibleSettings
    coarse : CageRun, optional
        Of the wave on the coarser mesh, where it was run already.
    drag_by_law : mapping of str to float, optional
        In the current of the site, where there is one [N].
    progress : Progress
    """
    choice = choice_of(case.model, speed)
    names, missing = [choice.chosen.name], [law.name for law in choice.others]
    base = coarse or _base(case, settings)
    if base is None or base.history.status != "converged":
        return _dataset(case, names, [_settled_numbers(case.model, case.run)], choice, missing), missing
    model, missing = coarse_model(case.model), []
    numbers = [_settled_numbers(model, base)]
    begun, wanted = base, extreme_laws(model, base, choice, drag_by_law)

    def run_under(law: NetLaw, heard: Progress) -> dict[str, float] | None:
        other = under(model, law)
        try:
            rest = solve_cage_equilibrium(other, build_cage(other), begun.rest.current, start=begun.rest.state)
            run = go_on(rest, begun, settings, heard)
        except (ConvergenceError, InputError):
            return None
        if run.history.status == "interrupted":
            raise KeyboardInterrupt
        return _settled_numbers(other, run) if run.history.status == "converged" else None

    for law, found in zip(wanted, each_at_once(run_under, wanted, progress), strict=True):
        if found is None:
            missing.append(law.name)
        else:
            names.append(law.name)
            numbers.append(found)
    return _dataset(case, names, numbers, choice, missing), missing


def _base(case: WaveCase, settings: FlexibleSettings) -> CageRun | None:
    """Return the wave on the coarser mesh under the law of the case; None where that fails."""
    try:
        return coarse_run(case.model, case.run, settings)
    except (ConvergenceError, InputError):
        return None


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
    if end - max(run.ramp, float(run.history.time[0])) < (BLOCKS * LAW_BLOCK - 0.5) * whole:
        return _numbers(model, run)
    parts = [
        _numbers(model, part_of(run, end - (number + 1) * LAW_BLOCK * whole, end - number * LAW_BLOCK * whole))
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
    # the stress at twelve rows a period, or the hundred of a short sea
    return {**largest_numbers(model, run, 12 * LAW_BLOCK if run.wave.regular else 100), **lines}


def part_of(run: CageRun, begin: float, end: float) -> CageRun:
    """Return the rows of a run between two times [s]."""
    time = run.history.time
    rows = (time > begin - 1e-9) & (time <= end + 1e-9)
    history = replace(
        run.history, time=time[rows], position=run.history.position[rows], tension=run.history.tension[rows],
        tension_peak=run.history.tension_peak[rows],
    )  # fmt: skip
    return replace(run, history=history, ramp=float(time[rows][0]))


def extreme_laws(
    model: FlexibleCage, base: CageRun, choice: LawChoice, known: Mapping[str, float] | None
) -> list[NetLaw]:
    """Return the laws other than that of the case that give least and most drag on a net that gives way.

    At rest in the current of the site; without one in a current of half the speed of the water in the wave.

    Parameters
    ----------
    model : FlexibleCage
        On the coarser mesh.
    base : CageRun
        Of that, under the law of the case.
    choice : LawChoice
    known : mapping of str to float, optional
        Drag by the name of the law in the current of the site [N].
    """
    if len(choice.others) < 3:
        return list(choice.others)
    laws = (choice.chosen, *choice.others)
    if known is not None:
        drags = [known[law.name] for law in laws]
    else:
        wave = base.wave
        flow = uniform(0.5 * math.pi * wave.height / wave.period, float(wave.components.heading[0]))
        try:
            drags = [_drag_at_rest(under(model, law), flow, base) for law in laws]
        except ConvergenceError:
            by_law = dict(zip(choice.laws, choice.drags, strict=True))
            drags = [by_law.get(law, choice.drag) for law in laws]
    ends = dict.fromkeys((int(np.argmin(drags)), int(np.argmax(drags))))
    return [laws[number] for number in ends if number]


def _drag_at_rest(model: FlexibleCage, flow: Current, base: CageRun) -> float:
    rest = solve_cage_equilibrium(model, build_cage(model), flow, start=base.rest.state)
    return float(np.linalg.norm(horizontal_balance(rest)[0].sum(axis=0)[:2]))


def line_quantity(name: str) -> str:
    """Return the quantity of one line."""
    return f"highest tension of {name} [N]"


def under(model: FlexibleCage, law: NetLaw) -> FlexibleCage:
    """Return a cage under another law."""
    return replace(model, design=replace(model.design, net=replace(model.design.net, law=law)))
