"""Report of a fit of a model to measurements."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result


class FitKind(Kind):
    """The page of a fit, imported when it is asked for."""

    name = "fit"
    package = "moyai.study"
    templates = (("fit", "template_fit.yaml"),)

    def file_schema(self, name: str) -> Any:
        from moyai.study.fit_schema import FitFile

        return FitFile

    def compose(self, result: Result) -> Any:
        from moyai.study.report.fit_page import compose

        return compose(result)


KIND = FitKind()
