"""Measured and computed series laid over each other."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result


class ComparisonKind(Kind):
    """The parts of this folder, each imported when it is asked for."""

    name = "comparison"
    package = __name__

    def compose(self, result: Result) -> Any:
        from moyai.records.comparison.report.page import compose

        return compose(result)


KIND = ComparisonKind()
