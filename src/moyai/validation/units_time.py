"""Rows of floating units against Capytaine's own solver, and in time against the frequency domain and the panels.

They need Capytaine; without it there are none of them.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from typing import Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.validation import ValidationCase
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.bem import MeshPanels, panels_of
from moyai.structures.units.hydrodynamics import RowHydrodynamics, solve_row
from moyai.structures.units.mesh import HULL, row_mesh
from moyai.structures.units.model import Connector
from moyai.structures.units.response import RowModel, respond
from moyai.structures.units.time.memory import RowMemory, fit_row_memory
from moyai.structures.units.time.model import RowInTime
from moyai.validation._capytaine import capytaine_mesh, closer_green_function
from moyai.validation.units import WATER, at_rest, row

HEAD = math.pi / 2.0
HINGE = Connector("h", "hinge", ((0, 1),), 0.0, 3.0, (1.0, 0.0, 0.0))
BAND = np.concatenate([np.linspace(0.3, 2.3, 19), np.linspace(2.5, 3.4, 4)])
WAVES = (0.6, 2.0)
#: Panels of comparisons on one and the same mesh, and of all others [m]
COARSE, FINE = 3.2, 2.0


def _free(*connectors: Connector) -> RowAtLevel:
    """Return two boxes without damping beyond waves."""
    return at_rest(replace(row(connectors), damping_fraction=np.zeros(6)))


@cache
def _panels(size: float = COARSE, lid: bool = False) -> tuple[RowAtLevel, MeshPanels]:
    """Return two boxes; coarse panels are even, as those of Capytaine's own solver."""
    at = _free()
    mesh = row_mesh(at.section, at.row.length, at.row.placements, size, lid=lid, gap_lid=False)
    return at, replace(panels_of(mesh, at.centres), even=size == COARSE)


@cache
def _own(omega: float) -> RowHydrodynamics:
    at, panels = _panels()
    return solve_row(panels, WATER, at.centres, np.array([omega]), np.array([HEAD]))


def _solved_by_capytaine(displacements: dict[str, Array], omega: float) -> tuple[Array, Array, ComplexArray]:
    """Return added mass, damping (d, d) and excitation (d,) of motions of the panels, by Capytaine's own solver."""
    import capytaine

    mesh = _panels()[1].mesh
    plain = capytaine_mesh(mesh.corners)
    body: Any = capytaine.FloatingBody(mesh=plain)
    body.dofs.update(displacements)
    solver = capytaine.BEMSolver(green_function=closer_green_function(), method="direct")
    given = {"body": body, "omega": omega, "water_depth": WATER.depth, "rho": WATER.density, "g": WATER.gravity}
    names = list(displacements)
    # without its warning of irregular frequencies, whose search among single panels takes longer than the solution
    once: dict[str, Any] = {"_check_wavelength": False}
    radiation = [solver.solve(capytaine.RadiationProblem(radiating_dof=name, **given), **once) for name in names]
    wave = capytaine.DiffractionProblem(wave_direction=HEAD, **given)
    scattered = solver.solve(wave, **once)
    incident = capytaine.bem.airy_waves.froude_krylov_force(wave)
    return (
        np.array([[item.added_masses[name] for item in radiation] for name in names]),
        np.array([[item.radiation_dampings[name] for item in radiation] for name in names]),
        np.array([scattered.forces[name] + incident[name] for name in names]),
    )


def _displacements(basis: Array) -> dict[str, Array]:
    """Return the motion of every panel (n, 3) in modes that are columns of motions of the units (m, modes)."""
    at, panels = _panels()
    mesh = panels.mesh
    out = {}
    for number, mode in enumerate(basis.T):
        moved = np.zeros((mesh.count, 3))
        for unit, centre in enumerate(at.centres):
            mine = mesh.unit == unit
            turn = mode[6 * unit + 3 : 6 * unit + 6]
            moved[mine] = mode[6 * unit : 6 * unit + 3] + np.cross(turn, mesh.centre[mine] - centre)
        out[f"mode {number}"] = moved
    return out


@cache
def against_capytaine() -> float:
    """Return the largest difference of coefficients of two boxes, over the geometric mean of the diagonals."""
    added, damping, excitation = _solved_by_capytaine(_displacements(np.eye(12)), 1.0)
    own = _own(1.0).solutions[0]
    worst = 0.0
    for found, other in ((own.added_mass, added), (own.damping, damping)):
        size = np.sqrt(np.outer(other.diagonal(), other.diagonal()))
        worst = max(worst, float(np.max(np.abs(found - other) / size)))
    sizes = np.abs(excitation).reshape(2, 6).max(axis=0)
    apart = np.abs(own.excitation[0] - excitation).reshape(2, 6)
    # in head seas sway, roll and yaw are not excited
    felt = sizes > 1e-6 * sizes.max()
    return max(worst, float(np.max(apart[:, felt] / sizes[felt])))


