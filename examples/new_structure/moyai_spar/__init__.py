"""A spar buoy on one chain in a current: the structure that docs/tutorial/add_a_structure.md builds."""

from pathlib import Path
from typing import Any

from moyai.case.criteria import given_criteria, line_criteria
from moyai.case.derived import Number
from moyai.core.kinds import StructureKind
from moyai.core.progress import Progress
from moyai.core.results import Result
from moyai_spar import case, page, run
from moyai_spar.model import SparProblem


class SparKind(StructureKind):
    """The door of the package: what the commands of moyai ask of a structure."""

    name = "spar"
    package = __name__
    templates = (("spar", "template.yaml"),)

    def schema(self) -> type[case.SparCase]:
        return case.SparCase

    def check(self, model: Any, findings: Any, folder: Path) -> None:
        case.check(model, findings)

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> SparProblem:
        return case.build_problem(model, case_text, case_hash)

    def derived(self, loaded: Any) -> Any:
        draught = case.build_problem(loaded.model, "", "").free_draught
        return (Number("spar", "", "draught without the chain", draught, "m"),)

    def criteria(self, model: Any, given: Any) -> Any:
        return (*line_criteria(given, "", "static", ["chain"]), *given_criteria(given))

    def run(self, problem: SparProblem, progress: Progress, keep: Path | None) -> Result:
        return run.run(problem, progress)

    def compose(self, result: Result) -> Any:
        return page.compose(result)


KIND = SparKind()
