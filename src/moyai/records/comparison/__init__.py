"""Measured and computed series laid over each other."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class ComparisonKind(Kind):
    """The parts of this folder, each imported when it is asked for."""

    name = "comparison"
    package = __name__

    def vocabulary(self) -> Vocabulary:
        from moyai.records.comparison.run import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.records.comparison.report.page import compose

        return compose(result)


KIND = ComparisonKind()
