"""A file of another command, given to ``moyai run`` or ``check``, is refused with the command that reads it."""

import pytest

from moyai.case.reader import load_case
from moyai.case.templates import kind_by_keys, next_command
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError
from moyai.core.kinds import further_files, structure_kind, structure_kinds


@pytest.mark.parametrize("name", sorted(further_files()))
def test_a_file_of_another_command_names_it(name, tmp_path):
    file = tmp_path / "given.yaml"
    file.write_text(further_files()[name].template(name), encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(file)
    assert f"this is a file of the kind '{name}', no case" in str(caught.value)
    assert next_command(name, "FILE") in str(caught.value)


def test_cases_of_structures_are_no_files_of_another_kind():
    for kind in map(structure_kind, structure_kinds()):
        for name, _ in kind.templates:
            assert kind_by_keys(parse_yaml(kind.template(name), "a").data) is None
    assert kind_by_keys({"moyai": 1, "site": {}}) is None
