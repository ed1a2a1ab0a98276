"""Bodies of networks whose wave loads come from a 3-D program: hydrostatics, frequency domain, what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

import moyai
from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.core.errors import CaseError, InputError
from moyai.coupled.hulls import box_hull, cylinder_hull
from moyai.coupled.rigid import RigidBody
from moyai.interop.read import read_coefficients
from moyai.sea.water import Water
from moyai.structures.network.body_plan import BodyPlan
from moyai.structures.network.coefficients import hydrostatic_stiffness
from moyai.structures.network.run import run

FILE = Path(__file__).parents[2] / "validation/data/wu_box_capytaine.nc"
CASE = """moyai: 1
title: Free box on a thread
site: {{water_depth: 0.5 m, density: 1000 kg/m3, gravity: 9.81 m/s2}}
waves: {{kind: regular, name: waves, height: {height}, period: {period}, heading_deg: {heading}}}
structure:
  kind: network
  line_types:
    thread: {{diameter: 0.2 mm, mass: 4e-5 kg/m, axial_stiffness: 1 N, viscosity: 1e-3 N s, drag_normal: 0,
             drag_tangential: 0, added_mass_normal: 0}}
  bodies:
    box:
      shape: box
      size: [0.2 m, 0.2 m, 0.132 m]
      mass: 3.148 kg
      inertia: [0.015, 0.015, 0.021]
      centre_of_gravity: {centre}
      position: [0, 0, -12.7 mm]
      rotation_deg: [0, 0, {yaw}]
      points: {{hook: [0, 0, 0.066 m]}}
      drag: [0, 0, 0]
      {loads}
  points: {{post: {{kind: fixed, position: [0, 0.3 m, 0.3 m]}}}}
  lines: {{thread: {{start: post, end: hook, type: thread, length: 0.8 m, segments: 6, shape: catenary}}}}
