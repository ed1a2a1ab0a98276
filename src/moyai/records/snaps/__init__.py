"""Sets of flume runs in which a slack curtain snaps taut: impact tensions, their similarity numbers, models."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class SnapRunsKind(Kind):
    """The parts of this folder, each imported when it is asked for."""

    name = "snap_runs"
    package = __name__
    templates = (("snaps", "template.yaml"),)

    def file_schema(self, name: str) -> Any:
        from moyai.records.snaps.case.schema import SnapRunsFile

        return SnapRunsFile

    def vocabulary(self) -> Vocabulary:
        from moyai.records.snaps.result import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.records.snaps.report.page import compose

        return compose(result)


KIND = SnapRunsKind()