@cache
def newman_modes() -> float:
    """Return the largest difference of motion of two hinged boxes in head seas from three generalized modes.

    Heave and pitch of the whole and the opening of the hinge (Newman 1994), each radiated as one body by Capytaine's
    own solver; two units of six motions with a constraint here.
    """
    at = _free(HINGE)
    joint = at.joints[0].place
    heave, surge, pitch, opening = (np.zeros(12) for _ in range(4))
    for unit, sign in ((0, -1.0), (1, 1.0)):
        part = 6 * unit
        heave[part + 2] = surge[part + 1] = 1.0
        arm = at.centres[unit] - joint
        for mode, turn in ((pitch, 1.0), (opening, sign)):
            mode[part : part + 3] = np.cross([turn, 0.0, 0.0], arm)
            mode[part + 3] = turn
    basis = np.stack([heave, surge, pitch, opening], axis=1)
    worst = 0.0
    for omega in (0.8, 1.2):
        added, damping, force = _solved_by_capytaine(_displacements(basis), omega)
        mass, stiffness = basis.T @ at.inertia @ basis, basis.T @ at.hydrostatic @ basis
        matrix = -(omega**2) * (mass + added) - 1j * omega * damping + stiffness
        expected = basis @ np.linalg.solve(matrix, force)
        model = RowModel(at, _own(omega), np.zeros(12))
        found = respond(model, np.array([omega]), np.zeros(1)).motion[0, 0]
        for kind in (slice(0, 3), slice(3, 6)):
            one, two = (values.reshape(2, 6)[:, kind] for values in (found, expected))
            worst = max(worst, float(np.max(np.abs(one - two)) / np.max(np.abs(two))))
    return worst


@cache
def two_boxes_wide() -> tuple[RowHydrodynamics, RowMemory]:
    """Return the coefficients of two boxes over a wide band, and their memory."""
    at, panels = _panels(FINE, True)
    hydro = solve_row(panels, WATER, at.centres, BAND, np.radians([0.0, 40.0]))
    return hydro, fit_row_memory(hydro.omega, hydro.added_mass, hydro.damping, band=WAVES)


@cache
def infinite_frequency() -> float:
    """Return the largest difference of A_inf of the memory from the panels with phi = 0 on the water, over mass."""
    from capytaine.green_functions.delhommeau import Delhommeau

    at, panels = _panels(FINE)
    mesh = panels.mesh
    hull = capytaine_mesh(mesh.corners[mesh.part == HULL])
    single, double = Delhommeau().evaluate(
        hull, hull, free_surface=0.0, water_depth=WATER.depth, wavenumber=np.inf, adjoint_double_layer=False,
        diagonal_term_in_double_layer=True,
    )  # fmt: skip
    potential = np.linalg.solve(double, single @ panels.modes.T)
    exact = -WATER.density * ((panels.modes * panels.variation.areas) @ potential).real
    exact = 0.5 * (exact + exact.T)
    mass = (at.inertia + exact).diagonal()
    return float(np.max(np.abs(two_boxes_wide()[1].infinite_added_mass - exact) / np.sqrt(np.outer(mass, mass))))


@cache
def time_against_frequency() -> float:
    """Return the largest difference of motion of two hinged boxes in regular oblique waves, time over frequency."""
    hydro, memory = two_boxes_wide()
    at = _free(HINGE)
    worst = 0.0
    for omega in (0.9, 1.3):
        k = np.array([float(np.interp(omega, hydro.omega, hydro.wave_number))])
        excitation = hydro.at(np.array([omega]), k)[2][0, 1]
        period = 2.0 * math.pi / omega
        step, count = period / 160.0, 160 * 120
        time = step * np.arange(count)
        ramp = 0.5 * (1.0 - np.cos(math.pi * np.minimum(time / (15.0 * period), 1.0)))
        load = ramp[:, None] * np.real(excitation * np.exp(-1j * omega * time)[:, None])
        run = RowInTime(at, memory, np.zeros(at.size), omega).run(load, step)
        turn = np.exp(1j * omega * time[-1600:])[:, None]
        moved = 2.0 * np.mean(run.position[-1600:] * turn, axis=0)
        found = respond(RowModel(at, hydro, np.zeros(12)), np.array([omega]), np.zeros(1)).motion[0, 1]
        for kind in (slice(0, 3), slice(3, 6)):
            one, two = (values.reshape(2, 6)[:, kind] for values in (moved, found))
            worst = max(worst, float(np.max(np.abs(one - two)) / np.max(np.abs(two))))
    return worst


_CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "units: coefficients of two boxes, all pairs of motions", "Capytaine's own solver, even panels in both",
        against_capytaine, 0.0, 5e-3, False,
        "over the geometric mean of the diagonals; near the surface Capytaine takes its function at centres of panels",
    ),
    ValidationCase(
        "units: two hinged boxes in head seas, motions", "generalized modes (Newman 1994) in Capytaine's own solver",
        newman_modes, 0.0, 0.01, False, "heave, pitch and the opening of the hinge radiate as one body there",
    ),
    ValidationCase(
        "units: memory of two boxes, error of added mass and damping in the band", "coefficients on the panels",
        lambda: two_boxes_wide()[1].error, 0.0, 0.02, False, "over the largest response of the pair",
    ),
    ValidationCase(
        "units: added mass at infinite frequency from the band of the memory", "panels with phi = 0 on the water",
        infinite_frequency, 0.0, 0.03, False, "over mass and added mass",
    ),
    ValidationCase(
        "units: two hinged boxes in regular oblique waves, time domain", "frequency domain", time_against_frequency,
        0.0, 0.02, False, "error of the memory; steps of a hundred and sixtieth of the period",
    ),
)  # fmt: skip

#: Those that are held against Capytaine
_BY_CAPYTAINE = (against_capytaine, newman_modes, infinite_frequency)
CASES: tuple[ValidationCase, ...] = tuple(
    case for case in _CASES if find_spec("capytaine") is not None or case.compute not in _BY_CAPYTAINE
)
