"""Files of WAMIT, NEMOH, Capytaine, AQWA and HAMS against each other, exact limits and identities.

The half spheroid (radius 4.5 m, draught 1.8 m, infinite depth) was computed by four programs with the same mesh, except
WAMIT (higher-order panels). Their spread below the first irregular frequency is the accuracy of the numbers, so it is
the tolerance here: 1.5 % of added mass, 2 % of the band maximum of damping, 2 % of force below 2.1 rad/s.
"""

import math

import numpy as np
import pytest

from moyai.interop.aqwa import read_aqwa
from moyai.interop.bemio import read_bemio
from moyai.interop.capytaine import read_capytaine
from moyai.interop.checks import check_coefficients, check_time_convention
from moyai.interop.limits import complete_limits
from moyai.interop.nemoh import read_nemoh
from moyai.interop.planar import move_reference_point, to_planar
from moyai.interop.wamit import read_wamit
from moyai.sea.dispersion import group_velocity, wave_number

pytestmark = pytest.mark.shared_data

FREQUENCIES = np.array([0.51, 0.75, 0.99, 1.25, 1.5, 1.8, 2.01])
PROGRAMS = ("wamit", "nemoh", "capytaine", "aqwa")


@pytest.fixture(scope="module")
def spheroid(shared_data):
    folder = shared_data / "bem"
    return {
        "wamit": read_wamit(folder / "ellipsoid_wamit" / "ellipsoid.1", density=1000.0),
        "nemoh": read_nemoh(folder / "ellipsoid_nemoh3"),
        "capytaine": read_capytaine(
            folder / "ellipsoid_capytaine" / "ellipsoid_hydrodynamics.nc", reference_point=(0.0, 0.0, 0.0)
        ),
        "aqwa": read_aqwa(folder / "ellipsoid_aqwa" / "ellipsoid.AH1"),
    }


def scaled(dataset):
    """Added mass / rho, damping / rho, force / (rho g) at the common frequencies."""
    at = dataset.interp(omega=FREQUENCIES)
    rho, g = float(dataset["rho"]), float(dataset["g"])
    force = at["excitation_force"].sel(wave_direction=0.0, method="nearest").values / (rho * g)
    return at["added_mass"].values / rho, at["radiation_damping"].values / rho, force


def test_figures_of_the_record(spheroid):
    """The numbers that the data's own README states as checked."""
    reference = {"wamit": (206.4, 164.0, 94.2), "nemoh": (207.6, 164.8, 94.6), "capytaine": (207.6, 164.9, 94.6)}
    for program, expected in reference.items():
        heave = spheroid[program]["added_mass"].sel(radiating_dof="Heave", influenced_dof="Heave")
        got = heave.sel(omega=[0.51, 0.99, 2.01], method="nearest").values / 1000.0
        np.testing.assert_allclose(got, expected, atol=0.051)
    wamit = spheroid["wamit"]
    assert wamit["zero_frequency_added_mass"].values[2, 2] / 1000.0 == pytest.approx(197.8, abs=0.051)
    assert wamit["infinite_frequency_added_mass"].values[2, 2] / 1000.0 == pytest.approx(109.0, abs=0.051)
    assert wamit.sizes["omega"] == 308


def test_four_programs_agree_in_the_planar_frame(spheroid):
    """Off-origin point, so that sway, heave and roll couple; waves along x, where all four have them."""
    values = {}
    for program in PROGRAMS:
        planar = to_planar(spheroid[program], length=9.0, centre_of_gravity=(0.6, -0.7), sea="head")
        values[program] = scaled(planar)
    added = np.array([values[program][0] for program in PROGRAMS])
    middle = np.median(added, axis=0)
    diagonal = np.sqrt(np.einsum("nii,njj->nij", middle, middle))
    assert np.max(np.abs(added - middle) / diagonal) < 0.015
    damping = np.array([values[program][1] for program in PROGRAMS])
    middle = np.median(damping, axis=0)
    peak = np.max(np.einsum("nii->ni", middle), axis=0)
    assert np.max(np.abs(damping - middle) / np.sqrt(peak[:, None] * peak)) < 0.02
    force = np.array([values[program][2] for program in PROGRAMS])
    middle = np.median(force.real, axis=0) + 1j * np.median(force.imag, axis=0)
    assert np.max(np.abs(force - middle) / np.max(np.abs(middle), axis=0)) < 0.02


