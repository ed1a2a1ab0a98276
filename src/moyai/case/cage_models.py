"""The models of a net cage and who checks, builds and sums up each of them.

A further model is one entry here, its schema in the union of :mod:`moyai.case.schema_cage`, its runner in
:mod:`moyai.cage.analysis` and its pages in :mod:`moyai.report.cage_page`.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any


@dataclass(frozen=True)
class CageModel:
    """Where the parts of one model live, as ``module:name``; signatures as in :mod:`moyai.case.structures`."""

    check: str
    build: str
    derived: str


MODELS = {
    "rigid": CageModel(
        check="moyai.case.check_cage_rigid:check",
        build="moyai.case.build_cage_rigid:build_problem",
        derived="moyai.case.derived_cage_rigid:derived_numbers",
    ),
    "flexible": CageModel(
        check="moyai.case.check_cage_flexible:check",
        build="moyai.case.build_cage_flexible:build_problem",
        derived="moyai.case.derived_cage_flexible:derived_numbers",
    ),
}


def part(model: str, name: str) -> Any:
    """Return one part of a model, for instance ``part("rigid", "build")``."""
    module, attribute = getattr(MODELS[model], name).split(":")
    return getattr(import_module(module), attribute)
