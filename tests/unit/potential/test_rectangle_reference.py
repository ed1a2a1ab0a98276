"""The rectangle reference against ordinary matched eigenfunctions, exact limits and identities at random inputs."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.potential.extrapolation import extrapolated_limit
from moyai.potential.rectangle import solve_rectangle
from moyai.potential.rectangle_basis import GapBasis
from moyai.potential.rectangle_outer import log_matrix
from moyai.sea.dispersion import evanescent_wave_numbers, wave_number
from moyai.sea.water import Water

G = 9.81


def random_case(rng):
    draught = 10.0 ** rng.uniform(-1.0, 1.0)
    beam = draught * 10.0 ** rng.uniform(-1.0, 1.2)
    depth = draught * (1.0 + 10.0 ** rng.uniform(-1.3, 1.3))
    return beam, draught, Water(depth, rng.uniform(900.0, 1100.0), rng.uniform(9.7, 9.9))


def matched_modes(beam, draught, water, omega, heading, modes):
    """R, T and sway moment by matched eigenfunctions with plain cosines: nothing in common but the equations."""
    h, b, s = water.depth, 0.5 * beam, water.depth - draught
    k0 = wave_number(omega, h, water.gravity)
    nu = k0 * abs(math.sin(heading))
    kn = evanescent_wave_numbers(omega, h, water.gravity, modes - 1)
    k = np.concatenate([[-1j * k0], kn])
    decay = np.concatenate([[-1j * math.sqrt(k0**2 - nu**2)], np.sqrt(kn**2 + nu**2)])
    norm = np.sqrt(0.5 * h * (1.0 + np.sinc(2.0 * k * h / np.pi)))
    inner = np.arange(modes) * np.pi / s
    kappa = np.hypot(inner, nu)
    overlap = 0.5 * s * (np.sinc((k[:, None] - inner) * s / np.pi) + np.sinc((k[:, None] + inner) * s / np.pi))
    overlap = overlap / norm[:, None]
    weight = np.where(np.arange(modes) == 0, 1.0 / s, 2.0 / s)
    wall = (np.sin(k * h) - np.sin(k * s)) / k / norm
    wave = np.zeros(modes, complex)
    wave[0] = 2.0
    mirrored, sway = {}, None
    for even in (True, False):
        tangent = np.tanh(kappa * b)
        if even:
            edge = kappa * tangent
        else:
            edge = np.where(kappa > 0.0, kappa / np.where(kappa > 0.0, tangent, 1.0), 1.0 / b)
        system = np.eye(modes) + weight[:, None] * (overlap.T @ (overlap * edge / decay[:, None]))
        below = np.linalg.solve(system, weight * (overlap.T @ wave))
        mirrored[even] = 1.0 - (overlap @ (edge * below))[0] / decay[0]
        if not even:
            below = np.linalg.solve(system, -weight * (overlap.T @ (wall / decay)))
            sway = 2.0 * np.sum(-(overlap @ (edge * below) + wall) / decay * wall)
    shift = np.exp(-2j * math.sqrt(k0**2 - nu**2) * b)
    return np.array(
        [shift * (mirrored[True] + mirrored[False]) / 2, shift * (mirrored[True] - mirrored[False]) / 2, sway]
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("oblique", [False, True])
def test_ordinary_matched_eigenfunctions_tend_to_the_reference(seed, oblique):
    rng = np.random.default_rng([seed, oblique])
    draught = rng.uniform(0.15, 0.7)
    beam, water = rng.uniform(0.4, 2.0), Water(1.0, 1000.0, G)
    omega, heading = rng.uniform(1.5, 5.0), rng.uniform(0.2, 1.3) if oblique else 0.0
    levels = np.array([matched_modes(beam, draught, water, omega, heading, 40 * 2**n) for n in range(4)])
    solution = solve_rectangle(beam, draught, water, omega, centre=(0.0, 0.0), heading=heading)
    raw = np.abs(levels[-1] - levels[-2]).max()
    reflection, transmission, sway = extrapolated_limit(levels, 4.0 / 3.0)
    # Corners make the plain series converge like modes^(-4/3); the extrapolation leaves a few units of 1e-6
    assert abs(solution.reflection_coefficient[0, 0] - reflection) < 1e-5
    assert abs(solution.transmission_coefficient[0, 0] - transmission) < 1e-5
    assert raw > 1e-5, "the plain series would have been good enough to need no extrapolation"
    if not oblique:
        own = -(solution.added_mass[0, 0, 0] + 1j * solution.radiation_damping[0, 0, 0] / omega) / water.density
        assert abs(own - sway) < 2e-5 * abs(sway)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_identities_of_random_rectangles(seed):
    rng = np.random.default_rng(seed)
    beam, draught, water = random_case(rng)
    k = 10.0 ** rng.uniform(-1.5, 1.0, 4) / draught
    omega = np.sort(np.sqrt(water.gravity * k * np.tanh(k * water.depth)))
    centre = (rng.uniform(-0.3, 0.3) * beam, rng.uniform(-1.0, 0.5) * draught)
    angles = [0.0, np.pi, rng.uniform(0.1, 1.4)]
    solution = solve_rectangle(beam, draught, water, omega, centre=centre, heading=angles)
    names = [check.name for check in solution.checks]
    assert len(names) == 4
    for check in solution.checks:
        assert check.value < 1e-9, check
    assert np.all(np.linalg.eigvalsh(solution.radiation_damping) > -1e-9 * np.abs(solution.radiation_damping).max())


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_more_functions_change_nothing(seed):
    rng = np.random.default_rng(100 + seed)
    beam, draught, water = random_case(rng)
    omega = math.sqrt(water.gravity / draught) * np.array([0.3, 0.9, 1.8])
    heading = rng.uniform(0.1, 1.3)
    few = solve_rectangle(beam, draught, water, omega, centre=(0.0, 0.0), heading=heading)
    many = solve_rectangle(beam, draught, water, omega, centre=(0.0, 0.0), heading=heading, pairs=40)
    for name in ("added_mass", "infinite_frequency_added_mass", "excitation_force"):
        a, b = getattr(few, name), getattr(many, name)
        assert np.abs(a - b).max() < 1e-9 * np.abs(b).max()
    assert np.abs(few.transmission_coefficient - many.transmission_coefficient).max() < 1e-9


def test_basis_transforms_are_the_quadrature_of_the_functions():
    basis = GapBasis(7)
    points, _ = basis.moment_rules()
    for a in (0.0, 0.3, 4.0, 11.0):
        moments = basis.moments(np.cos(a * points))
        # rounding of the Gauss weights, times the scale of the highest function
        assert np.allclose(moments, basis.cosine_transform(np.array([a]))[:, 0], rtol=0.0, atol=2e-12)
    cosh = basis.moments(np.cosh(3.0 * points)) * math.exp(-3.0)
    assert np.allclose(cosh, basis.hyperbolic_transform(np.array([3.0 + 0j]))[:, 0], rtol=0.0, atol=2e-12)


@pytest.mark.slow
def test_oblique_waves_tend_to_straight_ones_and_opposite_ones_mirror():
    water = Water(7.0, 1025.0, G)
    solution = solve_rectangle(9.0, 2.0, water, [0.5, 1.1, 2.0], centre=(0.4, -0.3), heading=[0.0, 1e-5, 3e-3, np.pi])
    straight, close, near = (solution.excitation_force[:, n] for n in range(3))
    assert np.abs(close - straight).max() < 1e-8 * np.abs(straight).max()
    assert 1e-8 < np.abs(near - straight).max() / np.abs(straight).max() < 1e-4
    # seen from the other side: about the middle sway and roll change sign
    other = solve_rectangle(9.0, 2.0, water, [0.5, 1.1, 2.0], centre=(-0.4, -0.3), heading=0.0).excitation_force[:, 0]
    assert np.allclose(solution.excitation_force[:, 3], other * [-1.0, 1.0, -1.0], rtol=1e-12)


def test_long_waves_and_low_frequencies():
    water = Water(4.0, 1000.0, G)
    omega = np.array([1e-3])
    solution = solve_rectangle(3.0, 1.5, water, omega, centre=(0.0, 0.0))
    # slow heave sends long waves; long waves lift with the waterplane and pass
    assert solution.radiation_damping[0, 1, 1] == pytest.approx(0.5 * 1000.0 * 9.0 * math.sqrt(G / 4.0), rel=1e-5)
    assert solution.excitation_force[0, 0, 1] == pytest.approx(1000.0 * G * 3.0, rel=1e-3)
    assert abs(solution.transmission_coefficient[0, 0]) == pytest.approx(1.0, abs=1e-5)
    assert np.allclose(solution.added_mass[0], solution.zero_frequency_added_mass, rtol=1e-4, atol=1e-6)


@pytest.mark.slow
def test_thin_plate_without_gravity_has_the_added_mass_of_the_strip():
    # both sides of a vertical plate under phi = 0, over rho d^2: values of an independent Galerkin calculation, 2/pi
    table = {0.4: 0.6374, 0.7: 0.6464, 0.9: 0.6837}
    for ratio, expected in table.items():
        solution = solve_rectangle(1e-5, ratio, Water(1.0, 1.0, G), 1.0, centre=(0.0, 0.0))
        assert solution.infinite_frequency_added_mass[0, 0] / ratio**2 == pytest.approx(expected, abs=1.1e-4)
    # the plate is the hardest case of the method: its edge of 360 degrees is not that of the basis
    deep = solve_rectangle(1e-5, 1.0, Water(30.0, 1.0, G), 1.0, centre=(0.0, 0.0))
    assert deep.infinite_frequency_added_mass[0, 0] == pytest.approx(2.0 / math.pi, abs=1.5e-4)


def test_dataset_has_the_names_and_dimensions_of_capytaine():
    water = Water(5.0, 1025.0, G)
    solution = solve_rectangle(4.0, 1.0, water, [0.8, 1.6], centre=(0.0, -0.2), heading=[0.0, 0.4])
    data = solution.dataset
    assert data["added_mass"].dims == ("omega", "radiating_dof", "influenced_dof")
    assert data["excitation_force"].dims == ("omega", "wave_direction", "influenced_dof")
    total = data["Froude_Krylov_force"] + data["diffraction_force"]
    assert np.allclose(total, data["excitation_force"])
    assert data["radiated_wave"].sel(side="minus", radiating_dof="sway").values == pytest.approx(
        -data["radiated_wave"].sel(side="plus", radiating_dof="sway").values
    )
    for variable in data.data_vars.values():
        assert variable.attrs["units"] and variable.attrs["long_name"]


@pytest.mark.parametrize(
    ("arguments", "options", "path"),
    [
        ((0.0, 1.0, Water(5.0, 1000.0, G), 1.0), {}, "beam"),
        ((1.0, math.nan, Water(5.0, 1000.0, G), 1.0), {}, "draught"),
        ((1.0, 5.0, Water(5.0, 1000.0, G), 1.0), {}, "draught"),
        ((1.0, 1.0, Water(math.inf, 1000.0, G), 1.0), {}, "water.depth"),
        ((1.0, 1.0, Water(5.0, 1000.0, G), [1.0, 0.0]), {}, "omega"),
        ((1.0, 1.0, Water(5.0, 1000.0, G), 1.0), {"heading": 0.5 * math.pi}, "heading"),
        ((1.0, 1.0, Water(5.0, 1000.0, G), 1.0), {"pairs": 1}, "pairs"),
    ],
)
def test_bad_input_is_named(arguments, options, path):
    with pytest.raises(InputError) as caught:
        solve_rectangle(*arguments, centre=(0.0, 0.0), **options)
    assert caught.value.fault.path == path


def test_the_logarithmic_kernel_is_the_integral_over_its_transforms():
    """-ln|y - y'| - ln|y + y'| is twice the integral of cos(k y) cos(k y') / k, but for a constant of the lowest."""
    basis = GapBasis(3)
    node, weight = np.polynomial.legendre.leggauss(16)
    start = np.concatenate([[0.0], np.geomspace(1e-3, 1.0, 20)[:-1], np.arange(1.0, 4000.0)])
    half = 0.5 * np.diff(np.append(start, 4000.0))
    k = (start[:, None] + half[:, None] * (1.0 + node)).ravel()
    transforms = basis.cosine_transform(k)
    found = 2.0 / np.pi * (transforms * (half[:, None] * weight).ravel() / k) @ transforms.T
    # the integrals of two functions that do not vanish at k = 0 have none
    settled = (basis.degree[:, None] > 0) | (basis.degree[None, :] > 0)
    assert np.allclose(log_matrix(basis, 1.0)[settled], found[settled], atol=2e-4)
