"""Viscosity and surface tension of fresh and sea water (data/waters.csv holds the numbers and their sources)."""

from __future__ import annotations

from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.tables.reader import read_table

_FILE = "waters.csv"


@dataclass(frozen=True)
class WaterProperties:
    """Properties of a water at 20 degrees Celsius."""

    #: Short name.
    name: str
    #: Which water.
    water: str
    #: [kg/m3].
    density: float
    #: Kinematic [m2/s].
    viscosity: float
    #: Against air [N/m].
    surface_tension: float
    #: Where the values come from.
    source: str


def available_waters() -> tuple[str, ...]:
    """Return the names of the table.

    Returns
    -------
    tuple of str
        Names that :func:`water_properties` takes.

    Examples
    --------
    >>> from moyai.tables import available_waters
    >>> available_waters()[:2]
    ('fresh', 'sea')
    """
    return tuple(record["name"] for record in read_table(_FILE))


def water_properties(name: str) -> WaterProperties:
    """Return a water of the table.

    Parameters
    ----------
    name : str
        One of :func:`available_waters`.

    Returns
    -------
    WaterProperties
        Density [kg/m3], viscosity [m2/s], surface tension [N/m] and their source.

    Raises
    ------
    InputError
        For an unknown name.

    Examples
    --------
    >>> from moyai.tables import available_waters, water_properties
    >>> water = water_properties(available_waters()[0])
    >>> water.name, round(water.density)                                 # [kg/m3]
    ('fresh', 998)
    """
    for record in read_table(_FILE):
        if record["name"] == name:
            return _properties(record)
    raise InputError(f"unknown water {name!r}", parameter="water", allowed=", ".join(available_waters()))


def water_of_density(density: float) -> WaterProperties:
    """Return the water of the table whose density is nearest to ``density`` [kg/m3]."""
    return min((_properties(record) for record in read_table(_FILE)), key=lambda water: abs(water.density - density))


def _properties(record: dict[str, str]) -> WaterProperties:
    return WaterProperties(
        record["name"],
        record["water"],
        float(record["density"]),
        float(record["viscosity"]),
        float(record["surface_tension"]),
        record["source"],
    )
