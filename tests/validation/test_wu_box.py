"""The moored box of Wu et al. (2018): coefficients in time against the frequency domain, symmetry, both models.

Inputs: Wu, M. et al. (2018) as a deck of foamMooring gives them; what is assumed is named in
examples/coupled/moored_box.py. Coefficients: tests/validation/data/wu_box_capytaine.nc, from benchmarks/peer_wu_box.py.
"""

import importlib.util
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.coupled.rigid import RigidBody
from moyai.coupled.wave_loads import WaveLoads
from moyai.flexible.flow import Flow
from moyai.interop.read import read_coefficients
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def example():
    path = Path(__file__).parents[2] / "examples/coupled/moored_box.py"
    spec = importlib.util.spec_from_file_location("moored_box", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def coefficients(example):
    return read_coefficients("capytaine", example.COEFFICIENTS)


@pytest.fixture(scope="module")
def loads(example, coefficients):
    found = WaveLoads.from_dataset(
        coefficients, displaced_volume=3.148e-3, equilibrium_position=(0.0, 0.0, -example.DRAUGHT)
    )
    # the example fits the memory of the same coefficients each time that it runs
    example.WaveLoads = SimpleNamespace(from_dataset=lambda *_, **__: found)
    return found


@pytest.mark.parametrize("period", [2.0, 0.9, 0.7])
def test_small_motions_of_the_free_box_are_those_of_the_frequency_domain(example, coefficients, loads, period) -> None:
    """Heave and pitch without chains, the memory carried by states, against X / (C - w2 (M + A) - i w B).

    Away from 1.3 s, where pitch resonates with next to no damping and no run is long enough.
    """
    omega, height = 2.0 * math.pi / period, 1e-3
    body = RigidBody("box", 3.148, (0.015, 0.015, 0.021), (0, 0, example.CENTRE), (0, 0, -example.DRAUGHT), loads=loads)
    number = wave_number(np.array([omega]), 0.5, 9.81)
    wave = WaveComponents([omega], [0.5 * height], [0.0], [0.0], number, example.WATER)
    carrier = body.carrier(example.WATER, Flow(waves=wave, ramp=4.0 * period))
    step, rows = period / 40.0, []
    none = np.zeros((2, 0, 3))
    for count in range(1, round(40.0 * period / step) + 1):
        carrier.try_step(count * step, none)
        carrier.accept()
        rows.append((count * step, carrier.position[2], math.atan2(-carrier.rotation[2, 0], carrier.rotation[0, 0])))
    time, heave, pitch = np.array(rows)[-400:].T
    at = coefficients.interp(omega=omega)
    mass = np.diag([3.148, 3.148, 3.148, 0.015, 0.015, 0.021])
    own = coefficients.reference_point.values
    assert own[2] == pytest.approx(example.CENTRE - example.DRAUGHT, abs=1e-9)
    impedance = (
        coefficients.hydrostatic_stiffness.values
        - omega**2 * (mass + at.added_mass.values)
        - 1j * omega * at.radiation_damping.values
    )
    answer = np.linalg.solve(impedance + 1e-9 * np.eye(6), at.excitation_force.sel(wave_direction=0.0).values)
    for found, mode, share in ((heave, 2, 0.02), (pitch, 4, 0.04)):
        basis = np.column_stack([np.cos(omega * time), np.sin(omega * time), np.ones_like(time)])
        cosine, sine, _ = np.linalg.lstsq(basis, found, rcond=None)[0]
        amplitude = cosine + 1j * sine
        assert abs(amplitude - 0.5 * height * answer[mode]) < share * abs(0.5 * height * answer[mode])


@pytest.mark.parametrize("model", ["coefficients", "morison"])
def test_the_moored_box_keeps_its_symmetry_and_nearly_slackens_its_chains(example, loads, model) -> None:
    history = example.run(model, periods=10.0, bars=10)
    assert history.status == "converged"
    assert all(check.passed for check in history.checks)
    body = history.bodies["box"]
    assert np.max(np.abs(body.position[:, 1])) < 1e-6
    assert np.max(np.abs(body.angles[:, [0, 2]])) < 1e-5
    found = example.figures(history, last=3.0)
    # the wave is thirty times as long as the box is deep: it rides the surface
    assert found["heave"] == pytest.approx(example.HEIGHT, rel=0.06)
    assert 0.2 < found["surge"] < 0.33
    assert 10.0 < found["pitch"] < 22.0
    for side in ("front", "back"):
        assert 0.0 < found[f"{side} min"] < 0.25
        assert 1.2 < found[f"{side} max"] < 2.2


def test_the_box_as_a_case_file_moves_as_by_the_program(example, loads) -> None:
    """examples/network/flume_box.yaml against examples/coupled/moored_box.py; drag on pitch is spread over the hull."""
    import moyai

    path = Path(__file__).parents[2] / "examples/network/flume_box.yaml"
    text = path.read_text(encoding="utf-8").replace("skip: 30 s", "skip: 30 s, mesh_check: off")
    result = moyai.run(case_of(parse_yaml(text, path.name), path))
    assert result.status == "converged", result.message
    found = result.tree["SWL/dynamic"].to_dataset().sel(run="waves")
    program = example.figures(example.run("coefficients"))
    series = result.tree["SWL/time/waves"].to_dataset()
    late = series["time"].values > 30.0
    surge = float(np.ptp(series["solid_position"].values[late, 0, 0]))
    assert surge == pytest.approx(program["surge"], rel=0.005)
    assert float(found["heave_range"][0]) == pytest.approx(program["heave"], rel=0.005)
    assert float(found["line_tension_maximum"].sel(line="seaward left")) == pytest.approx(
        program["front max"], rel=0.01
    )
    assert float(found["line_tension_maximum"].sel(line="lee left")) == pytest.approx(program["back max"], rel=0.01)
    # 11.7 degrees against 13.7: drag on every part of the bottom and the sides turns against pitch
    assert 0.8 < math.degrees(float(found["pitch_range"][0])) / program["pitch"] < 0.95
