"""Net cages: the rigid cage of small models, flexible cages, their moorings and their analyses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.core.kinds import StructureKind
from moyai.core.progress import Progress
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary, joined


class CageKind(StructureKind):
    """The parts of this folder, each imported when it is asked for; the model of a cage chooses among them."""

    name = "cage"
    package = __name__
    templates = (
        ("cage", "template.yaml"),
        ("rigid_cage", "template_rigid.yaml"),
    )

    def schema(self) -> Any:
        from moyai.structures.cage.case.schema import CageCase

        return CageCase

    def add_sizes(self, model: Any, sizes: Any, periods: Any) -> None:
        from moyai.structures.cage.case.sizes import add_sizes

        add_sizes(model, sizes)

    def criteria(self, model: Any, given: Any) -> Any:
        from moyai.structures.cage.case.criteria import criteria

        return criteria(model, given)

    def check(self, model: Any, findings: Any, folder: Path) -> None:
        from moyai.structures.cage.case.check import check

        check(model, findings, folder)

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        from moyai.structures.cage.case import build_flexible, build_rigid

        build = {"rigid": build_rigid.build_problem, "flexible": build_flexible.build_problem}[model.structure.model]
        return build(model, folder, case_text=case_text, case_hash=case_hash)

    def derived(self, case: Any) -> Any:
        from moyai.structures.cage.case import derived_flexible, derived_rigid

        if case.model.structure.model == "rigid":
            return derived_rigid.derived_numbers(case)
        return derived_flexible.derived_numbers(case)

    def nominal(self, problem: Any) -> Any | None:
        settings = problem.settings
        if "statics" not in settings.analyses or not hasattr(settings, "other_laws"):
            return None
        return replace(problem, settings=replace(settings, current_speeds=(), other_laws=False))

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.structures.cage.run import run

        return run(problem, progress)

    def vocabulary(self) -> Vocabulary:
        return joined("cage", _vocabularies().values())

    def vocabulary_of(self, root: Mapping[Any, Any]) -> Vocabulary:
        return _vocabularies().get(str(root.get("cage_model", "")), self.vocabulary())

    def compose(self, result: Result) -> Any:
        from moyai.structures.cage.report.page import compose

        return compose(result)


def _vocabularies() -> dict[str, Vocabulary]:
    from moyai.structures.cage.flexible.variables import VOCABULARY as FLEXIBLE
    from moyai.structures.cage.rigid.variables import VOCABULARY as RIGID

    return {"rigid": RIGID, "flexible": FLEXIBLE}


KIND = CageKind()
