"""Tests of net panels: towing, towing through waves, waves alone."""

from __future__ import annotations

from typing import Any

from moyai.core.kinds import Kind
from moyai.core.results import Result
from moyai.core.vocabulary import Vocabulary


class NetTestsKind(Kind):
    """The parts of this folder, each imported when it is asked for."""

    name = "nets"
    package = __name__
    templates = (("nets", "template.yaml"),)

    def file_schema(self, name: str) -> Any:
        from moyai.records.nets.case.schema import NetsFile

        return NetsFile

    def vocabulary(self) -> Vocabulary:
        from moyai.records.nets.result import VOCABULARY

        return VOCABULARY

    def compose(self, result: Result) -> Any:
        from moyai.records.nets.report.page import compose

        return compose(result)


KIND = NetTestsKind()
