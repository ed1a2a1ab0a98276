"""The planar frame against quantities that know nothing of the mapping: pressure integrals, energies, rotations."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.interop.checks import check_coefficients, check_time_convention, import_notices
from moyai.interop.coefficients import DOFS, assemble
from moyai.interop.planar import move_reference_point, to_planar

DENSITY, GRAVITY = 1025.0, 9.81


def rotation_vector_displacement(twist, point, reference):
    """Displacement of a point of a rigid body whose reference point moves by twist[:3] and turns by twist[3:]."""
    return twist[:3] + np.cross(twist[3:], np.asarray(point) - np.asarray(reference))


def random_dataset(rng, reference, directions, depth=math.inf):
    omega = np.sort(rng.uniform(0.3, 2.5, 4))
    matrix = rng.normal(size=(4, 6, 6))
    return assemble(
        program="random",
        source="random",
        dofs=DOFS,
        omega=omega,
        added_mass=matrix @ matrix.transpose(0, 2, 1),
        radiation_damping=matrix.transpose(0, 2, 1) @ matrix,
        wave_direction=directions,
        forces={
            "excitation_force": rng.normal(size=(4, len(directions), 6)) + 1j * rng.normal(size=(4, len(directions), 6))
        },
        density=DENSITY,
        gravity=GRAVITY,
        water_depth=depth,
        reference_point=reference,
        limits={"infinite_frequency_added_mass": matrix[0] @ matrix[0].T},
    )


@pytest.mark.parametrize("seed", range(5))
def test_energy_and_power_do_not_depend_on_the_reference_point(seed):
    rng = np.random.default_rng(seed)
    old, new = rng.normal(size=(2, 3))
    before = random_dataset(rng, old, np.array([0.0]))
    after = move_reference_point(before, new)
    for _ in range(3):
        twist_new = rng.normal(size=6)
        twist_old = np.concatenate([rotation_vector_displacement(twist_new, old, new), twist_new[3:]])
        for name in ("added_mass", "radiation_damping", "infinite_frequency_added_mass"):
            energy_old = np.einsum("i,...ij,j->...", twist_old, before[name].values, twist_old)
            energy_new = np.einsum("i,...ij,j->...", twist_new, after[name].values, twist_new)
            np.testing.assert_allclose(energy_new, energy_old, rtol=1e-11)
        np.testing.assert_allclose(
            after["excitation_force"].values @ twist_new, before["excitation_force"].values @ twist_old, rtol=1e-10
        )
    back = move_reference_point(after, old)
    np.testing.assert_allclose(back["added_mass"], before["added_mass"], rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("sea", ["beam", "head"])
def test_planar_energy_is_that_of_the_same_motion_in_three_dimensions(seed, sea):
    rng = np.random.default_rng(100 + seed)
    reference = rng.normal(size=3)
    along, rotation_axis = {
        "beam": (np.array([0.0, 1.0, 0.0]), np.array([-1.0, 0.0, 0.0])),
        "head": (np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])),
    }[sea]
    heading = 0.5 * math.pi if sea == "beam" else 0.0
    before = random_dataset(rng, reference, np.array([heading]))
    length, x_g, z_g = rng.uniform(1.0, 30.0), rng.normal(), rng.normal()
    origin = tuple(rng.normal(size=2))
    after = to_planar(before, length=length, centre_of_gravity=(x_g, z_g), sea=sea, origin=origin)
    sway, heave, roll = rng.normal(size=3)
    # Planar roll takes the top towards planar +x: a rotation about the axis z cross (planar x)
    gravity_centre = np.array([*origin, 0.0]) + x_g * along + np.array([0.0, 0.0, z_g])
    twist_g = np.concatenate([sway * along + np.array([0.0, 0.0, heave]), roll * rotation_axis])
    top = gravity_centre + np.array([0.0, 0.0, 1.0])
    assert (rotation_vector_displacement(np.r_[np.zeros(3), rotation_axis], top, gravity_centre) @ along) > 0.0
    twist = np.concatenate([rotation_vector_displacement(twist_g, reference, gravity_centre), twist_g[3:]])
    planar = np.array([sway, heave, roll])
    for name in ("added_mass", "radiation_damping"):
        three = np.einsum("i,nij,j->n", twist, before[name].values, twist)
        two = length * np.einsum("i,nij,j->n", planar, after[name].values, planar)
        np.testing.assert_allclose(two, three, rtol=1e-10)
    power = before["excitation_force"].values @ twist
    number = before["omega"].values ** 2 / GRAVITY
    phase = np.exp(-1j * number * (np.asarray(origin) @ along[:2]))[:, None]
    np.testing.assert_allclose(length * after["excitation_force"].values @ planar, power * phase, rtol=1e-10)


def box_froude_krylov(beam, draught, length, centre, reference, wave_number, direction):
    """Exciting force of the undisturbed wave on a box, by Gauss integration over its five wetted faces, deep water."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    half = np.array([0.5 * beam, 0.5 * length])
    faces = []
    for axis in (0, 1):
        for side in (-1.0, 1.0):
            other = 1 - axis
            z = -0.5 * draught * (1.0 + nodes)
            grid = np.zeros((24, 24, 3))
            grid[..., axis] = side * half[axis]
            grid[..., other] = half[other] * nodes[:, None]
            grid[..., 2] = z[None, :]
            normal = np.zeros(3)
            normal[axis] = side
            faces.append((grid, normal, np.outer(weights, weights) * half[other] * 0.5 * draught))
    grid = np.zeros((24, 24, 3))
    grid[..., 0], grid[..., 1], grid[..., 2] = half[0] * nodes[:, None], half[1] * nodes[None, :], -draught
    faces.append((grid, np.array([0.0, 0.0, -1.0]), np.outer(weights, weights) * half[0] * half[1]))
    force = np.zeros(6, dtype=complex)
    k = wave_number * np.array([math.cos(direction), math.sin(direction)])
    for grid, normal, area in faces:
        place = grid + np.array([*centre, 0.0])
        pressure = DENSITY * GRAVITY * np.exp(wave_number * place[..., 2] + 1j * (place[..., :2] @ k))
        arm = np.cross(place - np.asarray(reference), normal)
        force[:3] += -np.sum(pressure * area) * normal
        force[3:] += -np.einsum("ab,ab,abc->c", pressure, area, arm)
    return force


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("sea", ["beam", "head"])
def test_froude_krylov_force_of_an_off_origin_box(seed, sea):
    """The planar force per metre is the line integral over the section, written down without any of the mapping."""
    rng = np.random.default_rng(200 + seed)
    beam, draught, length = rng.uniform(0.5, 3.0), rng.uniform(0.3, 1.5), rng.uniform(1.0, 8.0)
    centre, reference = rng.normal(size=2), rng.normal(size=3)
    direction = 0.5 * math.pi if sea == "beam" else 0.0
    plan = (length, beam) if sea == "beam" else (beam, length)
    omega = np.sort(rng.uniform(0.8, 2.5, 3))
    number = omega**2 / GRAVITY
    forces = [box_froude_krylov(plan[0], draught, plan[1], centre, reference, k, direction) for k in number]
    zeros = np.zeros((3, 6, 6))
    dataset = assemble(
        program="box",
        source="box",
        dofs=DOFS,
        omega=omega,
        added_mass=zeros + np.eye(6),
        radiation_damping=zeros,
        wave_direction=np.array([direction]),
        forces={"excitation_force": np.array(forces)[:, None, :]},
        density=DENSITY,
        gravity=GRAVITY,
        water_depth=math.inf,
        reference_point=reference,
    )
    x_g, z_g = rng.normal(), rng.normal()
    planar = to_planar(dataset, length=length, centre_of_gravity=(x_g, z_g), sea=sea, origin=tuple(centre))
    x, weights = np.polynomial.legendre.leggauss(40)
    for n, k in enumerate(number):
        # Section centred at planar x = 0: sides, then bottom; force -p n, moment -p ((z - z_G) n_x - (x - x_G) n_z)
        z = 0.5 * draught * (x - 1.0)
        side = DENSITY * GRAVITY * np.exp(k * z) * weights * 0.5 * draught
        left, right = np.exp(-0.5j * k * beam), np.exp(0.5j * k * beam)
        across = 0.5 * beam * x
        bottom = DENSITY * GRAVITY * np.exp(-k * draught + 1j * k * across) * weights * 0.5 * beam
        sway = np.sum(side) * (left - right)
        heave = np.sum(bottom)
        roll = np.sum(side * (z - z_g)) * (left - right) - np.sum(bottom * (across - x_g))
        got = planar["excitation_force"].sel(wave_direction=0.0).values[n]
        np.testing.assert_allclose(got, [sway, heave, roll], rtol=1e-9)


