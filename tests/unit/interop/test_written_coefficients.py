"""Coefficients written for WAMIT, NEMOH and BEMIO come back through our own readers to 1e-12."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.interop import read_bemio, read_nemoh, read_wamit
from moyai.interop.coefficients import DOFS, assemble
from moyai.interop.planar import PLANAR_DOFS, to_planar
from moyai.interop.whole_body import coefficients_of_result, from_planar
from moyai.interop.write import write_coefficients

TOLERANCE = 1e-12
POINT = (0.5, -0.25, -1.7)
UNIT, CENTRE = 21.0, (0.3, -0.71)


def body(seed: int, dofs: tuple[str, ...] = DOFS, depth: float = 17.3) -> xr.Dataset:
    """Return random coefficients of no symmetry at all."""
    rng = np.random.default_rng(seed)
    n, m, k = 7, 3, len(dofs)

    def forces() -> np.ndarray:
        return rng.normal(size=(n, m, k)) * 1e5 * np.exp(1j * rng.uniform(-9.0, 9.0, size=(n, m, k)))

    return assemble(
        program="random",
        source="random",
        dofs=dofs,
        omega=np.sort(rng.uniform(0.2, 4.0, n)),
        added_mass=rng.normal(size=(n, k, k)) * 1e6,
        radiation_damping=rng.normal(size=(n, k, k)) * 1e5,
        wave_direction=np.radians([0.0, 37.5, 90.0]),
        forces={name: forces() for name in ("excitation_force", "Froude_Krylov_force", "diffraction_force")},
        density=rng.uniform(990.0, 1030.0),
        gravity=rng.uniform(9.78, 9.83),
        water_depth=depth,
        reference_point=POINT,
        limits={
            name: rng.normal(size=(k, k)) * 1e6
            for name in ("zero_frequency_added_mass", "infinite_frequency_added_mass")
        },
        hydrostatic_stiffness=rng.normal(size=(k, k)) * 1e7,
        mean_drift_force=rng.normal(size=(n, m, k)) * 1e4,
    )


def same(found: xr.Dataset, given: xr.Dataset, without: set[str]) -> None:
    """Compare all variables and facts; motions that were not given are zero."""
    assert set(given.data_vars) - set(found.data_vars) == without
    for name in ("omega", "wave_direction", "reference_point", "rho", "g", "water_depth"):
        np.testing.assert_allclose(found[name], given[name], rtol=TOLERANCE, err_msg=name)
    dofs = [str(name) for name in given["radiating_dof"].values]
    for name in set(found.data_vars):
        chosen = {dim: dofs for dim in ("radiating_dof", "influenced_dof") if dim in found[name].dims}
        values = found[name].sel(chosen).transpose(*given[name].dims)
        scale = float(np.abs(given[name]).max())
        np.testing.assert_allclose(values, given[name], rtol=0.0, atol=TOLERANCE * scale, err_msg=name)
        if name != "mean_drift_force":
            total = float(np.abs(found[name]).sum())
            assert total == pytest.approx(float(np.abs(given[name]).sum()), rel=TOLERANCE)


@pytest.mark.parametrize("dofs", [DOFS, ("Sway", "Heave", "Roll")])
@pytest.mark.parametrize("depth", [17.3, math.inf])
def test_wamit(tmp_path: Path, dofs: tuple[str, ...], depth: float) -> None:
    given = body(1, dofs, depth)
    write_coefficients("wamit", given, tmp_path)
    found = read_wamit(tmp_path / "unit.1", density=float(given["rho"]))
    same(found, given, {"Froude_Krylov_force", "diffraction_force"})


@pytest.mark.parametrize("dofs", [DOFS, ("Surge", "Heave", "Pitch")])
@pytest.mark.parametrize("depth", [17.3, math.inf])
def test_nemoh(tmp_path: Path, dofs: tuple[str, ...], depth: float) -> None:
    given = body(2, dofs, depth)
    write_coefficients("nemoh", given, tmp_path)
    limits = {"zero_frequency_added_mass", "infinite_frequency_added_mass"}
    same(read_nemoh(tmp_path), given, limits | {"mean_drift_force"})


@pytest.mark.parametrize("dofs", [DOFS, ("Sway", "Heave", "Roll")])
@pytest.mark.parametrize("depth", [17.3, math.inf])
def test_bemio(tmp_path: Path, dofs: tuple[str, ...], depth: float) -> None:
    given = body(3, dofs, depth)
    (file,) = write_coefficients("bemio", given, tmp_path)
    found = read_bemio(file, reference_point=POINT)
    same(found, given, {"zero_frequency_added_mass", "mean_drift_force"})


def test_what_drift_lacks_stays_unknown(tmp_path: Path) -> None:
    given = body(4)
    given["mean_drift_force"][:, :, 2:5] = np.nan  # far-field momentum gives surge, sway and yaw
    write_coefficients("wamit", given, tmp_path)
    found = read_wamit(tmp_path / "unit.1", density=float(given["rho"]))
    np.testing.assert_array_equal(np.isnan(found["mean_drift_force"]), np.isnan(given["mean_drift_force"]))


def test_bemio_asks_for_infinite_frequency(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="infinite frequency"):
        write_coefficients("bemio", body(5).drop_vars("infinite_frequency_added_mass"), tmp_path)


def test_files_are_not_replaced_without_a_word(tmp_path: Path) -> None:
    write_coefficients("wamit", body(6), tmp_path)
    with pytest.raises(InputError, match="exists"):
        write_coefficients("wamit", body(6), tmp_path)
    write_coefficients("wamit", body(6), tmp_path, replace=True)
    with pytest.raises(InputError, match="unknown program 'hydrostar'"):
        write_coefficients("hydrostar", body(6), tmp_path)


def section(seed: int) -> xr.Dataset:
    """Return random coefficients of a section per metre, as a result holds them."""
    rng = np.random.default_rng(seed)
    n, pair, wave = 5, ("radiating_dof", "influenced_dof"), ("omega", "wave_direction", "influenced_dof")
    names = list(PLANAR_DOFS)
    force = rng.normal(size=(n, 1, 3)) + 1j * rng.normal(size=(n, 1, 3))
    return xr.Dataset(
        {
            "added_mass": (("omega", *pair), rng.normal(size=(n, 3, 3))),
            "radiation_damping": (("omega", *pair), rng.normal(size=(n, 3, 3))),
            "infinite_frequency_added_mass": (pair, rng.normal(size=(3, 3))),
            "zero_frequency_added_mass": (pair, np.full((3, 3), np.nan)),
            "excitation_force": (wave, force),
        },
        coords={"omega": np.linspace(0.5, 2.0, n), "radiating_dof": names, "influenced_dof": names,
                "wave_direction": [0.0]},
        attrs={"rho": 1025.0, "g": 9.81, "water_depth": 11.5},
    )  # fmt: skip


@pytest.mark.parametrize("sea", ["beam", "head"])
def test_a_section_becomes_a_unit_and_a_section_again(sea: str) -> None:
    given, stiffness = section(7), np.random.default_rng(8).normal(size=(3, 3))
    unit = from_planar(given, length=UNIT, centre_of_gravity=CENTRE, sea=sea, hydrostatic_stiffness=stiffness)
    again = to_planar(unit, length=UNIT, centre_of_gravity=CENTRE, sea=sea)
    for name in ("added_mass", "radiation_damping", "infinite_frequency_added_mass", "excitation_force"):
        np.testing.assert_allclose(again[name], given[name], rtol=1e-13, atol=1e-13, err_msg=name)
    np.testing.assert_allclose(again["hydrostatic_stiffness"], stiffness / UNIT, rtol=1e-13, atol=1e-13)
    assert "zero_frequency_added_mass" not in unit  # a section has none
    assert float(unit["wave_direction"][0]) == pytest.approx(math.pi / 2 if sea == "beam" else 0.0)


def result() -> Result:
    stiffness = np.random.default_rng(9).normal(size=(3, 3))
    names = list(PLANAR_DOFS)
    statics = xr.Dataset(
        {
            "hydrostatic_stiffness": (("influenced_dof", "radiating_dof"), stiffness),
            "unit_length": UNIT,
            "centre_of_gravity_x": CENTRE[0],
            "centre_of_gravity_z": CENTRE[1],
        },
        coords={"influenced_dof": names, "radiating_dof": names},
    )
    groups = {}
    for seed, level in enumerate(("HWL", "LWL")):
        groups |= {f"/{level}/statics": statics, f"/{level}/hydrodynamics": section(seed)}
    return Result(xr.DataTree.from_dict(groups))


@pytest.mark.parametrize("program", ["wamit", "nemoh", "bemio"])
def test_the_command_writes_what_the_result_holds(tmp_path: Path, program: str) -> None:
    result().write(tmp_path / "results.nc")
    command = ["convert", str(tmp_path / "results.nc"), "--to", program, "-o", str(tmp_path / "out"), "--json"]
    ran = CliRunner().invoke(app, [*command, "--water-level", "LWL"])
    assert ran.exit_code == 0, ran.output
    record = json.loads(ran.stdout)
    given = coefficients_of_result(result(), water_level="LWL")
    assert record["reference_point"] == pytest.approx(given["reference_point"].values)
    found = {
        "wamit": lambda: read_wamit(tmp_path / "out" / "unit.1", density=record["rho"]),
        "nemoh": lambda: read_nemoh(tmp_path / "out"),
        "bemio": lambda: read_bemio(tmp_path / "out" / "unit.h5", reference_point=record["reference_point"]),
    }[program]()
    same(found, given, {"infinite_frequency_added_mass"} if program == "nemoh" else set())
    assert CliRunner().invoke(app, command).exit_code == 2  # the files exist


def test_a_result_without_coefficients_says_so(tmp_path: Path) -> None:
    Result(xr.DataTree.from_dict({"/SWL/statics": xr.Dataset({"a": 1.0})})).write(tmp_path / "results.nc")
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "results.nc"), "--to", "wamit"])
    assert ran.exit_code == 2
    assert "holds no coefficients of a floating body" in ran.output
    with pytest.raises(InputError, match="no water level 'MWL'"):
        coefficients_of_result(result(), water_level="MWL")
