"""Thin plates in waves, alone and on hulls: identities, exact limits and reference solutions at random inputs."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.potential.drift import mean_drift_far_field, mean_drift_near_field
from moyai.potential.field import potential_at, surface_elevation
from moyai.potential.modes import Modes, Rigid, rigid_modes
from moyai.potential.plates import PlateLine
from moyai.potential.shapes import circle, pi_type, polygon, rectangle, rounded_rectangle, trapezoid, twin_pontoon
from moyai.potential.skirt_modes import edge_modes, stretching_modes
from moyai.potential.solver import solve
from moyai.potential.thin_plate import Plate, hanging_arc, horizontal_motion, solve_plate_limit
from moyai.potential.thin_plate_waves import plate_jumps, plate_memory, plate_memory_functions, plate_section
from moyai.potential.thin_plate_waves import solve_plate_waves as waves
from moyai.potential.vertical_barrier import solve_vertical_barrier
from moyai.sea.water import Water

G = 9.81
SWAY = Modes(("sway",), (Rigid("sway"),))
BOX = rectangle(4.0, 2.0)


def random_plates(rng):
    """A plate of each kind: hanging, submerged, on the bed of depth 3, bent, an arc."""
    slant = rng.uniform(-0.6, 0.6)
    return {
        "hanging": PlateLine([(0, 0), (slant, -rng.uniform(0.3, 2.5))]),
        "submerged": PlateLine([(0, -rng.uniform(0.2, 0.8)), (slant, -rng.uniform(1.2, 2.5))]),
        "bed": PlateLine([(0, -3.0), (slant, -rng.uniform(0.5, 2.0))]),
        "bent": PlateLine([(0, 0), (slant, -0.7), (slant + rng.uniform(-0.4, 0.4), -1.5)]),
        "arc": PlateLine([(0, 0), (slant, -rng.uniform(1.0, 2.0))], [rng.uniform(-0.4, 0.4)]),
    }


def random_omega(rng, depth, count=4):
    return np.sort(rng.uniform(0.3, 2.2, count)) * math.sqrt(G / min(depth, 3.0))


@pytest.mark.parametrize("kind", ["hanging", "submerged", "bed", "bent", "arc"])
@pytest.mark.parametrize("seed", range(2))
def test_identities_of_random_plates(kind, seed):
    """Energy, symmetry, Haskind and damping by waves hold to the accuracy asked for, from either side."""
    rng = np.random.default_rng(10 * seed + len(kind))
    plate = random_plates(rng)[kind]
    found = waves(plate, Water(3.0, 1025.0, G), random_omega(rng, 3.0), accuracy=1e-5)
    assert found.solution.status == "converged"
    assert all(check.value < 1e-5 for check in found.checks)
    energy = np.abs(found.reflection_coefficient) ** 2 + np.abs(found.transmission_coefficient) ** 2
    assert np.abs(energy - 1.0).max() < 1e-5
    # A lossless scatterer: R of one side from that of the other
    passed = found.transmission_coefficient[:, 0]
    other = -found.reflection_coefficient[:, 0].conj() * passed / passed.conj()
    assert np.abs((found.reflection_coefficient[:, 1] - other) * np.abs(passed)).max() < 1e-5


@pytest.mark.parametrize("seed", range(6))
def test_vertical_barrier_against_matched_eigenfunctions(seed):
    rng = np.random.default_rng(60 + seed)
    depth, share = 10.0 ** rng.uniform(-1, 2), rng.uniform(0.1, 0.9)
    draught, water = share * depth, Water(depth, rng.uniform(900, 1100), G)
    omega = np.sort(rng.uniform(0.3, 2.0, 4)) * math.sqrt(G / draught)
    found = solve(plate_section(Plate((0, 0), (0, -draught))), water, omega, modes=SWAY, accuracy=1e-6)
    exact = solve_vertical_barrier(draught, water, omega, polynomials=16)
    unit = 2.0 * water.density * draught**2 / math.pi
    assert np.abs(found.added_mass[:, 0, 0] - exact.added_mass).max() < 1e-4 * unit
    assert np.abs(found.radiation_damping[:, 0, 0] - exact.radiation_damping).max() < 1e-4 * unit * omega[-1]
    assert np.abs(found.normal.reflection_coefficient - exact.reflection_coefficient).max() < 2e-5
    assert np.abs(found.normal.transmission_coefficient - exact.transmission_coefficient).max() < 2e-5


@pytest.mark.parametrize("seed", range(6))
def test_limits_of_frequency_against_the_stream_function(seed):
    """Two equations for the same limits: derivative along the normal on panels, stream function on a line rule."""
    rng = np.random.default_rng(70 + seed)
    plate = Plate((0.0, 0.0), (rng.uniform(-0.4, 0.4), -1.0), rng.uniform(-0.4, 0.4))
    water = Water(rng.choice([math.inf, rng.uniform(1.2, 4.0)]), 1000.0, G)
    found = solve(plate_section(plate), water, [1.0, 3.0], modes=SWAY, accuracy=1e-6)
    infinite = solve_plate_limit(plate, water, (horizontal_motion,)).added_mass[0, 0]
    zero = solve_plate_limit(plate, water, (horizontal_motion,), frequency="zero").added_mass[0, 0]
    assert found.infinite_frequency_added_mass[0, 0] == pytest.approx(infinite, rel=3e-6)
    assert found.zero_frequency_added_mass[0, 0] == pytest.approx(zero, rel=3e-6)


def test_error_falls_with_the_accuracy_asked_for():
    """Deep water, Ursell's barrier: the error follows the target over five decades."""
    from scipy.special import iv, kv

    ka = np.array([0.1, 0.5, 1.0, 2.0])
    exact = np.pi * iv(1, ka) / (np.pi * iv(1, ka) + 1j * kv(1, ka))
    section, water = plate_section(Plate((0, 0), (0, -1))), Water(math.inf, 1000.0, G)
    for accuracy in (1e-3, 1e-5, 1e-7):
        found = solve(section, water, np.sqrt(G * ka), modes=SWAY, accuracy=accuracy)
        assert np.abs(found.normal.reflection_coefficient - exact).max() < accuracy