analyses: {analyses}
settings: {{duration: {duration}, output_step: 25 ms, ramp: {ramp}, start: as_built{more}}}
"""
LOADS = (
    "coefficients_file: {{program: capytaine, path: '" + FILE.as_posix() + "', draught: {draught}, memory: {memory}}}"
)
ABSENT = "coefficients_file: {{{{program: {}, path: none.nc, draught: 7 cm}}}}"


def written(folder, **changes):
    values = {
        "height": "1 mm", "period": "0.9 s", "heading": 0, "centre": "[0, 0, 0.1 mm]", "yaw": 0,
        "analyses": "[dynamic]",
        "duration": "30 s", "ramp": "3 s", "draught": "78.7 mm", "memory": "true", "more": "", "loads": LOADS,
    } | changes  # fmt: skip
    values["loads"] = values["loads"].format(**values)
    path = folder / "case.yaml"
    path.write_text(CASE.format(**values), encoding="utf-8")
    return path


@pytest.mark.parametrize("seed", range(4))
def test_restoring_is_that_of_the_hull_under_a_small_motion(seed) -> None:
    """Columns, whose buoyancy acts part by part, moved by a little against the stiffness in closed form."""
    random = np.random.default_rng(seed)
    shape = ("box", "cylinder")[seed % 2]
    size = random.uniform(0.5, 3.0, 3)
    size[1] = size[0] if shape == "cylinder" else size[1]
    draught, centre = random.uniform(0.2, 0.8) * size[2], (0.0, 0.0, random.uniform(-0.3, 0.3) * size[2])
    water = Water(20.0, random.uniform(990, 1030), 9.81)
    plan = BodyPlan(
        "body", shape, tuple(size), 1.0, (1.0, 1.0, 1.0), centre, (0, 0, 0), (0, 0, 0), {}, (0, 0, 0), (0, 0, 0)
    )
    found = hydrostatic_stiffness(plan, draught, water)
    bottom = -0.5 * size[2]
    hull = box_hull(size, bottom=bottom) if shape == "box" else cylinder_hull(size[0], size[2], bottom=bottom)
    volume = float(hull.volume.sum()) * draught / size[2]
    body = RigidBody(
        "body", water.density * volume, (1, 1, 1), centre, (0, 0, 0.5 * size[2] - draught), lumps=hull
    )  # fmt: skip
    restoring = body.carrier(water).restoring
    scale = np.abs(np.diag(found)).max()
    assert np.abs(restoring - found).max() < 1e-5 * scale


@pytest.mark.slow
@pytest.mark.parametrize(("period", "heading"), [(0.9, 0.0), (0.75, 90.0)])
def test_a_box_of_a_case_moves_as_the_frequency_domain_says(tmp_path, period, heading) -> None:
    """Heave and the rotation across the waves, amplitude and phase; a body turned by 90 degrees in turned waves."""
    # pitch is all but undamped near 1.3 s: a slow start keeps it from ringing
    path = written(tmp_path, period=f"{period} s", heading=heading, yaw=heading, ramp="12 s")
    result = moyai.run(load_case(path))
    assert result.status == "converged", result.message
    series = result.tree["SWL/time/waves"].to_dataset()
    time = series["time"].values
    late = time > time[-1] - 8.0 * period
    omega, data = 2.0 * math.pi / period, read_coefficients("capytaine", FILE)
    at = data.interp(omega=omega)
    mass = np.diag([3.148, 3.148, 3.148, 0.015, 0.015, 0.021])
    water = Water(0.5, 1000.0, 9.81)
    stiffness = hydrostatic_stiffness(build(load_case(path)).bodies[0], 0.0787, water)
    impedance = stiffness - omega**2 * (mass + at.added_mass.values) - 1j * omega * at.radiation_damping.values
    answer = 0.5e-3 * np.linalg.solve(impedance, at.excitation_force.sel(wave_direction=0.0).values)
    lean = series["solid_angle"].values[late, 0]
    # with the yaw of 90 degrees the pitch of the body is reported about its own axis all the same
    for values, mode in ((series["solid_position"].values[late, 0, 2], 2), (lean[:, 1], 4)):
        basis = np.column_stack([np.cos(omega * time[late]), np.sin(omega * time[late]), np.ones(late.sum())])
        cosine, sine, _ = np.linalg.lstsq(basis, values, rcond=None)[0]
        assert abs(cosine + 1j * sine - answer[mode]) < 0.04 * abs(answer[mode])


def faults_of(path):
    with pytest.raises(CaseError) as raised:
        load_case(path)
    return "\n".join(str(item) for item in raised.value.faults)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"draught": "0.2 m"}, "submerges a body of 0.132 m"),
        ({"draught": "-3 cm"}, "greater than 0"),
        ({"centre": "[1 cm, 0, 0]"}, "its centre of gravity is above its middle"),
        ({"loads": "added_mass: [1, 1, 1]\n      " + LOADS}, "coefficients_file"),
        ({"loads": ABSENT.format("capytaine")}, "there is no file 'none.nc'"),
        ({"loads": ABSENT.format("hydrostar")}, "hydrostar"),
    ],
)  # fmt: skip
def test_coefficients_that_do_not_fit_are_reported(tmp_path, changes, words) -> None:
    assert words in faults_of(written(tmp_path, **changes))


def test_a_draught_that_does_not_carry_the_body_is_reported(tmp_path) -> None:
    warned = load_case(written(tmp_path, draught="5 cm")).warnings
    assert any("displaces 2 kg at 0.05 m and weighs 3.148 kg" in item.message for item in warned)


def test_waves_beyond_the_coefficients_stop_before_anything_is_run(tmp_path) -> None:
    data = read_coefficients("capytaine", FILE)
    period = 2.0 * math.pi / (1.2 * float(data.omega.max()))
    with pytest.raises(InputError, match="meet coefficients of") as raised:
        moyai.run(load_case(written(tmp_path, period=f"{period} s", height="0.1 mm", memory="false")))
    assert raised.value.fault.path == "structure.bodies.box.coefficients_file"
    with pytest.raises(InputError, match="were not read"):
        run(build(load_case(written(tmp_path))))


@pytest.mark.slow
def test_another_depth_and_a_body_of_wave_length_are_reported(tmp_path) -> None:
    path = written(tmp_path, memory="false", duration="0.5 s")
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("water_depth: 0.5 m", "water_depth: 0.8 m"), encoding="utf-8")
    reported = " ".join(item.message for item in moyai.run(load_case(path)).notices)
    assert "those of 0.5 m of water" in reported and "0.8 m" in reported
    small = moyai.run(load_case(written(tmp_path, loads="added_mass: [1, 1, 1]", duration="0.5 s", period="0.7 s")))
    assert any(item.code == "body-not-small" for item in small.notices)
    long = build(load_case(written(tmp_path, loads="added_mass: [1, 1, 1]", duration="0.5 s", period="2 s")))
    assert not any(item.code == "body-not-small" for item in run(long).notices)
