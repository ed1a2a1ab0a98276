"""Spectra of several times and places, whatever file they were read from."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.sea.measured_spreading import MeasuredSpreading
from moyai.sea.spectra import from_table
from moyai.sea.spectrum import Spectrum


@dataclass(frozen=True)
class SpectrumArchive:
    """Spectra of several times and places."""

    #: ``swan``, ``ww3``, ``ndbc``, or the name of a reader of wavespectra.
    format: str
    #: ISO 8601, one a record.
    time: tuple[str, ...]
    #: Names or coordinates, one a place.
    place: tuple[str, ...]
    #: [Hz], rising; shape (f,).
    frequency: Array
    #: [m2/Hz]; NaN where a record holds nothing for a place; shape (time, place, f).
    density: Array
    #: Mean direction that the waves come from, clockwise from north [degrees]; NaN where the file gives none; shape
    #: (time, place).
    direction: Array
    #: Where the waves of a two-dimensional spectrum come from, clockwise from north [degrees]; shape (d,).
    directions: Array | None = None
    #: Their energy, the width of each direction included [m2/Hz]; shape (time, place, f, d).
    energy: Array | None = None

    def spreading(self, record: int, place: int = 0) -> MeasuredSpreading:
        """Return how one spectrum is spread about its mean direction.

        Raises
        ------
        InputError
            For spectra without directions, a record or place that the file does not have, or one without energy.
        """
        if self.directions is None or self.energy is None:
            raise InputError(
                f"the file ({self.format}) holds no energy by directions", parameter="spreading",
                allowed="two-dimensional spectra", remedy="give a spreading function, or leave 'spreading' out",
            )  # fmt: skip
        self.spectrum(record, place)
        mean = float(self.direction[record, place])
        return MeasuredSpreading.of(self.frequency, self.directions, self.energy[record, place], mean)

    def spectrum(self, record: int, place: int = 0) -> Spectrum:
        """Return one spectrum.

        Raises
        ------
        InputError
            For a record or place that the file does not have, or one without energy.
        """
        for name, number, count in (("record", record, len(self.time)), ("place", place, len(self.place))):
            if not 0 <= number < count:
                raise InputError(f"there is no {name} {number}", parameter=name, allowed=f"0 to {count - 1}")
        values = self.density[record, place]
        if not np.isfinite(values).all() or not values.any():
            raise InputError(f"record {record} ({self.time[record]}) holds no energy", parameter="record")
        return from_table(self.frequency, values, f"{self.format} {self.time[record]}")

    def significant_height(self) -> Array:
        """Return four times the root of the energy of every spectrum, trapezoidal [m] (time, place)."""
        return np.asarray(4.0 * np.sqrt(np.trapezoid(self.density, self.frequency, axis=-1)))


def mean_direction(density: Array, directions: Array, frequency: Array) -> float:
    """Return the mean direction of a 2-D spectrum (f, d) whose directions are where the waves come from [degrees]."""
    angle = np.radians(directions)
    total = np.gradient(frequency) @ density
    if not total.any():
        return math.nan
    return math.degrees(math.atan2(float((total * np.sin(angle)).sum()), float((total * np.cos(angle)).sum()))) % 360.0
