"""Ordinary floating breakwaters from handbook sizes, built as a user builds them, all settings left at their defaults.

Sizes: McCartney (1985, Journal of Waterway, Port, Coastal and Ocean Engineering 111(2)) gives concrete box breakwaters
of 3.7 to 6.4 m beam and 0.9 to 1.7 m draught for significant heights up to about 1 m and periods under 4 s; PIANC
(1994) the same range and large pontoons of 10 to 20 m; the remaining sizes are ordinary ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

GRAVITY, DENSITY = 9.81, 1025.0

TEXT = """
moyai: 1
title: {title}
site: {{water_depth: {depth} m, water_levels: {levels}, density: 1025 kg/m3, gravity: 9.81 m/s2}}
waves:
  name: storm
  kind: jonswap
  significant_height: {height} m
  peak_period: {period} s
  peak_enhancement: 3.3
  heading_deg: 0
  duration: {duration} s
  seed: 1
wind: {{speed: {wind} m/s, heading_deg: 0, density: 1.225 kg/m3}}
current: {{speed: {current} m/s, heading_deg: 0}}
structure:
  kind: breakwater
  length: {length} m
  section: {{shape: rectangle, beam: {beam} m, height: {hull} m}}
  draught: {draught} m
  centre_of_gravity_above_keel: {gravity_height} m
  roll_gyradius: {gyradius} m
  damping: {{fraction_of_critical: 0.1, modes: [sway, heave, roll]}}
  wind_drag_coefficient: 1.2
  current_drag_coefficient: 1.5
lines:
  - name: seaward
    count: {count}
    fairlead: {{x: -{half_beam} m, above_keel: 0 m}}
    anchor: {{x: -{anchor} m}}
    segments: [{{catalogue: studless_chain_R3, diameter: {chain} mm, length: {line} m}}]
  - name: shoreward
    count: {count}
    fairlead: {{x: {half_beam} m, above_keel: 0 m}}
    anchor: {{x: {anchor} m}}
    segments: [{{catalogue: studless_chain_R3, diameter: {chain} mm, length: {line} m}}]
analyses: [{analyses}]
{settings}
"""


@dataclass(frozen=True)
class Design:
    """Numbers of one design; lengths in m, chain diameter in mm."""

    title: str
    beam: float
    hull: float
    draught: float
    length: float
    depth: float
    height: float
    period: float
    chain: int
    line: float
    anchor: float
    count: int = 2
    wind: float = 20.0
    current: float = 0.3
    levels: str = "{SWL: 0 m}"

    @property
    def gravity_height(self) -> float:
        """Centre of gravity above the keel, half the hull's height [m]."""
        return 0.5 * self.hull

    @property
    def metacentric_height(self) -> float:
        """GM of a box by hand: KB + B^2/(12 d) - KG [m]."""
        return 0.5 * self.draught + self.beam**2 / (12.0 * self.draught) - self.gravity_height

    @property
    def steady_load(self) -> float:
        """Wind on the freeboard and current on the draught by hand [N]."""
        wind = 0.5 * 1.225 * 1.2 * self.length * (self.hull - self.draught) * self.wind**2
        return wind + 0.5 * DENSITY * 1.5 * self.length * self.draught * self.current**2

    def write(self, folder: Path, *, duration: float = 600.0, analyses: str = "statics, frequency, time",
              settings: str = "") -> Path:  # fmt: skip
        """Write the case file and return its place."""
        path = folder / "case.yaml"
        text = TEXT.format(
            **{name: getattr(self, name) for name in self.__dataclass_fields__}, half_beam=0.5 * self.beam,
            gravity_height=self.gravity_height, gyradius=0.35 * self.beam, duration=duration, analyses=analyses,
            settings=settings,
        )  # fmt: skip
        path.write_text(text, encoding="utf-8")
        return path


def catenary_pretension(weight: float, line: float, drop: float, reach: float) -> tuple[float, float]:
    """Return horizontal pull and length on the bed of an inextensible chain with part of it on the bed.

    With a = H/w: the hanging length is s = sqrt(h^2 + 2 h a), its reach a asinh(s/a); found by bisection on H.
    """
    low, high = 1e-3 * weight * drop, 1e4 * weight * drop
    for _ in range(200):
        middle = math.sqrt(low * high)
        a = middle / weight
        hanging = math.sqrt(drop**2 + 2.0 * drop * a)
        low, high = (middle, high) if line - hanging + a * math.asinh(hanging / a) < reach else (low, middle)
    return middle, line - hanging


DESIGNS = (
    Design("small marina box", 4.0, 1.5, 1.0, 12.0, 6.0, 0.6, 3.0, 24, 21.0, 22.0),
    Design("concrete pontoon of a harbour", 6.0, 1.8, 1.2, 20.0, 8.0, 0.8, 3.5, 32, 31.0, 33.0),
    Design("pontoon of the tank model at full size", 10.0, 4.5, 3.0, 21.0, 10.0, 1.0, 4.8, 68, 54.5, 57.5),
    Design("wide pontoon", 15.0, 4.0, 2.5, 50.0, 15.0, 1.2, 4.5, 60, 61.8, 67.0, count=3),
    Design(
        "pontoon of an exposed harbour", 20.0, 3.6, 2.4, 40.0, 15.0, 1.5, 5.0, 70, 62.8, 70.0, wind=25.0, current=0.8
    ),
)
