"""Floating breakwaters: their case, model, analyses and report."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.core.kinds import StructureKind
from moyai.core.progress import Progress
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class BreakwaterKind(StructureKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "breakwater"
    package = __name__
    templates = (("breakwater", "template.yaml"),)

    def schema(self) -> Any:
        from moyai.structures.breakwater.case.schema import BreakwaterCase

        return BreakwaterCase

    def add_sizes(self, model: Any, sizes: Any, periods: Any) -> None:
        from moyai.structures.breakwater.case.sizes import add_sizes

        add_sizes(model, sizes)

    def criteria(self, model: Any, given: Any) -> Any:
        from moyai.structures.breakwater.case.criteria import criteria

        return criteria(model, given)

    def check(self, model: Any, findings: Any, folder: Path) -> None:
        from moyai.structures.breakwater.case.check import check

        check(model, findings, folder)

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        from moyai.structures.breakwater.case.build import build_problem

        return build_problem(model, folder, case_text=case_text, case_hash=case_hash)

    def derived(self, case: Any) -> Any:
        from moyai.structures.breakwater.case.derived import derived_numbers

        return derived_numbers(case)

    def nominal(self, problem: Any) -> Any | None:
        given = problem.breakwater.damping
        if given.band == (1.0, 1.0) or "frequency" not in problem.settings.analyses:
            return None
        damping = replace(given, band=(1.0, 1.0))
        return replace(problem, breakwater=replace(problem.breakwater, damping=damping))

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.core.store import DatasetStore
        from moyai.structures.breakwater.coefficients_file import planar_coefficients
        from moyai.structures.breakwater.run import run

        store = None if keep is None else DatasetStore(keep)
        coefficients, notices = planar_coefficients(problem)
        return run(problem, progress, store=store, coefficients=coefficients, notices=notices)

    def vocabulary(self) -> Vocabulary:
        from moyai.structures.breakwater.variables import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.structures.breakwater.report.page import compose

        return compose(result)


KIND = BreakwaterKind()
