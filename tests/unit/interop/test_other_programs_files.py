"""Files of NEMOH, Capytaine, AQWA and BEMIO written here from random coefficients come back as they went out."""

import math

import numpy as np
import pytest
import xarray as xr

from moyai.core.errors import InputError
from moyai.interop.aqwa import read_aqwa
from moyai.interop.bemio import read_bemio
from moyai.interop.bodies import one_body
from moyai.interop.capytaine import read_capytaine
from moyai.interop.coefficients import DOFS
from moyai.interop.nemoh import read_nemoh
from moyai.interop.read import read_coefficients


def random_body(seed, headings=2, count=6):
    rng = np.random.default_rng(seed)
    omega = np.sort(rng.uniform(0.3, 3.0, 4))
    return {
        "omega": omega,
        "added_mass": rng.normal(size=(4, count, count)) * 1e4,
        "damping": rng.normal(size=(4, count, count)) * 1e3,
        "force": (rng.normal(size=(4, headings, count)) + 1j * rng.normal(size=(4, headings, count))) * 1e5,
        "headings": np.array([0.0, 90.0][:headings]),
    }


def check(dataset, body, rtol):
    np.testing.assert_allclose(dataset.omega, body["omega"], rtol=rtol)
    np.testing.assert_allclose(dataset.added_mass, body["added_mass"], rtol=rtol)
    np.testing.assert_allclose(dataset.radiation_damping, body["damping"], rtol=rtol)
    scale = np.abs(body["force"]).max()
    np.testing.assert_allclose(dataset.excitation_force.values, body["force"], rtol=rtol, atol=rtol * scale)
    np.testing.assert_allclose(dataset.wave_direction, np.radians(body["headings"]))


def write_nemoh(folder, body, *, depth, tec, point=(0.0, 0.0, -1.25), modes=DOFS):
    lines = ["--- Environment ---", "1025.0 ! RHO", "9.81 ! G", f"{depth} ! DEPTH", "0. 0. ! XEFF YEFF"]
    lines += ["--- Description of floating bodies ---", "1 ! Number of bodies", "--- Body 1 ---", "mesh\\b.dat ! Name"]
    lines += ["5000 1250 ! points", f"{len(modes)} ! Number of degrees of freedom"]
    entries = []
    for mode in modes:
        i = DOFS.index(mode)
        axis = " ".join("1." if k == i % 3 else "0." for k in range(3))
        centre = "0. 0. 0." if i < 3 else " ".join(map(str, point))
        entries.append(f"{1 + i // 3} {axis} {centre} ! {mode}")
    lines += [*entries, f"{len(modes)} ! Number of resulting generalised forces", *entries, "0 ! lines"]
    lines += ["--- Load cases ---", f"1 {len(body['omega'])} 0.1 3.0 ! freq", "2 0. 90. ! directions", "--- Post ---"]
    (folder / "Nemoh.cal").write_text("\n".join(lines))
    results = folder / "Results"
    results.mkdir()
    for name, key in (("CM.dat", "added_mass"), ("CA.dat", "damping")):
        text = [f"Nb de frequency : {len(body['omega'])}"]
        for omega, matrix in zip(body["omega"], body[key]):
            text.append(f"{omega:.9f}")
            text += ["  ".join(f"{value:.9E}" for value in row) for row in matrix]
        (results / name).write_text("\n".join(text))
    text = ['VARIABLES="w (rad/s)"', '"abs(F 1 1)" "angle(F 1 1)"']
    for h, heading in enumerate(body["headings"]):
        text.append(f'Zone t="Excitation force - beta = {heading:7.3f} deg",I= 4,F=POINT')
        for n, omega in enumerate(body["omega"]):
            force = body["force"][n, h]
            if tec:
                cells = [f"{value:.9E}" for x in force for value in (abs(x), np.angle(x))]
            else:
                cells = [f"{abs(x):.9E}" for x in force] + [f"{np.degrees(np.angle(x)):.2f}" for x in force]
            text.append(f"{omega:.9f} " + " ".join(cells))
    (results / ("ExcitationForce.tec" if tec else "Fe.dat")).write_text("\n".join(text))


@pytest.mark.parametrize(("tec", "rtol"), [(True, 1e-7), (False, 2e-4)])
def test_nemoh_round_trip(tmp_path, tec, rtol):
    body = random_body(11)
    write_nemoh(tmp_path, body, depth=0.0, tec=tec)
    dataset = read_nemoh(tmp_path / "Results")
    check(dataset, body, rtol)
    assert math.isinf(dataset.water_depth)
    np.testing.assert_allclose(dataset.reference_point, (0.0, 0.0, -1.25))