@pytest.mark.slow
@pytest.mark.parametrize("heading", [0.0, pytest.param(0.7, marks=pytest.mark.slow)])
def test_plates_of_small_thickness_tend_to_thin_ones(heading):
    """Keel plates of a pi-type section, thickness t: the difference falls like t ln t."""
    water, motion = Water(6.0, 1025.0, G), rigid_modes((0.0, -0.3))
    omega = np.array([0.8, 1.6, 2.6])[: 3 if heading == 0.0 else 1]
    plates = [PlateLine([(side, 0.0), (side, -1.2)]) for side in (-2.0, 2.0)]
    thin = solve(BOX.with_plates(*plates).immersed(1.5), water, omega, modes=motion, heading=heading, accuracy=1e-4)
    assert thin.status == "converged"
    scale = np.abs(thin.at_heading(heading).added_mass).max()
    apart = []
    for thickness in (0.03, 0.003):
        hull = pi_type(4.0, 2.0, 1.2, thickness).immersed(2.7)
        thick = solve(hull, water, omega, modes=motion, heading=heading, accuracy=1e-4)
        mass = thick.at_heading(heading).added_mass - thin.at_heading(heading).added_mass
        wave = thick.at_heading(heading).transmission_coefficient - thin.at_heading(heading).transmission_coefficient
        apart.append([np.abs(mass).max() / scale, np.abs(wave).max()])
    assert max(apart[1]) < 3e-3
    assert (np.array(apart[1]) < 0.25 * np.array(apart[0])).all()


@pytest.mark.slow
def test_a_box_that_grows_thin_tends_to_the_plate():
    water, omega = Water(3.0, 1000.0, G), np.array([1.5, 3.0, 4.5])
    plate = solve(plate_section(Plate((0, 0), (0, -1))), water, omega, modes=SWAY, accuracy=1e-5)
    apart = []
    for breadth in (0.02, 0.002, 0.0002):
        box = solve(rectangle(breadth, 2.0).immersed(1.0), water, omega, modes=SWAY, accuracy=1e-4)
        apart.append(np.abs(box.added_mass - plate.added_mass).max() / plate.added_mass.max())
    assert apart[2] < 1e-3
    assert apart[2] < 0.25 * apart[1] < 0.25**2 * apart[0]


