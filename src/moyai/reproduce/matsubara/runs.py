"""Runs of the paper: the model cage on taut and on slack lines, and a panel of net in waves."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import each_counted
from moyai.core.progress import Progress, silent
from moyai.core.vocabulary import LINE_TENSION_PEAK_SINCE_ROW
from moyai.morison.net_laws.matsubara import Matsubara
from moyai.reproduce.inputs import problem_of, run_problem
from moyai.sea.dispersion import wave_number
from moyai.sea.kinematics import depth_functions
from moyai.structures.cage.rigid.model import RigidCageProblem, RigidCageWaves
from moyai.tables.nets import matsubara_net

if TYPE_CHECKING:
    from moyai.core.results import Result

NETS = tuple("ABCDEFGHIJ")
VISCOSITY, DENSITY, DEPTH, GRAVITY = 1.14e-6, 1000.0, 0.45, 9.81
GRAM = 9.81e-3  # N in a gram-force
TAUT_PERIOD, SLACK_PERIOD, HEIGHT = 1.1, 1.2, 0.03
SHORE, OFFSHORE = "shore", "offshore"


@dataclass(frozen=True)
class CageWave:
    """What one wave does to the cage."""

    #: [s].
    period: float
    #: [m].
    height: float
    #: Of the last two periods, from 0 [s].
    time: Array
    #: Sway from rest [m].
    sway: Array
    #: Heave from rest [m].
    heave: Array
    #: From rest [rad].
    rotation: Array
    #: At the cage, by side [N].
    tension: dict[str, Array]
    #: Largest tension of the last ten periods, by side [N].
    peak: dict[str, float]
    #: Phase of sway after heave [rad].
    phase: float

    def ratio(self, mode: str) -> float:
        """Return the range of sway or heave over the wave height."""
        return float(np.ptp(getattr(self, mode))) / self.height

    @property
    def turn(self) -> float:
        """Half of the range of rotation [degrees]."""
        return math.degrees(0.5 * float(np.ptp(self.rotation)))


@dataclass(frozen=True)
class MatsubaraRuns:
    """The runs that the figures and statements read."""

    #: Waves on taut lines, over the periods of the case files.
    taut: tuple[CageWave, ...]
    #: Waves on slack lines, over the same periods.
    slack: tuple[CageWave, ...]
    #: Taut, over the wave heights.
    higher: tuple[CageWave, ...]
    #: On taut lines.
    case: RigidCageProblem
    #: Taut and slack.
    results: tuple[Result, Result]
    quick: bool

    @staticmethod
    def at(waves: tuple[CageWave, ...], period: float) -> CageWave:
        """Return the wave of a period [s]."""
        return min(waves, key=lambda wave: abs(wave.period - period))


def read(result: Result, sea: str) -> tuple[CageWave, ...]:
    """Return the waves of a regular sea of a result."""
    tree: Any = result.tree["SWL"]
    waves = tree["waves"][sea].to_dataset()
    found = []
    for index in range(waves.sizes["wave"]):
        data = tree["time"][sea][f"wave {index + 1}"].to_dataset()
        period, time = float(waves.period[index]), data.time.values
        last, many = time > time[-1] - 2.0 * period, time > time[-1] - 10.0 * period
        sides = {OFFSHORE if "offshore" in str(name) else SHORE: name for name in data.line.values}
        phases, peaks = waves.first_phase.values[index], data[LINE_TENSION_PEAK_SINCE_ROW.name]
        found.append(
            CageWave(
                period,
                float(waves.wave_height[index]),
                time[last] - time[last][0],
                data.sway.values[last],
                data.heave.values[last],
                data["roll"].values[last],
                {side: data.tension.sel(line=name).values[last, 0] for side, name in sides.items()},
                {side: float(peaks.sel(line=name).values[many].max()) for side, name in sides.items()},
                float(np.angle(np.exp(1j * (phases[0] - phases[1])))),
            )
        )
    return tuple(found)


def shortened(case: RigidCageProblem, *seas: RigidCageWaves) -> RigidCageProblem:
    """Return the case with other waves and a run of 24 periods."""
    settings = replace(case.settings, analyses=("statics", "time"), periods=24, settled_periods=10, tolerance=1e-5)
    return replace(case, seas=tuple(seas), settings=settings)


def run(quick: bool = False, progress: Progress = silent) -> MatsubaraRuns:
    """Run everything.

    Parameters
    ----------
    quick : bool
        Fewer waves, 24 periods each.
    progress : Progress
    """
    taut: RigidCageProblem = problem_of("matsubara", "taut")
    slack: RigidCageProblem = problem_of("matsubara", "slack")
    plans = [taut, slack]
    if quick:
        one, heights = (TAUT_PERIOD, 1.2), (0.022, 0.033)
        plans = [
            shortened(taut, RigidCageWaves("periods", (HEIGHT,), one),
                      RigidCageWaves("heights", heights, (TAUT_PERIOD,))),
            shortened(slack, RigidCageWaves("periods", (HEIGHT,), (1.1, 1.2, 1.5))),
        ]  # fmt: skip
    results = each_counted("moorings of the paper", partial(run_problem, "cage"), plans, progress)
    return MatsubaraRuns(
        read(results[0], "periods"), read(results[1], "periods"), read(results[0], "heights"), taut,
        (results[0], results[1]), quick,
    )  # fmt: skip


def towed(net: str) -> tuple[Array, Array]:
    """Return Reynolds numbers of a net towed at 5 to 90 cm/s and its drag coefficient by equation (2)."""
    reynolds = np.geomspace(0.05, 0.9, 60) * matsubara_net(net).twine_diameter / VISCOSITY
    return reynolds, Matsubara().twine_drag(reynolds)


def net_in_wave(net: str, height: float, period: float, depth: float = 0.2) -> tuple[Array, Array, Array, Array]:
    """Return time [s], velocity [m/s], drag and inertia force [N] on a net in a wave of the flume.

    Parameters
    ----------
    net : str
    height, period : float
        [m], [s].
    depth : float
        Of the middle of the panel below still water [m].
    """
    omega = 2.0 * math.pi / period
    k = float(wave_number(omega, DEPTH, GRAVITY))
    time = np.linspace(0.0, 2.0 * period, 201)
    amplitude = 0.5 * height * omega * float(depth_functions(k, DEPTH, -depth)[0])
    velocity = amplitude * np.cos(omega * time)
    row = matsubara_net(net)
    drag = 0.5 * DENSITY * row.projected_area * Matsubara().twine_drag(
        np.abs(velocity) * row.twine_diameter / VISCOSITY
    ) * velocity * np.abs(velocity)  # fmt: skip
    volume = 0.25 * math.pi * row.twine_diameter * row.projected_area
    inertia = -2.0 * DENSITY * volume * amplitude * omega * np.sin(omega * time)
    return time, velocity, drag, inertia
