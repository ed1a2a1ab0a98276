"""Thin plates in the limits of frequency against closed forms."""

from __future__ import annotations

import math

from moyai.core.validation import ValidationCase
from moyai.potential.thin_plate import Plate, hanging_arc, solve_plate_limit
from moyai.sea.water import Water

_APERY = 1.2020569031595942


def _hanging(depth: float, frequency: str = "infinite") -> float:
    plate, water = Plate((0.0, 0.0), (0.0, -1.0)), Water(depth, 1.0, 9.81)
    limit = solve_plate_limit(plate, water, frequency="zero" if frequency == "zero" else "infinite")
    return float(limit.added_mass[0, 0])


def _half_circle() -> float:
    limit = solve_plate_limit(hanging_arc(1.0, 0.0), Water(math.inf, 1.0, 9.81))
    return float(limit.added_mass[0, 0]) * math.pi / 2.0


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "thin plates: flat plate, infinite frequency, deep water",
        "2 rho d^2 / pi, Sawaragi, Aoki and Liu (1991) eq. 1",
        lambda: _hanging(math.inf),
        2.0 / math.pi,
        1e-10,
    ),
    ValidationCase(
        "thin plates: flat plate that stands on the bed",
        "28 zeta(3) / pi^3, closed form",
        lambda: _hanging(1.0),
        28.0 * _APERY / math.pi**3,
        1e-8,
    ),
    ValidationCase(
        "thin plates: zero frequency, depth twice the draught",
        "-(4 rho h^2 / pi) ln cos(pi d / 2h), closed form",
        lambda: _hanging(2.0, "zero"),
        -16.0 / math.pi * math.log(math.cos(0.25 * math.pi)),
        1e-6,
    ),
    ValidationCase(
        "thin plates: half circle over flat plate",
        "vortex panels of another construction: 1.461 +- 0.003; Sawaragi, Aoki and Liu (1991): about 1.4",
        _half_circle,
        1.461,
        0.003,
        False,
        "spread of the source",
    ),
)