def hull_with(kind, rng):
    side, low = rng.uniform(-1.5, 1.5), -rng.uniform(0.6, 2.5)
    plates = {
        "keel": [PlateLine([(-2, 0), (-2, low)]), PlateLine([(2, 0), (2, low)])],
        "curtain": [PlateLine([(side, 0), (side + 0.3, low)])],
        "below": [PlateLine([(side, -0.4), (side - 0.3, low - 0.4)])],
        "wing": [PlateLine([(2, 0.5), (3.2, 0.5 + rng.uniform(-0.2, 0.2))])],
        "cross": [PlateLine([(0, 0), (0, low)]), PlateLine([(-0.7, low), (0.7, low)])],
        "alongside": [PlateLine([(3.5, 2.5), (3.2, low)])],
    }
    return BOX.with_plates(*plates[kind]).immersed(1.5)


@pytest.mark.parametrize("kind", ["keel", "curtain", "below", "wing", "cross", "alongside"])
def test_hulls_with_plates_keep_all_identities_and_both_drifts(kind):
    """Drift by pressure on the two faces with the suction of the edges against the momentum of the waves far off."""
    rng = np.random.default_rng(len(kind))
    section = hull_with(kind, rng)
    omega = np.sort(rng.uniform(0.7, 3.0, 4))
    found = solve(section, Water(6.0, 1025.0, G), omega, modes=rigid_modes((0.1, -0.4)), accuracy=1e-5)
    assert found.status == "converged"
    motions = (rng.normal(size=(4, 3)) + 1j * rng.normal(size=(4, 3))) * np.array([0.5, 0.5, 0.2])
    for moved in (None, motions):
        far = mean_drift_far_field(found, moved).horizontal
        near = mean_drift_near_field(found, moved).horizontal
        assert np.abs(far - near).max() < 1e-4 * np.abs(far).max()


def random_hull_with_plates(rng):
    """Any hull with one to three plates on it, under it or next to it; None where they would cross."""
    beam = 10.0 ** rng.uniform(-0.3, 1.0)
    height = beam * rng.uniform(0.2, 1.0)
    hulls = (
        rectangle(beam, height),
        trapezoid(beam * rng.uniform(0.5, 1.0), beam, height),
        rounded_rectangle(beam, height, 0.3 * min(0.5 * beam, height)),
        circle(height),
        twin_pontoon(beam / 3.0, height, beam / 3.0),
    )
    kind = rng.integers(5)
    corner = height if kind == 3 else 0.5 * beam
    plates = []
    for side in rng.choice([-1.0, 1.0, 0.0], rng.integers(1, 4), replace=False):
        start = np.array([side * corner, 0.0]) if kind in (0, 4) and side else np.array([side * beam, -0.3 * height])
        angle, length = rng.uniform(-0.6, 0.6), height * 10.0 ** rng.uniform(-1.3, 0.5)
        end = start + length * np.array([math.sin(angle), -math.cos(angle)])
        plates.append(PlateLine([start, end], [rng.choice([0.0, rng.uniform(-0.5, 0.5)])]))
    try:
        return hulls[kind].with_plates(*plates).immersed(height * rng.uniform(0.1, 0.9))
    except InputError:
        return None


@pytest.mark.slow
def test_random_hulls_with_plates():
    """Fifty random problems keep all identities to the accuracy asked for."""
    solved = 0
    for seed in range(60):
        rng = np.random.default_rng(7000 + seed)
        section = random_hull_with_plates(rng)
        if section is None:
            continue
        depth = rng.choice([math.inf, -section.bottom * (1.0 + 10.0 ** rng.uniform(-1.3, 1.0))])
        wave_number = np.sort(10.0 ** rng.uniform(-1.0, 1.0, 3)) / section.bounds[1]
        omega = np.sqrt(G * wave_number * np.tanh(np.minimum(wave_number * depth, 30.0)))
        found = solve(section, Water(depth, 1025.0, G), omega, modes=rigid_modes((0.0, -0.2)))
        assert found.status == "converged", (seed, found.message)
        assert np.isfinite(found.infinite_frequency_added_mass).all()
        solved += 1
    assert solved > 45


@pytest.mark.parametrize("seed", range(4))
def test_suction_of_the_edge_closes_the_drift_of_random_plates(seed):
    rng = np.random.default_rng(80 + seed)
    plates = random_plates(rng)
    kind = ("hanging", "submerged", "bed", "arc")[seed]
    found = waves(plates[kind], Water(3.0, 1025.0, G), random_omega(rng, 3.0), accuracy=1e-6)
    motions = rng.normal(size=(4, 3)) + 1j * rng.normal(size=(4, 3))
    # A plate that stands on the bed cannot move
    for moved in (None, None if kind == "bed" else motions):
        far, near = found.drift_by_momentum(moved).horizontal, found.drift_by_pressure(moved).horizontal
        assert np.abs(far - near).max() < 3e-5 * np.abs(far).max()


