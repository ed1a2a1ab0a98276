"""Report of a study."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result


class StudyKind(Kind):
    """The parts of a study that a report needs, each imported when it is asked for."""

    name = "study"
    package = "moyai.study"
    templates = (("study", "template.yaml"),)

    def file_schema(self, name: str) -> Any:
        from moyai.study.schema import StudyFile

        return StudyFile

    def compose(self, result: Result) -> Any:
        from moyai.study.report.page import compose

        return compose(result)


KIND = StudyKind()