@pytest.mark.parametrize("program", PROGRAMS)
def test_sway_roll_of_a_body_of_revolution_is_surge_pitch(spheroid, program):
    """The planar radiation terms must not depend on which way the body is looked at: the sign of roll is right."""
    dataset = spheroid[program]
    # Beam seas need a heading of 90 degrees; a body of revolution has the same force there, in sway and minus roll
    turned = dataset.copy(deep=True)
    force = dataset["excitation_force"].sel(wave_direction=[0.0], method="nearest")
    swapped = force.copy(data=force.values[..., [1, 0, 2, 4, 3, 5]] * np.array([1, 1, 1, -1, 1, 1]))
    turned = turned.drop_vars(["excitation_force", "Froude_Krylov_force", "diffraction_force"], errors="ignore")
    turned = turned.drop_dims("wave_direction").assign(excitation_force=swapped)
    turned = turned.assign_coords(wave_direction=[0.5 * math.pi])
    beam = to_planar(turned, length=9.0, centre_of_gravity=(0.0, -0.9), sea="beam")
    head = to_planar(dataset, length=9.0, centre_of_gravity=(0.0, -0.9), sea="head")
    for name in ("added_mass", "radiation_damping"):
        one, two = beam[name].values, head[name].values
        # Meshes are not quite bodies of revolution, and NEMOH's irregular frequency stands at 4 rad/s
        low = dataset["omega"].values < 3.5
        scale = np.max(np.abs(np.einsum("nii->ni", two[low])), axis=0)
        assert np.max(np.abs(one - two)[low] / np.sqrt(scale[:, None] * scale)) < 2e-3
    assert np.all(np.abs(head["added_mass"].values[:, 0, 2]) > 0.0)


@pytest.mark.parametrize("program", PROGRAMS)
def test_signs_in_long_waves(spheroid, program):
    """Heave force tends to rho g A_w, surge force to -i rho g k (V + A_11 / rho); damping is positive."""
    dataset = spheroid[program]
    assert check_time_convention(dataset) == ()
    rho, g = float(dataset["rho"]), float(dataset["g"])
    omega = dataset["omega"].values[0]
    force = dataset["excitation_force"].sel(wave_direction=0.0, method="nearest").values[0]
    # AQWA's water is 1000 m deep, which is shallow for the lowest frequency
    number = float(wave_number(omega, float(dataset["water_depth"]), g))
    waterplane, volume = math.pi * 4.5**2, 2.0 / 3.0 * math.pi * 4.5**2 * 1.8
    added = dataset["added_mass"].sel(radiating_dof="Surge", influenced_dof="Surge").values[0]
    # The meshes hold 0.2 % less volume and waterplane than the body, and WAMIT's surge force at 0.03 rad/s 1.7 % more
    assert force[2] == pytest.approx(rho * g * waterplane, rel=0.006)
    assert force[0] == pytest.approx(-1j * g * number * (rho * volume + added), rel=0.025)
    damping = dataset["radiation_damping"].sel(omega=slice(0.3, 2.1)).values
    assert np.all(np.einsum("nii->ni", damping)[:, :5] > 0.0)


def haskind_damping(dataset):
    """Damping of surge, heave and pitch that the exciting force of waves along x implies for a body of revolution."""
    omega = dataset["omega"].values
    depth, gravity, density = float(dataset["water_depth"]), float(dataset["g"]), float(dataset["rho"])
    number = np.asarray(wave_number(omega, depth, gravity))
    speed = np.asarray(group_velocity(omega, depth, gravity))
    along = dataset["excitation_force"].sel(wave_direction=0.0, method="nearest", tolerance=1e-6)
    names = ["Surge", "Heave", "Pitch"]
    # The force varies as cos(direction) for surge and pitch: its square has the mean 1/2
    mean = np.array([0.5, 1.0, 0.5])
    squares = np.abs(along.sel(influenced_dof=names).values) ** 2
    values = number[:, None] * squares * mean / (4.0 * density * gravity * speed[:, None])
    return dict(zip(names, values.T))


@pytest.mark.parametrize(("program", "tolerance"), [("wamit", 0.003), ("capytaine", 0.025), ("aqwa", 0.03)])
def test_haskind_relation(spheroid, program, tolerance):
    """Damping from the exciting force against damping from radiation, up to 3 rad/s."""
    dataset = spheroid[program].sel(omega=slice(0.05, 3.0))
    implied = haskind_damping(dataset)
    for name, other in implied.items():
        own = dataset["radiation_damping"].sel(radiating_dof=name, influenced_dof=name).values
        assert np.max(np.abs(own - other)) < tolerance * np.max(own), name


def test_forces_add_up(spheroid):
    for program in ("nemoh", "capytaine"):
        dataset = spheroid[program]
        together = dataset["Froude_Krylov_force"] + dataset["diffraction_force"]
        scale = np.abs(dataset["excitation_force"]).max("omega")
        assert float((np.abs(together - dataset["excitation_force"]) / (scale + 1e-3 * scale.max())).max()) < 1e-3


