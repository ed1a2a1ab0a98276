"""Floating breakwaters: their case, model, analyses and report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from moyai.core.kinds import FolderKind
from moyai.core.progress import Progress
from moyai.core.results import Result


class BreakwaterKind(FolderKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "breakwater"
    package = __name__
    templates = (("breakwater", "template.yaml"),)
    root_schema = "BreakwaterCase"

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.core.store import DatasetStore
        from moyai.structures.breakwater.coefficients_file import planar_coefficients
        from moyai.structures.breakwater.run import run

        store = None if keep is None else DatasetStore(keep)
        coefficients, notices = planar_coefficients(problem)
        return run(problem, progress, store=store, coefficients=coefficients, notices=notices)


KIND = BreakwaterKind()