def test_refusals():
    rng = np.random.default_rng(3)
    dataset = random_dataset(rng, (0.0, 0.0, 0.0), np.array([0.0]))
    with pytest.raises(InputError, match="90 degrees"):
        to_planar(dataset, length=5.0, centre_of_gravity=(0.0, 0.0), sea="beam")
    with pytest.raises(InputError, match="length"):
        to_planar(dataset, length=0.0, centre_of_gravity=(0.0, 0.0), sea="head")
    with pytest.raises(InputError, match="lack"):
        move_reference_point(dataset.isel(radiating_dof=slice(3), influenced_dof=slice(3)), (0.0, 0.0, 1.0))


def test_headings_turn_with_the_frame():
    rng = np.random.default_rng(4)
    directions = np.radians([-180.0, -90.0, 0.0, 45.0, 90.0, 135.0])
    dataset = random_dataset(rng, (0.0, 0.0, 0.0), directions)
    beam = to_planar(dataset, length=1.0, centre_of_gravity=(0.0, 0.0), sea="beam")
    np.testing.assert_allclose(np.degrees(beam.wave_direction), [-90.0, -45.0, 0.0, 45.0, 90.0, 180.0], atol=1e-9)
    # Planar y is minus the body's x: a wave at 45 degrees in the plane travels at 135 degrees of the body
    np.testing.assert_allclose(
        beam.excitation_force.sel(influenced_dof="heave").sel(wave_direction=math.pi / 4, method="nearest"),
        dataset.excitation_force.sel(influenced_dof="Heave").sel(wave_direction=0.75 * math.pi, method="nearest"),
    )


