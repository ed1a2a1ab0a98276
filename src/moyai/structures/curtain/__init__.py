"""Silt curtains: statics, impact tension, waves, anchor loads, limits."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.core.kinds import StructureKind
from moyai.core.progress import Progress
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class CurtainKind(StructureKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "curtain"
    package = __name__
    templates = (("curtain", "template.yaml"),)

    def schema(self) -> Any:
        from moyai.structures.curtain.case.schema import CurtainCase

        return CurtainCase

    def add_sizes(self, model: Any, sizes: Any, periods: Any) -> None:
        from moyai.structures.curtain.case.sizes import add_sizes

        add_sizes(model, sizes)

    def criteria(self, model: Any, given: Any) -> Any:
        from moyai.structures.curtain.case.criteria import criteria

        return criteria(model, given)

    def check(self, model: Any, findings: Any, folder: Path) -> None:
        from moyai.structures.curtain.case.check import check

        check(model, findings, folder)

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        from moyai.structures.curtain.case.build import build_problem

        return build_problem(model, folder, case_text=case_text, case_hash=case_hash)

    def derived(self, case: Any) -> Any:
        from moyai.structures.curtain.case.derived import derived_numbers

        return derived_numbers(case)

    def nominal(self, problem: Any) -> Any | None:
        if "statics" not in problem.settings.analyses:
            return None
        return replace(problem, settings=replace(problem.settings, nominal=True))

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.structures.curtain.run import run

        return run(problem, progress)

    def vocabulary(self) -> Vocabulary:
        from moyai.structures.curtain.variables import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.structures.curtain.report.page import compose

        return compose(result)


KIND = CurtainKind()
