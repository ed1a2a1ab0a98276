"""WAMIT files written here from random coefficients come back as they went out, with their quirks."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.interop.wamit import read_wamit
from moyai.sea.dispersion import wave_number

ROTATION = np.array([0, 0, 0, 1, 1, 1])


class Body:
    """Random coefficients of a body in SI units, exp(-i omega t)."""

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        self.density, self.gravity = rng.uniform(990.0, 1030.0), rng.uniform(9.78, 9.83)
        self.length_scale = rng.uniform(0.3, 12.0)
        self.omega = np.sort(rng.uniform(0.2, 4.0, 5))
        self.headings = np.array([0.0, 37.5, 90.0])
        self.added_mass = rng.normal(size=(5, 6, 6))
        self.damping = rng.normal(size=(5, 6, 6))
        self.zero, self.infinite = rng.normal(size=(2, 6, 6))
        self.force = rng.normal(size=(5, 3, 6)) + 1j * rng.normal(size=(5, 3, 6))
        self.stiffness = rng.normal(size=(6, 6))
        self.drift = rng.normal(size=(5, 3, 6))

    @property
    def mass_scale(self):
        return self.density * self.length_scale ** (3 + ROTATION[:, None] + ROTATION)

    def write(self, folder, first, *, header=True, zero_code=-1.0, infinite_code=0.0):
        """Write .1, .3, .hst and .9 the way WAMIT does, force row i, motion column j."""
        head = [" WAMIT Numeric Output -- Filename  body.1       01-Jan-2020"] if header else []
        lines = list(head)
        for code, matrix in ((zero_code, self.zero), (infinite_code, self.infinite)):
            lines += [f" {code:.8E} {i + 1} {j + 1} {matrix[j, i]:.8E}" for i in range(6) for j in range(6)]
        for n, value in enumerate(first):
            for i in range(6):
                for j in range(6):
                    a, b = self.added_mass[n, j, i], self.damping[n, j, i]
                    lines.append(f" {value:.8E} {i + 1} {j + 1} {a:.8E} {b:.8E}".replace("E", "D"))
        (folder / "body.1").write_text("\n".join(lines) + "\n")
        lines = list(head)
        for n, value in enumerate(first):
            for h, heading in enumerate(self.headings):
                for i in range(6):
                    x = np.conj(self.force[n, h, i])
                    lines.append(
                        f" {value:.8E} {heading:.6E} {i + 1} {abs(x):.8E} {np.degrees(np.angle(x)):.8E} "
                        f"{x.real:.8E} {x.imag:.8E}"
                    )
        (folder / "body.3").write_text("\r\n".join(lines) + "\r\n")
        rows = [f" {i + 1} {j + 1} {self.stiffness[i, j]:.8E}" for i in range(6) for j in range(6)]
        (folder / "body.HST").write_text("\n".join(head + rows) + "\n")
        lines = list(head)
        for n, value in enumerate(first):
            for h, heading in enumerate(self.headings):
                for i in range(6):
                    d = self.drift[n, h, i]
                    lines.append(f" {value:.8E} {heading:.6E} {heading:.6E} {i + 1} {abs(d):.8E} 0.0 {d:.8E} 0.0")
                lines.append(f" {value:.8E} {heading:.6E} {heading:.6E} -4 9.9E+9 0.0 9.9E+9 0.0")
        (folder / "body.9").write_text("\n".join(lines) + "\n")

    def inputs(self):
        return {
            "density": self.density,
            "gravity": self.gravity,
            "length_scale": self.length_scale,
            "water_depth": 17.0,
            "reference_point": (0.5, -0.25, -1.5),
        }

    def check(self, dataset):
        rotation = ROTATION
        np.testing.assert_allclose(dataset.omega, self.omega, rtol=1e-7)
        np.testing.assert_allclose(dataset.added_mass, self.added_mass * self.mass_scale, rtol=1e-7)
        np.testing.assert_allclose(
            dataset.radiation_damping, self.damping * self.mass_scale * self.omega[:, None, None], rtol=1e-7
        )
        force = self.force * self.density * self.gravity * self.length_scale ** (2 + rotation)
        np.testing.assert_allclose(dataset.excitation_force, force, rtol=1e-7)
        np.testing.assert_allclose(dataset.zero_frequency_added_mass, self.zero * self.mass_scale, rtol=1e-7)
        np.testing.assert_allclose(dataset.infinite_frequency_added_mass, self.infinite * self.mass_scale, rtol=1e-7)
        stiffness = (
            self.stiffness * self.density * self.gravity * self.length_scale ** (2 + rotation[:, None] + rotation)
        )
        np.testing.assert_allclose(dataset.hydrostatic_stiffness, stiffness, rtol=1e-7)
        drift = self.drift * self.density * self.gravity * self.length_scale ** (1 + rotation)
        np.testing.assert_allclose(dataset.mean_drift_force, drift, rtol=1e-7)
        np.testing.assert_allclose(dataset.wave_direction, np.radians(self.headings))


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("header", [True, False])
def test_round_trip_with_periods(tmp_path, seed, header):
    body = Body(seed)
    body.write(tmp_path, 2.0 * math.pi / body.omega, header=header)
    body.check(read_wamit(tmp_path / "body.1", **body.inputs()))


def test_facts_come_from_the_input_files(tmp_path):
    body = Body(4)
    body.write(tmp_path, 2.0 * math.pi / body.omega)
    (tmp_path / "BODY.GDF").write_text(f"a mesh\n {body.length_scale:.9f} {body.gravity:.9f}  ULEN GRAV\n 1 1\n")
    lines = ["a title", " -1.  HBOT", " 1 1 IRAD IDIFF", " -5", " 0 1", " 1", " 0.0", " 1"]
    lines += ["body.gdf", " 0.5 -0.25 -1.5 0.0  XBODY", " 1 1 1 1 1 1"]
    (tmp_path / "body.pot").write_text("\n".join(lines))
    dataset = read_wamit(tmp_path / "body.3", density=body.density)
    assert math.isinf(dataset.water_depth)
    np.testing.assert_allclose(dataset.reference_point, (0.5, -0.25, -1.5))
    body.check(dataset)


def test_all_missing_facts_are_named_at_once(tmp_path):
    body = Body(5)
    body.write(tmp_path, 2.0 * math.pi / body.omega)
    with pytest.raises(InputError, match=r"gravity, length scale, water depth, reference point"):
        read_wamit(tmp_path / "body.1", density=body.density)


def test_angular_frequencies_by_iperout(tmp_path):
    body = Body(6)
    body.write(tmp_path, body.omega, zero_code=0.0, infinite_code=-1.0)
    (tmp_path / "body.cfg").write_text(" IPERIN=2\n IPEROUT=2  (frequencies)\n")
    with pytest.raises(InputError, match="zero or infinite"):
        read_wamit(tmp_path / "body.1", **body.inputs())
    body.check(read_wamit(tmp_path / "body.1", **body.inputs(), zero_frequency_code=0.0, infinite_frequency_code=-1.0))


def test_hams_is_refused_until_the_user_decides(tmp_path):
    body = Body(7)
    inputs = body.inputs()
    number = np.array([float(wave_number(w, inputs["water_depth"], body.gravity)) for w in body.omega])
    body.write(tmp_path, number, header=False, zero_code=0.0, infinite_code=-1.0)
    (tmp_path / "ControlFile.in").write_text("--HAMS--\n Output_frequency_type 2\n")
    with pytest.raises(InputError, match="HAMS") as refusal:
        read_wamit(tmp_path / "body.1", **inputs)
    assert "first_column" in str(refusal.value) and "Output_frequency_type" in str(refusal.value)
    with pytest.raises(InputError, match="zero or infinite"):
        read_wamit(tmp_path / "body.1", **inputs, first_column="wave_number")
    dataset = read_wamit(
        tmp_path / "body.1",
        **inputs,
        first_column="wave_number",
        zero_frequency_code=0.0,
        infinite_frequency_code=-1.0,
    )
    body.check(dataset)


def test_bad_rows_are_named_with_their_line(tmp_path):
    body = Body(8)
    body.write(tmp_path, 2.0 * math.pi / body.omega)
    lines = (tmp_path / "body.1").read_text().splitlines()
    lines[40] = "  1.0 2 three 4.0"
    (tmp_path / "body.1").write_text("\n".join(lines))
    with pytest.raises(InputError, match=r"body\.1:41"):
        read_wamit(tmp_path / "body.1", **body.inputs())


def test_a_missing_heading_is_not_filled_with_zero(tmp_path):
    body = Body(9)
    body.write(tmp_path, 2.0 * math.pi / body.omega)
    lines = (tmp_path / "body.3").read_text().splitlines()
    kept = [line for line in lines if line.split()[1:2] != ["9.000000E+01"] or line.startswith(lines[1][:12])]
    (tmp_path / "body.3").write_text("\n".join(kept))
    with pytest.raises(InputError, match="have no exciting force"):
        read_wamit(tmp_path / "body.1", **body.inputs())


def test_a_turned_body_comes_back_in_global_axes(tmp_path):
    """A body that looks along y of the file: its surge is the sway of the file."""
    body = Body(10)
    body.write(tmp_path, 2.0 * math.pi / body.omega)
    straight = read_wamit(tmp_path / "body.1", **body.inputs())
    (tmp_path / "body.pot").write_text("t\n 10. HBOT\n 1 1\n 1\n 1\n 1\n 0\n 1\nbody.gdf\n 0 0 0 90.0\n 1 1 1 1 1 1\n")
    turned = read_wamit(tmp_path / "body.1", **body.inputs())
    for new, old, sign in (
        ("Sway", "Surge", 1.0),
        ("Surge", "Sway", -1.0),
        ("Heave", "Heave", 1.0),
        ("Pitch", "Roll", 1.0),
    ):
        np.testing.assert_allclose(
            turned["excitation_force"].sel(influenced_dof=new),
            sign * straight["excitation_force"].sel(influenced_dof=old),
            rtol=1e-9, atol=1e-6,
        )  # fmt: skip
        np.testing.assert_allclose(
            turned["added_mass"].sel(radiating_dof=new, influenced_dof="Heave"),
            sign * straight["added_mass"].sel(radiating_dof=old, influenced_dof="Heave"), rtol=1e-9, atol=1e-6,
        )  # fmt: skip


def test_modes_of_more_bodies_than_the_control_file_has_are_refused(tmp_path):
    body = Body(10)
    body.write(tmp_path, 2.0 * math.pi / body.omega)
    with (tmp_path / "body.1").open("a") as stream:
        stream.write(" 1.0 7 7 1.0 1.0\n")
    (tmp_path / "body.pot").write_text("t\n 10. HBOT\n 1 1\n 1\n 1\n 1\n 0\n 1\nbody.gdf\n 0 0 0 0.0\n 1 1 1 1 1 1\n")
    with pytest.raises(InputError, match=r"modes of 2 bodies, its \.pot file has 1"):
        read_wamit(tmp_path / "body.1", **body.inputs())