@pytest.mark.slow
def test_oblique_waves_tend_to_normal_ones_and_keep_energy():
    section = BOX.with_plates(PlateLine([(-2, 0), (-2, -1.0)])).immersed(1.5)
    water, omega = Water(6.0, 1025.0, G), np.array([1.1, 2.3])
    found = solve(section, water, omega, modes=rigid_modes((0, 0)), heading=[0.0, 1e-3, 1.2], accuracy=1e-5)
    assert found.status == "converged"
    assert np.abs(found.at_heading(1e-3).transmission_coefficient - found.normal.transmission_coefficient).max() < 1e-5
    assert np.abs(found.at_heading(1e-3).added_mass - found.normal.added_mass).max() < 1e-4 * found.added_mass.max()


@pytest.mark.parametrize("seed", range(3))
def test_a_plate_cut_in_two_is_the_same_plate(seed):
    rng = np.random.default_rng(90 + seed)
    water, omega = Water(3.0, 1025.0, G), random_omega(rng, 3.0, 2)
    top, bottom = np.array([0.0, 0.0]), np.array([rng.uniform(-0.5, 0.5), -1.5])
    middle = top + rng.uniform(0.2, 0.8) * (bottom - top)
    motion = rigid_modes((0.0, 0.0))
    whole = solve(plate_section(PlateLine([top, bottom])), water, omega, modes=motion, accuracy=1e-6)
    halves = plate_section(PlateLine([top, middle]), PlateLine([bottom, middle]))
    cut = solve(halves, water, omega, modes=motion, accuracy=1e-6)
    assert np.abs(cut.added_mass - whole.added_mass).max() < 1e-6 * np.abs(whole.added_mass).max()
    assert np.abs(cut.normal.reflection_coefficient - whole.normal.reflection_coefficient).max() < 1e-6
    assert len(plate_jumps(cut)) == 2


@pytest.mark.parametrize("seed", range(3))
def test_place_and_size_do_not_matter(seed):
    """A shift turns the phase of R only; Froude's law scales the rest."""
    rng = np.random.default_rng(100 + seed)
    plate, shift, scale = random_plates(rng)["arc"], rng.uniform(-7, 7), 10.0 ** rng.uniform(-2, 2)
    water, omega = Water(3.0, 1000.0, G), random_omega(rng, 3.0, 3)
    here = solve(plate_section(plate), water, omega, modes=SWAY)
    there = solve(plate_section(plate.moved((shift, 0.0))), water, omega, modes=SWAY)
    turned = here.normal.reflection_coefficient * np.exp(2j * here.normal.states.wave_number * shift)
    assert np.abs(there.normal.reflection_coefficient - turned).max() < 1e-9
    larger = PlateLine(scale * plate.points, plate.bulges)
    scaled = solve(plate_section(larger), Water(3.0 * scale, 1000.0, G), omega / math.sqrt(scale), modes=SWAY)
    assert scaled.added_mass / scale**2 == pytest.approx(here.added_mass, rel=1e-8)
    assert np.abs(scaled.normal.reflection_coefficient - here.normal.reflection_coefficient).max() < 1e-8


@pytest.mark.slow
def test_split_and_stretching_modes_in_the_limit():
    water = Water(math.inf, 1.0, G)
    flat = Plate((0, 0), (0, -1))
    split = waves(flat, water, [1.0, 3.0], modes=edge_modes(flat), accuracy=1e-6)
    cross = 1.0 / 3.0 - math.pi / 16.0
    exact = [[2.0 / math.pi - 2.0 / 3.0 + math.pi / 16.0, cross], [cross, math.pi / 16.0]]
    assert np.abs(split.solution.infinite_frequency_added_mass - exact).max() < 1e-6
    whole = waves(flat, water, [1.0, 3.0], modes=SWAY, accuracy=1e-6)
    assert split.added_mass.sum(axis=(1, 2)) == pytest.approx(whole.added_mass[:, 0, 0], rel=1e-6)
    arc = hanging_arc(1.0, 0.4)
    modes = stretching_modes(arc)
    radius = math.hypot(0.4, 0.5)
    found = waves(arc, water, [1.0, 3.0], modes=modes, accuracy=1e-5).solution.infinite_frequency_added_mass
    exact = solve_plate_limit(arc, water, (horizontal_motion, lambda p, n: np.abs(p[:, 0]) / radius)).added_mass
    assert np.abs(found - exact).max() < 2e-5 * exact.max()


