"""In which flow the coefficients of a member were measured, and how far apart measurements lie there.

The half widths are stated allowances of this program, taken from the spread of published measurements of each kind;
they are no confidence limits of a test series. Theory: docs/answer/member.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.morison.coefficients import CoefficientRule, KeuleganCarpenterTable


@dataclass(frozen=True)
class MeasuredRange:
    """Where a coefficient was found and how well it is known there."""

    #: Of the law, in words.
    name: str
    #: Range of the Keulegan-Carpenter number of its source [-].
    keulegan_carpenter: tuple[float, float]
    #: Range of the Reynolds number of its source [-].
    reynolds: tuple[float, float]
    #: Allowance under the coefficient, as a part of it [-].
    below: float
    #: Allowance over the coefficient, as a part of it [-].
    above: float
    source: str
    #: What moved its allowance, in words.
    note: str = ""

    def holds(self, keulegan_carpenter: float, reynolds: float) -> bool:
        """Whether a flow lies inside the range."""
        low, high = self.keulegan_carpenter
        slow, fast = self.reynolds
        return low <= keulegan_carpenter <= high and slow <= reynolds <= fast


_ALL = (0.0, math.inf)
_SARPKAYA = "spread of oscillatory-flow and sea measurements, Sarpkaya and Isaacson (1981), chapter 3"
_LAMINAR = "Sarpkaya (1986), oscillating flow at small KC"

#: Drag by the name of its law; measured drag of circles in waves scatters by about a quarter
DRAG_RANGES: dict[str, MeasuredRange] = {
    "dnv_c205": MeasuredRange("drag of DNV-RP-C205", _ALL, (1e6, math.inf), 0.25, 0.25, _SARPKAYA),
    "api": MeasuredRange("drag of API RP 2A", (30.0, math.inf), (1e6, math.inf), 0.25, 0.25, "API RP 2A, 2.3.1b7"),
    "stokes_wang": MeasuredRange("laminar drag of Stokes and Wang", (0.0, 2.0), (0.0, 1e4), 0.10, 0.60, _LAMINAR),
    "steady": MeasuredRange("drag of steady flow", (20.0, math.inf), _ALL, 0.20, 0.50, _SARPKAYA),
}  # fmt: skip
#: Inertia by the name of its law: vortices take up to a fifth or more of the ideal coefficient, hardly anything adds
INERTIA_RANGES: dict[str, MeasuredRange] = {
    "ideal": MeasuredRange("inertia of ideal fluid", (0.0, 5.0), _ALL, 0.20, 0.05, _SARPKAYA),
    "dnv_c205": MeasuredRange("inertia of DNV-RP-C205", _ALL, (1e6, math.inf), 0.15, 0.15, _SARPKAYA),
    "api": MeasuredRange("inertia of API RP 2A", (30.0, math.inf), (1e6, math.inf), 0.20, 0.25, "API RP 2A, 2.3.1b7"),
    "stokes_wang": MeasuredRange("laminar inertia of Stokes and Wang", (0.0, 2.0), (0.0, 1e4), 0.20, 0.05, _LAMINAR),
}  # fmt: skip
#: Circulation of orbital flow: gamma of 0.936 to 1.036 in three series of measurements, KC up to 2
CIRCULATION = MeasuredRange("circulation of orbital flow", (0.0, 2.0), _ALL, 0.10, 0.10, "Arai; Otsuka; Chaplin")
#: Numbers of the case itself, whose measurement the program does not have
GIVEN = 0.25, 0.10


def drag_range(rule: CoefficientRule) -> MeasuredRange:
    """Return the range of the drag of a rule."""
    if isinstance(rule.drag, str):
        return DRAG_RANGES[rule.drag]
    return _own(rule.drag, "drag", GIVEN[0])


def inertia_range(rule: CoefficientRule) -> MeasuredRange:
    """Return the range of the inertia of a rule."""
    if isinstance(rule.inertia, str):
        return INERTIA_RANGES[rule.inertia]
    return _own(rule.inertia, "inertia", GIVEN[1])


def _own(value: object, what: str, allowance: float) -> MeasuredRange:
    """Return the range of numbers or a table of the case."""
    if isinstance(value, KeuleganCarpenterTable):
        limits = (value.rows[0][0], value.rows[-1][0])
        return MeasuredRange(f"table of the {what}", limits, _ALL, allowance, allowance, "the case file")
    return MeasuredRange(f"{what} coefficient of the case", _ALL, _ALL, allowance, allowance, "the case file")
