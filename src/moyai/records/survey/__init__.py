"""Field surveys and flume records: waves, currents, tensions, motions by blocks."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class SurveyKind(Kind):
    """The parts of this folder, each imported when it is asked for."""

    name = "records"
    package = __name__
    templates = (("records", "template.yaml"),)

    def file_schema(self, name: str) -> Any:
        from moyai.records.survey.case.schema import RecordsFile

        return RecordsFile

    def vocabulary(self) -> Vocabulary:
        from moyai.records.survey.variables import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.records.survey.report.page import compose

        return compose(result)


KIND = SurveyKind()