@pytest.mark.slow
def test_jump_tends_to_the_inverse_hyperbolic_secant():
    """At high frequency the jump off the still water is that of the limit, (4/pi) z arsech(z/d)."""
    found = waves(Plate((0, 0), (0, -1)), Water(math.inf, 1.0, G), math.sqrt(G * 1e5), modes=SWAY, accuracy=1e-5)
    (jump,) = found.jumps
    depth = -jump.points[:, 1]
    exact = 4.0 / math.pi * depth * np.arccosh(np.maximum(1.0 / depth, 1.0))
    low = depth > 0.2
    towards = jump.normals[:, 0]
    assert np.abs(-(towards * jump.radiation[0, :, 0]).real - exact)[low].max() < 1e-3
    # Near the edge the jump is C sqrt(distance), C = (4/pi) sqrt(2)
    assert abs(jump.tip_radiation[0, 0, 0].real) == pytest.approx(4.0 / math.pi * math.sqrt(2.0), rel=1e-3)


def test_field_on_both_sides_of_a_plate():
    """The jump of the field is that of the solution, its normal velocity that of the plate; far off it is the wave."""
    water, omega = Water(4.0, 1025.0, G), np.array([1.3, 2.4])
    section = BOX.with_plates(PlateLine([(1.0, 0.0), (1.4, -1.2)])).immersed(1.5)
    found = solve(section, water, omega, modes=rigid_modes((0.0, 0.0)), accuracy=1e-6)
    (jump,) = plate_jumps(found)
    motions = np.array([0.3 - 0.2j, 0.1j, 0.2])
    speed = -1j * omega[1] * motions
    chosen = slice(2, None, 5)
    points, normals = jump.points[chosen], jump.normals[chosen]

    def field(offset):
        return potential_at(found, points + offset * normals, 1, motions=motions)

    near = 1e-4
    expected = (jump.diffraction[1] + jump.radiation[1] @ speed)[chosen]
    assert np.abs(field(near) - field(-near) - expected).max() < 2e-3 * np.abs(expected).max()
    displacement = np.stack([motions[0] + motions[2] * points[:, 1], motions[1] - motions[2] * points[:, 0]], axis=1)
    through = -1j * omega[1] * (displacement * normals).sum(axis=1)
    inner = slice(1, -1)
    for side in (1.0, -1.0):
        slope = (field(side * 0.02) - field(side * 0.01)) / (side * 0.01)
        steeper = (field(side * 0.03) - field(side * 0.02)) / (side * 0.01)
        assert np.abs(2.0 * slope - steeper - through)[inner].max() < 0.05 * np.abs(through).max() + 0.02
    x = np.array([40.0, 45.0])
    transmitted = found.normal.transmission_coefficient[1] + speed @ found.radiated_wave[1, :, 1]
    wave = transmitted * np.exp(1j * found.normal.states.wave_number[1] * x)
    assert np.abs(surface_elevation(found, x, 1, motions=motions) - wave).max() < 1e-5


def test_plates_move_with_what_they_hang_on():
    plates = PlateLine([(0, 0), (0, -1)]), PlateLine([(3, -1), (3, -2)])
    section = BOX.with_plates(*plates).immersed(1.5)
    assert [plate.body for plate in section.wetted_plates] == [0, 2]
    water, omega = Water(6.0, 1025.0, G), [1.0, 2.0]
    apart = Modes(("box", "curtain"), (Rigid("sway"), Rigid("sway")), ((0,), (2,)))
    parts = solve(section, water, omega, modes=apart, accuracy=1e-5).added_mass
    whole = solve(section, water, omega, modes=SWAY, accuracy=1e-5).added_mass[:, 0, 0]
    assert parts.sum(axis=(1, 2)) == pytest.approx(whole, rel=1e-6)
    joined = twin_pontoon(2.0, 2.0, 3.0).with_plates(PlateLine([(-1.5, 0.0), (1.5, 0.0)])).immersed(1.0)
    assert joined.wetted_plates[0].joined == (True, True)


