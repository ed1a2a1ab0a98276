"""The road from a case file to a problem: units against their definitions, directions, and numbers done by hand."""

from __future__ import annotations

import math
from pathlib import Path

from moyai.case.builder import build
from moyai.case.headings import heading_of
from moyai.case.reader import case_of, derived_numbers
from moyai.case.schema_environment import WindKeys
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core import quantities
from moyai.core.quantities import QuantityKind, to_si
from moyai.core.validation import ValidationCase

_NIST = "NIST SP 811 (2008), appendix B, conversion factors"


def _unit(text: str, kind: QuantityKind, reference: float, source: str = _NIST) -> ValidationCase:
    return ValidationCase(
        f"foundation: {text} in {kind.unit or 'numbers'}", source, lambda: to_si(text, kind), reference, 5e-7, True,
        "printed to seven digits"
    )  # fmt: skip


def _template_number(label: str) -> float:
    """Return a derived number of the breakwater template, read from its text."""
    case = case_of(parse_yaml(template("breakwater"), "breakwater.yaml"), Path("breakwater.yaml"))
    return next(number.value for number in derived_numbers(case) if number.label == label)


def _northing_of_travel() -> float:
    """Return the northward part of the travel of waves from 300 degrees, by the heading with +x at 240 degrees."""
    wind = WindKeys.model_validate({"speed": 1.0, "density": 1.2, "from_bearing_deg": 300.0})
    heading = heading_of(wind, 240.0, "wind")
    axis = math.radians(240.0)
    # +y lies a quarter turn to the left of +x, thus at bearing 150
    return math.cos(heading) * math.cos(axis) + math.sin(heading) * math.cos(axis - math.pi / 2.0)


def _units_do_not_matter() -> float:
    """Return the difference of two masses: the template in metres and in millimetres."""
    text = template("breakwater")
    other = text.replace("beam: 10 m, height: 4.5 m}", "beam: 1e4 mm, height: 450 cm}", 1)
    problems = [build(case_of(parse_yaml(found, "a.yaml"), Path("a.yaml"))) for found in (text, other)]
    areas = [problem.breakwater.hull.immersed(3.0).area for problem in problems]
    return float(abs(areas[0] - areas[1]))


CASES: tuple[ValidationCase, ...] = (
    _unit("1 lbf", quantities.FORCE, 4.448222),
    _unit("1 kip", quantities.FORCE, 4448.222),
    _unit("1 psi", quantities.PRESSURE, 6894.757),
    _unit("1 tf", quantities.FORCE, 9806.65),
    _unit("1 kn", quantities.SPEED, 0.5144444),
    _unit("1 ft", quantities.LENGTH, 0.3048),
    _unit("1 kgf/cm2", quantities.PRESSURE, 98066.5),
    _unit("1 deg", quantities.ANGLE, 0.01745329),
    _unit("1 rpm", quantities.ANGULAR_FREQUENCY, 0.1047198),
    ValidationCase(
        "foundation: waves from 300 degrees travel to 120 degrees",
        "compass: the northward part of a travel to 120 degrees is cos 120",
        _northing_of_travel,
        -0.5,
        1e-12,
        True,
        "rounding",
    ),
    ValidationCase(
        "foundation: metacentric height of the template's box",
        "box: GM = B^2/(12 d) + d/2 - KG, by hand",
        lambda: _template_number("metacentric height GM"),
        100.0 / 36.0 + 1.5 - 2.29,
        1e-9,
        True,
        "rounding",
    ),
    ValidationCase(
        "foundation: displacement of the template's box",
        "box: rho B d l, by hand",
        lambda: _template_number("displaced mass"),
        1025.0 * 10.0 * 3.0 * 21.0,
        1e-9,
        True,
        "rounding",
    ),
    ValidationCase(
        "foundation: one section in metres and in millimetres",
        "identity",
        _units_do_not_matter,
        0.0,
        0.0,
        False,
        "decimal units are converted exactly",
    ),
)
