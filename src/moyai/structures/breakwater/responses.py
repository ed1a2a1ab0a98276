"""What motions do to lines and deck: tensions, uplift at the anchors, water against the deck edge."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.validity import Notice
from moyai.floating.drift import DriftedMotions
from moyai.floating.frequency import Motions, relative_elevation
from moyai.floating.irregular import response_statistics
from moyai.mooring.lines import LineElement, SpringLine
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.hydrodynamics import wavelengths

PHASES = 72  # instants of a cycle at which the nonlinear lines are looked up along the linear orbit
PEAKS_LOOKED_UP = 50
SNAP_RATIO = 5.0  # largest over mean tension beyond which a quasi-static peak is not to be trusted alone


def line_tensions(unit: FloatingUnit, solved: DriftedMotions, moving: ComplexArray) -> dict[str, Array]:
    """Tension of one line of each kind: mean and amplitude (linear), largest and smallest along the linear orbit.

    The exact lines are evaluated at the positions of a cycle; lines are at rest at each of them (quasi-static).
    """
    planar, count = unit.mooring.planar, len(moving)
    kinds = len(unit.lines)
    names = (
        "line_tension_mean",
        "tension_amplitude",
        "line_tension_maximum",
        "line_tension_minimum",
        "anchor_vertical_tension_maximum",
    )
    out = {name: np.zeros((count, kinds)) for name in names}
    if not kinds:
        return out
    phase = np.exp(-2j * math.pi * np.arange(PHASES) / PHASES)
    for index in range(count):
        offset, orbit = solved.offset[index], np.nan_to_num(moving[index])
        path = offset + (phase[:, None] * orbit).real
        states = planar.states(
            np.concatenate([offset[None], path, offset + 1e-3 * orbit.real[None], offset + 1e-3 * orbit.imag[None]])
        )
        for column, state in enumerate(states.values()):
            pull = state.tension_fairlead
            out["line_tension_mean"][index, column] = pull[0]
            # The linear amplitude from small steps along the two quadratures of the orbit
            out["tension_amplitude"][index, column] = 1e3 * abs(complex(pull[-2] - pull[0], pull[-1] - pull[0]))
            out["line_tension_maximum"][index, column] = pull[: PHASES + 1].max()
            out["line_tension_minimum"][index, column] = pull[: PHASES + 1].min()
            out["anchor_vertical_tension_maximum"][index, column] = state.vertical_tension_anchor[: PHASES + 1].max()
    load = np.array([line.breaking_load for line in unit.lines])
    out["maximum_utilisation"] = np.where(np.isfinite(load), out["line_tension_maximum"] / load, np.nan)
    return out


def tension_transfer(unit: FloatingUnit, motions: Motions, offset: Array) -> tuple[ComplexArray, Array]:
    """Linear tension per wave amplitude (n, h, lines) about the mean offset, and the mean tensions."""
    if not unit.lines:
        return np.zeros((*motions.displacement.shape[:2], 0), dtype=complex), np.zeros(0)
    steps = np.diag([1e-4 * unit.breakwater.hull.beam, 1e-4 * unit.breakwater.hull.beam, 1e-4])
    around = np.concatenate([offset[None], offset + steps, offset - steps])
    pull = unit.mooring.planar.tensions(around)
    slope = (pull[1:4] - pull[4:7]) / (2.0 * np.diag(steps))[:, None]
    return motions.displacement @ slope, pull[0]


def anchor_loads(unit: FloatingUnit, position: Array, tension: Array) -> tuple[Array, Array, Array]:
    """Return largest vertical and horizontal tension at the anchor of each kind of line [N], and least grounded length.

    The exact lines are solved at the instants of the largest fairlead tensions, where both are largest too.
    """
    kinds = len(unit.lines)
    if not kinds or not len(position):
        return np.zeros(kinds), np.zeros(kinds), np.zeros(kinds)
    count = min(PEAKS_LOOKED_UP, len(position))
    instants = np.unique(np.argpartition(-tension, count - 1, axis=0)[:count])
    states = unit.mooring.planar.states(position[instants]).values()
    return (
        np.array([state.vertical_tension_anchor.max() for state in states]),
        np.array([state.horizontal_tension.max() for state in states]),
        np.array([state.grounded_length.min() for state in states]),
    )


def snap_notices(where: str, lines: Sequence[LineElement], largest: Array, mean: Array) -> tuple[Notice, ...]:
    """Warn of lines whose largest tension leaves the mean far behind: they go taut, and are taken to be at rest.

    Springs have no drag, no inertia and no shock of their own.

    Parameters
    ----------
    where : str
        Level and sea.
    lines : sequence of LineElement
    largest, mean : ndarray (..., lines)
        Tensions [N]; the worst over the leading axes counts.
    """
    if not lines or not np.size(largest):
        return ()
    ratio = np.where(mean > 0.0, largest / np.where(mean > 0.0, mean, 1.0), 0.0).reshape(-1, len(lines))
    worst = np.nan_to_num(ratio).max(axis=0)
    return tuple(
        Notice(
            "quasi-static-snap",
            f"{where}: line {line.name} reaches {value:.1f} times its mean tension; lines are at rest at every "
            "instant, so that drag, inertia and the shock of a line going taut are not in this peak",
            value=float(value),
            limit=SNAP_RATIO,
            remedy="slacken or lengthen the line, or take the peak as a lower bound and use a dynamic line model",
        )
        for line, value in zip(lines, worst)
        if value > SNAP_RATIO and not isinstance(line, SpringLine)
    )


def deck_relative_elevation(unit: FloatingUnit, motions: Motions, k: Array, heading: float) -> Array:
    """Amplitude of the water surface relative to the seaward deck edge per wave amplitude [eq:breakwater-overtopping].

    The surface is the incident wave times something between one, where it passes, and two, as at a wall. The motion of
    the edge may go with it or against it: the larger of both ends bounds all that lies between, since the modulus is
    convex.
    """
    side = -1.0 if math.cos(heading) >= 0.0 else 1.0
    point = (side * 0.5 * unit.breakwater.hull.beam, unit.freeboard)
    incident = np.exp(1j * k * point[0] * math.cos(heading))[:, None]
    ends = [relative_elevation(motions, point, unit.centre, factor * incident)[:, 0] for factor in (1.0, 2.0)]
    return np.asarray(np.abs(ends).max(axis=0))


def overtopping_notices(unit: FloatingUnit, name: str, elevation: Array) -> tuple[Notice, ...]:
    worst = float(np.nanmax(elevation)) if np.isfinite(elevation).any() else 0.0
    if worst <= unit.freeboard:
        return ()
    return (
        Notice(
            "overtopping",
            f"{unit.name}, {name}: water and seaward deck edge move {worst:.3g} m towards each other, more than the "
            f"freeboard of {unit.freeboard:.3g} m: the edge goes under water",
            value=worst,
            limit=unit.freeboard,
            remedy="waves over the deck pass energy that linear theory does not count; raise the deck",
            source="incident wave, once and doubled as at a wall, against linear motion",
        ),
    )


def overtopping_share(
    unit: FloatingUnit, motions: Motions, omega: Array, headings: Array, directional: Array
) -> tuple[float, float]:
    """Return the share of waves over the deck edge [eq:breakwater-overtopping] and the significant double amplitude."""
    k = 2.0 * math.pi / wavelengths(omega, unit)
    columns = []
    for column, heading in enumerate(headings):
        one = replace(
            motions, heading=headings[column : column + 1], displacement=motions.displacement[:, column : column + 1]
        )
        columns.append(deck_relative_elevation(unit, one, k, float(heading)))
    statistics = response_statistics(omega, np.stack(columns, axis=1)[..., None], directional)
    significant = float(statistics.significant[0])
    if unit.freeboard <= 0.0:
        return 1.0, significant
    return (math.exp(-2.0 * unit.freeboard**2 / (0.5 * significant) ** 2) if significant > 0.0 else 0.0), significant