def test_nemoh_with_three_modes_and_finite_depth(tmp_path):
    body = random_body(12, count=3)
    write_nemoh(tmp_path, body, depth=12.5, tec=True, modes=("Sway", "Heave", "Roll"))
    dataset = read_nemoh(tmp_path)
    check(dataset, body, 1e-7)
    assert float(dataset.water_depth) == 12.5
    assert list(dataset.radiating_dof.values) == ["Sway", "Heave", "Roll"]


def test_nemoh_refuses_generalised_modes_and_missing_files(tmp_path):
    body = random_body(13)
    write_nemoh(tmp_path, body, depth=5.0, tec=True)
    control = (tmp_path / "Nemoh.cal").read_text()
    (tmp_path / "Nemoh.cal").write_text(control.replace("1 0. 0. 1.", "0 1. 0. 0."))
    with pytest.raises(InputError, match="not a rigid motion"):
        read_nemoh(tmp_path)
    (tmp_path / "Nemoh.cal").write_text(control)
    (tmp_path / "Results" / "CA.dat").unlink()
    with pytest.raises(InputError, match=r"CA\.dat"):
        read_nemoh(tmp_path)


def capytaine_file(path, body, *, prefix="", split=True, extra_omega=(), engine="scipy", **attributes):
    names = [prefix + name for name in DOFS]
    omega = np.concatenate([body["omega"], extra_omega])
    more = len(extra_omega)
    matrix = np.concatenate([body["added_mass"], np.full((more, 6, 6), 7.0)])
    damping = np.concatenate([body["damping"], np.zeros((more, 6, 6))])
    force = np.concatenate([body["force"], np.zeros((more, *body["force"].shape[1:]))])
    parts = np.stack([force.real, force.imag])
    dataset = xr.Dataset(
        {
            "added_mass": (("omega", "radiating_dof", "influenced_dof"), matrix),
            "radiation_damping": (("omega", "radiating_dof", "influenced_dof"), damping),
            "Froude_Krylov_force": (("complex", "omega", "wave_direction", "influenced_dof"), 0.25 * parts),
            "diffraction_force": (("complex", "omega", "wave_direction", "influenced_dof"), 0.75 * parts),
        },
        coords={
            "omega": omega,
            "radiating_dof": names,
            "influenced_dof": names,
            "wave_direction": np.radians(body["headings"]),
            "complex": ["re", "im"],
            "rho": 1000.0,
            "g": 9.81,
            "water_depth": 11.0,
        },
    )
    dataset.assign(attributes).to_netcdf(path, engine=engine)


@pytest.mark.parametrize("engine", ["scipy", "h5netcdf"])
def test_capytaine_round_trip_and_limits(tmp_path, engine):
    body = random_body(14)
    capytaine_file(tmp_path / "a.nc", body, extra_omega=[0.0, np.inf], engine=engine)
    with pytest.raises(InputError, match="reference point"):
        read_capytaine(tmp_path / "a.nc")
    dataset = read_capytaine(tmp_path / "a.nc", reference_point=(0.0, 0.0, -0.4))
    check(dataset, body, 1e-12)
    np.testing.assert_allclose(dataset.infinite_frequency_added_mass, 7.0)
    np.testing.assert_allclose(dataset.zero_frequency_added_mass, 7.0)


