"""Mean drift near against far, and the field against Laplace's equation, the surface condition and the far waves."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.potential import shapes
from moyai.potential.drift import mean_drift_far_field, mean_drift_near_field
from moyai.potential.field import potential_at, surface_elevation
from moyai.potential.modes import rigid_modes
from moyai.potential.solver import solve
from moyai.sea.water import Water

GRAVITY, DENSITY = 9.81, 1000.0
CENTRE = (0.3, -0.5)
OMEGA = np.array([0.6, 1.0, 1.5, 2.0])


def free_motions(section, solution):
    """Motions of the freely floating section: no energy is lost, so that R and T of the moving section balance."""
    area, breadth = section.area, section.waterplane_breadth
    mass = DENSITY * area * np.diag([1.0, 1.0, 4.0])
    # the centre of gravity is put on the vertical of buoyancy only for symmetric sections; any centre will do here
    first = section.waterplane_first_moment - CENTRE[0] * breadth
    second = (
        section.waterplane_second_moment - 2 * CENTRE[0] * section.waterplane_first_moment + CENTRE[0] ** 2 * breadth
    )
    stiffness = np.zeros((3, 3))
    stiffness[1, 1] = breadth
    stiffness[1, 2] = stiffness[2, 1] = -first
    stiffness[2, 2] = second + area * (section.centroid[1] - CENTRE[1])
    stiffness *= DENSITY * GRAVITY
    part = solution.normal
    return np.array(
        [
            np.linalg.solve(
                -(o**2) * (mass + part.added_mass[i].T) - 1j * o * part.radiation_damping[i].T + stiffness,
                part.excitation_force[i],
            )
            for i, o in enumerate(solution.omega)
        ]
    )


SECTIONS = {
    "box": (shapes.rectangle(10.0, 4.5).immersed(3.0), 2e-3),
    "heeled box": (shapes.rectangle(10.0, 4.5).immersed(3.0, heel=0.2), 2e-3),
    "half circle": (shapes.circle(3.0).immersed(3.0), 1e-3),
    "submerged circle": (shapes.circle(2.0).immersed(5.0), 1e-3),
    "flared": (shapes.trapezoid(5.0, 9.0, 4.0).immersed(2.5), 5e-3),
    "pi type": (shapes.pi_type(10.0, 3.0, 2.0, 0.5).immersed(4.0), 2e-3),
    "twin": (shapes.twin_pontoon(3.0, 3.0, 2.0, deck_thickness=0.5).immersed(2.0), 5e-3),
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "depth"),
    [*((name, 10.0) for name in SECTIONS), *((name, math.inf) for name in ("box", "submerged circle", "twin"))],
)
def test_pressure_and_momentum_give_the_same_drift(name, depth):
    """Fixed, freely floating and driven at random, over the largest of 1/2 rho g a^2 and the force itself."""
    section, tolerance = SECTIONS[name]
    solution = solve(section, Water(depth, DENSITY, GRAVITY), OMEGA, modes=rigid_modes(CENTRE), heading=[0.0, 0.6])
    rng = np.random.default_rng(5)
    driven = (rng.normal(size=(len(OMEGA), 3)) + 1j * rng.normal(size=(len(OMEGA), 3))) * [0.5, 0.5, 0.1]
    for motions in (None, free_motions(section, solution), driven):
        far = mean_drift_far_field(solution, motions).horizontal
        near = mean_drift_near_field(solution, motions).horizontal
        # many terms of the size rho g |zeta_r|^2 cancel
        size = 0.5 * DENSITY * GRAVITY * (1.0 + (0 if motions is None else np.abs(motions * [1, 1, 3]).max() ** 2))
        assert np.abs(near - far).max() < tolerance * size
    far, near = (f(solution, None, 0.6).horizontal for f in (mean_drift_far_field, mean_drift_near_field))
    assert np.abs(near - far).max() < tolerance * 0.5 * DENSITY * GRAVITY


def test_finer_panels_bring_the_two_together():
    section = shapes.rectangle(10.0, 4.5).immersed(3.0)
    gaps = []
    for accuracy in (1e-3, 1e-5):
        solution = solve(section, Water(10.0, DENSITY, GRAVITY), OMEGA, modes=rigid_modes(CENTRE), accuracy=accuracy)
        motions = free_motions(section, solution)
        far, near = mean_drift_far_field(solution, motions), mean_drift_near_field(solution, motions)
        gaps.append(np.abs(far.horizontal - near.horizontal).max())
    assert gaps[1] < 0.1 * gaps[0]


def test_short_waves_are_reflected_with_the_whole_momentum():
    section = shapes.rectangle(10.0, 4.5).immersed(3.0)
    solution = solve(section, Water(math.inf, DENSITY, GRAVITY), [4.0], modes=rigid_modes(CENTRE), heading=[0.0, 0.7])
    for heading in (0.0, 0.7):
        drift = mean_drift_far_field(solution, None, heading)
        assert drift.horizontal[0] == pytest.approx(0.5 * DENSITY * GRAVITY * math.cos(heading) ** 2, rel=1e-3)
        assert abs(drift.along_crest[0]) < 1e-3 * drift.horizontal[0]


def test_paper_form_of_the_drift():
    """E (Cg/C) (2 R^2 + E_L), with E_L the energy that is lost, equals E (Cg/C) (1 + R^2 - T^2)."""
    solution = solve(
        shapes.rectangle(4.0, 3.0).immersed(1.5), Water(6.0, DENSITY, GRAVITY), OMEGA, modes=rigid_modes(CENTRE)
    )
    motions = 0.3 * np.ones((len(OMEGA), 3)) * np.array([1.0, 0.5j, 0.1])
    drift = mean_drift_far_field(solution, motions)
    states = solution.normal.states
    energy = 0.5 * DENSITY * GRAVITY * states.group_velocity * states.wave_number / states.omega
    assert drift.horizontal == pytest.approx(energy * (2.0 * np.abs(drift.reflection_coefficient) ** 2 + drift.loss))


def test_vertical_drift_and_moment_of_a_submerged_circle():
    """About its centre a circle feels no moment; in waves it is sucked up (Ogilvie 1963)."""
    section = shapes.circle(1.0).immersed(2.5)
    solution = solve(section, Water(math.inf, DENSITY, GRAVITY), [2.0, 3.0], modes=rigid_modes((0.0, -1.5)))
    drift = mean_drift_near_field(solution)
    assert (drift.vertical > 0.0).all()
    assert np.abs(drift.moment).max() < 1e-6 * drift.vertical.max()
    assert np.abs(drift.horizontal).max() < 1e-3 * drift.vertical.max()


def test_drift_refuses_what_it_cannot_do():
    section = shapes.twin_pontoon(2.0, 3.0, 1.5).immersed(2.0)
    apart = rigid_modes(CENTRE, body=0, prefix="left ") + rigid_modes(CENTRE, body=1, prefix="right ")
    solution = solve(section, Water(9.0, DENSITY, GRAVITY), [1.0], modes=apart, heading=0.0)
    with pytest.raises(InputError, match="whole section"):
        mean_drift_near_field(solution)
    with pytest.raises(InputError, match="motions"):
        mean_drift_far_field(solution, np.zeros((2, 6)))
    with pytest.raises(InputError, match="heading"):
        mean_drift_far_field(solution, None, 0.3)


@pytest.mark.parametrize("lid", [None, 0.1])
@pytest.mark.parametrize("depth", [10.0, math.inf])
def test_field_of_a_heeled_twin_pontoon(depth, lid):
    """Two representations meet next to the hull; Laplace, bed, surface and far waves hold."""
    section = shapes.twin_pontoon(3.0, 3.0, 2.0, deck_thickness=0.5).immersed(2.0, 0.1)
    solution = solve(section, Water(depth, DENSITY, GRAVITY), [0.7, 1.6], modes=rigid_modes(CENTRE), lid=lid)
    motions = np.array([0.3, 0.2 - 0.1j, 0.05])
    right = section.bounds[1]
    for index, omega in enumerate(solution.omega):

        def phi(points, index=index):
            return potential_at(solution, points, index, motions=motions)

        # across the ray of validity: Green's representation on one side, wave and evanescent modes on the other
        for x in (right + 1.0, right + 2.5):
            z = -1.2 * (x - right)
            a, b = phi([(x, z - 1e-7), (x, z + 1e-7)])
            assert abs(a - b) < 2e-4 * abs(a)
        for x, z in ((right + 2.0, -1.0), (right + 0.5, -4.0), (0.0, -5.0), (-12.0, -0.7)):
            e = 2e-2
            c, *ring = phi([(x, z), (x + e, z), (x - e, z), (x, z + e), (x, z - e)])
            assert abs(sum(ring) - 4.0 * c) / e**2 < 2e-3 * abs(c)
        number = omega**2 / GRAVITY
        for x in (right + 2.0, -9.0):
            e = 1e-3
            p = phi([(x, 0.0), (x, -e), (x, -2 * e)])
            assert (3 * p[0] - 4 * p[1] + p[2]) / (2 * e) == pytest.approx(number * p[0], rel=1e-4)
        if math.isfinite(depth):
            p = phi([(right + 3.0, -depth), (right + 3.0, -depth + 1e-3)])
            assert abs(p[1] - p[0]) / 1e-3 < 2e-3 * abs(p[0])
        far = 400.0
        speed = -1j * omega * motions
        waves = speed @ solution.normal.radiated_wave[index]
        k = solution.normal.states.wave_number[index]
        ahead, behind = surface_elevation(solution, [far, -far], index, motions=motions)
        assert ahead == pytest.approx(
            (solution.normal.transmission_coefficient[index] + waves[1]) * np.exp(1j * k * far), abs=5e-4
        )
        back = (solution.normal.reflection_coefficient[index] + waves[0]) * np.exp(1j * k * far)
        assert behind == pytest.approx(np.exp(-1j * k * far) + back, abs=5e-4)
        assert np.isnan(surface_elevation(solution, [section.waterlines[0][0] + 0.5], index)).all()


def test_normal_velocity_on_the_hull():
    """The derivative of the field next to the hull is the hull's own velocity."""
    section = shapes.circle(1.5).immersed(4.0)
    solution = solve(section, Water(9.0, DENSITY, GRAVITY), [1.2], modes=rigid_modes((0.0, -2.5)))
    heave = np.array([0.0, 1.0, 0.0])
    angle = np.array([0.4, 2.2, 4.0])
    normal = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    e = 1e-3
    near, far = (np.array([0.0, -2.5]) + (1.5 + s * e) * normal for s in (1.0, 2.0))
    at = np.array([0.0, -2.5]) + 1.5 * (1.0 + 1e-9) * normal
    values = [potential_at(solution, p, 0, motions=heave, amplitude=0.0) for p in (at, near, far)]
    slope = (-3 * values[0] + 4 * values[1] - values[2]) / (2 * e)
    assert slope == pytest.approx(-1j * 1.2 * normal[:, 1], abs=1e-3)
