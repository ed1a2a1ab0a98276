"""Energy of the unit in regular waves in time: what reflection and transmission leave, and where it went."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.damping import QuadraticDamping
from moyai.floating.energy import ENERGY_TOLERANCE, HARMONICS, SHOWN_LOSS, drag_force, harmonic_work, unexplained_share
from moyai.floating.far_field import energy_velocity
from moyai.floating.forcing import Forcing
from moyai.structures.breakwater.frequency.model import FrequencyModel
from moyai.structures.breakwater.model import RegularSea
from moyai.structures.breakwater.time.model import TimeRun

HIGHER = tuple(range(2, HARMONICS + 1))


@dataclass(frozen=True)
class EnergyOfPeriod:
    """Where the energy of a regular wave goes in time, over the incident energy flux [eq:breakwater-time-energy]."""

    #: 1 - |R|^2 - |T|^2 of the first harmonic.
    loss: float
    #: Work of all damping on the first harmonic: linear, quadratic less what moving water drives, and what the lines
    #: lose in all harmonics.
    damping: float
    #: Energy that the lines carry from the first harmonic into others.
    passed_on: float
    #: Radiated by the second and third harmonic; shape (2,).
    radiated: Array

    @classmethod
    def unknown(cls) -> EnergyOfPeriod:
        """Return blanks, for a run that did not end or has no far field."""
        return cls(math.nan, math.nan, math.nan, np.full(len(HIGHER), math.nan))

    @property
    def missing(self) -> float:
        """Loss that damping does not explain, over the loss, or a quarter of the incident energy where that is more."""
        return float(unexplained_share(self.loss, self.damping, SHOWN_LOSS))

    @property
    def unexplained(self) -> float:
        """Loss that neither damping nor other harmonics explain, over the loss."""
        return float(unexplained_share(self.loss, self.damping + self.passed_on))

    def variables(self) -> dict[str, Array]:
        """Return what the summary of a sea holds of it."""
        return {
            "damping_work": np.array(self.damping),
            "energy_to_harmonics": np.array(self.passed_on),
            "harmonic_radiation": self.radiated,
        }


def energy_of_period(
    model: FrequencyModel,
    run: TimeRun,
    sea: RegularSea,
    period: float,
    periods: int,
    loss: float,
    damping: Array,
    quadratic: QuadraticDamping | None,
    forcing: Forcing,
) -> EnergyOfPeriod:
    """Return where the energy of one period went.

    Parameters
    ----------
    model : FrequencyModel
    run : TimeRun
    sea : RegularSea
    period : float
        [s].
    periods : int
        That are analysed.
    loss : float
        1 - |R|^2 - |T|^2 of the first harmonic, NaN where it is not known.
    damping : ndarray (3, 3)
        Linear damping beyond radiation.
    quadratic : QuadraticDamping or None
        That the run had.
    forcing : Forcing
        Of the run, with the motion of the water where drag is taken against it.
    """
    # a damping lid takes energy of its own
    if not (math.isfinite(loss) and sea.height > 0.0) or model.unit.breakwater.gap_damping_lid:
        return EnergyOfPeriod.unknown()
    unit, simulation = model.unit, run.simulation
    water = forcing.sample(simulation.time_step, len(simulation.time))[0][:, simulation.velocity.shape[1] :]
    drag = drag_force(quadratic, simulation.velocity, water)
    oblique = sea.heading != 0.0
    found = harmonic_work(
        simulation, period, periods, damping, model.hydro.whole(sea.heading), drag, one_frequency=oblique
    )
    group, _ = energy_velocity(np.array([2.0 * math.pi / period]), unit.water)
    energy = 0.5 * unit.water.density * unit.water.gravity * (0.5 * sea.height) ** 2
    flux = energy * float(group[0]) * abs(math.cos(sea.heading)) * model.hydro.whole(sea.heading).length
    lost = float(found.damping[0] + found.drag[0]) + found.lines_in_all
    return EnergyOfPeriod(
        loss, lost / flux, (float(found.lines[0]) - found.lines_in_all) / flux, found.radiation[1:] / flux
    )


def energy_checks(found: Sequence[tuple[float, EnergyOfPeriod]], where: str) -> tuple[IdentityCheck, ...]:
    """Compare the loss of the first harmonic with the work on it, over all periods of a sea; none without a far field.

    Parameters
    ----------
    found : sequence of (float, EnergyOfPeriod)
        Period [s] and what was found there.
    where : str
        Level and sea.
    """
    known = [(period, one) for period, one in found if math.isfinite(one.loss)]
    if not known:
        return ()
    period, worst = max(known, key=lambda item: item[1].missing)
    other, rough = max(known, key=lambda item: item[1].unexplained)
    return (
        IdentityCheck(
            f"{where}, time domain: loss of the first harmonic and work of the damping, T = {period:.4g} s",
            worst.missing,
            ENERGY_TOLERANCE,
            f"{_shares(worst)}; where they differ, reflection and transmission of the first harmonic are not those of "
            "the whole wave",
        ),
        IdentityCheck(
            f"{where}, time domain: loss of the first harmonic and work of all forces, T = {other:.4g} s",
            rough.unexplained,
            ENERGY_TOLERANCE,
            "loss of the far field equals the work of damping and lines on the first harmonic, over the loss",
        ),
    )


def of_springs(checks: tuple[IdentityCheck, ...]) -> tuple[tuple[IdentityCheck, ...], tuple[Notice, ...]]:
    """Return the checks of a unit on springs alone, which may well carry energy into other harmonics, and what is said.

    Chains at rest at every instant that do so are out of their range; springs that come tight and slack are not.
    """
    if not checks or checks[0].passed:
        return checks, ()
    first, *others = checks
    text = f"{first.name}: {first.meaning}"
    remedy = "take the record in time for what passes, or reflection and transmission of the frequency domain"
    return tuple(others), (
        Notice("energy-in-harmonics", text, value=first.value, limit=first.tolerance, remedy=remedy),
    )


def _shares(one: EnergyOfPeriod) -> str:
    second, third = one.radiated[:2]
    return (
        f"the far field of the first harmonic loses {100.0 * one.loss:.3g} % of the incident energy, damping "
        f"takes {100.0 * one.damping:.3g} %, lines carry {100.0 * one.passed_on:.3g} % into other harmonics; "
        f"the second radiates {100.0 * second:.3g} %, the third {100.0 * third:.3g} %"
    )
