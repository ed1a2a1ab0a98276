"""Floating breakwaters of several units: their case, model, analyses and report."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from moyai.core.kinds import StructureKind
from moyai.core.progress import Progress
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class UnitsKind(StructureKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "units"
    package = __name__
    templates = (("units", "template.yaml"),)

    def schema(self) -> Any:
        from moyai.structures.units.case.schema import UnitsCase

        return UnitsCase

    def add_sizes(self, model: Any, sizes: Any, periods: Any) -> None:
        from moyai.structures.units.case.sizes import add_sizes

        add_sizes(model, sizes)

    def keys(self) -> Mapping[str, str]:
        from moyai.structures.units.case.keys import KEYS

        return KEYS

    def criteria(self, model: Any, given: Any) -> Any:
        from moyai.structures.units.case.criteria import criteria

        return criteria(model, given)

    def check(self, model: Any, findings: Any, folder: Path) -> None:
        from moyai.structures.units.case.check import check

        check(model, findings, folder)

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        from moyai.structures.units.case.build import build_problem

        return build_problem(model, folder, case_text=case_text, case_hash=case_hash)

    def derived(self, case: Any) -> Any:
        from moyai.structures.units.case.derived import derived_numbers

        return derived_numbers(case)

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.core.store import DatasetStore
        from moyai.structures.units.run import run

        return run(problem, progress, store=None if keep is None else DatasetStore(keep))

    def vocabulary(self) -> Vocabulary:
        from moyai.structures.units.variables import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.structures.units.report.page import compose

        return compose(result)


KIND = UnitsKind()
