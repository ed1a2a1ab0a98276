"""Damping computed from the section against the measured section in its flume (docs/validation/viscous.md).

Sundsdal, Greco, Hanssen and Lugni (2025), NTNU. Nothing was fitted: the default of a case without any roll damping, at
the two periods between the resonances, must come nearer to the records than wave radiation and the rig alone.
"""

import copy
import importlib.util
import sys
from pathlib import Path

import pytest
import yaml

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "flume_section"
RUNS = ("3041_2", "3061_1")


def compare():
    spec = importlib.util.spec_from_file_location("flume_section_compare_viscous", EXAMPLE / "compare.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def errors(shared_data):
    module = compare()
    content = yaml.safe_load((EXAMPLE / "section.yaml").read_text(encoding="utf-8"))
    del content["structure"]["roll_damping"]
    found = {}
    for name, damping in (("computed", None), ("none", {"viscous": "none"})):
        case = copy.deepcopy(content)
        if damping is not None:
            case["structure"]["damping"] = damping
        rows = module.compare(shared_data / "flume_moored_section", RUNS, case)
        found[name] = {(row.run, row.quantity): row.error for row in rows}
    return found


@pytest.mark.slow
@pytest.mark.shared_data
@pytest.mark.parametrize("run", RUNS)
@pytest.mark.parametrize("quantity", ["heave", "reflection"])
def test_computed_damping_comes_nearer_to_the_records(errors, run, quantity):
    assert 0.0 < errors["computed"][run, quantity] < 0.93 * errors["none"][run, quantity]


@pytest.mark.slow
@pytest.mark.shared_data
@pytest.mark.parametrize(("run", "heave", "roll"), [("3041_2", 0.09, -0.13), ("3061_1", 0.165, -0.22)])
def test_errors_are_those_of_the_page(errors, run, heave, roll):
    assert 0.0 < errors["computed"][run, "heave"] < heave
    assert roll < errors["computed"][run, "roll"] < 0.0
    assert abs(errors["computed"][run, "transmission"]) < 0.02
