"""The memory of the water for the time domain of a unit: wide band of coefficients, memory functions, states."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.memory import ConvolutionMemory, Memory, StateSpaceMemory
from moyai.floating.time import CumminsModel
from moyai.potential.damping_model import fit_damping
from moyai.potential.damping_tail import TailTheory, wall_sided_tails
from moyai.potential.memory import MemoryFunctions, memory_functions, steady_damping
from moyai.potential.memory_plan import MemoryPlan, recommend_memory
from moyai.potential.sections import Section
from moyai.potential.state_space import StateSpace, fit_memory
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.frequency.model import FrequencyModel
from moyai.structures.breakwater.hydrodynamics import damping_start
from moyai.structures.breakwater.settings import MODES
from moyai.structures.breakwater.variables import labelled

if TYPE_CHECKING:
    import xarray as xr


MOST_POLES = 32
CAUSAL = ("Kramers-Kronig", "Ogilvie", "lambda is the integral of K", "frequencies resolve the damping")
LEAST_STEPS, MOST_STEPS = 400, 4000  # of the time grid on which the kernels are stored
STATE_TOLERANCES = (1e-3, 4e-3, 0.02)  # of the fit by states: the first that it keeps; sharp resonances ask for more
COARSE = 0.01  # error of that fit that is warned of


@dataclass(frozen=True)
class UnitMemory:
    """Memory of the unit and the coefficients that it was made of."""

    #: Of the whole unit over the wide band, normal incidence.
    beam_sea: Hydrodynamics
    #: Per unit.
    functions: MemoryFunctions
    #: What the integrator takes.
    memory: Memory
    checks: tuple[IdentityCheck, ...]
    notices: tuple[Notice, ...]

    def model(self, model: FrequencyModel, linear_damping: Array) -> CumminsModel:
        """Return the unit in time without its nonlinear lines."""
        return CumminsModel(
            inertia=model.unit.inertia + self.functions.infinite_frequency_added_mass,
            stiffness=model.unit.statics.stiffness,
            linear_damping=linear_damping,
            memory=self.memory,
            quadratic=model.quadratic,
        )

    @property
    def dataset(self) -> xr.Dataset:
        """The kernels and the band of coefficients, labelled."""
        import xarray as xr

        pair = ("influenced_dof", "radiating_dof")
        functions = self.functions
        data = {
            "velocity_kernel": (("time", *pair), functions.velocity_kernel),
            "acceleration_kernel": (("time", *pair), functions.acceleration_kernel),
            "added_mass": (("omega", *pair), self.beam_sea.added_mass),
            "radiation_damping": (("omega", *pair), self.beam_sea.radiation_damping),
            "infinite_frequency_added_mass": (pair, functions.infinite_frequency_added_mass),
            "steady_dashpot": (pair, functions.steady_dashpot),
        }
        coords = {
            "time": functions.time,
            "omega": self.beam_sea.omega,
            "influenced_dof": list(MODES),
            "radiating_dof": list(MODES),
        }
        return labelled(xr.Dataset(data, coords=coords))


def unit_memory(model: FrequencyModel, *, convolution: bool = False) -> UnitMemory:
    """Compute the memory of a unit.

    Parameters
    ----------
    model : FrequencyModel
    convolution : bool
        Give the convolution instead of states (for comparison; its cost grows with the length of the memory).
    """
    unit = model.unit
    functions, plan = _functions(unit, model.hydro.unit)
    where = f"{unit.name}: memory, "
    checks, notices = _causality(unit, functions.checks)
    memory: Memory | None = None
    message = plan.reason
    if not convolution:
        fit, fault = _states(functions)
        if fit is not None:
            memory = StateSpaceMemory.of(fit)
            checks.extend(fit.checks)
            message = (
                f"{2 * len(fit.poles)} states or fewer represent the radiation memory, the fitted frequency response "
                "within "
                f"{fit.error:.1e}; {plan.reason}"
            )
            if fit.error > COARSE:
                words = (
                    f"{unit.name}: the memory of the water in time is off by up to {100.0 * fit.error:.2g} % of its "
                )
                words += "largest value: water between hulls resonates too sharply for its states"
                notices.append(Notice("memory-coarse", words, value=fit.error, limit=COARSE))
        else:
            notices.append(Notice("memory-states", f"{unit.name}: {fault}; the convolution is used instead"))
    if memory is None:
        kernel = ConvolutionMemory(functions.time, functions.velocity_kernel, np.zeros((3, 3)))
        memory = kernel.truncated(float(functions.time[-1]), functions.steady_dashpot)
    notices.append(Notice("memory", f"{unit.name}: {message}", severity="information"))
    named = tuple(replace(check, name=where + check.name) for check in checks)
    return UnitMemory(model.hydro.unit, functions, memory, named, tuple(notices))


def _states(functions: MemoryFunctions) -> tuple[StateSpace | None, str]:
    """Return the fit by states within the first tolerance that it keeps; ``None`` and why where it keeps none."""
    fault = ""
    for tolerance in STATE_TOLERANCES:
        try:
            fit = fit_memory(functions, tolerance=tolerance, highest_order=MOST_POLES)
        except ConvergenceError as error:
            fault = error.fault.message
            continue
        if all(check.passed for check in fit.checks):
            return fit, ""
        fault = f"the memory is fitted to {fit.error:.1e} of its largest response"
    return None, fault


def _causality(unit: FloatingUnit, checks: tuple[IdentityCheck, ...]) -> tuple[list[IdentityCheck], list[Notice]]:
    """Part the identities that a damping lid breaks from those that hold with it.

    A lid that takes a constant fraction at every frequency answers before it is pushed (as hysteretic damping does): no
    memory function obeys Kramers-Kronig with it. How far it is off is reported instead.
    """
    if not unit.breakwater.gap_damping_lid:
        gaps = len(unit.section.waterlines) - 1
        if gaps > 0 and any(check.name in CAUSAL and not check.passed for check in checks):
            advice = Notice(
                "gap-memory",
                f"{unit.name}: the water in the gap resonates too sharply for a memory in time",
                remedy="give a damping lid in the gap (0.01 to 0.1), or leave the time domain out",
            )
            return list(checks), [advice]
        return list(checks), []
    kept = [check for check in checks if check.name not in CAUSAL]
    worst = max((check.value for check in checks if check.name in CAUSAL), default=0.0)
    reported = Notice(
        "lid-memory",
        f"{unit.name}: a damping lid of constant fraction has no causal memory; added mass and damping in time are off "
        f"by up to {100.0 * worst:.1f} % of their largest values",
        value=worst,
        severity="information" if worst < 0.05 else "warning",
        remedy="use the frequency domain near the gap resonance, or lower the lid",
    )
    return kept, [reported]


def _functions(unit: FloatingUnit, beam: Hydrodynamics) -> tuple[MemoryFunctions, MemoryPlan]:
    """Return the memory functions of the unit on a time grid that the damping itself requires."""
    planar = beam.has_far_field
    start = damping_start(unit) if planar else "zero"
    steady = None
    if planar and start == "even":
        steady = unit.breakwater.length * steady_damping(volume_rates(unit.section, unit.centre), unit.water)
    tails = _tails(unit) if planar else ()
    infinite = beam.infinite_frequency_added_mass
    model = fit_damping(beam.omega, beam.radiation_damping, start=start, steady_damping=steady, tail_theory=tails)
    plan = recommend_memory(model)
    steps = min(max(math.ceil(plan.length / plan.time_step), LEAST_STEPS), MOST_STEPS)
    found = memory_functions(
        beam.omega,
        beam.radiation_damping,
        beam.added_mass[-1] if infinite is None else infinite,
        np.linspace(0.0, plan.length, steps + 1),
        start=start,
        steady_damping=steady,
        tail_theory=tails,
        added_mass=beam.added_mass if infinite is not None else None,
    )
    return found, plan


def volume_rates(section: Section, centre: tuple[float, float]) -> Array:
    """Return the volume pushed out per metre by unit velocity of sway, heave and roll: water plane and its lever."""
    breadth = section.waterplane_breadth
    return np.array([0.0, breadth, -(section.waterplane_first_moment - breadth * centre[0])])


def _tails(unit: FloatingUnit) -> tuple[TailTheory, ...]:
    """Return the exact tails of a wall-sided section, of the whole unit (kept only where they meet the damping)."""
    length = unit.breakwater.length
    return tuple(
        replace(tail, coefficients=tuple(length * item for item in tail.coefficients))
        for tail in wall_sided_tails(unit.water, unit.centre[1])
    )
