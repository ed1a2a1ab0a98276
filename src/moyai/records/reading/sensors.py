"""What an instrument sees of a linear wave: transfer functions from the surface, and back."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water

Quantity = Literal[
    "elevation",
    "pressure",
    "velocity_x",
    "velocity_y",
    "velocity_z",
    "slope_x",
    "slope_y",
    "displacement_x",
    "displacement_y",
    "acceleration_z",
]

# Power of cos and sin of the heading that each quantity carries
_DIRECTION = {"x": (1, 0), "y": (0, 1), "z": (0, 0)}


@checks_words
@dataclass(frozen=True)
class Sensor:
    """One channel of a wave instrument."""

    #: What it measures: elevation [m], pressure [Pa], velocity [m/s], slope [rad], displacement of a buoy [m], vertical
    #: acceleration [m/s2].
    quantity: Quantity
    #: Where along x [m].
    x: float = 0.0
    #: Where along y [m].
    y: float = 0.0
    #: Where from the mean water level, upwards [m].
    z: float = 0.0

    @property
    def powers(self) -> tuple[int, int]:
        """Powers of the cosine and the sine of the heading."""
        return _DIRECTION.get(self.quantity[-1], (0, 0)) if "_" in self.quantity else (0, 0)

    def magnitude(self, omega: Array, k: Array, water: Water) -> ComplexArray:
        """Return the transfer function from the surface without the heading; equation [eq:records-transfer].

        Parameters
        ----------
        omega, k : ndarray
            Angular frequencies [rad/s], positive, and wave numbers [1/m].
        water : Water

        Raises
        ------
        InputError
            When the sensor is below the bed.
        """
        if math.isfinite(water.depth) and self.z < -water.depth - 1e-9:
            raise InputError(
                f"sensor at z = {self.z:g} m", parameter="z", allowed=f"at least {-water.depth:g} m, the bed"
            )
        z = min(self.z, 0.0)  # Wheeler's rule would be no better for a linear analysis
        if math.isinf(water.depth):
            level = np.exp(k * z)
            cosh_cosh, cosh_sinh, sinh_sinh = level, level, level
        else:
            h = water.depth
            down = np.exp(-2.0 * k * (z + h))
            bottom = np.exp(-2.0 * k * h)
            level = np.exp(k * z)
            cosh_cosh = level * (1.0 + down) / (1.0 + bottom)
            cosh_sinh = level * (1.0 + down) / -np.expm1(-2.0 * k * h)
            sinh_sinh = level * (1.0 - down) / -np.expm1(-2.0 * k * h)
        kind = self.quantity.split("_")[0]
        if kind == "elevation":
            out = np.ones_like(omega, dtype=complex)
        elif kind == "pressure":
            out = water.density * water.gravity * cosh_cosh + 0j
        elif kind == "velocity":
            out = -1j * omega * sinh_sinh if self.quantity.endswith("z") else omega * cosh_sinh + 0j
        elif kind == "slope":
            out = 1j * k
        elif kind == "displacement":
            out = 1j * cosh_sinh
        elif kind == "acceleration":
            out = -(omega**2) * sinh_sinh + 0j
        else:
            raise InputError(f"unknown quantity '{self.quantity}'", parameter="quantity", allowed=", ".join(QUANTITIES))
        return np.asarray(out, dtype=np.complex128)

    def response(self, omega: Array, k: Array, heading: Array, water: Water) -> ComplexArray:
        """Return the transfer function at every frequency and heading [rad], shape (frequencies, headings)."""
        cosine, sine = np.cos(heading), np.sin(heading)
        power_x, power_y = self.powers
        phase = np.exp(1j * k[:, None] * (self.x * cosine + self.y * sine))
        return np.asarray(self.magnitude(omega, k, water)[:, None] * cosine**power_x * sine**power_y * phase)


QUANTITIES = get_args(Quantity)


@dataclass(frozen=True, eq=False)
class SurfaceFromRecord:
    """Surface elevation found from another quantity."""

    #: [m], band-limited.
    elevation: Array
    #: Lower end of the band that was carried over [Hz].
    lowest: float
    #: Upper end of it [Hz].
    highest: float
    notices: tuple[Notice, ...]


def surface_elevation(
    step: float,
    values: ArrayLike,
    sensor: Sensor,
    water: Water,
    *,
    lowest: float,
    highest: float,
    largest_gain: float = 10.0,
) -> SurfaceFromRecord:
    """Return the surface above a pressure or vertical-velocity sensor by linear theory [eq:records-transfer].

    Parameters
    ----------
    step : float
        Time step [s].
    values : array_like
        Record of the sensor without gaps.
    sensor : Sensor
        ``pressure``, ``velocity_z``, ``acceleration_z`` or ``elevation``.
    water : Water
    lowest, highest : float
        Band that is carried over [Hz].
    largest_gain : float
        The band ends where the surface is so many times the record's own (relative to its value at the surface):
        beyond, noise would be raised more.

    Returns
    -------
    SurfaceFromRecord

    Raises
    ------
    InputError
        For horizontal quantities, gaps, or an empty band.
    """
    record = np.asarray(values, dtype=float)
    if sensor.powers != (0, 0):
        raise InputError(
            f"{sensor.quantity} depends on the heading", parameter="quantity", allowed="a vertical quantity"
        )
    if not np.isfinite(record).all():
        raise InputError("the record has gaps", parameter="values", remedy="choose a stretch without gaps")
    frequency = np.asarray(np.fft.rfftfreq(record.size, step), dtype=np.float64)
    omega = 2.0 * math.pi * frequency
    inside = (frequency >= max(lowest, 1e-12)) & (frequency <= highest)
    if not inside.any():
        raise InputError(f"no frequency between {lowest:g} and {highest:g} Hz", parameter="lowest, highest")
    k = np.asarray(wave_number(omega[inside], water.depth, water.gravity), dtype=float)
    transfer = sensor.magnitude(omega[inside], k, water)
    at_surface = Sensor(sensor.quantity, z=0.0).magnitude(omega[inside], k, water)
    allowed = np.abs(at_surface) <= largest_gain * np.abs(transfer)
    notices: tuple[Notice, ...] = ()
    reached = highest
    if not allowed.all():
        reached = float(frequency[inside][np.argmin(allowed)])
        message = f"above {reached:.3g} Hz the sensor feels less than 1/{largest_gain:g} of the surface: cut there"
        notices = (Notice("depth-attenuation", message, reached, highest),)
    slope = np.linspace(-1.0, 1.0, record.size)
    level = record - record.mean()
    level = level - slope * (slope @ level) / (slope @ slope)
    # the conjugate amplitude of numpy's transform needs the conjugate transfer function
    spectrum = np.fft.rfft(level)
    kept = np.zeros_like(spectrum)
    kept[inside] = np.where(allowed, spectrum[inside] / np.conj(transfer), 0.0)
    return SurfaceFromRecord(np.asarray(np.fft.irfft(kept, record.size)), lowest, min(highest, reached), notices)
