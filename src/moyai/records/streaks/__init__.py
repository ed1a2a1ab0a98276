"""Streak images: camera, streaks, drift velocity, circulation."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class StreaksKind(Kind):
    """The parts of this folder, each imported when it is asked for."""

    name = "streaks"
    package = __name__
    templates = (("streaks", "template.yaml"),)

    def file_schema(self, name: str) -> Any:
        from moyai.records.streaks.case.schema import StreaksFile

        return StreaksFile

    def vocabulary(self) -> Vocabulary:
        from moyai.records.streaks.variables import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.records.streaks.report.page import compose

        return compose(result)


KIND = StreaksKind()