def test_capytaine_rotation_centre_bodies_and_speed(tmp_path):
    body = random_body(15)
    centre = xr.DataArray([0.1, 0.2, -0.3], dims="space_coordinate")
    capytaine_file(tmp_path / "b.nc", body, prefix="float__", rotation_center=centre)
    dataset = read_capytaine(tmp_path / "b.nc")
    np.testing.assert_allclose(dataset.reference_point, (0.1, 0.2, -0.3))
    check(dataset, body, 1e-12)
    capytaine_file(tmp_path / "c.nc", body, forward_speed=xr.DataArray(1.5))
    with pytest.raises(InputError, match="forward speed"):
        read_capytaine(tmp_path / "c.nc", reference_point=(0.0, 0.0, 0.0))
    with xr.open_dataset(tmp_path / "b.nc") as stored:
        two = xr.concat([stored.drop_vars(["rotation_center"])] * 2, dim="omega").isel(omega=slice(4)).load()
    names = ["a__Heave", "b__Heave", *[f"a__{name}" for name in DOFS if name != "Heave"]][:6]
    two.assign_coords(radiating_dof=names, influenced_dof=names).to_netcdf(tmp_path / "d.nc", engine="scipy")
    with pytest.raises(InputError, match="bodies a, b"):
        read_capytaine(tmp_path / "d.nc", reference_point=(0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="holds the bodies a, b"):
        one_body(read_capytaine(tmp_path / "d.nc", reference_point=np.zeros((2, 3))))
    one = read_capytaine(tmp_path / "d.nc", reference_point=(0.0, 0.0, 0.0), body="b")
    np.testing.assert_allclose(one.added_mass.values[:, 0, 0], body["added_mass"][:, 1, 1])


def test_capytaine_file_that_is_none(tmp_path):
    (tmp_path / "e.nc").write_text("no NetCDF")
    with pytest.raises(InputError, match="cannot be read"):
        read_capytaine(tmp_path / "e.nc", reference_point=(0.0, 0.0, 0.0))


def write_aqwa(path, body, centre="0.0 0.0 -0.5"):
    def matrix(values):
        return [" ".join(f"{value:.9E}" for value in row) for row in values.T]

    count = len(body["omega"])
    lines = ["* DATE", f" 1 {len(body['headings'])} {count} " + " ".join(f"{h:.5f}" for h in body["headings"])]
    lines += [" ".join(f"{w:.9f}" for w in body["omega"]), "GENERAL", " 1 30.0 1025.0 9.806 0 0", "COG", f" 1 {centre}"]
    for title, key in (("ADDEDMASS", "added_mass"), ("DAMPING", "damping")):
        lines.append(title)
        for n in range(count):
            first, *rest = matrix(body[key][n])
            lines += [f" 1 1 {n + 1} {first}", *rest]
    lines.append("FORCERAO")
    for h in range(len(body["headings"])):
        for n in range(count):
            force = body["force"][n, h]
            lines.append(f" 1 {h + 1} {n + 1} " + " ".join(f"{abs(x):.9E}" for x in force))
            lines.append(" ".join(f"{np.degrees(np.angle(x)):.7f}" for x in force))
    path.write_text("\n".join(lines))


def test_aqwa_round_trip(tmp_path):
    body = random_body(16)
    write_aqwa(tmp_path / "s.AH1", body)
    dataset = read_aqwa(tmp_path / "s.AH1")
    check(dataset, body, 1e-7)
    np.testing.assert_allclose(dataset.reference_point, (0.0, 0.0, -0.5))
    assert float(dataset.water_depth) == 30.0
    write_aqwa(tmp_path / "off.AH1", body, centre="2.0 0.0 0.0")
    with pytest.raises(InputError, match="centre of gravity"):
        read_aqwa(tmp_path / "off.AH1")


def write_bemio(path, body, *, scaled=False):
    h5py = pytest.importorskip("h5py")
    density, gravity = 1013.0, 9.8
    mass, force = (1.0, 1.0) if scaled else (density, density * gravity)
    damping = np.ones(4) if scaled else density * body["omega"]
    with h5py.File(path, "w") as file:
        parameters = {"rho": density, "g": gravity, "scaled": float(scaled)}
        for name, value in parameters.items():
            file[f"simulation_parameters/{name}"] = [[value]]
        file["simulation_parameters/w"] = body["omega"][:, None]
        file["simulation_parameters/wave_dir"] = body["headings"][:, None]
        file["simulation_parameters/water_depth"] = b"infinite"
        group = file.create_group("body1/hydro_coeffs")
        group["added_mass/all"] = body["added_mass"].transpose(2, 1, 0) / mass
        group["added_mass/inf_freq"] = body["added_mass"][-1].T / mass
        group["radiation_damping/all"] = body["damping"].transpose(2, 1, 0) / damping
        group["linear_restoring_stiffness"] = np.diag([0.0, 0.0, 5.0, 6.0, 7.0, 0.0])
        group["excitation/re"] = body["force"].real.transpose(2, 1, 0) / force
        group["excitation/im"] = -body["force"].imag.transpose(2, 1, 0) / force


@pytest.mark.parametrize("scaled", [False, True])
def test_bemio_round_trip(tmp_path, scaled):
    body = random_body(17)
    write_bemio(tmp_path / "b.h5", body, scaled=scaled)
    dataset = read_bemio(tmp_path / "b.h5", reference_point=(0.0, 0.0, -2.0))
    check(dataset, body, 1e-12)
    assert math.isinf(dataset.water_depth)
    np.testing.assert_allclose(dataset.infinite_frequency_added_mass, body["added_mass"][-1])
    with pytest.raises(InputError, match="has no body '2'"):
        read_bemio(tmp_path / "b.h5", reference_point=(0.0, 0.0, -2.0), body=2)


def test_one_door_names_unknown_programs_and_options(tmp_path):
    with pytest.raises(InputError, match="orcawave"):
        read_coefficients("orcawave", tmp_path)
    with pytest.raises(InputError, match="densty"):
        read_coefficients("wamit", tmp_path, {"densty": 1000.0})
