"""The section solver at random sections, depths, frequencies and headings, by identities and exact limits."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.potential import shapes
from moyai.potential.mesh import MOST_PANELS, Resolution
from moyai.potential.modes import Modes, rigid_modes
from moyai.potential.sections import Hull, Outline
from moyai.potential.solver import solve
from moyai.sea.water import Water

GRAVITY = 9.81


def star(rng, corners, radius, centre):
    while True:
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, corners))
        steps = np.diff(np.append(angle, angle[0] + 2.0 * np.pi))
        if steps.max() < 2.6 and steps.min() > 0.12:
            break
    reach = radius * rng.uniform(0.4, 1.0, corners)
    return np.stack([centre[0] + reach * np.cos(angle), centre[1] + reach * np.sin(angle)], axis=1)


def random_case(seed):
    """Section, water, frequencies, heading and length scale of a random problem."""
    rng = np.random.default_rng(seed)
    while True:
        count, scale = int(rng.integers(1, 3)), 10.0 ** rng.uniform(-1.0, 1.5)
        try:
            outlines = []
            for body in range(count):
                points = star(rng, int(rng.integers(4, 9)), scale, ((body - 0.5 * (count - 1)) * 2.3 * scale, 0.0))
                bulges = rng.uniform(-0.3, 0.3, len(points)) * (rng.random(len(points)) < 0.3)
                outlines.append(Outline(points, bulges))
            draught = rng.uniform(1.1, 2.0) * scale if rng.random() < 0.3 else rng.uniform(-0.2, 0.5) * scale
            section = Hull(tuple(outlines)).immersed(draught, heel=rng.uniform(-0.3, 0.3))
        except InputError:
            continue
        break
    depth = math.inf if rng.random() < 0.25 else -section.bottom * (1.0 + 10.0 ** rng.uniform(-1.5, 1.0))
    number = 10.0 ** rng.uniform(-1.0, 1.2, 3) / scale
    omega = np.sort(np.sqrt(GRAVITY * number * np.tanh(number * min(depth, 10.0 * scale))))
    heading = float(rng.uniform(-1.4, 1.4)) if rng.random() < 0.4 else 0.0
    return section, Water(depth, 1025.0, GRAVITY), omega, heading, scale


@pytest.mark.parametrize("seed", [*range(1, 5), *(pytest.param(s, marks=pytest.mark.slow) for s in (0, *range(5, 10)))])
def test_identities_of_random_sections(seed):
    """Energy, symmetry, Haskind, damping: all within a thousandth, mostly far better; refined sets agree with them."""
    section, water, omega, heading, scale = random_case(seed)
    modes = rigid_modes((0.1 * scale, -0.2 * scale))
    solution = solve(section, water, omega, modes=modes, heading=heading)
    assert solution.status == "converged", solution.message
    # the figures are recomputed here from the dataset alone
    data = solution.dataset
    part = solution.at_heading(heading)
    reflection, transmission = data.reflection_coefficient.values[:, 0], data.transmission_coefficient.values[:, 0]
    assert np.abs(np.abs(reflection) ** 2 + np.abs(transmission) ** 2 - 1.0).max() < 1e-3
    flux = water.density * GRAVITY * part.states.group_velocity * math.cos(heading)
    haskind = -2.0 * flux[:, None] * part.radiated_wave[:, :, 0]
    excitation = data.excitation_force.values[:, 0]
    assert (np.abs(excitation - haskind).max(axis=0) <= 1e-3 * np.abs(excitation).max(axis=0)).all()
    for coefficient in (part.added_mass, part.pressure_damping):
        size = np.sqrt(np.abs(np.einsum("wii->wi", part.added_mass)).max(axis=0))
        asymmetry = np.abs(coefficient - np.swapaxes(coefficient, 1, 2)) / np.outer(size, size)
        assert asymmetry.max() < 1e-3 * max(1.0, omega.max())


@pytest.mark.slow
@pytest.mark.parametrize("seed", [101, 102, 103, 105, 110, 226])
def test_random_sections_against_a_refined_solution(seed):
    """The refined one is good to a hundredth of what is allowed."""
    section, water, omega, heading, scale = random_case(seed)
    modes = rigid_modes((0.1 * scale, -0.2 * scale))
    plain = solve(section, water, omega[::2], modes=modes, heading=heading)
    fine = solve(section, water, omega[::2], modes=modes, heading=heading, accuracy=1e-5)
    for name in ("added_mass", "radiation_damping"):
        a, b = getattr(plain, name), getattr(fine, name)
        size = np.sqrt(np.abs(np.einsum("wii->wi", b)).max(axis=0))
        assert (np.abs(a - b).max(axis=0) / np.outer(size, size)).max() < 1e-3
    a, b = plain.excitation_force, fine.excitation_force
    assert (np.abs(a - b).max(axis=(0, 1)) / np.abs(b).max(axis=(0, 1))).max() < 1e-3
    assert np.abs(plain.reflection_coefficient - fine.reflection_coefficient).max() < 1e-3


@pytest.mark.slow
def test_thirty_random_sections():
    """30 problems: one or two bodies, arcs, heel, submerged or piercing, clearance 3 % and more, up to 80 degrees."""
    worst, missed = np.zeros(4), []
    for seed in range(300, 330):
        section, water, omega, heading, scale = random_case(seed)
        solution = solve(section, water, omega, modes=rigid_modes((0.1 * scale, -0.2 * scale)), heading=heading)
        if solution.status != "converged":
            missed.append((seed, solution.message))
        worst = np.fmax(worst, [check.value for check in solution.checks[:4]])
    print("worst identities", worst)
    assert not missed


def test_deep_water_and_infinite_depth_agree():
    """h = 1000 m against infinite depth for the 10 m pontoon; heave keeps a difference of order 1/(kh)^2."""
    section, modes = shapes.rectangle(10.0, 4.5).immersed(3.0), rigid_modes((0.0, -1.0))
    omega = np.linspace(0.6, 2.5, 7)
    deep = solve(section, Water(1000.0, 1025.0, GRAVITY), omega, modes=modes, accuracy=1e-5)
    infinite = solve(section, Water(math.inf, 1025.0, GRAVITY), omega, modes=modes, accuracy=1e-5)
    assert deep.radiation_damping == pytest.approx(infinite.radiation_damping, rel=1e-4, abs=1e-2)
    assert deep.added_mass == pytest.approx(infinite.added_mass, rel=1e-3, abs=1.0)
    assert deep.excitation_force == pytest.approx(infinite.excitation_force, rel=1e-4, abs=0.1)


@pytest.mark.parametrize("depth", [9.0, 40.0])
def test_zero_frequency_limit_is_reached(depth):
    section, modes = shapes.trapezoid(6.0, 9.0, 4.0).immersed(3.0, heel=0.1), rigid_modes((0.4, -1.0))
    solution = solve(section, Water(depth, 1000.0, GRAVITY), [2e-3, 1e-2], modes=modes, accuracy=1e-5)
    limit = solution.zero_frequency_added_mass
    size = np.sqrt(np.outer(np.diag(limit), np.diag(limit)))
    near = np.abs(solution.added_mass - limit) / size
    assert near[0].max() < 3e-4
    # a mode that displaces volume keeps the damping rho sqrt(gh) Q^2 / 2h
    breadth = section.waterplane_breadth
    expected = 1000.0 * math.sqrt(GRAVITY * depth) * breadth**2 / (2.0 * depth)
    assert solution.radiation_damping[0, 1, 1] == pytest.approx(expected, rel=1e-3)


def test_zero_frequency_in_infinite_depth():
    section = shapes.rectangle(4.0, 3.0).immersed(2.0)
    solution = solve(section, Water(math.inf, 1000.0, GRAVITY), [2e-3], modes=rigid_modes((0.0, -1.0)))
    limit = solution.zero_frequency_added_mass
    assert np.isnan(limit[1, 1]) and np.isfinite(limit[[0, 0, 2, 2], [0, 2, 0, 2]]).all()
    assert solution.added_mass[0, 0, 0] == pytest.approx(limit[0, 0], rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("depth", [4.0, math.inf])
def test_infinite_frequency_limit_is_approached(depth):
    """Added mass goes to the phi = 0 limit like 1/K for upright sides: the rest falls at least as fast."""
    section, modes = shapes.rounded_rectangle(3.0, 2.0, 0.6).immersed(1.5), rigid_modes((0.1, -0.7))
    solution = solve(section, Water(depth, 1000.0, GRAVITY), [12.0, 24.0], modes=modes)
    rest = np.abs(solution.added_mass - solution.infinite_frequency_added_mass).max(axis=(1, 2))
    scale = np.abs(solution.infinite_frequency_added_mass).max()
    assert rest[1] < 0.5 * rest[0]
    assert rest[1] < 0.01 * scale


def test_infinite_frequency_of_a_half_circle():
    """phi = 0: heave rho pi a^2 / 2 (half of the circle in unbounded water), sway 2 rho a^2 / pi."""
    radius = 1.7
    solution = solve(
        shapes.circle(radius).immersed(radius), Water(math.inf, 1000.0, GRAVITY), [1.0], modes=rigid_modes((0.0, 0.0))
    )
    mass = solution.infinite_frequency_added_mass
    assert mass[1, 1] == pytest.approx(1000.0 * math.pi * radius**2 / 2.0, rel=1e-7)
    assert mass[0, 0] == pytest.approx(2000.0 * radius**2 / math.pi, rel=1e-7)
    assert mass[2, 2] == 0.0


def test_half_circle_at_zero_frequency_sways_like_a_circle():
    """A rigid surface doubles the half circle: sway in infinite depth has rho pi a^2 / 2."""
    solution = solve(
        shapes.circle(1.0).immersed(1.0), Water(math.inf, 1000.0, GRAVITY), [1.0], modes=rigid_modes((0.0, 0.0))
    )
    assert solution.zero_frequency_added_mass[0, 0] == pytest.approx(500.0 * math.pi, rel=1e-6)


def test_whole_and_halved_problem_agree():
    """The symmetric split against the unsplit problem, forced by an immaterial break of symmetry."""
    points = np.array([(-5.0, 0.0), (5.0, 0.0), (5.0, 4.5), (-5.0, 4.5)])
    halved = shapes.polygon(points).immersed(3.0)
    points[2, 0] += 1e-6
    whole = shapes.polygon(points).immersed(3.0)
    assert halved.symmetry_axis() is not None and whole.symmetry_axis() is None
    water, omega, modes = Water(10.0, 1000.0, GRAVITY), [0.7, 1.8], rigid_modes((0.3, -1.0))
    a, b = (solve(item, water, omega, modes=modes, heading=[0.0, 0.5]) for item in (halved, whole))
    assert a.added_mass == pytest.approx(b.added_mass, rel=1e-4, abs=3.0)
    assert a.excitation_force == pytest.approx(b.excitation_force, rel=1e-4, abs=1.0)
    assert a.transmission_coefficient == pytest.approx(b.transmission_coefficient, abs=1e-5)


def test_shift_and_mirror_of_the_section():
    """A section moved by s: R gets exp(2iks), T stays; the mirrored section transmits the same (reciprocity)."""
    hull = shapes.polygon([(-2.0, 0.0), (1.0, 0.5), (3.0, 2.0), (2.5, 4.0), (-2.5, 4.0)])
    mirrored = shapes.polygon([(2.0, 0.0), (-1.0, 0.5), (-3.0, 2.0), (-2.5, 4.0), (2.5, 4.0)])
    water, omega, modes = Water(7.0, 1000.0, GRAVITY), [0.8, 1.9], rigid_modes((0.0, 0.0))
    base = solve(hull.immersed(2.5), water, omega, modes=modes)
    moved = solve(hull.immersed(2.5, offset=3.0), water, omega, modes=rigid_modes((3.0, 0.0)))
    other = solve(mirrored.immersed(2.5), water, omega, modes=modes)
    k = base.normal.states.wave_number[:, None]
    assert moved.reflection_coefficient == pytest.approx(base.reflection_coefficient * np.exp(6j * k), abs=2e-5)
    assert moved.transmission_coefficient == pytest.approx(base.transmission_coefficient, abs=2e-5)
    assert other.transmission_coefficient == pytest.approx(base.transmission_coefficient, abs=2e-5)
    assert np.abs(other.reflection_coefficient) == pytest.approx(np.abs(base.reflection_coefficient), abs=2e-5)
    assert moved.added_mass == pytest.approx(base.added_mass, rel=1e-4, abs=5.0)
    assert other.added_mass[:, 0, 1] == pytest.approx(-base.added_mass[:, 0, 1], rel=1e-4)


def test_oblique_solution_joins_the_normal_one():
    """The K_0 machinery at a heading of 0.5 degrees against the logarithmic kernel at 0."""
    section, water = shapes.rectangle(6.0, 4.0).immersed(2.0, heel=0.05), Water(8.0, 1000.0, GRAVITY)
    solution = solve(section, water, [0.9, 1.7], modes=rigid_modes((0.0, -0.5)), heading=[0.0, math.radians(0.5)])
    (oblique,) = solution.oblique
    assert oblique.added_mass == pytest.approx(solution.added_mass, rel=3e-4, abs=10.0)
    assert oblique.transmission_coefficient == pytest.approx(solution.normal.transmission_coefficient, abs=3e-4)
    data = solution.dataset
    assert data.added_mass.dims == ("omega", "radiating_dof", "influenced_dof")
    assert data.oblique_added_mass.dims == ("omega", "wave_direction", "radiating_dof", "influenced_dof")
    assert data.oblique_added_mass.isel(wave_direction=0).values == pytest.approx(solution.added_mass)


def test_grazing_waves_are_reflected_almost_wholly():
    """R goes to -1 in proportion to cos(beta)."""
    section, angles = shapes.rectangle(6.0, 4.0).immersed(2.0), np.radians([80.0, 86.0])
    solution = solve(section, Water(8.0, 1000.0, GRAVITY), [1.2], modes=rigid_modes((0.0, 0.0)), heading=angles)
    assert solution.status == "converged"
    rest = np.abs(solution.reflection_coefficient[0] + 1.0)
    assert rest[1] / rest[0] == pytest.approx(math.cos(angles[1]) / math.cos(angles[0]), rel=0.2)


def test_user_modes_and_separate_bodies():
    """Rigid motion of two bodies together is the sum of their separate motions; a flexible mode keeps symmetry."""
    section = shapes.twin_pontoon(2.0, 3.0, 1.5).immersed(2.0)
    water, omega = Water(9.0, 1000.0, GRAVITY), [0.9, 2.1]
    together = solve(section, water, omega, modes=rigid_modes((0.0, -0.5)))
    apart = rigid_modes((0.0, -0.5), body=0, prefix="left ") + rigid_modes((0.0, -0.5), body=1, prefix="right ")
    pair = solve(section, water, omega, modes=apart)
    for i in range(3):
        for j in range(3):
            total = pair.added_mass[:, [i, i + 3]][:, :, [j, j + 3]].sum(axis=(1, 2))
            assert total == pytest.approx(together.added_mass[:, i, j], rel=1e-6, abs=1e-3)
    force = pair.excitation_force[:, :, :3] + pair.excitation_force[:, :, 3:]
    assert force == pytest.approx(together.excitation_force, rel=1e-6, abs=1e-3)

    def bending(points):
        return np.stack([np.zeros(len(points)), 0.1 * points[:, 0] ** 2], axis=1)

    flexible = Modes(("heave", "bending"), (rigid_modes((0.0, 0.0)).functions[1], bending))
    found = solve(section, water, omega, modes=flexible)
    assert found.status == "converged"
    assert found.added_mass[:, 0, 1] == pytest.approx(found.added_mass[:, 1, 0], rel=1e-5)


def test_lid_takes_energy_at_the_gap_resonance():
    section = shapes.twin_pontoon(5.0, 3.0, 1.0, deck_thickness=0.5).immersed(2.0)
    water, modes = Water(12.0, 1000.0, GRAVITY), rigid_modes((0.0, -0.5))
    omega = np.linspace(1.3, 2.1, 81)
    free = solve(section, water, omega, modes=modes)
    damped = solve(section, water, omega, modes=modes, lid=0.05)
    (notice,) = free.notices
    assert notice.code == "gap-resonance" and notice.severity == "warning"
    assert [reported.severity for reported in damped.notices] == ["information"]
    gap = free.normal.surface
    inside = np.abs(gap.u.real) < 0.5
    swing = np.abs(free.normal.scattered_surface[:, inside & (gap.kind == 1)]).max(axis=1) * omega / GRAVITY
    assert notice.value == pytest.approx(omega[np.argmax(swing)], rel=0.06)
    assert damped.status == "converged"  # energy with the loss, damping with the loss, Haskind
    loss = damped.normal.lid_loss
    assert loss.max() > 0.05 and omega[np.argmax(loss)] == pytest.approx(omega[np.argmax(swing)], abs=0.03)
    assert (np.linalg.eigvalsh(damped.normal.lid_damping) > -1e-6 * damped.normal.lid_damping.max()).all()
    calmer = np.abs(damped.normal.scattered_surface[:, inside & (gap.kind == 1)]).max(axis=1) * omega / GRAVITY
    assert calmer.max() < 0.7 * swing.max()


@pytest.mark.parametrize(
    ("section", "depth", "numbers"),
    [
        (shapes.rectangle(10.0, 4.5).immersed(3.0), 10.0, [0.05, 1.0, 4.0]),
        (shapes.rectangle(10.0, 12.0).immersed(9.8), 10.0, [0.01, 0.1, 1.0]),
        (shapes.rectangle(10.0, 12.0).immersed(9.99), 10.0, [0.01, 0.1, 1.0]),
        (shapes.rectangle(10.0, 4.5).immersed(0.05), 10.0, [0.01, 0.1, 1.0]),
        (shapes.rectangle(10.0, 4.5).immersed(3.0), 10.0, [1e-4, 1e-2, 10.0]),
        (shapes.pi_type(10.0, 3.0, 4.0, 0.05).immersed(6.0), 12.0, [0.01, 0.1, 1.0]),
        (shapes.circle(2.0).immersed(9.95), 10.0, [0.01, 0.1, 1.0]),
        (shapes.circle(2.0).immersed(4.04), 10.0, [0.01, 0.1, 1.0]),
        (shapes.circle(2.0).immersed(3.9), 10.0, [0.01, 0.1, 1.0]),
    ],
    ids=[
        "kB 40",
        "clearance 2 %",
        "clearance 0.1 %",
        "thin",
        "five decades",
        "plates",
        "near bed",
        "near top",
        "awash",
    ],
)
def test_extreme_sections_and_waves(section, depth, numbers):
    k = np.array(numbers)
    omega = np.sqrt(GRAVITY * k * np.tanh(k * depth))
    solution = solve(section, Water(depth, 1000.0, GRAVITY), omega, modes=rigid_modes((0.2, -1.0)))
    assert solution.status == "converged", solution.message
    assert (np.linalg.eigvalsh(solution.radiation_damping) >= -1e-9 * solution.radiation_damping.max()).all()


@pytest.mark.parametrize("gravity, density, scale", [(9.81, 1025.0, 1e-2), (9.81, 1.0, 100.0), (1.62, 1000.0, 1.0)])
def test_froude_scaling(gravity, density, scale):
    """The same section at another scale, gravity and density gives the same numbers without dimension."""

    def without_dimension(size, g, rho):
        section = shapes.trapezoid(4.0 * size, 6.0 * size, 3.0 * size).immersed(2.0 * size)
        omega = np.array([0.6, 1.1, 1.9]) * math.sqrt(g / size)
        found = solve(section, Water(5.0 * size, rho, g), omega, modes=rigid_modes((0.0, -0.5 * size)))
        unit = rho * size**2 * np.array([[1, 1, size], [1, 1, size], [size, size, size**2]])
        return found.added_mass / unit, found.transmission_coefficient

    (a, t), (b, u) = without_dimension(scale, gravity, density), without_dimension(1.0, 1.0, 1.0)
    assert a == pytest.approx(b, rel=1e-8, abs=1e-8)
    assert t == pytest.approx(u, abs=1e-8)


def test_interrupted_work_hands_back_what_is_done():
    section = shapes.rectangle(6.0, 4.0).immersed(2.0)

    def stop(what, done, total):
        if done >= 3 and total == 5:
            raise KeyboardInterrupt

    omega = [0.5, 0.8, 1.1, 1.4, 1.7]
    heard = []

    def stop_at_oblique(what, done, total):
        heard.append((done, total))
        if len(heard) == 4:
            raise KeyboardInterrupt

    solution = solve(
        section,
        Water(8.0, 1000.0, GRAVITY),
        omega,
        modes=rigid_modes((0, 0)),
        heading=[0.0, 0.6],
        progress=stop_at_oblique,
    )
    assert solution.status == "interrupted"
    assert np.isfinite(solution.reflection_coefficient[:, 0]).all()
    assert np.isfinite(solution.reflection_coefficient[:3, 1]).all()
    assert np.isnan(solution.reflection_coefficient[3:, 1]).all()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"omega": [0.0, 1.0]}, "omega contains 0"),
        ({"omega": [-1.0]}, "omega contains -1"),
        ({"omega": [np.nan]}, "omega contains nan"),
        ({"omega": []}, "no frequency"),
        ({"heading": math.radians(90.0)}, "heading contains 90"),
        ({"heading": 3.0}, "heading contains"),
        ({"heading": np.nan}, "finite angles"),
        ({"lid": -0.1}, "lid is"),
        ({"accuracy": 0.0}, "accuracy is 0"),
        ({"depth": 2.0}, "reaches down to z = -2"),
        ({"depth": 1.5}, "clearance above the bed"),
    ],
)
def test_bad_input_gets_one_clear_message(change, words):
    arguments = {"omega": [1.0], "heading": 0.0, "lid": None, "accuracy": 1e-3, "depth": 8.0, **change}
    water = Water(arguments.pop("depth"), 1000.0, GRAVITY)
    with pytest.raises(InputError, match=words):
        solve(
            shapes.rectangle(6.0, 4.0).immersed(2.0),
            water,
            arguments.pop("omega"),
            modes=rigid_modes((0, 0)),
            **arguments,
        )


def test_bad_modes_are_refused():
    with pytest.raises(InputError, match="repeat"):
        rigid_modes((0.0, 0.0)) + rigid_modes((0.0, 0.0))
    with pytest.raises(InputError, match="not finite"):
        bad = Modes(("bad",), (lambda points: points * np.nan,))
        solve(shapes.rectangle(6.0, 4.0).immersed(2.0), Water(8.0, 1000.0, GRAVITY), [1.0], modes=bad)
    with pytest.raises(InputError, match="centre"):
        rigid_modes((np.nan, 0.0))


def test_a_hull_that_is_not_set_into_the_water_says_what_to_do():
    hull, water = shapes.rectangle(4.0, 2.0), Water(5.0, 1025.0, GRAVITY)
    with pytest.raises(InputError, match=r"hull\.immersed\(draught=\.\.\.\)"):
        solve(hull, water, [1.0], modes=rigid_modes((0.0, 0.0)))
    with pytest.raises(InputError, match="tuple is no Modes"):
        solve(hull.immersed(draught=1.0), water, [1.0], modes=("sway",))


def test_a_section_that_memory_does_not_hold_is_refused_before_it_is_built():
    """The dense matrix of the most panels stays below half a gigabyte; 4000 of eight nodes would take 16."""
    section = shapes.rectangle(3000.0, 4.0).immersed(3.0)
    with pytest.raises(InputError, match=f"more than {MOST_PANELS} panels"):
        solve(section, Water(200.0, 1025.0, GRAVITY), [math.pi], modes=rigid_modes((0.0, -1.0)))
    assert (Resolution().order * MOST_PANELS) ** 2 * 16 < 0.5e9
