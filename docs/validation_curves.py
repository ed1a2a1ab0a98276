"""Curves of the validation pages: what moyai computes at this build as points on the exact curve."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

_SIZE, _LEFT, _TOP, _RIGHT, _FOOT = (460, 260), 44, 24, 10, 36


def chart(
    curves: Sequence[tuple[str, NDArray[np.float64], NDArray[np.float64]]],
    points: Sequence[tuple[str, NDArray[np.float64], NDArray[np.float64]]],
    axes: tuple[str, str],
    ranges: tuple[tuple[float, float], tuple[float, float]],
    *,
    logarithmic: bool = False,
) -> str:
    """Return curves and points over linear axes, or over a logarithmic abscissa, as SVG.

    Parameters
    ----------
    curves, points : sequence of (name, abscissae, ordinates)
    axes : (str, str)
        Words of both axes.
    ranges : ((float, float), (float, float))
    logarithmic : bool
    """
    (x0, x1), (y0, y1) = ranges
    width, height = _SIZE[0] - _LEFT - _RIGHT, _SIZE[1] - _TOP - _FOOT

    def across(values: NDArray[np.float64]) -> NDArray[np.float64]:
        if logarithmic:
            return np.asarray(_LEFT + width * np.log(values / x0) / np.log(x1 / x0))
        return np.asarray(_LEFT + width * (values - x0) / (x1 - x0))

    def up(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(_TOP + height * (y1 - values) / (y1 - y0))

    if logarithmic:
        steps = [base * 10.0**power for power in range(-3, 4) for base in (1.0, 2.0, 5.0)]
        marks = np.array([step for step in steps if x0 <= step <= x1])
    else:
        marks = np.linspace(x0, x1, 6)
    parts = [f'<rect x="{_LEFT}" y="{_TOP}" width="{width}" height="{height}" fill="none" stroke="#9aa5b1"/>']
    for value, x in zip(marks, across(marks), strict=True):
        parts.append(f'<text x="{x:.1f}" y="{_SIZE[1] - 22}" text-anchor="middle">{value:g}</text>')
        parts.append(f'<path d="M{x:.1f} {_TOP}v{height}" stroke="#eef1f4"/>')
    heights = np.linspace(y0, y1, 6)
    for value, y in zip(heights, up(heights), strict=True):
        parts.append(f'<text x="{_LEFT - 5}" y="{y + 4:.1f}" text-anchor="end">{value:.3g}</text>')
        parts.append(f'<path d="M{_LEFT} {y:.1f}h{width}" stroke="#eef1f4"/>')
    colours = ("#1b6ca8", "#c2571a", "#2a8a4a")
    for number, (name, x, y) in enumerate(curves):
        path = "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in zip(across(x), up(y), strict=True))
        parts.append(f'<path d="{path}" fill="none" stroke="{colours[number]}" stroke-width="1.5"/>')
        at = _LEFT + 4 + 150 * number
        parts.append(f'<path d="M{at} 12h16" stroke="{colours[number]}" stroke-width="1.5"/>')
        parts.append(f'<text x="{at + 20}" y="16">{name}</text>')
    for number, (name, x, y) in enumerate(points):
        for a, b in zip(across(x), up(y), strict=True):
            parts.append(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3.4" fill="none" stroke="#1b2430" stroke-width="1.2"/>')
        if not number:
            at = _LEFT + 4 + 150 * len(curves)
            parts.append(f'<circle cx="{at + 8}" cy="12" r="3.4" fill="none" stroke="#1b2430" stroke-width="1.2"/>')
            parts.append(f'<text x="{at + 20}" y="16">{name}</text>')
    parts.append(f'<text x="{_LEFT + width / 2}" y="{_SIZE[1] - 6}" text-anchor="middle">{axes[0]}</text>')
    middle = _TOP + height / 2
    parts.append(f'<text x="12" y="{middle}" text-anchor="middle" transform="rotate(-90 12 {middle})">{axes[1]}</text>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_SIZE[0]} {_SIZE[1]}" font-family="sans-serif" '
        f'font-size="11" fill="#1b2430"><rect width="100%" height="100%" fill="#fff"/>{"".join(parts)}</svg>'
    )


def struck_string(records: Sequence[dict[str, Any]]) -> tuple[str, str]:
    """Return the peak of a string struck by its end mass over the mass, with the words below the picture."""
    head = "flexible: string struck by its end mass, M/mL = "
    found = {float(one["name"].removeprefix(head)): one["value"] for one in records if one["name"].startswith(head)}
    ratios = np.linspace(0.8, 5.0, 200)
    svg = chart(
        [("2 (1 + exp(-2mL/M))", ratios, 2.0 * (1.0 + np.exp(-2.0 / ratios)))],
        [("250 bars", np.array(list(found)), np.array(list(found.values())))],
        ("mass over that of the string, M/mL", "peak at the fixed end over V √(EA m)"),
        ((0.0, 5.0), (2.0, 3.5)),
    )
    return svg, "A string stopped by its end mass: the table's values on the closed form of Saint-Venant."


def barrier(records: Sequence[dict[str, Any]]) -> tuple[str, str]:
    """Return reflection and transmission of a barrier in deep water over the frequency, with the words below it."""
    from scipy.special import i1, k1

    from moyai.potential.modes import Modes, Rigid
    from moyai.potential.solver import solve
    from moyai.potential.thin_plate import Plate
    from moyai.potential.thin_plate_waves import plate_section
    from moyai.sea.water import Water

    del records
    x = np.geomspace(0.05, 5.0, 200)
    size = np.hypot(math.pi * i1(x), k1(x))
    at = np.geomspace(0.07, 4.0, 12)
    section, sway = plate_section(Plate((0.0, 0.0), (0.0, -1.0))), Modes(("sway",), (Rigid("sway"),))
    waves = solve(section, Water(math.inf, 1.0, 9.81), list(np.sqrt(9.81 * at)), modes=sway)
    found = [
        ("this build", at, np.abs(values))
        for values in (waves.normal.reflection_coefficient, waves.normal.transmission_coefficient)
    ]
    svg = chart(
        [("reflection, Ursell", x, math.pi * i1(x) / size), ("transmission, Ursell", x, k1(x) / size)],
        found,
        ("wave number times draught, Kd", "share of the incident height"),
        ((0.05, 5.0), (0.0, 1.0)),
        logarithmic=True,
    )
    return svg, "A thin barrier in deep water: points of this build on Ursell's closed form (1947)."


CURVES: dict[str, Callable[[Sequence[dict[str, Any]]], tuple[str, str]]] = {
    "struck_string": struck_string,
    "barrier": barrier,
}