def test_hemisphere_with_the_reference_at_its_centre_has_no_roll(shared_data):
    """Potential flow exerts no moment about the centre of a sphere: an exact off-origin transformation.

    The file holds coefficients about the centre of gravity, 2 m below: A_15 = 2 A_11 there.
    """
    low = read_bemio(shared_data / "bem" / "sphere_bemio_h5" / "sphere.h5", reference_point=(0.0, 0.0, -2.0))
    mass = 1000.0 * 261.8
    assert low["added_mass"].values[0, 0, 4] == pytest.approx(2.0 * low["added_mass"].values[0, 0, 0], rel=1e-4)
    centred = move_reference_point(low, (0.0, 0.0, 0.0))
    for name in ("added_mass", "infinite_frequency_added_mass"):
        rotations = np.abs(centred[name].sel(radiating_dof=["Roll", "Pitch"]).values)
        assert rotations.max() < 2e-4 * mass
    force = np.abs(centred["excitation_force"].sel(influenced_dof=["Roll", "Pitch"]).values).max()
    assert force < 2e-4 * np.abs(low["excitation_force"].sel(influenced_dof="Pitch").values).max()
    # Exact: 2 pi / 3 rho R^3 / 2 at infinite frequency in heave
    assert centred["infinite_frequency_added_mass"].values[2, 2] == pytest.approx(
        0.5 * 1000.0 * 2 / 3 * math.pi * 125, rel=1e-3
    )
    planar = to_planar(low, length=10.0, centre_of_gravity=(0.0, 0.0), sea="head")
    assert np.max(np.abs(planar["added_mass"].values[:, 2, :])) < 2e-4 * mass


def test_hemisphere_of_radius_one(shared_data):
    """Exact values: A33 = pi/3 at infinite frequency, C33 = pi; drift as the data's README states it."""
    dataset = read_wamit(shared_data / "bem" / "sphere_wamit_drift" / "sphere.1", density=1000.0)
    assert dataset["infinite_frequency_added_mass"].values[2, 2] == pytest.approx(1000.0 * math.pi / 3.0, rel=0.01)
    assert dataset["hydrostatic_stiffness"].values[2, 2] == pytest.approx(1000.0 * 9.80665 * math.pi, rel=0.005)
    drift = dataset["mean_drift_force"].sel(influenced_dof="Surge", wave_direction=0.0) / (1000.0 * 9.80665)
    assert float(drift.max()) == pytest.approx(0.877, abs=5e-4)
    assert float(dataset["period"][int(np.argmax(drift.values))]) == pytest.approx(1.848, abs=5e-4)
    assert all(check.name for check in check_coefficients(dataset))


def test_spar_of_hams_in_beam_and_head_seas(shared_data):
    """One body, waves at 0 and 90 degrees: both ways into the plane must give the same section, roll sign and all."""
    folder = shared_data / "bem" / "spar_hams"
    inputs = {"density": 1025.0, "gravity": 9.81, "length_scale": 1.0, "water_depth": math.inf}
    dataset = read_wamit(
        folder / "Buoy.1",
        **inputs,
        reference_point=(0.0, 0.0, 0.0),
        first_column="wave_number",
        zero_frequency_code=0.0,
        infinite_frequency_code=-1.0,
    )
    # The same run in HAMS' own format lists 2.712 and 3.835 rad/s next to these wave numbers
    np.testing.assert_allclose(dataset["omega"], [2.712, 3.835], atol=1.1e-3)
    beam = to_planar(dataset, length=7.0, centre_of_gravity=(0.0, -78.0), sea="beam").sel(
        wave_direction=0.0, method="nearest"
    )
    head = to_planar(dataset, length=7.0, centre_of_gravity=(0.0, -78.0), sea="head").sel(
        wave_direction=0.0, method="nearest"
    )
    for name in ("added_mass", "radiation_damping", "zero_frequency_added_mass", "infinite_frequency_added_mass"):
        scale = np.sqrt(np.abs(np.einsum("...ii,...jj->...ij", head[name].values, head[name].values)))
        np.testing.assert_array_less(np.abs(beam[name].values - head[name].values), 5e-5 * scale + 1e-3)
    scale = np.abs(head["excitation_force"].values).max(axis=0)
    assert np.max(np.abs(beam["excitation_force"].values - head["excitation_force"].values) / scale) < 1e-5


def test_spar_of_hams_is_refused_without_a_decision(shared_data):
    from moyai.core.errors import InputError

    with pytest.raises(InputError, match="HAMS"):
        read_wamit(shared_data / "bem" / "spar_hams" / "Buoy.1", density=1025.0)


def test_infinite_frequency_from_the_damping(spheroid):
    """WAMIT and AQWA hold the limit; their own damping gives it back, and that of the others agrees with it."""
    exact = spheroid["wamit"]["infinite_frequency_added_mass"].values
    for program, tolerance in (("wamit", 0.012), ("aqwa", 0.012), ("capytaine", 0.012), ("nemoh", 0.02)):
        dataset = spheroid[program]
        found = complete_limits(dataset.drop_vars("infinite_frequency_added_mass", errors="ignore"))
        own = dataset.get("infinite_frequency_added_mass")
        reference = exact if own is None else own.values
        density = float(dataset["rho"]) / (1000.0 if own is None else float(dataset["rho"]))
        for i in (0, 2, 4):
            got = found["infinite_frequency_added_mass"].values[i, i]
            assert got == pytest.approx(reference[i, i] * density, rel=tolerance), program