@pytest.mark.slow
def test_memory_of_a_plate():
    """Damping and added mass are one function (Kramers-Kronig); a draught scales by Froude's law."""
    rng = np.random.default_rng(5)
    depth, time = rng.uniform(1.3, 3.0), np.linspace(0.0, 30.0, 301)
    functions = plate_memory_functions(1.0, Water(depth, 1000.0, G), time)
    named = {check.name: check for check in functions.checks}
    assert named["Kramers-Kronig"].value < 1e-4
    assert named["frequencies resolve the damping"].value < 1e-3
    kernel, mass = plate_memory(1.0, Water(depth, 1000.0, G), time)
    assert kernel == pytest.approx(functions.velocity_kernel[:, 0, 0])
    assert mass == functions.infinite_frequency_added_mass[0, 0]
    scaled, _ = plate_memory(4.0, Water(4.0 * depth, 1000.0, G), 2.0 * time)
    assert scaled / 4.0 == pytest.approx(kernel, rel=1e-6, abs=1e-6 * kernel[0])


def test_wall_to_the_bed_reflects_all():
    found = solve(plate_section(Plate((0, 0), (0, -3.0))), Water(3.0, 1025.0, G), [1.0, 2.0], modes=SWAY, accuracy=1e-6)
    assert np.abs(np.abs(found.normal.reflection_coefficient) - 1.0).max() < 1e-6
    assert np.isnan(found.zero_frequency_added_mass).all()


def plated(*points, hull=BOX):
    return hull.with_plates(*(PlateLine(line) for line in points)).immersed(1.5)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: PlateLine([(0, 0), (0, 0)]), "no length"),
        (lambda: PlateLine([(0, 0)]), "shape"),
        (lambda: PlateLine([(0, 0), (math.nan, -1)]), "not a finite number"),
        (lambda: PlateLine([(0, 0), (0, -1)], [0.1, 0.2]), "2 bulges for 1 edges"),
        (lambda: PlateLine([(0, 0), (2, 0), (1, 1), (1, -1)]), "intersects itself"),
        (lambda: plated([(-3, -1), (3, -1)], [(0, 0), (0, -2)]), "cross"),
        (lambda: plated([(-3, 1), (3, 1)]), "outline 1"),
        (lambda: plated([(-1, 1), (1, 1)]), "outline 1"),
        (lambda: plated([(-2, 0), (2, 0)]), "outline 1"),
        (lambda: plated([(-1, 0), (-1, -1), (1, -1), (1, 0)]), "ring"),
        (lambda: plate_section(), "no plate"),
        (lambda: plate_section(PlateLine([(0, 1), (0, 2)])), "does not reach the water"),
        (lambda: waves(Plate((0, 0), (0, -4)), Water(3.0, 1.0, G), 1.0), "3 m deep"),
        (lambda: waves(hanging_arc(1.0, 0.0), Water(3.0, 1.0, G), 1.0), "leaves the still water"),
        (lambda: plate_memory(3.0, Water(3.0, 1.0, G), [0.0, 1.0]), "no gap"),
        (lambda: plate_memory(1.0, Water(3.0, 1.0, G), [1.0, 0.5]), "time"),
        (lambda: edge_modes(Plate((0, -1), (1, -1))), "does not hang"),
        (lambda: stretching_modes(Plate((0, 0), (0, -1))), "flat"),
        (lambda: stretching_modes(Plate((0, 0), (1, -1), 0.2)), "upright"),
        (lambda: solve_vertical_barrier(1.0, Water(math.inf, 1.0, G), 1.0), "finite depth"),
        (lambda: solve_vertical_barrier(2.0, Water(2.0, 1.0, G), 1.0), "2 m deep"),
    ],
)
def test_bad_plates_are_refused_in_words(make, word):
    with pytest.raises(InputError, match=word):
        make()


def test_polygon_hull_takes_a_plate_in_the_middle_of_an_edge():
    hull = polygon([(-2, 0.5), (0, 0), (2, 0.5), (2, 2), (-2, 2)])
    section = hull.with_plates(PlateLine([(1, 0.25), (1, -1)])).immersed(1.0)
    found = solve(section, Water(5.0, 1000.0, G), [1.0, 2.0], modes=rigid_modes((0, 0)), accuracy=1e-5)
    assert found.status == "converged"
    assert section.wetted_plates[0].joined == (True, False)
    assert len(section.chains[0].edges) == 5
