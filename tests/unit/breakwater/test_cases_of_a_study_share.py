"""What cases share that differ in their irregular seas alone is computed once, and changes no bit of any of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.core.progress import Progress
from moyai.core.remembered import Remembered, key_of_objects
from moyai.core.results import Result
from moyai.sea.spectra import jonswap
from moyai.structures.breakwater import hydrodynamics
from moyai.structures.breakwater import run as running
from moyai.structures.breakwater.frequency import about_rest, regular
from moyai.structures.breakwater.frequency.model import FrequencyModel, FrequencyResult
from moyai.structures.breakwater.model import BreakwaterProblem, Damping, IrregularSea, RegularSea

HEIGHTS = (0.01, 0.02, 0.015)


def forget() -> None:
    for kept in (
        running._HYDRODYNAMICS,
        running._STATICS,
        running._MODELS,
        running._REGULAR,
        hydrodynamics._SOLVED,
        hydrodynamics._BANDS,
        about_rest._NATURAL,
    ):
        kept.clear()


def with_storm(problem: BreakwaterProblem, height: float) -> BreakwaterProblem:
    damping = Damping(0.05, roll_quadratic=2.0, band=(0.5, 2.0))
    seas = (RegularSea("waves", 0.02, (0.8, 1.0)), IrregularSea("storm", jonswap(height, 1.0, 3.3), duration=600.0))
    return replace(
        problem,
        breakwater=replace(problem.breakwater, damping=damping),
        environment=replace(problem.environment, sea_states=seas),
        analyses=("statics", "frequency"),
    )


def assert_same_bits(first: Result, second: Result) -> None:
    assert first.tree.groups == second.tree.groups
    for group in first.tree.groups:
        one, other = first.tree[group].to_dataset(), second.tree[group].to_dataset()
        assert one.identical(other), group
    assert first.checks == second.checks or repr(first.checks) == repr(second.checks)
    assert first.notices == second.notices or repr(first.notices) == repr(second.notices)


@pytest.mark.slow
def test_seas_of_one_unit_in_a_row_are_those_run_alone(
    pontoon_problem: BreakwaterProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = []
    for height in HEIGHTS:
        forget()
        alone.append(running.run(with_storm(pontoon_problem, height)))
    forget()
    calls: list[str] = []
    solve = regular.regular_sea

    def counted(model: FrequencyModel, sea: RegularSea, *more: Progress) -> FrequencyResult:
        calls.append(sea.name)
        return solve(model, sea, *more)

    monkeypatch.setattr(regular, "regular_sea", counted)
    for height, expected in zip(HEIGHTS, alone, strict=True):
        found = running.run(with_storm(pontoon_problem, height))
        assert_same_bits(expected, found)
        # What a user does to a result stays with it
        found.tree["/SWL/frequency/waves"].attrs["status"] = "spoilt"
    assert calls == ["waves"]


def with_seas(problem: BreakwaterProblem, *seas: RegularSea | IrregularSea) -> BreakwaterProblem:
    return replace(problem, environment=replace(problem.environment, sea_states=seas))


@pytest.mark.parametrize(
    "change",
    [
        lambda p: replace(p, breakwater=replace(p.breakwater, damping=Damping(0.06))),
        lambda p: replace(p, breakwater=replace(p.breakwater, lines=p.breakwater.lines[:1])),
        lambda p: replace(p, environment=replace(p.environment, water_levels=(("SWL", 0.01),))),
        lambda p: replace(p, settings=p.settings.changed(drift=False)),
        lambda p: with_seas(p, RegularSea("waves", 0.03, (0.8, 1.0)), p.environment.sea_states[1]),
        lambda p: with_seas(p, p.environment.sea_states[0], IrregularSea("storm", jonswap(0.02, 1.2, 3.3))),
    ],
    ids=["damping", "lines", "level", "drift", "regular height", "peak period"],
)
def test_whatever_touches_regular_waves_is_another_key(pontoon_problem: BreakwaterProblem, change) -> None:  # type: ignore[no-untyped-def]
    problem = with_storm(pontoon_problem, 0.02)
    keys = set()
    for case in (problem, change(problem)):
        name, level = case.environment.water_levels[0]
        unit = running.assemble(case, name, level)
        sea = case.environment.sea_states[0]
        keys.add(key_of_objects(running._key_without_irregular_seas(case, unit), sea))
    assert len(keys) == 2


def test_the_last_few_answers_are_kept() -> None:
    made: list[str] = []
    kept: Remembered[str] = Remembered(2)
    for key in ("a", "b", "a", "c", "a", "b", None, None):
        assert kept.of(key, lambda key=key: made.append(str(key)) or f"answer {key}") == f"answer {key}"  # type: ignore[misc]
    assert made == ["a", "b", "c", "b", "None", "None"]
    assert key_of_objects(np.arange(3.0)) == key_of_objects(np.arange(3.0)) != key_of_objects(np.arange(3.0) + 1e-16)
