"""Sliders that a case names: one number each, written in the file; they change no result."""

from __future__ import annotations

import pytest

from moyai.case.reader import load_case
from moyai.case.templates import template
from moyai.core.errors import CaseError

KINDS = ("breakwater", "curtain", "cage", "rigid_cage", "network", "member")


@pytest.mark.parametrize("kind", KINDS)
def test_every_structure_takes_sliders_and_keeps_its_hash(kind: str) -> None:
    plain = load_case(template(kind))
    case = load_case(template(kind) + "\napp: {sliders: [site.water_depth, site.density]}\n")
    assert case.model.app.sliders == ("site.water_depth", "site.density")
    assert plain.model.app.sliders is None
    assert case.case_hash == plain.case_hash


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ("site.water_dept", "not written"),
        ("sites.water_depth", "no key 'sites'"),
        ("structure", "no number of the case"),
        ("structure.kind", "no number of the case"),
        ("lines[*].segments[0].length", "means 2 numbers"),
        ("lines[9].segments[0].length", "entries"),
        ("site..", "is no path"),
    ],
)
def test_a_path_that_is_no_number_is_one_clear_error(path: str, said: str) -> None:
    with pytest.raises(CaseError) as error:
        load_case(template("breakwater") + f"\napp: {{sliders: ['{path}']}}\n")
    (fault,) = error.value.faults
    assert said in fault.message and fault.path == "app.sliders[0]" and fault.line > 1


def test_a_slider_stands_once_and_the_list_is_not_empty() -> None:
    for written, said in (("[site.density, site.density]", "twice"), ("[]", "empty")):
        with pytest.raises(CaseError, match=said):
            load_case(template("member") + f"\napp: {{sliders: {written}}}\n")
