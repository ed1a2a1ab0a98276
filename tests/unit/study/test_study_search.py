"""Limits by bisection and optima against a case whose answers are known in closed form."""

import numpy as np
import pytest
import study_cases

from moyai.cli.study import answers_of_search
from moyai.core.errors import CaseError, InputError
from moyai.report.writer import write_report
from moyai.study.execute import run_study
from moyai.study.found import found_by_search
from moyai.study.plan import case_at, load_study
from moyai.study.trial import require_responses, runs_of_search

LIMIT = """{path: 'waves[storm].significant_height', from: 0.1 m, to: 150 cm,
             conditions: [{response: SWL/tension, at_most: 250}], tolerance: 0.002}"""


def test_the_largest_height_that_holds_is_found_in_every_case(tmp_path):
    path = study_cases.write_text(tmp_path, "- grid: {'waves[storm].peak_period': [4 s, 5 s]}", limit=LIMIT)
    result = run_study(load_study(path), tmp_path / "out", study_cases.linear_case, workers=1)
    assert result.status == "converged"
    limit = result.tree["limit"]["limit"]
    exact = np.sqrt(250.0 / 1000.0 * 5.0 / np.array([4.0, 5.0]) * (54.5 / 55.0) ** 4)
    assert limit.attrs["units"] == "m"
    assert (limit.values <= exact).all() and np.allclose(limit.values, exact, atol=0.002 * 1.4)


def test_what_never_or_always_holds_is_said(tmp_path):
    never = LIMIT.replace("250", "0.1")
    result = run_study(
        load_study(study_cases.write_text(tmp_path, "- grid: {'waves[0].peak_period': [5 s]}", limit=never)),
        tmp_path / "never", study_cases.linear_case, workers=1,
    )  # fmt: skip
    assert np.isnan(result.tree["limit"]["limit"].values).all()
    assert "does not hold at 0.1 m" in str(result.tree["case_message"].values[0])
    always = LIMIT.replace("250", "1e9")
    result = run_study(
        load_study(study_cases.write_text(tmp_path, "- grid: {'waves[0].peak_period': [5 s]}", limit=always)),
        tmp_path / "always", study_cases.linear_case, workers=1,
    )  # fmt: skip
    assert result.tree["limit"]["limit"].values == pytest.approx([1.5])
    assert "largest value tried" in str(result.tree["case_message"].values[0])


@pytest.mark.slow
def test_the_shortest_line_that_holds_its_tension_is_found_along_a_trade_off(tmp_path):
    optimise = """{variables: {'lines[*].segments[0].length': [54 m, 57 m]}, minimise: SWL/cost,
             trade_off: {response: SWL/tension, at_most: [950, 1000, 1040]}, starts: 2}"""
    path = study_cases.write_text(tmp_path, "[]", optimise=optimise)
    result = run_study(load_study(path), tmp_path / "out", study_cases.linear_case, workers=1)
    assert result.status == "converged", result.tree["case_message"].values
    exact = 55.0 * (1000.0 / np.array([950.0, 1000.0, 1040.0])) ** 0.25
    found = result.tree["optimum"]["objective"].values
    assert np.allclose(found, exact, rtol=2e-3)
    assert (result.tree["optimum"]["margin"].values >= 0.0).all(), "an optimum lies within its limits"
    messages = [str(word) for word in result.tree["case_message"].values.ravel()]
    for word, best in zip(messages, found):
        assert word.startswith(f"lines[*].segments[0].length = {best:.4g} m: best of"), "the case says what was found"
    assert list(result.tree["optimum"]["best"].coords["variable"].values) == ["lines[*].segments[0].length [m]"]
    assert np.allclose(result.tree["optimum"]["best"].values.ravel(), found, rtol=1e-12)
    for answer, best, word in zip(found_by_search(result), found, answers_of_search(result), strict=True):
        assert answer.values == (("lines[*].segments[0].length", pytest.approx(best), "m"),)
        assert answer.objective[1] == pytest.approx(best) and answer.governing == ("limit of SWL/tension",)
        assert f"lines[*].segments[0].length = {best:.4g} m" in word and "governed by limit of SWL/tension" in word
    page = write_report(result, tmp_path / "page")[0].read_text(encoding="utf-8")
    assert "Least cost (SWL)" in page and "governed by limit of SWL/tension" in page


def test_an_optimum_at_the_end_of_its_range_says_so(tmp_path):
    optimise = """{variables: {'lines[*].segments[0].length': [54 m, 57 m]}, minimise: SWL/cost,
             subject_to: {response: SWL/tension, at_most: 1e9}, starts: 1}"""
    path = study_cases.write_text(tmp_path, "[]", optimise=optimise)
    result = run_study(load_study(path), tmp_path / "out", study_cases.linear_case, workers=1)
    assert found_by_search(result)[0].governing == ("lower end of the range of lines[*].segments[0].length",)


def test_a_limit_names_the_response_that_sets_it(tmp_path):
    path = study_cases.write_text(tmp_path, "- grid: {'waves[storm].peak_period': [4 s, 5 s]}", limit=LIMIT)
    result = run_study(load_study(path), tmp_path / "out", study_cases.linear_case, workers=1)
    for answer in found_by_search(result):
        assert answer.values[0][0] == "waves[storm].significant_height" and answer.values[0][2] == "m"
        assert answer.governing == ("limit of SWL/tension",)


