"""Catalogue of mooring chain and rope (data/lines.csv holds the numbers, their sources and ranges)."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.tables.reader import read_table

_FILE = "lines.csv"


@checks_words
@dataclass(frozen=True)
class LineProperties:
    """Properties of one mooring line type at one diameter."""

    #: Catalogue name.
    name: str
    #: What it is.
    material: str
    #: Nominal diameter d (bar diameter of a chain) [m].
    diameter: float
    #: In air [kg/m].
    mass_per_length: float
    #: Displaced volume [m2].
    volume_per_length: float
    #: EA [N]; of fibre ropes the quasi-static value.
    axial_stiffness: float
    #: Minimum breaking load, new [N].
    breaking_load: float
    #: Drag coefficient across, on the nominal diameter [-]: force per length rho/2 C d u|u|.
    drag_normal: float
    #: Drag coefficient along, on the nominal diameter [-]: force per length as across.
    drag_tangential: float
    #: Added-mass coefficient across, on the displaced volume [-].
    added_mass_normal: float
    #: Added-mass coefficient along, on the displaced volume [-].
    added_mass_tangential: float
    #: Range of the source [m].
    diameter_range: tuple[float, float]
    #: Whether every value was read in the source named; otherwise check before design use.
    confirmed: bool
    #: Where the values come from.
    source: str

    def submerged_weight_per_length(self, density: float, gravity: float) -> float:
        """Return the weight in water per length [N/m].

        Parameters
        ----------
        density : float
            Of the water [kg/m3].
        gravity : float
            [m/s2].
        """
        return (self.mass_per_length - density * self.volume_per_length) * gravity

    @property
    def volume_diameter(self) -> float:
        """Diameter of the cylinder of equal displacement [m]."""
        return 2.0 * math.sqrt(self.volume_per_length / math.pi)


def available_line_types() -> tuple[str, ...]:
    """Return the names of the catalogue.

    Returns
    -------
    tuple of str
        Names that :func:`line_type` takes.

    Examples
    --------
    >>> from moyai.tables import available_line_types
    >>> "studless_chain_R3" in available_line_types()
    True
    """
    return tuple(record["name"] for record in read_table(_FILE))


def line_type(name: str, diameter: float) -> LineProperties:
    """Return a catalogue entry at a nominal diameter [m].

    Parameters
    ----------
    name : str
        One of :func:`available_line_types`.
    diameter : float
        Nominal diameter [m].

    Returns
    -------
    LineProperties
        Masses per metre [kg/m], axial stiffness and breaking load [N], with their source.

    Raises
    ------
    InputError
        For an unknown name or a diameter that is not positive, or so large that the strength formula turns down.

    Examples
    --------
    >>> from moyai.tables import line_type
    >>> chain = line_type("studless_chain_R3", 0.05)
    >>> round(chain.breaking_load / 1e6, 2)                          # [MN]
    2.23
    """
    if not (math.isfinite(diameter) and diameter > 0.0):
        raise InputError(f"diameter is {diameter:g} m", parameter="diameter", allowed="greater than 0")
    for record in read_table(_FILE):
        if record["name"] == name:
            break
    else:
        near = difflib.get_close_matches(name, available_line_types(), 1, 0.3)
        raise InputError(
            f"unknown line type {name!r}",
            parameter="line_type",
            allowed=", ".join(available_line_types()),
            remedy=f"did you mean {near[0]!r}?" if near else "",
        )
    value = {key: float(record[key]) for key in record if key not in ("name", "material", "confirmed", "source")}
    d = diameter
    breaking = value["breaking_d2"] * d**2 + value["breaking_d3"] * d**3
    if 2.0 * value["breaking_d2"] + 3.0 * value["breaking_d3"] * d <= 0.0:
        raise InputError(
            f"diameter is {d:g} m: the strength formula of {name} falls beyond its maximum",
            parameter="diameter",
            allowed=f"{value['diameter_min']:g} to {value['diameter_max']:g} m",
        )
    return LineProperties(
        name=name,
        material=record["material"],
        diameter=d,
        mass_per_length=value["mass_d2"] * d**2,
        volume_per_length=math.pi / 4.0 * (value["volume_ratio"] * d) ** 2,
        axial_stiffness=value["axial_d2"] * d**2 + value["axial_d3"] * d**3 + value["axial_per_breaking"] * breaking,
        breaking_load=breaking,
        drag_normal=value["drag_normal"],
        drag_tangential=value["drag_tangential"],
        added_mass_normal=value["added_mass_normal"],
        added_mass_tangential=value["added_mass_tangential"],
        diameter_range=(value["diameter_min"], value["diameter_max"]),
        confirmed=record["confirmed"] == "true",
        source=record["source"],
    )


def check_line_properties(properties: LineProperties) -> tuple[Notice, ...]:
    """Tell where a catalogue entry is used outside its source's range or rests on unconfirmed values."""
    low, high = properties.diameter_range
    notices = []
    if not low <= properties.diameter <= high:
        limit = low if properties.diameter < low else high
        notices.append(
            Notice(
                "line-diameter-range",
                f"{properties.name}: nominal diameter {properties.diameter * 1e3:.4g} mm is outside the "
                f"{low * 1e3:g} to {high * 1e3:g} mm of its source; the properties are extrapolated",
                properties.diameter,
                limit,
                "information",
                "give mass, stiffness and breaking load of the maker",
                properties.source,
            )
        )
    if not properties.confirmed:
        notices.append(
            Notice(
                "line-values-unconfirmed",
                f"{properties.name}: not every catalogue value was compared with its source",
                severity="information",
                remedy="give the breaking load of the maker's certificate before design use",
                source=properties.source,
            )
        )
    return tuple(notices)
