"""Submerged members: forces of waves and currents on them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from moyai.core.kinds import StructureKind
from moyai.core.progress import Progress
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class MemberKind(StructureKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "member"
    package = __name__
    templates = (("member", "template.yaml"),)

    def schema(self) -> Any:
        from moyai.structures.member.case.schema import MemberCase

        return MemberCase

    def add_sizes(self, model: Any, sizes: Any, periods: Any) -> None:
        from moyai.structures.member.case.sizes import add_sizes

        add_sizes(model, sizes, periods)

    def criteria(self, model: Any, given: Any) -> Any:
        from moyai.structures.member.case.criteria import criteria

        return criteria(model, given)

    def check(self, model: Any, findings: Any, folder: Path) -> None:
        from moyai.structures.member.case.check import check

        check(model, findings, folder)

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        from moyai.structures.member.case.build import build_problem

        return build_problem(model, folder, case_text=case_text, case_hash=case_hash)

    def derived(self, case: Any) -> Any:
        from moyai.structures.member.case.derived import derived_numbers

        return derived_numbers(case)

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.structures.member.run import run

        return run(problem, progress)

    def vocabulary(self) -> Vocabulary:
        from moyai.structures.member.variables import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.structures.member.report.page import compose

        return compose(result)


KIND = MemberKind()
