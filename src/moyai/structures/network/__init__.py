"""Networks of lines and nets in free arrangement: equilibrium, modes, motion in waves and current."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from moyai.core.kinds import StructureKind
from moyai.core.progress import Progress
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class NetworkKind(StructureKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "network"
    package = __name__
    templates = (("network", "template.yaml"),)

    def schema(self) -> Any:
        from moyai.structures.network.case.schema import NetworkCase

        return NetworkCase

    def add_sizes(self, model: Any, sizes: Any, periods: Any) -> None:
        from moyai.structures.network.case.sizes import add_sizes

        add_sizes(model, sizes, periods)

    def keys(self) -> Mapping[str, str]:
        from moyai.structures.network.case.keys import KEYS

        return KEYS

    def criteria(self, model: Any, given: Any) -> Any:
        from moyai.structures.network.case.criteria import criteria

        return criteria(model, given)

    def check(self, model: Any, findings: Any, folder: Path) -> None:
        from moyai.structures.network.case.check import check

        check(model, findings, folder)

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        from moyai.structures.network.case.build import build_problem

        return build_problem(model, folder, case_text=case_text, case_hash=case_hash)

    def derived(self, case: Any) -> Any:
        from moyai.structures.network.case.derived import derived_numbers

        return derived_numbers(case)

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.structures.network.coefficients import coefficients_of_bodies
        from moyai.structures.network.run import run

        return run(problem, progress, coefficients=coefficients_of_bodies(problem))

    def vocabulary(self) -> Vocabulary:
        from moyai.structures.network.variables import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.structures.network.report.page import compose

        return compose(result)


KIND = NetworkKind()
