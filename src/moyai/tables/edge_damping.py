"""Numbers of the damping by eddies at edges (data/edge_damping.csv holds them with their sources)."""

from __future__ import annotations

from dataclasses import dataclass

from moyai.tables.reader import read_table

_FILE = "edge_damping.csv"


@dataclass(frozen=True)
class EdgeDampingNumbers:
    """What the laws of :mod:`moyai.floating.viscous` take from the table."""

    #: C_p of a sharp corner of 90 degrees.
    edge_pressure: float
    #: Factor of C_D = plate_drag KC^plate_exponent of a thin plate.
    plate_drag: float
    #: Exponent of the same law.
    plate_exponent: float
    #: KC that the same law is taken at.
    plate_keulegan_carpenter: float
    #: Turn of the outline below which a vertex is smooth [degrees].
    smallest_turn: float
    #: A face shorter than this part of its neighbours is the tip of a plate.
    thin_plate: float
    #: Bilge radius over the shorter face beyond which no corner is left.
    largest_radius: float
    #: Least half beam over draught of the law of round bilges.
    ikeda_half_beam_low: float
    #: Largest half beam over draught of that law.
    ikeda_half_beam_high: float
    #: Factor on the damping at the low end of the band.
    band_low: float
    #: Factor on the damping at the high end of the band.
    band_high: float

    @property
    def plate_coefficient(self) -> float:
        """C_D of a thin plate at the KC of the table."""
        return float(self.plate_drag * self.plate_keulegan_carpenter**self.plate_exponent)


def edge_damping_numbers() -> EdgeDampingNumbers:
    """Return the numbers of the table."""
    return EdgeDampingNumbers(**{record["name"]: float(record["value"]) for record in read_table(_FILE)})
