"""Members: ideal inertia coefficients, circulation, laminar flow, identification."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.morison import sections
from moyai.morison.circulation import STRENGTHS, inertia_reduction, settled_circulation
from moyai.morison.forces import strip_forces
from moyai.morison.planar import stokes_wang_drag, stokes_wang_inertia
from moyai.records.forces.identification import ForceRecord, Setup, identify

_FREQUENCY, _BREADTH = 0.95, 0.045
_ARAI = "Arai et al., horizontal cylinders in regular waves at low KC"
_MAP = "Schwarz-Christoffel map of the exterior"


def _triangle_capacity() -> float:
    """Return C_M of an equilateral triangle, 2 pi cap^2 / A, with the capacity of a regular polygon."""
    side = 1.0
    gamma = math.gamma
    capacity = side * gamma(1 / 3) / (2 ** (5 / 3) * math.sqrt(math.pi) * gamma(5 / 6))
    return 2.0 * math.pi * capacity**2 / (math.sqrt(3.0) / 4.0 * side**2)


def _triangle() -> float:
    points = [(0.0, 0.0), (1.0, 0.0), (0.5, math.sqrt(0.75))]
    return float(sections.polygon(points).inertia.tensor[1, 1])


def _fall(section: sections.MemberSection, strength: str) -> float:
    speed = _FREQUENCY * _BREADTH
    circulation = settled_circulation(STRENGTHS[strength], speed, speed, 1.0 / _FREQUENCY)
    return float(inertia_reduction(circulation, 2.0 * math.pi * _FREQUENCY, section.area, speed, speed)[0])


def _circulation(number: float) -> float:
    speed = number * _FREQUENCY * _BREADTH
    return float(settled_circulation(STRENGTHS["arai"], speed, speed, 1.0 / _FREQUENCY)) * 1e4


def _magnus() -> float:
    """Amplitude of the Magnus force over the model of 79 cm at KC = 1 [N], from the force law itself."""
    speed, omega = _FREQUENCY * _BREADTH, 2.0 * math.pi * _FREQUENCY
    section = sections.rectangle(0.045, 0.024)
    angle = np.linspace(0.0, 2.0 * math.pi, 73)
    velocity = speed * np.column_stack([np.cos(angle), -np.sin(angle)])
    rate = omega * speed * np.column_stack([-np.sin(angle), -np.cos(angle)])
    circulation = settled_circulation(STRENGTHS["arai"], speed, speed, 1.0 / _FREQUENCY)
    found = strip_forces(
        velocity,
        rate,
        density=1000.0,
        area=section.area,
        inertia=section.inertia.tensor,
        drag=(0.0, 0.0),
        drag_widths=section.drag_widths,
        circulation=circulation,
    )
    return float(np.linalg.norm(found.magnus, axis=1).max()) * 0.79


def _identified(name: str) -> float:
    """One coefficient out of a clean record of a sine, 37.7 samples a period, KC 1.5."""
    time = np.asarray(0.0279 * np.arange(400), dtype=float)
    omega, area = 2.0 * math.pi * _FREQUENCY, math.pi / 4.0 * _BREADTH**2
    peak = 1.5 * _BREADTH * _FREQUENCY
    velocity = np.asarray(peak * np.cos(omega * time), dtype=float)
    rate = -peak * omega * np.sin(omega * time)
    force = 1000.0 * area * 1.573 * rate + 500.0 * _BREADTH * 1.21 * velocity * np.abs(velocity)
    setup = Setup(1000.0, area, (_BREADTH,), period=1.0 / _FREQUENCY, methods=("fourier",), bootstrap=50)
    fit = identify(ForceRecord(time, force, velocity), setup).fit("fourier")
    return float(getattr(fit, name).value)


_CIRCLE, _SQUARE, _RECTANGLE = (
    sections.circle(_BREADTH),
    sections.rectangle(_BREADTH, _BREADTH),
    sections.rectangle(_BREADTH, 0.024),
)

CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "morison: ideal C_M, circle", "closed form", lambda: float(_CIRCLE.inertia.tensor[0, 0]), 2.0, 1e-12
    ),
    ValidationCase(
        "morison: ideal C_M, square",
        f"{_MAP}: 2 pi cap^2 / A",
        lambda: float(_SQUARE.inertia.tensor[0, 0]),
        2.1884396152264767,
        1e-7,
    ),
    ValidationCase(
        "morison: ideal C_M, rectangle 45 x 24, along its long side",
        _MAP,
        lambda: float(_RECTANGLE.inertia.tensor[0, 0]),
        1.7026,
        5e-5,
        False,
        "digits of the source",
    ),
    ValidationCase(
        "morison: ideal C_M, rectangle 45 x 24, across it",
        _MAP,
        lambda: float(_RECTANGLE.inertia.tensor[1, 1]),
        3.0266,
        5e-5,
        False,
        "digits of the source",
    ),
    ValidationCase(
        "morison: ideal C_M, equilateral triangle",
        "capacity of regular polygons in gamma functions",
        _triangle,
        _triangle_capacity(),
        1e-7,
    ),
    ValidationCase(
        "morison: ideal C_M, thin rectangle 1000 : 1, added mass over that of a plate",
        "flat plate, rho pi c^2 / 4",
        lambda: float(sections.rectangle(1.0, 1e-3).inertia.added_mass[1, 1]) * 1e-3 / (math.pi / 4.0),
        1.0,
        0.007,
        True,
        "the thickness itself adds about t ln(1/t)",
    ),
    ValidationCase(
        "morison: fall of C_M at KC = 1, circle",
        f"{_ARAI}, eq. (8)",
        lambda: _fall(_CIRCLE, "arai"),
        0.19,
        0.005,
        False,
        "rounded by the paper",
    ),
    ValidationCase(
        "morison: fall of C_M at KC = 1, square",
        f"{_ARAI}, eq. (9)",
        lambda: _fall(_SQUARE, "arai"),
        0.15,
        0.005,
        False,
        "rounded by the paper",
    ),
    ValidationCase(
        "morison: fall of C_M at KC = 1, rectangle",
        f"{_ARAI}, eq. (10)",
        lambda: _fall(_RECTANGLE, "arai"),
        0.28,
        0.005,
        False,
        "rounded by the paper",
    ),
    ValidationCase(
        "morison: fall of C_M at KC = 1, Chaplin",
        "Chaplin (1984), C_M = 2 - 0.21 KC^2",
        lambda: _fall(_CIRCLE, "chaplin"),
        0.21,
        1e-12,
    ),
    ValidationCase(
        "morison: fall of C_M at KC = 1, Otsuka",
        "Otsuka and Ikeda (1993), 2/pi^2",
        lambda: _fall(_CIRCLE, "otsuka"),
        2.0 / math.pi**2,
        1e-12,
    ),
    ValidationCase("morison: circulation at KC = 2 in cm2/s", _ARAI, lambda: _circulation(2.0), 72.0, 1e-12),
    ValidationCase(
        "morison: Magnus force on 79 cm at KC = 1 in N", f"{_ARAI}, figure 14", _magnus, 6.08e-2, 1e-3, True, "digits"
    ),
    ValidationCase(
        "morison: laminar planar C_M at beta 1690",
        "Stokes and Wang",
        lambda: float(stokes_wang_inertia(1690.0)),
        2.0549,
        5e-5,
        False,
        "digits of the source",
    ),
    ValidationCase(
        "morison: laminar planar C_D KC at beta 1035",
        "Stokes and Wang",
        lambda: float(stokes_wang_drag(1.0, 1035.0)),
        0.8299,
        5e-5,
        False,
        "digits of the source",
    ),
    ValidationCase("morison: C_M identified", "planted in a clean record", lambda: _identified("inertia"), 1.573, 1e-9),
    ValidationCase("morison: C_D identified", "planted in a clean record", lambda: _identified("drag"), 1.21, 1e-9),
)
