"""A breakwater takes one body of a file with several; without a choice the fault lists them, at the key."""

from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import InputError
from moyai.interop.coefficients import assemble, dof_names
from moyai.interop.write import write_coefficients
from moyai.structures.breakwater.coefficients_file import planar_coefficients

NAMES = ("port", "starboard")


def file_of_two(folder):
    omega = np.linspace(0.4, 4.0, 12)
    rng = np.random.default_rng(1)
    added = np.repeat(np.eye(12)[None] * 1e5, 12, axis=0) + rng.normal(size=(12, 12))
    force = 1e4 * (rng.normal(size=(12, 1, 12)) - 5j)
    given = assemble(
        program="hand", source="hand", dofs=dof_names(NAMES), omega=omega, added_mass=added,
        radiation_damping=np.repeat(np.eye(12)[None] * 1e3, 12, axis=0), wave_direction=np.zeros(1),
        forces={"excitation_force": force}, density=1025.0, gravity=9.81, water_depth=10.0,
        reference_point=[[0.0, -10.0, 0.0], [0.0, 10.0, 0.0]], bodies=NAMES,
    )  # fmt: skip
    write_coefficients("nemoh", given, folder / "two")
    return given


def problem(folder, entry):
    text = template("breakwater").replace("  section:", f"  coefficients_file: {{{entry}}}\n  section:", 1)
    case = case_of(parse_yaml(text, "case.yaml"), Path(folder) / "case.yaml")
    return case, build(case)


def test_the_fault_lists_the_bodies_at_the_key(tmp_path):
    file_of_two(tmp_path)
    case, found = problem(tmp_path, "program: nemoh, path: two, sea: head")
    with pytest.raises(InputError, match="holds the bodies port, starboard") as caught:
        planar_coefficients(found)
    located = case.located(caught.value)
    assert located.fault.path == "structure.coefficients_file"
    assert located.fault.line > 0


@pytest.mark.parametrize("body", ["2", "starboard"])
def test_one_is_taken_by_number_or_name(tmp_path, body):
    given = file_of_two(tmp_path)
    _, found = problem(tmp_path, f"program: nemoh, path: two, sea: head, body: {body}")
    options = dict(found.breakwater.coefficients_file.options)
    from moyai.interop.read import read_body

    read = read_body("nemoh", tmp_path / "two", {"body": options["body"]})
    np.testing.assert_allclose(read["added_mass"], given["added_mass"][:, 6:, 6:], rtol=1e-12)
