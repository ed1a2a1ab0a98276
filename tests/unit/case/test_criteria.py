"""What a design has to keep: keys, defaults that are said, codes, and the faults of a block."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from case_files import CASE, faults, read

from moyai.case.builder import build
from moyai.case.criteria import criteria_of
from moyai.case.line_code import code_criterion
from moyai.core.errors import InputError
from moyai.core.headline import Band, Criterion, Headline, judge
from moyai.design.codes import LineLoad, check_line, design_code


def criteria(block: str) -> dict[str, Criterion]:
    text = CASE + block
    assert faults(text) == []
    found = criteria_of(read(text).model)
    return {f"{item.name} {item.sea}".strip(): item for item in found}


def test_defaults_are_there_and_say_that_they_are_assumed():
    found = criteria("")
    lines = found["line_safety_factor"]
    assert 1.0 / lines.limit == pytest.approx(2.0) and lines.assumed
    assert "ISO 19901-7" in lines.source and "not confirmed" in lines.source
    assert found["greatest_uplift"].limit == 0.0 and "default of moyai" in found["greatest_uplift"].source
    assert {"least_metacentric_height", "least_freeboard"} <= set(found)


def test_keys_replace_defaults_of_their_name_and_leave_the_others():
    found = criteria("criteria: {line_safety_factor: 3, greatest_uplift: 20 kN, least_freeboard: not_judged}\n")
    assert found["line_safety_factor"].limit == pytest.approx(1.0 / 3.0)
    assert found["greatest_uplift"].limit == 20e3 and not found["greatest_uplift"].assumed
    assert "least_freeboard" not in found and "least_metacentric_height" in found


def test_none_leaves_nothing_to_judge():
    case = read(CASE + "criteria: none\n")
    assert build(case).criteria == ()
    assert judge((Headline("offset", "Offset", 1.0, "m"),), build(case).criteria, computed=True).outcome == "not judged"


def test_limits_of_named_seas_and_angles():
    found = criteria("criteria: {greatest_transmission: {storm: 0.5, operation: 30 %}, greatest_roll_deg: 10}\n")
    assert found["greatest_transmission storm"].limit == 0.5
    assert found["greatest_transmission operation"].limit == pytest.approx(0.3)
    assert found["greatest_roll_deg"].limit == pytest.approx(math.radians(10.0))


@pytest.mark.parametrize(
    ("block", "said"),
    [
        ("criteria: nothing\n", "not known here"),
        ("criteria: {greatest_transmission: {strom: 0.5}}\n", "did you mean 'storm'?"),
        ("criteria: {line_safty_factor: 2}\n", "did you mean 'line_safety_factor'?"),
        ("criteria: {line_safety_factor: 0.5}\n", "at least 1"),
        ("criteria: {line_safety_factor: 2, code: NS 9415}\n", "exclude each other"),
        ("criteria: {code: ISO 1}\n", "there is no design code"),
        ("criteria: {code: OCIMF}\n", "no value for a chain"),
        ("criteria: {code: DNV-OS-E301}\n", "needs a consequence class"),
        ("criteria: {greatest_offset: 3 kN}\n", "expected a length"),
    ],
)
def test_faults_are_reported(block, said):
    assert any(said in fault for fault in faults(CASE + block)), faults(CASE + block)


@pytest.mark.parametrize(("mean", "largest"), [(0.2e6, 0.9e6), (0.5e6, 0.9e6), (0.85e6, 0.9e6)])
def test_partial_factors_agree_with_the_design_check(mean, largest):
    block = 'criteria: {code: {name: DNV-OS-E301, consequence: "2", analysis: dynamic}}\n'
    criterion = criteria(block)["code"]
    strength = 1.9e6
    load = LineLoad("seaward", largest, mean, strength, "chain")
    check = check_line(load, design_code("DNV-OS-E301", analysis="dynamic", consequence="2"))
    headline = Headline("line_utilisation", "Lines", largest / strength, "1", mean=mean / strength)
    verdict = judge([headline], [criterion], computed=True)
    assert verdict.outcome == ("holds" if check.passed else "does not hold")
    # demand over characteristic strength is the same number
    item = verdict.judgements[0]
    assert item.value / criterion.limit == pytest.approx(check.utilisation)


def test_partial_factors_without_the_mean_are_judged_only_where_every_mean_agrees():
    block = "criteria: {code: {name: DNV-OS-E301, consequence: 1, analysis: dynamic}}\n"
    criterion = criteria(block)["code"]  # 1.1 mean + 1.5 varying part
    outcomes = [
        judge([Headline("line_utilisation", "Lines", used, "1")], [criterion], computed=True).outcome
        for used in (0.6, 0.7, 0.9)
    ]
    assert outcomes == ["holds", "not judged", "does not hold"]


def test_a_code_that_weighs_the_mean_names_the_line_that_decides():
    """The line with the largest tension keeps the limit, another one with a smaller mean does not."""
    criterion = criteria("criteria: {code: {name: DNV-OS-E301, consequence: 1, analysis: dynamic}}\n")["code"]
    steady = Headline("line_utilisation", "Lines", 0.78, "1", "storm, line a", mean=0.75)
    varying = Headline("line_utilisation", "Lines", 0.77, "1", "storm, line b", mean=0.10, shown=False)
    verdict = judge([steady, varying], [criterion], computed=True)
    assert verdict.message.endswith(" is below 1.58 (storm, line b)") and "line a" not in verdict.message
    unknown = judge([steady, replace(varying, value=0.7, mean=None)], [criterion], computed=True)
    assert unknown.message == f"{criterion.words}: the mean tension is not known (storm, line b)"
    # a bound beyond the limit whatever the mean is fails
    beyond = replace(varying, value=0.95, bound="at least")
    assert judge([beyond], [criterion], computed=True).outcome == "does not hold"
    assert judge([replace(beyond, value=0.7)], [criterion], computed=True).outcome == "not judged"


def test_a_curtain_with_two_metres_of_four_does_not_hold(tmp_path):
    from moyai.case.reader import load_case
    from moyai.case.templates import template

    text = template("curtain")
    for block in ("", "criteria: {least_effective_depth: 4 m}\n"):
        changed = text.replace("  least_effective_depth: 4 m\n", "") + block if block else text
        (tmp_path / "case.yaml").write_text(changed, encoding="utf-8")
        problem = build(load_case(tmp_path / "case.yaml"))
        # either place feeds the criterion, and the limits of the analysis too
        assert problem.curtain.strengths.least_depth == 4.0
        depth = Headline("effective_depth", "Effective depth", 1.99, "m", band=Band(1.8, 2.2, "drag"))
        asked = [item for item in problem.criteria if item.name == "least_effective_depth"]
        verdict = judge([depth], asked, computed=True)
        assert verdict.outcome == "does not hold"
        assert verdict.message == "effective depth 1.8 m is below 4 m"


def test_each_tension_is_judged_by_the_factor_of_its_own_analysis():
    given = [item for item in build(read(CASE)).criteria if item.headline == "line_utilisation"]
    assert {item.analysis: 1.0 / item.limit for item in given} == pytest.approx({"dynamic": 1.67, "quasi_static": 2.0})
    # 0.55 is within 1/1.67 and beyond 1/2
    moving = Headline("line_utilisation", "Utilisation", 0.55, "1", analysis="dynamic")
    still = Headline("line_utilisation", "Utilisation", 0.55, "1", analysis="quasi_static")
    assert judge([moving], given, computed=True).outcome == "holds"
    verdict = judge([moving, still], given, computed=True)
    assert verdict.outcome == "does not hold"
    assert {item.criterion.analysis: item.outcome for item in verdict.judgements} == {
        "dynamic": "holds",
        "quasi_static": "does not hold",
    }
    assert "quasi-static analysis" in verdict.message


def test_a_code_for_the_analysis_that_the_case_names_judges_all():
    given = criteria("criteria: {code: {name: ISO 19901-7, analysis: quasi_static}}\n")["code"]
    assert given.analysis == "" and 1.0 / given.limit == pytest.approx(2.0)


def test_a_default_code_judges_a_material_that_it_does_not_know_as_its_strictest_one():
    """Nobody asked for the code: it may not refuse the case. A code of the case does."""
    known, unknown = (code_criterion("NS 9415", "dynamic", [name], assumed=True) for name in ("rope", "wire"))
    assert unknown.limit == known.limit
    assert "wire judged as rope" in unknown.source
    with pytest.raises(InputError, match="no value for a wire"):
        code_criterion("NS 9415", "dynamic", ["wire"])


def test_a_code_names_the_materials_that_its_factor_is_for():
    """None where it is for any; all that share the strictest where a line does not say what it is made of."""
    for names in (["studless_chain_R3"], [None], ["polyester_rope", "studless_chain_R3"]):
        assert code_criterion("ISO 19901-7", "dynamic", names).source == (
            "ISO 19901-7 (2013), factor 1.67 on the breaking load, dynamic analysis, not confirmed against the standard"
        )
    assert ", rope, dynamic" in code_criterion("NS 9415", "dynamic", ["rope"]).source
