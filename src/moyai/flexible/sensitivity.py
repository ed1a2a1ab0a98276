"""The accuracy of a peak: the same run at half the step, on a finer mesh, with other viscosity."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network, check_network
from moyai.flexible.numbers import whole_number
from moyai.flexible.refine import more_viscous, refined, with_viscosity
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium


@dataclass(frozen=True)
class PeakSensitivity:
    """The highest tension of a bar and what it becomes when the discretisation or the viscosity changes."""

    #: Of the run itself [N].
    peak: float
    #: Highest tension at the same place with half the step [N].
    half_step: float
    #: Highest tension at the same place with every bar cut in two [N].
    double_mesh: float
    #: Highest tension at the same place with half the viscosity [N].
    half_viscosity: float
    #: Highest tension at the same place with twice the viscosity [N]; of a network without any, with a twentieth of
    #: critical damping on the mesh.
    double_viscosity: float
    #: Time step of the run itself [s].
    step: float
    #: On a finer mesh whose bars are damped by a part of critical [N]; NaN where it was not run. Fronts on undamped
    #: bars overshoot by a part that no finer mesh takes away.
    damped: float = math.nan
    #: With every bar cut in ``factor`` [N]; NaN where no such mesh was run.
    finest: float = math.nan
    factor: int = 1
    #: The same of the pull on fixed points, by their names; empty where it was not looked at.
    pulls: Mapping[str, PeakSensitivity] = field(default_factory=dict)
    #: The same of every line and net, by their names; empty where only the peak itself was looked at.
    lines: Mapping[str, PeakSensitivity] = field(default_factory=dict)
    #: The same of the pull of nets on what holds them, by their names.
    held: Mapping[str, PeakSensitivity] = field(default_factory=dict)

    @property
    def discretisation_error(self) -> float:
        """Relative change with step and mesh together, without viscosity [-]."""
        return self._change(self.half_step) + self._change(self.double_mesh)

    @property
    def viscosity_effect(self) -> float:
        """Largest relative change when the viscosity is halved or doubled [-]."""
        return max(self._change(self.half_viscosity), self._change(self.double_viscosity))

    def _change(self, other: float) -> float:
        """Return the relative change of the peak; of a bar that stays slack none, or all."""
        if self.peak == 0.0:
            return 0.0 if other == 0.0 else math.inf
        return abs(other / self.peak - 1.0)

    def notices(self, limit: float = 0.02) -> tuple[Notice, ...]:
        """Tell, with the other peaks, when the peak moves by more than ``limit`` with the discretisation.

        Parameters
        ----------
        limit : float
            Change over the peak that is passed over [-].

        Returns
        -------
        tuple of Notice
            Empty within the limit.
        """
        if self.discretisation_error <= limit:
            return ()

        def of(peak: float) -> str:
            return spoken(peak, "N", like=self.peak)

        by_step = self._change(self.half_step) > self._change(self.double_mesh)
        return (
            Notice(
                "peak-not-converged",
                f"the peak of {of(self.peak)} is {of(self.half_step)} with half the step and {of(self.double_mesh)} "
                f"with bars of half the length: {100 * self.discretisation_error:.1f} % together "
                f"({of(self.half_viscosity)} and {of(self.double_viscosity)} with half and twice the viscosity)",
                self.discretisation_error,
                limit,
                "warning",
                "bars that go slack and taut without viscosity end in one of many motions, which the step chooses: "
                "give the line the viscosity that it has [N s]"
                if by_step
                else "use more segments, or the pace of the elastic wave (safety=1) when a wave front makes the peak",
            ),
        )


def refined_start(
    network: Network, factor: int, start: State | None, equilibrium_flow: Flow | None
) -> tuple[Network, State]:
    """Return a finer mesh and where a run on it starts.

    A run from rest starts from the equilibrium of the finer mesh itself: places between those of the given mesh are
    none there, and the jolt would count as an effect of the mesh.

    Parameters
    ----------
    network : Network
    factor : int
        Into how many every bar is cut.
    start : State or None
        On the given mesh.
    equilibrium_flow : Flow or None
        In which ``start`` is at rest; ``None`` where it is none.
    """
    finer, state = refined(network, factor, start)
    if equilibrium_flow is None:
        return finer, state
    try:
        return finer, replace(solve_equilibrium(finer, flow=equilibrium_flow, start=state).state, time=state.time)
    except ConvergenceError:
        return finer, state


def peak_sensitivity(
    network: Network,
    motions: Mapping[str, Motion] | None = None,
    *,
    bar: int,
    after: float = 0.0,
    start: State | None = None,
    equilibrium_flow: Flow | None = None,
    progress: Progress = silent,
    **options: Any,
) -> PeakSensitivity:
    """Run a network five times and compare the highest tension of one bar [eq:flexible-bar].

    Parameters
    ----------
    network : Network
        The network.
    motions : mapping of str to Motion, optional
        As in :func:`moyai.flexible.simulation.simulate`.
    bar : int
        The bar; on the finer mesh the tension is that of its first or last half, whichever is nearer to the end of its
        strand.
    after : float
        Only peaks after this time since the start count [s].
    start : State, optional
        As built, without speed, when left out.
    equilibrium_flow : Flow, optional
        In which ``start`` is in equilibrium: the finer mesh then starts from its own equilibrium in it.
    progress : Progress
        Called with the number of the run.
    **options
        Further arguments of ``simulate``; ``duration`` and ``output_step`` among them.

    Returns
    -------
    PeakSensitivity
        Highest tension [N] of the run itself, with half the step, double the mesh, half and twice the viscosity.

    Raises
    ------
    InputError
        For an unknown bar, or an ``after`` that lies outside the run.
    ConvergenceError
        When one of the runs had to stop.

    Examples
    --------
    >>> from moyai.flexible import BarType, NetworkBuilder, peak_sensitivity, solve_equilibrium
    >>> from moyai.sea import Water
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> rope = BarType("rope", mass_per_length=10.0, axial_stiffness=1e5, diameter=0.05)
    >>> builder.fixed("left", (0.0, 0.0, -2.0))
    >>> builder.fixed("right", (20.0, 0.0, -2.0))
    >>> builder.line("span", "left", "right", rope, length=21.0, segments=10)
    >>> network = builder.build()
    >>> start = solve_equilibrium(network).state
    >>> found = peak_sensitivity(network, bar=0, start=start, duration=0.2, output_step=0.1)
    >>> abs(found.half_step / found.peak - 1.0) < 1e-3                   # the step matters little
    True
    """
    check_network(network)
    bar = whole_number(bar, "bar", least=0)
    if not bar < len(network.bars):
        raise InputError(f"bar {bar}", parameter="bar", allowed=f"0 to {len(network.bars) - 1}")
    if not 0.0 <= after < options.get("duration", math.inf):
        raise InputError(
            f"peaks count after {after:g} s of a run of {options['duration']:g} s"
            if "duration" in options
            else f"peaks count after {after:g} s",
            parameter="after",
            allowed="0 or more, less than the duration",
        )
    last = any(strand.bars[-1] == bar and strand.bars.size > 1 for strand in network.strands)

    def peak(number: int, which: str, mesh: Network, begin: State | None, own: int, **more: Any) -> tuple[float, float]:
        def heard(what: str, done: float, total: float) -> None:
            progress("sensitivity", number + done / total, 5)

        chosen_options = {**options, **more, "keep_nodes": [0], "keep_bars": [own], "progress": heard}
        history = simulate(mesh, motions, start=begin, **chosen_options)
        if mesh is not network and any(notice.code == "step-not-stable" for notice in history.notices):
            # a step given by hand need not suit a finer mesh or more viscosity
            history = simulate(mesh, motions, start=begin, **{**chosen_options, "step": None})
        if history.status == "interrupted":
            raise KeyboardInterrupt
        if history.status != "converged":
            raise ConvergenceError(f"run with {which}: {history.message}", parameter="sensitivity")
        chosen = history.time >= history.time[0] + after
        progress("sensitivity", number + 1, 5)
        return float(np.max(history.tension_peak[chosen, 0])), history.step

    first, step = peak(0, "the given step and mesh", network, start, bar)
    half, _ = peak(1, "half the step", network, start, bar, step=0.5 * step)
    finer, state = refined_start(network, 2, start, equilibrium_flow)
    # a step given by hand is the longest that is stable on the given mesh
    shorter = {} if options.get("step") is None else {"step": 0.5 * options["step"]}
    mesh, _ = peak(2, "half the mesh", finer, state, 2 * bar + (1 if last else 0), **shorter)
    less, _ = peak(3, "half the viscosity", with_viscosity(network, 0.5), start, bar)
    more, _ = peak(4, "twice the viscosity", more_viscous(network), start, bar)
    return PeakSensitivity(first, half, mesh, less, more, step)
