"""Records of forces on members: identified coefficients and circulation."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class ForceRecordKind(Kind):
    """The parts of this folder, each imported when it is asked for."""

    name = "force_record"
    package = __name__
    templates = (("forces", "template.yaml"),)

    def file_schema(self, name: str) -> Any:
        from moyai.records.forces.case.schema import ForceRecordFile

        return ForceRecordFile

    def vocabulary(self) -> Vocabulary:
        from moyai.records.forces.result import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.records.forces.report.page import compose

        return compose(result)


KIND = ForceRecordKind()