def test_checks_see_a_conjugated_force_and_a_negative_damping():
    rng = np.random.default_rng(5)
    dataset = random_dataset(rng, (0.0, 0.0, 0.0), np.array([0.0]))
    dataset["excitation_force"].values[0, 0, :3] = [-3.0j, 0.0, 10.0 - 0.1j]
    assert check_time_convention(dataset) == ()
    wrong = dataset.copy(deep=True)
    wrong["excitation_force"] = wrong["excitation_force"].conj()
    assert [notice.code for notice in check_time_convention(wrong)] == ["time-convention"]
    assert all(check.passed for check in check_coefficients(dataset))
    wrong["radiation_damping"] = -wrong["radiation_damping"]
    assert [check.passed for check in check_coefficients(wrong)] == [True, True, False]
    wrong["added_mass"].values[:, 0, 4] += wrong["added_mass"].values[:, 0, 0]
    assert not check_coefficients(wrong)[0].passed


def test_an_import_reports_what_fails_and_nothing_else():
    dataset = random_dataset(np.random.default_rng(5), (0.0, 0.0, 0.0), np.array([0.0]))
    dataset["excitation_force"].values[0, 0, :3] = [-3.0j, 0.0, 10.0 - 0.1j]
    assert import_notices(dataset) == ()
    wrong = dataset.copy(deep=True)
    wrong["added_mass"].values[:, 0, 4] += 0.3 * wrong["added_mass"].values[:, 0, 0]
    wrong["excitation_force"] = wrong["excitation_force"].conj()
    found = import_notices(wrong)
    assert [(one.code, one.severity) for one in found] == [
        ("coefficients-identity", "warning"), ("time-convention", "error"),
    ]  # fmt: skip
    assert "symmetry of the added mass" in found[0].message


@pytest.mark.parametrize("degrees", [-120.0, -60.0, -30.0, 0.0, 30.0, 60.0, 120.0, 180.0])
def test_the_time_convention_is_judged_by_the_phase_in_oblique_waves(degrees):
    """The force of long waves falls with the cosine of the direction; its phase, and with it the verdict, stays."""
    part = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    dataset = random_dataset(np.random.default_rng(5), (0.0, 0.0, 0.0), np.radians([degrees]))
    lag = np.exp(0.3j)  # the lowest frequency of a file is not quite the limit
    dataset["excitation_force"].values[0, 0, :3] = [-3.0j * part[0] * lag, -3.0j * part[1] * lag, 10.0]
    assert check_time_convention(dataset) == ()
    wrong = dataset.copy(deep=True)
    wrong["excitation_force"] = wrong["excitation_force"].conj()
    assert {notice.code for notice in check_time_convention(wrong)} == {"time-convention"}
