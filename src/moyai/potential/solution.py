"""The result of a radiation and diffraction solve, and its dataset in Capytaine's names."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.results import DIRECTION_CONVENTION, TIME_CONVENTION, Status
from moyai.core.validity import IdentityCheck, Notice
from moyai.potential.heading import HeadingSolution
from moyai.potential.modes import Modes
from moyai.potential.sections import Section
from moyai.potential.variables import VARIABLES, VOCABULARY
from moyai.sea.water import Water

if TYPE_CHECKING:
    import xarray as xr


@checks_words
@dataclass(frozen=True, eq=False)
class RadiationDiffraction:
    """Coefficients, potentials and identities of one section; everything per metre of structure."""

    #: Section that was solved.
    section: Section
    #: Water that was solved.
    water: Water
    #: Modes that were solved.
    modes: Modes
    #: Headings that were solved [rad].
    heading: Array
    #: Damping lid that was solved with.
    lid: float
    #: Waves along +x; its radiation coefficients hold for motion that is uniform along the structure.
    normal: HeadingSolution
    #: One for every other |heading|; its modes vary as exp(i k sin(beta) y).
    oblique: tuple[HeadingSolution, ...]
    #: Limit of infinite frequency; shape (radiating, influenced).
    infinite_frequency_added_mass: Array
    #: Limit of zero frequency; NaN in infinite depth for modes that displace volume; shape (radiating, influenced).
    zero_frequency_added_mass: Array
    #: Number of nodes.
    unknowns: int
    #: Whether the identities were met.
    status: Status
    #: That outcome in words.
    message: str
    #: Figures of the identities.
    checks: tuple[IdentityCheck, ...]
    #: What makes the numbers doubtful.
    notices: tuple[Notice, ...] = ()

    @property
    def omega(self) -> Array:
        """Frequencies that were solved [rad/s]."""
        return self.normal.states.omega

    @property
    def added_mass(self) -> Array:
        """Added mass (omega, radiating, influenced) of uniform motion, per metre [kg/m, kg, kg m]."""
        return self.normal.added_mass

    @property
    def radiation_damping(self) -> Array:
        """Radiation damping (omega, radiating, influenced) of uniform motion, per metre [kg/(m s), kg/s, kg m/s]."""
        return self.normal.radiation_damping

    @property
    def radiated_wave(self) -> ComplexArray:
        """Wave amplitude (omega, radiating, side) per unit velocity on the minus and plus side [s, m s]."""
        return self.normal.radiated_wave

    def at_heading(self, heading: float) -> HeadingSolution:
        """Return the solution at one of the headings [rad] that were solved.

        Parameters
        ----------
        heading : float
            Either sign [rad].

        Raises
        ------
        InputError
            When the heading was not solved.
        """
        for solution in (self.normal, *self.oblique):
            if abs(abs(heading) - solution.heading) < 1e-12:
                return solution
        solved = ", ".join(f"{value:g}" for value in sorted({0.0, *np.abs(self.heading)}))
        raise InputError(
            f"heading {heading:g} rad was not solved", parameter="heading", allowed=f"one of +-{solved} rad"
        )

    @property
    def excitation_force(self) -> ComplexArray:
        """Excitation (omega, heading, mode) per unit wave amplitude, per metre [N/m2, N/m]."""
        values: ComplexArray = self._over_headings("excitation_force")
        return values

    @property
    def reflection_coefficient(self) -> ComplexArray:
        """R (omega, heading) of the section held fixed, phase at x = 0 [-]."""
        values: ComplexArray = self._over_headings("reflection_coefficient")
        return values

    @property
    def transmission_coefficient(self) -> ComplexArray:
        """T (omega, heading) of the section held fixed, phase at x = 0 [-]."""
        values: ComplexArray = self._over_headings("transmission_coefficient")
        return values

    def _over_headings(self, name: str) -> Any:
        """Stack a quantity of the headings that were finished along a second axis; NaN for the others."""
        first = getattr(self.normal, name)
        out = np.full((first.shape[0], len(self.heading), *first.shape[1:]), np.nan, dtype=first.dtype)
        for index, heading in enumerate(self.heading):
            for solution in (self.normal, *self.oblique):
                if abs(abs(heading) - solution.heading) < 1e-12:
                    values = getattr(solution, name)
                    out[: len(values), index] = values
        return out

    @property
    def dataset(self) -> xr.Dataset:
        """Everything labelled, in Capytaine's names where they exist; see :mod:`moyai.potential.variables`.

        The ``oblique_`` variables are there only when a heading is oblique.
        """
        normal = self.normal
        over = self._over_headings
        values: dict[str, Any] = {
            "added_mass": normal.added_mass,
            "radiation_damping": normal.radiation_damping,
            "radiated_wave": normal.radiated_wave,
            "Froude_Krylov_force": over("froude_krylov_force"),
            "diffraction_force": over("diffraction_force"),
            "excitation_force": over("excitation_force"),
            "reflection_coefficient": over("reflection_coefficient"),
            "transmission_coefficient": over("transmission_coefficient"),
            "lid_loss": over("lid_loss"),
            "infinite_frequency_added_mass": self.infinite_frequency_added_mass,
            "zero_frequency_added_mass": self.zero_frequency_added_mass,
        }
        if self.oblique:
            values["oblique_added_mass"] = over("added_mass")
            values["oblique_radiation_damping"] = over("radiation_damping")
            values["oblique_radiated_wave"] = over("radiated_wave")
        data = {name: (dims.split(), values[name]) for name, (dims, _, _) in VARIABLES.items() if name in values}
        names = list(self.modes.names)
        coordinates = {
            "omega": normal.states.omega,
            "period": ("omega", 2.0 * np.pi / normal.states.omega),
            "wavenumber": ("omega", normal.states.wave_number),
            "wave_direction": self.heading,
            "radiating_dof": names,
            "influenced_dof": names,
            "side": ["minus", "plus"],
        }
        attributes = {
            **self.conventions,
            "water_depth": self.water.depth,
            "rho": self.water.density,
            "g": self.water.gravity,
            "section": self.section.name,
            "draught": self.section.draught,
            "lid": self.lid,
            "status": self.status,
            "message": self.message,
            "checks": json.dumps([check.as_dict() for check in self.checks]),
            "per": "metre of structure",
        }
        return VOCABULARY.dataset(data, coordinates, attributes)

    @property
    def conventions(self) -> dict[str, str]:
        """Attributes that every dataset carries."""
        return {"time_convention": TIME_CONVENTION, "direction_convention": DIRECTION_CONVENTION}
