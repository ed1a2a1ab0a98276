"""The memory of the water for the time domain of a unit: wide band of coefficients, memory functions, states."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.breakwater.assembly import FloatingUnit
from moyai.breakwater.frequency_analysis import FrequencyModel
from moyai.breakwater.model import MODES
from moyai.breakwater.variables import labelled
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.memory import ConvolutionMemory, Memory
from moyai.floating.realisation import realise_memory
from moyai.floating.time import CumminsModel
from moyai.potential.damping_tail import TailTheory, wall_sided_tails
from moyai.potential.memory import MemoryFunctions, memory_functions, steady_damping
from moyai.potential.sections import Section

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

KERNEL_LENGTH = 50.0  # length of the kernels over sqrt(B/g), by which they have died away to about 1e-4
KERNEL_STEPS = 1200
STATE_TOLERANCE = 1e-3


@dataclass(frozen=True)
class UnitMemory:
    """Memory of the unit and the coefficients that it was made of.

    Parameters
    ----------
    beam_sea : Hydrodynamics
        Of the whole unit over the wide band, normal incidence.
    functions : MemoryFunctions
        Per unit.
    memory : StateSpaceMemory or ConvolutionMemory
        What the integrator takes.
    checks : tuple of IdentityCheck
    notices : tuple of Notice
    """

    beam_sea: Hydrodynamics
    functions: MemoryFunctions
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
    beam = model.hydro.unit
    functions = _functions(unit, beam)
    where = f"{unit.name}: memory, "
    checks = tuple(replace(check, name=where + check.name) for check in functions.checks)
    if convolution:
        memory: Memory = ConvolutionMemory(functions.time, functions.velocity_kernel, np.zeros((3, 3))).truncated(
            float(functions.time[-1]), functions.steady_dashpot
        )
        return UnitMemory(beam, functions, memory, checks, ())
    realised = realise_memory(functions.time, functions.velocity_kernel, tolerance=STATE_TOLERANCE)
    checks += tuple(replace(check, name=where + check.name) for check in realised.checks)
    notices = (
        Notice(
            "memory-states",
            f"{unit.name}: the memory of the water is carried by {realised.states} states, its kernel within "
            f"{realised.error:.1e} of its start",
            value=realised.error,
            limit=STATE_TOLERANCE,
            severity="information",
        ),
        *realised.notices,
    )
    return UnitMemory(beam, functions, realised.memory, checks, notices)


def _functions(unit: FloatingUnit, beam: Hydrodynamics) -> MemoryFunctions:
    length = KERNEL_LENGTH * math.sqrt(unit.breakwater.hull.beam / unit.water.gravity)
    infinite = beam.infinite_frequency_added_mass
    if infinite is None:
        infinite = beam.added_mass[-1]
    planar = beam.has_far_field
    finite = planar and math.isfinite(unit.water.depth)
    return memory_functions(
        beam.omega,
        beam.radiation_damping,
        infinite,
        np.linspace(0.0, length, KERNEL_STEPS + 1),
        start="even" if finite else "zero",
        steady_damping=unit.breakwater.length * steady_damping(volume_rates(unit.section, unit.centre), unit.water)
        if finite
        else None,
        tail_theory=_tails(unit) if planar else (),
        added_mass=beam.added_mass,
    )


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
