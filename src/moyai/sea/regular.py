"""Regular linear waves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.sea import dispersion
from moyai.sea.components import WaveComponents
from moyai.sea.water import Water


@dataclass(frozen=True)
class RegularWave:
    """A regular wave of linear theory, crest at x = y = 0 when t = 0.

    Raises
    ------
    InputError
        When height is negative, period not positive, or the current blocks the wave.

    Examples
    --------
    >>> from moyai.sea import RegularWave, Water
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> wave = RegularWave(height=1.0, period=5.0, heading=0.0, water=water)
    >>> round(wave.wavelength, 2), round(wave.elevation(0.0), 3)         # [m], crest at the origin [m]
    (36.59, 0.5)
    """

    #: Wave height H, crest to trough [m].
    height: float
    #: Period T in the fixed frame [s].
    period: float
    #: Direction of travel [rad], 0 towards +x, pi/2 towards +y.
    heading: float
    #: Depth, density, gravity.
    water: Water
    #: Component of a depth-uniform current along ``heading`` [m/s]; the Doppler shift is applied.
    current_along_wave: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.height) and self.height >= 0.0):
            raise InputError(f"wave height is {self.height:g} m", parameter="height", allowed="at least 0 m")
        if not (math.isfinite(self.period) and self.period > 0.0):
            raise InputError(f"wave period is {self.period:g} s", parameter="period", allowed="greater than 0 s")
        if not math.isfinite(self.heading):
            raise InputError(f"heading is {self.heading:g}", parameter="heading", allowed="finite")
        _ = self.wave_number

    @property
    def omega(self) -> float:
        """Angular frequency in the fixed frame [rad/s]."""
        return 2.0 * math.pi / self.period

    @cached_property
    def wave_number(self) -> float:
        """Wave number k [1/m]."""
        return float(
            dispersion.wave_number_in_current(self.omega, self.water.depth, self.water.gravity, self.current_along_wave)
        )

    @property
    def intrinsic_omega(self) -> float:
        """Frequency seen by an observer who drifts with the current [rad/s]."""
        return self.omega - self.wave_number * self.current_along_wave

    @property
    def wavelength(self) -> float:
        """Wavelength L [m]."""
        return 2.0 * math.pi / self.wave_number

    @property
    def amplitude(self) -> float:
        """Amplitude H / 2 [m]."""
        return 0.5 * self.height

    @property
    def steepness(self) -> float:
        """Steepness H / L [-]."""
        return self.height / self.wavelength

    @property
    def relative_depth(self) -> float:
        """Relative depth kh [-]."""
        return self.wave_number * self.water.depth

    @property
    def ursell_number(self) -> float:
        """Ursell number H L^2 / h^3 [-] (zero in infinite depth)."""
        return self.height * self.wavelength**2 / self.water.depth**3

    @property
    def phase_velocity(self) -> float:
        """Phase velocity in the fixed frame [m/s]."""
        return self.omega / self.wave_number

    @property
    def group_velocity(self) -> float:
        """Group velocity in the fixed frame, current included [m/s]."""
        relative = dispersion.group_velocity_scalar(self.wave_number, self.water.depth, self.water.gravity)
        return float(relative) + self.current_along_wave

    @property
    def energy(self) -> float:
        """Mean energy per unit of surface, rho g H^2 / 8 [J/m2]."""
        return self.water.density * self.water.gravity * self.height**2 / 8.0

    @property
    def energy_flux(self) -> float:
        """Mean energy flux per unit of crest in the fixed frame, E c_g [W/m] [eq:sea-energy-flux]."""
        return self.energy * self.group_velocity

    def components(self) -> WaveComponents:
        """Return the wave as a sea of one component, with all its kinematics."""
        return WaveComponents(
            omega=np.array([self.omega]),
            amplitude=np.array([self.amplitude]),
            phase=np.zeros(1),
            heading=np.array([self.heading]),
            wave_number=np.array([self.wave_number]),
            water=self.water,
            intrinsic_omega=np.array([self.intrinsic_omega]),
        )

    def elevation(self, time: ArrayLike, x: ArrayLike = 0.0, y: ArrayLike = 0.0) -> Any:
        """Return the surface elevation [m]; see :meth:`WaveComponents.elevation`.

        Parameters
        ----------
        time : array_like (*time)
            [s].
        x, y : array_like (*points)
            Site axes [m], broadcast together.
        """
        return self.components().elevation(time, x, y)
