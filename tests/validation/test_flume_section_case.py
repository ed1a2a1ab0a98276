"""The example case of the measured section against its records: what linear theory and a bare-hull roll damping reach.

Sundsdal, Greco, Hanssen and Lugni (2025), NTNU. Nothing was fitted. The bounds are the departures that were found,
rounded up, and each has its reason: a change of the program that makes the comparison worse must show here.
"""

import importlib.util
import sys
from pathlib import Path

import pytest
import yaml

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "flume_section"


def load(name):
    spec = importlib.util.spec_from_file_location(f"flume_section_{name}", EXAMPLE / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def rows(shared_data):
    found = load("compare").compare(
        shared_data / "flume_moored_section", ["2041", "2062", "2101_2", "3041_2", "3061_1", "3101_3", "3102_1"]
    )
    return {(row.run, row.quantity): row for row in found}


@pytest.mark.slow
@pytest.mark.shared_data
@pytest.mark.parametrize("run", ["2041", "2062", "2101_2"])
def test_fixed_section(rows, run):
    """Forces within 5 %; the records lose 5 to 7 % of the energy, linear theory none: reflection is 0.03 too high."""
    assert abs(rows[run, "horizontal force"].error) < 0.03
    assert abs(rows[run, "vertical force"].error) < 0.05
    assert 0.0 < rows[run, "reflection"].error < 0.04
    assert abs(rows[run, "transmission"].error) < 0.03
    drift = rows[run, "mean horizontal force"]
    assert abs(drift.computed - drift.measured) < 0.1 * drift.measured + drift.spread


@pytest.mark.slow
@pytest.mark.shared_data
@pytest.mark.parametrize("run", ["3101_3", "3102_1"])
def test_free_section_in_short_waves(rows, run):
    """Two wave heights at 0.897 s, away from resonance."""
    assert abs(rows[run, "reflection"].error) < 0.035
    assert abs(rows[run, "transmission"].error) < 0.03
    assert abs(rows[run, "heave"].error) < 0.03
    assert abs(rows[run, "roll"].error) < 0.10
    assert abs(rows[run, "sway"].error) < 0.13
    assert abs(rows[run, "spring force"].error) < 0.14
    assert abs(rows[run, "mean drift force"].error) < 0.06


@pytest.mark.shared_data
@pytest.mark.parametrize("run", ["3041_2", "3061_1"])
def test_free_section_between_the_resonances(rows, run):
    """1.210 and 1.158 s, between the natural periods of heave (1.17 s) and roll (1.26 s).

    The guides' static friction in heave and the eddies of the heaving bilges are not in the case: heave is up to a
    fifth and reflection up to 0.2 too high. Sway is a small difference of large forces there and is not held.
    """
    assert abs(rows[run, "transmission"].error) < 0.03
    assert 0.0 < rows[run, "reflection"].error < 0.2
    assert 0.0 < rows[run, "heave"].error < 0.2
    assert -0.22 < rows[run, "roll"].error < 0.0
    assert abs(rows[run, "mean drift force"].error) < 0.27


@pytest.mark.shared_data
def test_natural_periods(shared_data):
    """Decay tests of the source: heave 1.17 s, roll 1.26 s; the closed flume stiffens the slow sway (7.50 s)."""
    periods = load("compare").natural_periods(shared_data / "flume_moored_section", "3101_3")
    assert periods["heave"] == pytest.approx(1.17, rel=0.01)
    assert periods["roll"] == pytest.approx(1.26, rel=0.01)
    assert periods["sway"] == pytest.approx(7.50, rel=0.12)


def test_roll_damping_in_the_case_is_what_its_source_gives():
    module = load("roll_damping")
    structure = yaml.safe_load((EXAMPLE / "section.yaml").read_text(encoding="utf-8"))["structure"]
    quadratic, linear = (float(structure["roll_damping"][name].split()[0]) for name in ("quadratic", "linear"))
    assert quadratic == pytest.approx(module.quadratic_roll_damping(module.MODEL, module.DENSITY), abs=5e-5)
    expected = module.friction_roll_damping(module.MODEL, module.DENSITY, module.VISCOSITY, module.ROLL_PERIOD)
    assert linear == pytest.approx(expected, abs=5e-5)


def test_lewis_form_has_the_ratio_and_the_area_asked_for():
    module = load("roll_damping")
    import math

    for ratio, area in ((1.0, 0.986), (1.7, 0.8), (0.6, 0.93)):
        a1, a3 = module.lewis_parameters(ratio, area)
        half_beam, depth = 1.0 + a1 + a3, 1.0 - a1 + a3
        assert half_beam / depth == pytest.approx(ratio)
        section_area = 0.5 * math.pi * (1.0 - a1**2 - 3.0 * a3**2)
        assert section_area / (2.0 * half_beam * depth) == pytest.approx(area)
