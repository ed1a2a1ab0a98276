"""Validation of the whole span of a curtain: dynamic cable, span of cables and skirt, cloth, sections of added mass."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.flexible import sheet_kernel
from moyai.flexible.sheets import Sheets, sheet_grid
from moyai.sea.water import Water
from moyai.structures.curtain.dynamic.cable import dynamic_cable
from moyai.structures.curtain.dynamic.model import CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.runs import run_span
from moyai.structures.curtain.dynamic.section import section_mesh
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy

_FLUME = Water(0.40, 1000.0, 9.81)


def _cable(length: float, start: str) -> float:
    """Return the peak of the dynamic cable over that of model A, with added mass times acceleration alone."""
    impact = Impact(0.7, length, 0.15, 75.0, 75.0, 0.3, _FLUME)
    found = dynamic_cable(impact, own_mass=0.14, start=start, convective=False, segments=40)  # type: ignore[arg-type]
    return found.tension / peak_by_energy(impact).tension


def _cable_energy() -> float:
    return 1.0 + dynamic_cable(Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, _FLUME), own_mass=0.14, segments=40).energy_drift


def _span(profile: str) -> float:
    """Return the peak of both cables of the flume case on 24 x 8 cells [N]."""
    span = CurtainSpan(0.7, 0.8, 0.15, 0.135, 75.0, 75.0, 0.0625, 0.0625, 2e4, 0.1)
    rise = peak_by_energy(Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, _FLUME)).time
    run = run_span(
        span, Mesh(24, 8, cable_viscosity=0.0036, skirt_damping_time=1e-5), _FLUME, duration=1.2 * rise,
        output_step=rise / 50.0, speed=0.3, profile=profile, weight=False, deep=True,  # type: ignore[arg-type]
    )  # fmt: skip
    return run.peak("both")[0]


def _lower_edge() -> float:
    mesh = section_mesh(1.0, 1.0, 8, math.inf, 1.0)
    down = np.linspace(0.0, 1.0, 9)
    return float(down @ mesh.added_mass[:9, :9] @ down)


def _wrinkled() -> float:
    """Return the energy of isotropic cloth, stretched one way and gathered the other, over that of a single pull."""
    triangles, rest = sheet_grid(np.arange(4).reshape(2, 2), [0.0, 1.0], [0.0, 1.0])
    sheets = Sheets(triangles, rest, 1000.0, 1000.0, 1000.0 / 2.6, 0.3)
    angle, pull, push = 0.4, 0.01, -0.02
    c, s = math.cos(angle), math.sin(angle)
    strain = pull * c * c + push * s * s, pull * s * s + push * c * c, 2.0 * (pull - push) * c * s
    return float(sheet_kernel.tensile_stress(sheets.constants(_FLUME), 0, *strain)[3] / (0.5 * 1000.0 * pull**2))


_PROTOTYPE = "independent prototype, two digits given"
_OF_MODEL = "added mass times acceleration alone, as the prototype; its viscosity is not known to the digit"


def _cable_case(length: float, reference: float) -> ValidationCase:
    return ValidationCase(
        f"curtain: dynamic cable over model A, sag start, l = {length:g} m",
        _PROTOTYPE, partial(_cable, length, "sag"), reference, 0.01, note=_OF_MODEL,
    )  # fmt: skip


def _span_case(profile: str, reference: float, tolerance: float) -> ValidationCase:
    return ValidationCase(
        f"curtain: span of 24 x 8 cells, {profile} start [N]",
        "independent prototype, the same mesh", partial(_span, profile), reference, tolerance,
        note="masses of the cables and the viscosity of the prototype are not known",
    )  # fmt: skip


CASES: tuple[ValidationCase, ...] = (
    _cable_case(0.8, 0.955),
    _cable_case(1.0, 1.016),
    _cable_case(0.72, 0.92),
    ValidationCase(
        "curtain: energy of the dynamic cable over that of its start", "identity", _cable_energy, 1.0, 1e-3,
        note="2 % of critical damping on the mesh",
    ),
    _span_case("sag", 8.92, 0.03),
    _span_case("uniform", 11.17, 0.03),
    ValidationCase(
        "curtain: section, mass of the lower edge over rho d^2", "pi/16, exact", _lower_edge, math.pi / 16.0, 1e-4
    ),
    ValidationCase("sheets: energy of a wrinkled single pull", "isotropic tension field, exact", _wrinkled, 1.0, 1e-9),
)  # fmt: skip
