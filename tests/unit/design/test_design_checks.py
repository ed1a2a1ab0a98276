"""Codes, corrosion and anchors at random loads against their rules turned round."""

import math

import pytest

from moyai.core.errors import InputError
from moyai.design.codes import LineLoad, check_confirmation, check_line, design_code
from moyai.design.fatigue import EnduranceCurve
from moyai.mooring.anchors import DragAnchor, Sinker, check_drag_anchor
from moyai.tables.design_codes import (
    CodeRule,
    available_codes,
    available_endurance_curves,
    code_rules,
    endurance_data,
    holding_data,
)


def load(**changes):
    given = {
        "line": "sea", "maximum_tension": 400e3, "mean_tension": 100e3, "breaking_load": 1e6, "component": "chain",
    }  # fmt: skip
    return LineLoad(**{**given, **changes})


@pytest.mark.parametrize(
    ("name", "analysis", "consequence", "component", "lost", "expected"),
    [
        ("API RP 2SK", "dynamic", "", "chain", "", 0.4 * 1.67),
        ("API RP 2SK", "quasi_static", "", "chain", "", 0.4 * 2.0),
        ("API RP 2SK", "dynamic", "", "rope", "other", 0.4 * 1.25),
        ("API RP 2SK", "quasi_static", "", "rope", "other", 0.4 * 1.43),
        ("DNV-OS-E301", "dynamic", "1", "chain", "", (0.1 * 1.1 + 0.3 * 1.5) / 0.95),
        ("DNV-OS-E301", "dynamic", "2", "chain", "", (0.1 * 1.4 + 0.3 * 2.1) / 0.95),
        ("DNV-OS-E301", "dynamic", "2", "chain", "other", (0.1 * 1.0 + 0.3 * 1.25) / 0.95),
        ("NS 9415", "dynamic", "", "rope", "", 0.4 * 1.15 * 3.0),
        ("NS 9415", "quasi_static", "", "chain", "", 0.4 * 1.15 * 1.1 * 2.0),
        ("OCIMF", "static", "", "rope", "", 0.4 / 0.5),
        ("OCIMF", "static", "", "wire", "", 0.4 / 0.55),
        ("Japanese port practice", "dynamic", "", "chain", "", 1.2),
    ],
)
def test_codes_give_the_factors_of_their_table(name, analysis, consequence, component, lost, expected):
    code = design_code(name, analysis=analysis, consequence=consequence)
    outcome = check_line(load(component=component, lost=lost), code)
    assert outcome.utilisation == pytest.approx(expected, rel=1e-12)
    assert outcome.passed == (expected <= 1.0)
    assert not outcome.confirmed


def test_every_code_says_that_its_values_are_not_confirmed_until_the_user_confirms_them():
    for name in available_codes():
        consequence = "1" if name == "DNV-OS-E301" else ""
        assert check_confirmation(design_code(name, analysis="dynamic", consequence=consequence))
        sure = design_code(name, analysis="dynamic", consequence=consequence, confirmed=[name])
        assert not check_confirmation(sure)


def test_own_values_stand_in_for_a_table():
    own = [CodeRule("ours", "2026", "intact", "any", "any", "any", "safety_factor", 4.0, True, "house rule")]
    outcome = check_line(load(), design_code("ours", analysis="dynamic", own=own))
    assert outcome.utilisation == pytest.approx(1.6) and outcome.confirmed


def test_corrosion_takes_the_area_of_the_worn_bar():
    code = design_code("API RP 2SK", analysis="dynamic")
    new = check_line(load(), code)
    worn = check_line(load(), code, corrosion=0.4e-3 * 20, diameter=0.068)
    assert worn.utilisation / new.utilisation == pytest.approx((0.068 / 0.060) ** 2)


def test_an_unknown_breaking_load_does_not_pass():
    assert not check_line(load(breaking_load=math.nan), design_code("API RP 2SK", analysis="dynamic")).passed


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: design_code("API", analysis="dynamic"), "API RP 2SK"),
        (lambda: design_code("API RP 2SK", analysis="guess"), "quasi_static"),
        (lambda: design_code("DNV-OS-E301", analysis="dynamic"), "class"),
        (lambda: check_line(load(component="chain"), design_code("OCIMF", analysis="dynamic")), "rope"),
        (lambda: check_line(load(), design_code("API RP 2SK", analysis="dynamic"), corrosion=0.1), "diameter"),
        (
            lambda: check_line(load(), design_code("API RP 2SK", analysis="dynamic"), corrosion=0.1, diameter=0.05),
            "more than the diameter",
        ),
        (lambda: Sinker(-1.0, 0.5, 1.2), "above 0"),
        (lambda: DragAnchor(1.0, 0.0, 1.2), "above 0"),
        (lambda: holding_data("sinker", "concrete", "lava"), "concrete on sand"),
        (lambda: endurance_data("string"), "studless_chain"),
    ],
)
def test_slips_are_reported(call, word):
    with pytest.raises(InputError, match=word):
        call()


def test_a_drag_anchor_bears_no_uplift():
    anchor = DragAnchor(50e3, 6.0, 1.5)
    assert check_drag_anchor(anchor, 200e3, 0.0).utilisation == pytest.approx(1.0)
    lifted = check_drag_anchor(anchor, 100e3, 10e3)
    assert not lifted.passed and "5.7 degrees" in lifted.notices[0].message


def test_every_value_of_the_tables_has_a_source_and_a_mark():
    for name in available_codes():
        for rule in code_rules(name):
            assert rule.source and rule.edition and rule.value > 0.0
    for name in available_endurance_curves():
        data = endurance_data(name)
        assert data.source and data.exponent > 1.0 and data.capacity > 0.0
        curve = EnduranceCurve(name, data.exponent, data.capacity, data.unit, data.confirmed, data.source)
        one = 1.0 if data.unit == "1" else 100.0
        assert curve.cycles_to_failure(one / 10) / curve.cycles_to_failure(one) == pytest.approx(10**data.exponent)
