"""Floating breakwaters of several units: their case, model, analyses and report."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.core.kinds import FolderKind
from moyai.core.progress import Progress
from moyai.core.results import Result


class UnitsKind(FolderKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "units"
    package = __name__
    templates = (("units", "template.yaml"),)
    root_schema = "UnitsCase"

    def nominal(self, problem: Any, shown: Collection[str] = ()) -> Any | None:
        if "frequency" not in problem.settings.analyses:
            return None
        return replace(problem, settings=replace(problem.settings, nominal=True))

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.core.store import DatasetStore
        from moyai.structures.units.run import run

        return run(problem, progress, store=None if keep is None else DatasetStore(keep))


KIND = UnitsKind()
