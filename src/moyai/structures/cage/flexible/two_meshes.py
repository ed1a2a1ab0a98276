"""Regular waves on two meshes at once: the coarser mesh goes on as long as the run of the case does."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable

from moyai.core.arrays import Array
from moyai.core.at_once import at_once
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.structures.cage.flexible.build import build_cage
from moyai.structures.cage.flexible.equilibrium import CageEquilibrium, solve_cage_equilibrium
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.problem import FlexibleSettings
from moyai.structures.cage.flexible.sensitivity import coarse_model
from moyai.structures.cage.flexible.time import CageRun, Settling, run_cage
from moyai.structures.cage.rigid.waves import RigidCageWave

#: Seconds between two looks for Ctrl-C of a run that waits.
_LOOK = 0.1


class _Length:
    """How long the run of the case is: as far as it has come, and at its end."""

    def __init__(self) -> None:
        self._reached, self._ended = 0.0, False
        self._changed = threading.Condition()

    def reached(self, time: float, *, ended: bool = False) -> None:
        """Say how far the run has come [s], or where it ended."""
        with self._changed:
            self._reached, self._ended = time, self._ended or ended
            self._changed.notify_all()

    def is_enough(self, time: float, waiting: Callable[[], None]) -> bool:
        """Wait until the run has come as far as ``time`` [s] or ended; return whether it goes no further."""
        with self._changed:
            while not self._ended and self._reached < time + 1e-9:
                waiting()
                self._changed.wait(_LOOK)
            # NaN: the run has failed
            return self._ended and not time < self._reached - 1e-9


def run_on_two_meshes(
    model: FlexibleCage,
    rest: CageEquilibrium,
    wave: RigidCageWave,
    settings: FlexibleSettings,
    progress: Progress = silent,
) -> tuple[CageRun, CageRun | BaseException | None]:
    """Run regular waves until their periods repeat, on the mesh of the case and on one that is coarser by a third.

    Parameters
    ----------
    model : FlexibleCage
    rest : CageRest
    wave : Wave
        Regular.
    settings : FlexibleSettings
    progress : Progress

    Returns
    -------
    CageRun
        Of the case; interrupted where the user stopped it.
    CageRun, exception or None
        On the coarser mesh, or why it failed or was stopped; ``None`` where the run of the case did not converge.
    """
    length, settled = _Length(), Settling(rest, wave, settings)
    runs: list[CageRun] = []
    others: list[CageRun | BaseException] = []

    def ends(time: Array, position: Array, peak: Array) -> bool:
        length.reached(float(time[-1]))
        return settled(time, position, peak)

    def run(heard: Progress) -> None:
        end = math.nan
        try:
            runs.append(run_cage(model, rest, wave, settings, enough=ends, progress=heard))
            end = float(runs[0].history.time[-1])
        finally:
            length.reached(end, ended=True)

    def follow(heard: Progress) -> None:
        longest = wave.period * (settings.ramp_periods + max(settings.periods, settings.most_periods))

        def told(what: str, done: float, total: float) -> None:
            heard("coarser mesh", done, total)

        def as_long(time: Array, *_: Array) -> bool:
            reached = float(time[-1])
            return length.is_enough(reached, lambda: told("", reached, longest))

        try:
            other = coarse_model(model)
            begun = solve_cage_equilibrium(other, build_cage(other), rest.current)
            others.append(run_cage(other, begun, wave, settings, enough=as_long, progress=told))
        except (ConvergenceError, InputError) as error:
            others.append(error)

    try:
        at_once(lambda number, heard: (run, follow)[number](heard), 2, progress)
    except KeyboardInterrupt as error:
        if not runs:
            raise
        others[:] = [error]
    return runs[0], others[0] if runs[0].history.status == "converged" else None


__all__ = ["run_on_two_meshes"]
