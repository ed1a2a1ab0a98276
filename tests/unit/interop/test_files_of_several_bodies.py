"""Files of several bodies: every coupling comes back, one body can be taken, other axes are the same physics."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from moyai.core.errors import InputError
from moyai.interop import read_aqwa, read_bemio, read_capytaine, read_nemoh, read_wamit
from moyai.interop.bodies import bodies_of, each_body, in_order, moved_axes, one_body, with_drift_of_all
from moyai.interop.checks import import_notices
from moyai.interop.coefficients import DOFS, assemble, dof_names
from moyai.interop.read import read_body, read_coefficients
from moyai.interop.write import write_coefficients
from moyai.sea.dispersion import wave_number

TOLERANCE = 1e-12
NAMES = ("left", "middle", "right")
POINTS = np.array([[0.5, -21.0, -1.7], [0.5, 0.25, -1.5], [-0.3, 22.0, -1.7]])


def row(seed: int, names: tuple[str, ...] = NAMES, depth: float = 17.3) -> xr.Dataset:
    """Return random coefficients of several bodies, no symmetry at all."""
    rng = np.random.default_rng(seed)
    n, m, k = 7, 3, 6 * len(names)

    def forces() -> np.ndarray:
        return rng.normal(size=(n, m, k)) * 1e5 * np.exp(1j * rng.uniform(-9.0, 9.0, size=(n, m, k)))

    stiffness = np.zeros((k, k))
    for b in range(len(names)):
        stiffness[6 * b : 6 * b + 6, 6 * b : 6 * b + 6] = rng.normal(size=(6, 6)) * 1e7
    return assemble(
        program="random",
        source="random",
        dofs=dof_names(names),
        omega=np.sort(rng.uniform(0.4, 4.0, n)),
        added_mass=rng.normal(size=(n, k, k)) * 1e6,
        radiation_damping=rng.normal(size=(n, k, k)) * 1e5,
        wave_direction=np.radians([0.0, 37.5, 90.0]),
        forces={name: forces() for name in ("excitation_force", "Froude_Krylov_force", "diffraction_force")},
        density=rng.uniform(990.0, 1030.0),
        gravity=rng.uniform(9.78, 9.83),
        water_depth=depth,
        reference_point=POINTS[: len(names)],
        limits={"infinite_frequency_added_mass": rng.normal(size=(k, k)) * 1e6},
        hydrostatic_stiffness=stiffness,
        mean_drift_force=rng.normal(size=(n, m, k)) * 1e4,
        mean_drift_of_all_bodies=rng.normal(size=(n, m, 3)) * 1e4,
        bodies=names,
    )


def same(found: xr.Dataset, given: xr.Dataset, without: set[str], tolerance: float = TOLERANCE) -> None:
    assert set(given.data_vars) - set(found.data_vars) == without
    assert bodies_of(found) == bodies_of(given)
    assert list(found["radiating_dof"].values) == list(given["radiating_dof"].values)
    for name in ("omega", "wave_direction", "reference_point", "rho", "g", "water_depth"):
        np.testing.assert_allclose(found[name], given[name], rtol=tolerance, atol=1e-15, err_msg=name)
    for name in found.data_vars:
        scale = float(np.abs(given[name]).max())
        np.testing.assert_allclose(
            found[name].transpose(*given[name].dims), given[name], rtol=0.0, atol=tolerance * scale, err_msg=str(name)
        )


@pytest.mark.slow
@pytest.mark.parametrize("names", [NAMES, NAMES[:2]])
@pytest.mark.parametrize("depth", [17.3, math.inf])
def test_every_coupling_comes_back(tmp_path: Path, names: tuple[str, ...], depth: float) -> None:
    given = row(1, names, depth)
    for program in ("wamit", "nemoh", "bemio"):
        write_coefficients(program, given, tmp_path / program)
    parts = {"Froude_Krylov_force", "diffraction_force"}
    same(read_wamit(tmp_path / "wamit" / "unit.1", density=float(given["rho"])), given, parts)
    drift = {"mean_drift_force", "mean_drift_of_all_bodies"}
    same(read_nemoh(tmp_path / "nemoh"), given, drift | {"infinite_frequency_added_mass"})
    points = given["reference_point"].values.tolist()
    same(read_bemio(tmp_path / "bemio" / "unit.h5", reference_point=points), given, {"mean_drift_force"})


def test_aqwa_of_several_structures(tmp_path: Path) -> None:
    given = row(2)
    omega, headings = given["omega"].values, np.degrees(given["wave_direction"].values)
    numbers = [f" 3 3 {len(omega)} " + " ".join(f"{h:.5f}" for h in headings), " ".join(f"{w:.12f}" for w in omega)]
    lines = [*numbers, "GENERAL", f" 1 17.3 {float(given['rho']):.12f} {float(given['g']):.12f} 0 0", "COG"]
    lines += [f" {b + 1} " + " ".join(map(str, point)) for b, point in enumerate(POINTS)]

    def rows(matrix: np.ndarray) -> list[str]:
        return [" ".join(f"{x:.12E}" for x in line) for line in matrix]

    lines.append("HYDSTIFFNESS")
    for b in range(3):
        first, *rest = rows(given["hydrostatic_stiffness"].values[6 * b : 6 * b + 6, 6 * b : 6 * b + 6])
        lines += [f" {b + 1} {first}", *rest]
    for title, key in (("ADDEDMASS", "added_mass"), ("DAMPING", "radiation_damping")):
        lines.append(title)
        values = given[key].transpose("omega", "influenced_dof", "radiating_dof").values
        for i, j, f in np.ndindex(3, 3, len(omega)):
            first, *rest = rows(values[f, 6 * i : 6 * i + 6, 6 * j : 6 * j + 6])
            lines += [f" {i + 1} {j + 1} {f + 1} {first}", *rest]
    lines.append("FORCERAO")
    force = given["excitation_force"].values
    for b, h, f in np.ndindex(3, 3, len(omega)):
        own = force[f, h, 6 * b : 6 * b + 6]
        lines.append(f" {b + 1} {h + 1} {f + 1} " + " ".join(f"{abs(x):.12E}" for x in own))
        lines.append(" ".join(f"{np.degrees(np.angle(x)):.12f}" for x in own))
    (tmp_path / "row.AH1").write_text("\n".join(lines))
    with pytest.raises(InputError, match="do phases refer to it"):
        read_aqwa(tmp_path / "row.AH1")
    found = read_aqwa(tmp_path / "row.AH1", phase_at="origin")
    names = dict(zip(dof_names(NAMES), dof_names(("1", "2", "3"))))
    wanted = given.assign_coords(
        radiating_dof=list(names.values()), influenced_dof=list(names.values()), body=["1", "2", "3"]
    ).drop_vars(
        ["Froude_Krylov_force", "diffraction_force", "mean_drift_force", "mean_drift_of_all_bodies",
         "infinite_frequency_added_mass"]
    )  # fmt: skip
    same(found, wanted, set(), 1e-11)
    # a wave that has its crest over a body at time zero is k x behind at the origin
    centred = read_aqwa(tmp_path / "row.AH1", phase_at="centre_of_gravity", body=3)
    k = float(wave_number(omega[2], 17.3, float(given["g"])))
    turned = force[2, 2, 12:] * np.exp(1j * k * 22.0)
    np.testing.assert_allclose(centred["excitation_force"].values[2, 2], turned, rtol=1e-9)


def test_capytaine_of_several_bodies(tmp_path: Path) -> None:
    given = row(3)
    split = xr.Dataset(
        {name: given[name] for name in ("added_mass", "radiation_damping", "hydrostatic_stiffness")}
        | {
            name: xr.concat([given[name].real, given[name].imag], dim=xr.Variable("complex", ["re", "im"]))
            for name in ("excitation_force", "Froude_Krylov_force", "diffraction_force")
        },
    ).drop_vars(["reference_point", "body", "xyz"], errors="ignore")  # fmt: skip
    split["infinity"] = 0.0
    split = split.drop_vars("infinity").assign_coords(rho=given["rho"], g=given["g"], water_depth=given["water_depth"])
    split["rotation_center"] = (("body_name", "point"), POINTS)
    split.to_netcdf(tmp_path / "row.nc", engine="scipy")
    lost = {"mean_drift_force", "mean_drift_of_all_bodies", "infinite_frequency_added_mass"}
    same(read_capytaine(tmp_path / "row.nc"), given, lost)


def test_nemoh_refers_phases_to_its_point_of_measurement(tmp_path: Path) -> None:
    given = row(4)
    write_coefficients("nemoh", given, tmp_path)
    control = tmp_path / "Nemoh.cal"
    control.write_text(control.read_text().replace("0. 0. ! XEFF YEFF", "3.0 -2.0 ! XEFF YEFF"))
    found = read_nemoh(tmp_path)["excitation_force"]
    for h, angle in enumerate(given["wave_direction"].values):
        k = wave_number(given["omega"].values, float(given["water_depth"]), float(given["g"]))
        phase = np.exp(1j * np.asarray(k) * (3.0 * math.cos(angle) - 2.0 * math.sin(angle)))
        wanted = given["excitation_force"].values[:, h] * phase[:, None]
        np.testing.assert_allclose(found.values[:, h], wanted, rtol=1e-9, atol=1e-3)


def test_nemoh_of_version_2_has_one_table_of_radiation(tmp_path: Path) -> None:
    given = row(5)
    write_coefficients("nemoh", given, tmp_path)
    results = tmp_path / "Results"
    lines = ['VARIABLES="w (rad/s)"']
    for i in range(18):
        lines.append(f'Zone t="Motion of body {i // 6 + 1} in DoF {i % 6 + 1}",I=7,F=POINT')
        for f, omega in enumerate(given["omega"].values):
            pairs = zip(given["added_mass"].values[f, i], given["radiation_damping"].values[f, i])
            lines.append(f"{omega:.16E} " + " ".join(f"{a:.16E} {b:.16E}" for a, b in pairs))
    (results / "RadiationCoefficients.tec").write_text("\n".join(lines))
    (results / "CM.dat").unlink()
    (results / "CA.dat").unlink()
    lost = {"mean_drift_force", "mean_drift_of_all_bodies", "infinite_frequency_added_mass"}
    same(read_nemoh(tmp_path), given, lost)


def test_one_body_by_choice(tmp_path: Path) -> None:
    given = row(6)
    write_coefficients("nemoh", given, tmp_path)
    with pytest.raises(InputError, match="holds the bodies left, middle, right") as caught:
        read_body("nemoh", tmp_path)
    assert "name one, or give its number" in str(caught.value)
    with pytest.raises(InputError, match=r"no body 'stern'.*left, middle, right"):
        read_body("nemoh", tmp_path, {"body": "stern"})
    for chosen in (2, "2", "middle"):
        found = read_body("nemoh", tmp_path, {"body": chosen})
        assert list(found["radiating_dof"].values) == list(DOFS)
        np.testing.assert_allclose(found["added_mass"], given["added_mass"][:, 6:12, 6:12], rtol=1e-12)
        np.testing.assert_allclose(found["excitation_force"], given["excitation_force"][:, :, 6:12], rtol=1e-12)
        np.testing.assert_allclose(found["reference_point"], POINTS[1])
    with pytest.raises(InputError, match="it holds one body"):
        one_body(found, 2)


def test_another_order_moves_rows_and_columns_together() -> None:
    given = row(7)
    found = in_order(given, ["right", 1, "middle"])
    assert bodies_of(found) == ("right", "left", "middle")
    np.testing.assert_array_equal(found["added_mass"].values[:, 0:6, 6:12], given["added_mass"].values[:, 12:, 0:6])
    np.testing.assert_array_equal(found["reference_point"], POINTS[[2, 0, 1]])
    with pytest.raises(InputError, match="does not name every body"):
        in_order(given, [1, 1, 2])


def test_other_axes_do_the_same_work() -> None:
    """Power of a wave on motions, and of motions on the water, do not depend on axes; phases follow the origin."""
    given = row(8)
    origin, angle = (4.0, -7.0), math.radians(30.0)
    found = moved_axes(given, origin, angle)
    rng = np.random.default_rng(9)
    motion = rng.normal(size=(3, 2, 3))
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    new = (motion @ turn.T).ravel()
    old = motion.ravel()
    for name in ("added_mass", "radiation_damping", "infinite_frequency_added_mass", "hydrostatic_stiffness"):
        np.testing.assert_allclose(
            new @ found[name].values @ new, old @ given[name].values @ old, rtol=1e-10, err_msg=name
        )
    np.testing.assert_allclose(found["wave_direction"], given["wave_direction"] + angle)
    np.testing.assert_allclose(found["reference_point"], POINTS @ turn.T + [4.0, -7.0, 0.0])
    force, moved = given["mean_drift_of_all_bodies"].values, found["mean_drift_of_all_bodies"].values
    np.testing.assert_allclose(moved[..., :2], force[..., :2] @ turn[:2, :2].T, rtol=1e-10)
    lever = 4.0 * moved[..., 1] + 7.0 * moved[..., 0]
    np.testing.assert_allclose(moved[..., 2], force[..., 2] + lever, rtol=1e-9)
    # with its crest over the origin of the file at time zero the wave meets a body as before
    k = wave_number(given["omega"].values, float(given["water_depth"]), float(given["g"]))
    for h, heading in enumerate(found["wave_direction"].values):
        delay = np.exp(-1j * np.asarray(k) * (4.0 * math.cos(heading) - 7.0 * math.sin(heading)))
        power = found["excitation_force"].values[:, h] @ new * delay
        np.testing.assert_allclose(power, given["excitation_force"].values[:, h] @ old, rtol=1e-9)


def test_drift_of_each_body_adds_up() -> None:
    given = row(10).drop_vars("mean_drift_of_all_bodies")
    found = with_drift_of_all(given)["mean_drift_of_all_bodies"].values
    each = given["mean_drift_force"].values.reshape(7, 3, 3, 6)
    np.testing.assert_allclose(found[..., 0], each[..., 0].sum(axis=2), rtol=1e-12)
    moment = sum(each[:, :, b, 5] + POINTS[b, 0] * each[:, :, b, 1] - POINTS[b, 1] * each[:, :, b, 0] for b in range(3))
    np.testing.assert_allclose(found[..., 2], moment, rtol=1e-10)
    unknown = given.copy(deep=True)
    unknown["mean_drift_force"][:, :, 11] = np.nan
    assert "mean_drift_of_all_bodies" not in with_drift_of_all(unknown)


def test_time_factor_is_judged_at_every_body() -> None:
    """Far apart in space the phases of the forces turn; at each body they follow the water there."""
    omega = np.array([0.5, 0.7])
    k = np.asarray(wave_number(omega, math.inf, 9.81))
    force = np.zeros((2, 1, 12), dtype=complex)
    for b, x in enumerate((0.0, 60.0)):
        force[:, 0, 6 * b] = -1j * 1e5 * np.exp(1j * k * x)
        force[:, 0, 6 * b + 2] = 1e6 * np.exp(1j * k * x)

    def bodies(values: np.ndarray) -> xr.Dataset:
        return assemble(
            program="hand", source="hand", dofs=dof_names(("a", "b")), omega=omega,
            added_mass=np.repeat(np.eye(12)[None] * 1e6, 2, axis=0),
            radiation_damping=np.repeat(np.eye(12)[None], 2, axis=0),
            wave_direction=np.zeros(1), forces={"excitation_force": values}, density=1025.0, gravity=9.81,
            water_depth=math.inf, reference_point=[[0.0, 0.0, 0.0], [60.0, 0.0, 0.0]], bodies=("a", "b"),
        )  # fmt: skip

    assert not import_notices(bodies(force))
    (wrong,) = [notice for notice in import_notices(bodies(np.conj(force))) if "'a'" in notice.message]
    assert wrong.severity == "error"
    assert [name for name, _ in each_body(bodies(force))] == ["a", "b"]


def test_no_numbers_at_the_lowest_frequencies_are_left_out(tmp_path: Path) -> None:
    given = row(11)
    write_coefficients("nemoh", given, tmp_path)
    file = tmp_path / "Results" / "CA.dat"
    lines = file.read_text().splitlines()
    lines[2] = " ".join(["NaN"] * 18)
    file.write_text("\n".join(lines))
    found = read_coefficients("nemoh", tmp_path)
    np.testing.assert_allclose(found["omega"], given["omega"][1:])
    assert import_notices(found)[0].code == "coefficients-dropped"
    lines[2], lines[2 + 19] = lines[3], " ".join(["NaN"] * 18)
    file.write_text("\n".join(lines))
    with pytest.raises(InputError, match="radiation_damping is incomplete"):
        read_coefficients("nemoh", tmp_path)
