"""Rows of floating units in three dimensions: identities, exact waves around barriers, the section as the limit.

They need Capytaine; without it there are none of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
from scipy.special import fresnel, h1vp, hankel1, jv, jvp

from moyai.core.arrays import Array, ComplexArray
from moyai.core.validation import ValidationCase
from moyai.potential.shapes import rectangle
from moyai.sea.environment import Environment
from moyai.sea.water import Water
from moyai.structures.units.assembly import RowAtLevel, assemble
from moyai.structures.units.bem import MeshPanels, elevation_at, given_flow, panels_of, solve_frequency
from moyai.structures.units.field import height_ratio, line_transmission, map_points, wave_field
from moyai.structures.units.hydrodynamics import RowHydrodynamics, solve_row
from moyai.structures.units.mesh import PanelMesh, cuts, row_mesh, turned_round
from moyai.structures.units.model import Connector, FloatingRow, MapArea, straight_row
from moyai.structures.units.response import RowModel, RowResponse, far_waves, respond
from moyai.structures.units.section import section_answer
from moyai.validation._screens import waves_on_screens

WATER = Water(10.0, 1025.0, 9.81)
OMEGA = np.array([0.8, 1.2, 1.6])
HEADINGS = np.radians([0.0, 40.0, 80.0])
LENGTH = 20.0


def row(
    connectors: tuple[Connector, ...] = (), count: int = 2, gap: float = 1.0, length: float = LENGTH
) -> FloatingRow:
    """Return boxes of 10 m beam and 3 m draught in a row."""
    return FloatingRow(
        rectangle(10.0, 4.5), length, 3.0, 2.29, (5.8, 2.67, 6.0), straight_row(count, length, 1.0), connectors,
        damping_fraction=np.array([0.0, 0.0, 0.0, 0.0, 0.1, 0.0]),
    )  # fmt: skip


def at_rest(given: FloatingRow, water: Water = WATER) -> RowAtLevel:
    """Return a row at its only water level."""
    return assemble(given, Environment(water), "SWL", 0.0)


@cache
def two_boxes(lid: bool) -> RowHydrodynamics:
    """Return the coefficients of two boxes with a gap."""
    at = at_rest(row())
    mesh = row_mesh(at.section, LENGTH, at.row.placements, 2.0, lid=lid, gap_lid=False)
    return solve_row(panels_of(mesh, at.centres), WATER, at.centres, OMEGA, HEADINGS)


def response(connectors: tuple[Connector, ...]) -> tuple[RowAtLevel, RowResponse]:
    """Return two boxes with connectors in waves."""
    at = at_rest(row(connectors))
    return at, respond(RowModel(at, two_boxes(True), np.zeros(at.size)), OMEGA, np.zeros(len(at.joints)))


@cache
def rigid_halves() -> float:
    """Return the largest difference of motion of a box cut into two rigidly joined halves, over that of the whole."""
    whole = row(count=1, length=2.0 * LENGTH)
    half = LENGTH
    # an even mass of the whole is that of two halves with their distance
    away = 0.5 * half
    pitch, yaw = (math.hypot(radius, away) for radius in (5.8, 6.0))
    # damping as a fraction of critical is that of each half by itself: none here
    whole = replace(whole, gyradii=(pitch, 2.67, yaw), damping_fraction=np.zeros(6))
    at = at_rest(whole)
    mesh = row_mesh(at.section, 2.0 * LENGTH, whole.placements, 2.0, lid=True, gap_lid=False)
    one = solve_row(panels_of(mesh, at.centres), WATER, at.centres, OMEGA, HEADINGS)
    parts = replace(
        row((Connector("r", "rigid", ((0, 1),), 0.0, 3.0),)), placements=straight_row(2, LENGTH, 0.0),
        damping_fraction=np.zeros(6),
    )  # fmt: skip
    at_parts = at_rest(parts)
    cut = PanelMesh(mesh.corners, (mesh.centre[:, 1] > 0.0).astype(np.int64), mesh.part)
    two = solve_row(panels_of(cut, at_parts.centres), WATER, at_parts.centres, OMEGA, HEADINGS)
    alone = respond(RowModel(at, one, np.zeros(6)), OMEGA, np.zeros(0)).motion
    joined = respond(RowModel(at_parts, two, np.zeros(12)), OMEGA, np.zeros(1)).motion
    middle = 0.5 * (joined[..., :6] + joined[..., 6:])
    return float(np.max(np.abs(middle - alone)) / np.max(np.abs(alone)))


def spring_order() -> float:
    """Return by how much the difference between springs and a rigid connector falls with ten times the stiffness."""
    rigid = response((Connector("r", "rigid", ((0, 1),), 0.0, 3.0),))[1].motion
    apart = []
    for stiffness in (1e9, 1e10):
        springs = np.diag([stiffness] * 3 + [100.0 * stiffness] * 3)
        found = response((Connector("s", "spring", ((0, 1),), 0.0, 3.0, stiffness=springs),))[1].motion
        apart.append(float(np.max(np.abs(found - rigid))))
    return apart[0] / apart[1]


def hinge_moment() -> float:
    """Return the moment about the axis of a hinge over the largest moment that it carries."""
    load = response((Connector("h", "hinge", ((0, 1),), 0.0, 3.0, (1.0, 0.0, 0.0)),))[1].load
    return float(np.abs(load[..., 0, 3]).max() / np.abs(load[..., 0, 4:]).max())


def energy_of_headings() -> float:
    """Return the error of the energy balance of two hinged boxes, headings 0 to 80 degrees."""
    at, found = response((Connector("h", "hinge", ((0, 1),), 0.0, 3.0, (1.0, 0.0, 0.0)),))
    return float(np.abs(far_waves(RowModel(at, two_boxes(True), np.zeros(12)), found).balance).max())


@cache
def fine_box() -> RowHydrodynamics:
    """Return the coefficients of one box on fine panels."""
    at = at_rest(row(count=1))
    mesh = row_mesh(at.section, LENGTH, at.row.placements, 0.7, lid=True, gap_lid=False)
    return solve_row(panels_of(mesh, at.centres), WATER, at.centres, np.array([1.0]), HEADINGS)


def box_check(hydro: RowHydrodynamics, name: str) -> float:
    """Return one of the identities of a row."""
    return next(check.value for check in hydro.checks if name in check.name)


def split(mesh: PanelMesh) -> PanelMesh:
    """Return every panel cut in four."""
    a, b, c, d = (mesh.corners[:, index] for index in range(4))
    ab, bc, cd, da, middle = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d), 0.5 * (d + a), 0.25 * (a + b + c + d)
    fours = ((a, ab, middle, da), (ab, b, bc, middle), (middle, bc, c, cd), (da, middle, cd, d))
    corners = np.stack([np.stack(four, axis=1) for four in fours], axis=1).reshape(-1, 4, 3)
    return PanelMesh(corners, np.repeat(mesh.unit, 4), np.repeat(mesh.part, 4))


@cache
def refined_twice() -> tuple[Array, Array]:
    """Return coefficients of a box on 252 panels, cut in four once and twice (3, c), and the limit of even panels (c,).

    Added mass and damping of sway, heave and roll, and their excitation; even panels are those of Capytaine, on the
    mesh and its two refinements, led to the limit by the ratio of their changes (Aitken).
    """
    at = at_rest(row(count=1))
    mesh = row_mesh(at.section, LENGTH, at.row.placements, 3.2, lid=False, gap_lid=False)
    own: list[Array] = []
    even: list[Array] = []
    pick = [0, 2, 4]
    for _ in range(3):
        panels = panels_of(mesh, at.centres)
        for found, one in ((own, panels), (even, replace(panels, even=True))):
            solved = solve_frequency(one, WATER, 1.2, np.zeros(1))
            matrices = [item.diagonal()[pick] for item in (solved.added_mass, solved.damping)]
            found.append(np.concatenate([*matrices, np.abs(solved.excitation[0, pick])]))
        mesh = split(mesh)
    first, second, third = even
    return np.array(own), third + (third - second) ** 2 / ((second - first) - (third - second))


def from_limit(level: int) -> float:
    """Return the largest relative difference of coefficients from the limit of even panels."""
    own, limit = refined_twice()
    return float(np.max(np.abs(own[level] / limit - 1.0)))


@cache
def long_unit(length: float = 346.0, size: float = 2.6) -> dict[str, float]:
    """Return a unit of ten wave lengths in beam seas over the section: sway, heave, roll, mean drift.

    Of the transmission it is one and the difference, in parts of the incident height.
    """
    omega = np.array([1.3])
    given = replace(row(count=1, length=length), gyradii=(0.29 * length, 2.67, 0.29 * length))
    at = at_rest(given)
    mesh = row_mesh(at.section, length, given.placements, size, lid=False, gap_lid=False)
    hydro = solve_row(panels_of(mesh, at.centres), WATER, at.centres, omega, np.zeros(1))
    model = RowModel(at, hydro, np.zeros(6))
    found = respond(model, omega, np.zeros(0))
    alone = section_answer(at, omega, np.zeros(1))
    line = (30.0, -0.25 * length, 30.0, 0.25 * length)
    points = map_points(MapArea((-90.0, -80.0), (0.0, 1.0), (2, 2), (), line), at)
    ratio = height_ratio(wave_field(points, hydro), 0, found.motion[0], np.array([0]))[:, 0]
    drift = far_waves(model, found).drift[0, 0, 0] / alone.drift[0, 0]
    motion = np.abs(found.motion[0, 0, [0, 2, 4]]) / np.abs(alone.motion[0, 0])
    transmission = 1.0 + line_transmission(ratio[points.line]) - float(alone.transmission[0, 0])
    return {"sway": motion[0], "heave": motion[1], "roll": motion[2], "drift": drift, "transmission": transmission}


def sommerfeld(k: float, x: Array, y: Array) -> ComplexArray:
    """Return the waves e^{ikx} of unit amplitude behind and before a half plane x = 0, y < 0 (Sommerfeld 1896).

    Written with Fresnel integrals of the distance to the shadow lines of the incident and of the reflected wave.
    """

    def part(across: Array, along: Array) -> ComplexArray:
        angle = np.arctan2(y, along)
        angle = np.where((along < 0.0) & (y < 0.0), angle + 2.0 * math.pi, angle)
        sine, cosine = fresnel(across * 2.0 * np.sqrt(k * np.hypot(x, y) / math.pi) * np.sin(0.5 * angle))
        return np.asarray(0.5 * (1.0 - 1.0j) * ((0.5 + cosine) + 1.0j * (0.5 + sine)))

    one = np.ones_like(x)
    return np.asarray(part(one, x) * np.exp(1j * k * x) + part(-one, -x) * np.exp(-1j * k * x))


def _upright(plan: Array, depth: float, layers: int) -> PanelMesh:
    """Return the panels of an upright wall on a closed plan (n, 2), counter-clockwise, from the bed to the surface."""
    z = np.linspace(-depth, 0.0, layers + 1)
    panels = [
        [(*a, low), (*b, low), (*b, high), (*a, high)]
        for a, b in zip(plan.tolist(), np.roll(plan, -1, axis=0).tolist())
        for low, high in pairwise(z.tolist())
    ]
    count = len(panels)
    return PanelMesh(np.array(panels), np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64))


def scattered(mesh: PanelMesh, water: Water, k: float, points: Array) -> Array:
    """Return K (p,) at points (p, 2) of waves along x on a fixed body."""
    omega = math.sqrt(water.gravity * k * math.tanh(k * water.depth))
    panels: MeshPanels = panels_of(mesh, np.zeros((1, 3)))
    heading = np.zeros(1)
    found = solve_frequency(panels, water, omega, heading)
    given = given_flow(panels, water, omega, k, heading)[:, 6:]
    waves = elevation_at(points, panels, water, omega, found.diffraction, given)[:, 0]
    return np.asarray(np.abs(waves + np.exp(1j * k * points[:, 0])))


@cache
def barrier() -> tuple[Array, Array, Array]:
    """Return K behind a thin barrier of six wave lengths: computed, of a screen, and the sum of two half planes.

    On the axis, and on the shadow line of an end, two and four wave lengths behind.
    """
    k, length, thickness = 1.0, 12.0 * math.pi, 0.15
    y = cuts(length, 0.4, even=True) - 0.5 * length
    side = np.stack([np.full(len(y), 0.5 * thickness), y], axis=1)
    plan = np.concatenate([side, -side])
    points = 2.0 * math.pi * np.array([[2.0, 0.0], [4.0, 0.0], [2.0, 3.0], [4.0, 3.0]])
    planes = sommerfeld(k, points[:, 0], points[:, 1] - 0.5 * length)
    planes = planes + sommerfeld(k, points[:, 0], -0.5 * length - points[:, 1])
    screen = waves_on_screens(k, ((-0.5 * length, 0.5 * length),), points)
    found = scattered(_upright(plan, 0.6, 8), Water(0.6, 1000.0, 9.81), k, points)
    return found, np.abs(screen), np.abs(planes)


@cache
def gap() -> tuple[Array, Array, Array]:
    """Return K behind a gap of two wave lengths between thin barriers of three: computed, of screens, of half planes.

    On the axis four wave lengths behind, and behind an end of the gap at two and four.
    """
    k, width, length, thickness = 1.0, 4.0 * math.pi, 6.0 * math.pi, 0.1
    y = cuts(length, 0.35, even=True) + 0.5 * width
    side = np.stack([np.full(len(y), 0.5 * thickness), y], axis=1)
    one = _upright(np.concatenate([side, side[::-1] * np.array([-1.0, 1.0])]), 0.6, 5)
    other = PanelMesh(turned_round(one.corners * np.array([1.0, -1.0, 1.0])), one.unit, one.part)
    points = 2.0 * math.pi * np.array([[4.0, 0.0], [2.0, 1.0], [4.0, 1.0]])
    x, along = points.T
    # Penney and Price (1952): openings next to each other, each of them the half planes at its ends
    planes = sommerfeld(k, x, along + 0.5 * width) + sommerfeld(k, x, 0.5 * width - along) - np.exp(1j * k * x)
    for sign in (1.0, -1.0):
        planes = planes + sommerfeld(k, x, sign * along - 0.5 * width - length)
    near, far = 0.5 * width, 0.5 * width + length
    screens = waves_on_screens(k, ((near, far), (-far, -near)), points)
    found = scattered(one.joined(other), Water(0.6, 1000.0, 9.81), k, points)
    return found, np.abs(screens), np.abs(planes)


def column_waves(k: float, radius: float, points: Array) -> Array:
    """Return K around an upright circular column on the bed (MacCamy and Fuchs 1954)."""
    r, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    total = np.zeros(len(points), dtype=complex)
    for order in range(40):
        share = jv(order, k * r) - jvp(order, k * radius) / h1vp(order, k * radius) * hankel1(order, k * r)
        total += (1.0 if order == 0 else 2.0) * 1j**order * share * np.cos(order * angle)
    return np.asarray(np.abs(total))


def column() -> float:
    """Return the largest error of K around a column of k a = 1, a half radius and more from its wall."""
    angle = np.arange(48) * 2.0 * math.pi / 48 + math.pi / 48
    # corners outside of the circle by as much as the middles of the chords are inside: equal area
    radius = math.sqrt(math.pi / (24.0 * math.sin(2.0 * math.pi / 48)))
    plan = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    grid = np.arange(8) * math.pi / 4.0
    points = np.concatenate([r * np.stack([np.cos(grid), np.sin(grid)], axis=1) for r in (1.5, 3.0, 8.0)])
    ratio = scattered(_upright(plan, 1.0, 6), Water(1.0, 1000.0, 9.81), 1.0, points)
    return float(np.max(np.abs(ratio - column_waves(1.0, 1.0, points))))


def _long(name: str) -> Callable[[], float]:
    return lambda: float(long_unit()[name])


def _identity(name: str, *, lid: bool) -> Callable[[], float]:
    return lambda: box_check(two_boxes(lid), name)


def _from_limit(level: int) -> Callable[[], float]:
    return lambda: from_limit(level)


def _behind(index: int, reference: int) -> Callable[[], float]:
    return lambda: float(barrier()[0][index] - barrier()[reference][index])


def _through(index: int) -> Callable[[], float]:
    return lambda: float(gap()[0][index] - gap()[1][index])


_MESH = "order 4/3 in the size of the panels"
CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "units: a box cut in two halves with a rigid connector, motions", "identity: the box in one piece",
        lambda: 1.0 + rigid_halves(), 1.0, 1e-8, note="rounding of the solver",
    ),
    ValidationCase(
        "units: springs against a rigid connector, ten times the stiffness", "first order in 1/k", spring_order, 10.0,
        0.01,
    ),
    ValidationCase(
        "units: moment about the axis of a hinge over its strength", "zero", hinge_moment, 0.0, 1e-9, False
    ),
    ValidationCase(
        "units: energy of the waves, two hinged boxes, headings 0 to 80 degrees", "identity", energy_of_headings, 0.0,
        0.01, False, _MESH,
    ),
    ValidationCase(
        "units: excitation by Haskind's relation, fine panels", "identity",
        lambda: box_check(fine_box(), "Haskind"), 0.0, 0.001, False, _MESH,
    ),
    ValidationCase(
        "units: damping by the energy that goes away, fine panels", "identity",
        lambda: box_check(fine_box(), "energy of the waves that go away"), 0.0, 0.01, False, _MESH,
    ),
    ValidationCase(
        "units: coefficients are symmetric, fine panels", "identity", lambda: box_check(fine_box(), "symmetric"), 0.0,
        0.001, False, _MESH + ", over the geometric mean of the two diagonal entries",
    ),
    *(
        ValidationCase(
            f"units: {said} of two boxes{where} on panels of 2 m, 0.8 to 1.6 rad/s", "identity",
            _identity(name, lid=not where), 0.0, limit, False, note,
        )
        for name, said, where, limit, note in (
            ("symmetric", "symmetry of the coefficients", " without lids", 0.002, _MESH),
            (
                "symmetric", "symmetry of the coefficients", "", 0.005,
                "roll: lids next to the sides hold the error of the panels there",
            ),
            ("Haskind", "excitation by Haskind's relation", "", 0.005, _MESH),
            ("energy of the waves that go away", "damping by the energy that goes away", "", 0.005, _MESH),
        )
    ),
    *(
        ValidationCase(
            f"units: coefficients of a box on {count} panels", "limit of Capytaine's panels, refined twice",
            _from_limit(level), 0.0, limit, False, "largest of nine; roll damping, a small difference, is the worst",
        )
        for level, count, limit in ((0, 252, 0.05), (1, 1008, 0.02), (2, 4032, 0.01))
    ),
    *(
        ValidationCase(
            f"units: {name} of a unit of ten wave lengths in beam seas over the section",
            "boundary elements of the section, by another program of our own, recomputed",
            _long(name), 1.0, 0.03, note="ends of the unit",
        )
        for name in ("sway", "heave", "roll", "drift", "transmission")
    ),
    *(
        ValidationCase(
            f"units: K behind a thin barrier of six wave lengths{other}, {place}", source, _behind(index, reference),
            0.0, 0.02, False, note,
        )
        for reference, other, source, note in (
            (1, "", "exact waves on a thin screen, Helmholtz in plan, recomputed", "a fortieth of a wave length thick"),
            (2, " over half planes", "Sommerfeld 1896, two half planes", "waves between the ends are left out there"),
        )
        for index, place in enumerate(
            ("on the axis, 2 L", "on the axis, 4 L", "on the shadow line, 2 L", "on the shadow line, 4 L")
        )
    ),
    *(
        ValidationCase(
            f"units: K behind a gap of two wave lengths, {place}",
            "exact waves on two thin screens, Helmholtz in plan, recomputed", _through(index), 0.0, 0.02, False,
            "the half planes of Penney and Price are 0.007, 0.027 and 0.008 off the screens",
        )
        for index, place in enumerate(("on the axis, 4 L", "behind an end, 2 L", "behind an end, 4 L"))
    ),
    ValidationCase(
        "units: K around a column of k a = 1", "MacCamy and Fuchs 1954, exact", column, 0.0, 0.01, False, _MESH
    ),
)  # fmt: skip
