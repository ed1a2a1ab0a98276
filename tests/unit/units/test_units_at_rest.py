"""The first page of a row of which no sea was run: lines and offset under wind and current are judged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from japanese import compared

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.headline import Headline, Judgement
from moyai.core.results import Result
from moyai.structures.units.run import run

STATICS = (("analyses: [statics, frequency, time, map]", "analyses: [statics]"),)
CURRENT = (
    ("# current: {speed: 0.3 m/s", "current: {speed: 0.6 m/s"),
    ("  gap_damping_lid: 0.05 ", "  current_drag_coefficient: 1.5\n  gap_damping_lid: 0.05 "),
)


def of_case(*changes: tuple[str, str], waves: bool = True) -> Result:
    text = template("units")
    for old, new in (*STATICS, *changes):
        assert old in text, old
        text = text.replace(old, new, 1)
    if not waves:
        text = text[: text.index("\nwaves:")] + text[text.index("\n# wind:") :]
    return run(build(case_of(parse_yaml(text, "case.yaml"), Path("case.yaml"))))


def shown(result: Result) -> dict[str, Headline]:
    return {item.name: item for item in result.headlines}


def outcomes(result: Result) -> dict[str, Judgement]:
    assert result.verdict is not None
    return {item.criterion.headline: item for item in result.verdict.judgements}


def test_steady_tension_and_offset_stand_on_the_page_and_are_not_judged_to_hold_without_the_seas() -> None:
    result = of_case(*CURRENT)
    rest, found = result.tree["SWL/statics"].to_dataset(), shown(result)
    tension = float(rest["line_tension_mean"].max())
    assert found["line_tension"].value == pytest.approx(tension)
    share = float((rest["line_tension_mean"] / rest["breaking_load"]).max())
    assert found["line_utilisation"].value == pytest.approx(share)
    sway, surge = (rest["steady_offset"].sel(dof=dof).values for dof in ("sway", "surge"))
    assert found["offset"].value == pytest.approx(float(np.hypot(sway, surge).max())) and found["offset"].value > 0.1
    judged = outcomes(result)
    assert judged["line_utilisation"].outcome == "not judged"
    assert judged["line_utilisation"].reason == "the seas of the case were not run"
    assert judged["freeboard"].outcome == judged["metacentric_height"].outcome == "holds"
    assert result.verdict is not None and result.verdict.outcome == "not judged"
    assert found["not_judged"].text.startswith("waves, forces in connectors, closing of gaps, one line lost")


def test_its_report_in_japanese_has_no_english_word() -> None:
    left, _ = compared(of_case(*CURRENT))
    assert not left, "\n".join(left)


def test_a_case_without_seas_is_judged_on_its_steady_tension() -> None:
    result = of_case(*CURRENT, waves=False)
    judged = outcomes(result)
    assert judged["line_utilisation"].outcome == "holds" and not judged["line_utilisation"].bound
    assert "static analysis" in judged["line_utilisation"].criterion.source
    assert result.verdict is not None and result.verdict.outcome == "holds"


def test_a_limit_that_the_current_alone_breaks_is_broken() -> None:
    criteria = "\ncriteria: {greatest_offset: 0.05 m, line_safety_factor: 1000}\n"
    result = of_case(*CURRENT, ("\nanalyses:", f"{criteria}\nanalyses:"))
    judged = outcomes(result)
    assert judged["offset"].outcome == judged["line_utilisation"].outcome == "does not hold"


def test_in_still_water_there_is_a_pretension_and_no_offset() -> None:
    found = shown(of_case(waves=False))
    assert found["line_tension"].model == "still water" and "offset" not in found