def test_a_trial_tells_runs_and_missing_responses_before_the_study_runs(tmp_path):
    path = study_cases.write_text(tmp_path, "- grid: {'waves[storm].peak_period': [4 s, 5 s]}", limit=LIMIT)
    study = load_study(path)
    # 500 steps of tolerance: both ends and nine halvings
    assert runs_of_search(study) == 11
    tree = study_cases.linear_case(case_at(study, study.cases[0]), lambda *_: None).tree
    require_responses(study, tree)
    path = study_cases.write_text(tmp_path, "[]", limit=LIMIT.replace("SWL/tension", "'SWL/tension[line=east]'"))
    with pytest.raises(InputError, match="no line 'east'"):
        require_responses(load_study(path), tree)


def test_what_cannot_be_reached_is_a_failed_row_that_says_so(tmp_path):
    optimise = """{variables: {'lines[*].segments[0].length': [54 m, 57 m]}, minimise: SWL/cost,
             subject_to: {response: SWL/tension, at_most: 1}, starts: 1}"""
    path = study_cases.write_text(tmp_path, "[]", optimise=optimise)
    result = run_study(load_study(path), tmp_path / "out", study_cases.linear_case, workers=1)
    assert "no combination within the ranges" in str(result.tree["case_message"].values)


@pytest.mark.parametrize(
    ("key", "text", "word"),
    [
        ("limit", LIMIT.replace("storm", "strom"), "did you mean 'storm'"),
        ("limit", LIMIT.replace("150 cm", "1 cm"), "empty"),
        ("limit", LIMIT.replace("at_most: 250", "at_most: 250, at_least: 3"), "exclude each other"),
        ("optimise", "{variables: {}, minimise: SWL/cost}", "variables"),
        ("optimise", "{variables: {'lines[*].count': [1, 1]}, minimise: SWL/cost}", "empty"),
    ],
)
def test_slips_of_a_search_are_reported(tmp_path, key, text, word):
    with pytest.raises(CaseError) as caught:
        load_study(study_cases.write_text(tmp_path, "- grid: {'waves[0].peak_period': [5 s]}", **{key: text}))
    assert word in "\n".join(str(fault) for fault in caught.value.faults)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_limits_and_optima_at_random_are_those_of_the_closed_form(tmp_path, seed):
    rng = np.random.default_rng(seed)
    periods, most = sorted(rng.uniform(3.0, 9.0, 2)), float(rng.uniform(80, 400))
    grid = f"- grid: {{'waves[storm].peak_period': [{periods[0]:.6f} s, {periods[1]:.6f} s]}}"
    limit = LIMIT.replace("250", f"{most:.6f}")
    result = run_study(
        load_study(study_cases.write_text(tmp_path, grid, limit=limit)),
        tmp_path / "limit", study_cases.linear_case, workers=1,
    )  # fmt: skip
    exact = np.sqrt(most / 1000.0 * 5.0 / np.array(periods) * (54.5 / 55.0) ** 4)
    found = result.tree["limit"]["limit"].values
    assert (found <= exact + 1e-12).all() and np.allclose(found, np.minimum(exact, 1.5), atol=0.002 * 1.4)
    # Two variables: in the lowest sea the shortest line stands on the limit of its tension
    bound = float(rng.uniform(850.0, 1000.0))
    optimise = (
        "{variables: {'lines[*].segments[0].length': [54 m, 57 m],"
        " 'waves[storm].significant_height': [0.98 m, 1.02 m]},"
        f" minimise: SWL/cost, subject_to: {{response: SWL/tension, at_most: {bound:.6f}}}, starts: 2, seed: {seed}}}"
    )
    path = study_cases.write_text(tmp_path, "[]", optimise=optimise)
    result = run_study(load_study(path), tmp_path / "best", study_cases.linear_case, workers=1)
    assert result.status == "converged", result.message
    assert float(result.tree["optimum"]["objective"]) == pytest.approx(55.0 * (960.4 / bound) ** 0.25, rel=1e-3)
    assert float(result.tree["optimum"]["margin"]) >= 0.0


def test_a_search_is_watched_by_what_it_finds(tmp_path):
    grid = "- grid: {'waves[storm].peak_period': [4 s, 5 s]}"
    study = load_study(study_cases.write_text(tmp_path, grid, limit=LIMIT))
    assert study.watch == "limit/limit"
    reported = []
    run_study(study, tmp_path / "out", study_cases.linear_case, workers=1, watch=reported.append)
    exact = np.sqrt(250.0 / 1000.0 * 5.0 / np.array([4.0, 5.0]) * (54.5 / 55.0) ** 4)
    assert reported[-1].largest[0] == pytest.approx(exact[0], abs=0.003) and reported[-1].latest.index == 1
    with pytest.raises(CaseError) as caught:
        load_study(study_cases.write_text(tmp_path, grid, limit=LIMIT, watch="SWL/tension"))
    assert "limit/limit" in str(caught.value)


@pytest.mark.parametrize(("evaluations", "settled"), [(5, False), (60, True)])
def test_a_search_cut_at_its_evaluations_is_said_to_be_unsettled(tmp_path, evaluations, settled):
    optimise = f"""{{variables: {{'lines[*].segments[0].length': [54 m, 57 m]}}, minimise: SWL/cost,
             subject_to: {{response: SWL/tension, at_most: 1000}}, starts: 1, evaluations: {evaluations}}}"""
    path = study_cases.write_text(tmp_path, "[]", optimise=optimise)
    result = run_study(load_study(path), tmp_path / "out", study_cases.linear_case, workers=1)
    (answer,) = found_by_search(result)
    assert answer.settled is settled
    assert any("before it settled" in line for line in answers_of_search(result)) is not settled
