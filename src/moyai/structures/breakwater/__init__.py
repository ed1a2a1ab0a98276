"""Floating breakwaters: their case, model, analyses and report."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.core.kinds import FolderKind, level_of_words
from moyai.core.progress import Progress
from moyai.core.results import Result


class BreakwaterKind(FolderKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "breakwater"
    package = __name__
    templates = (("breakwater", "template.yaml"),)
    drafts = (("statics", "mooring"), ("statics", "frequency"), ("statics", "mooring", "frequency"))
    numbers = (
        ("structure.section.beam", "Beam"),
        ("structure.draught", "Draught"),
        ("structure.mass", "Mass"),
        ("structure.length", "Length of a unit"),
        ("structure.centre_of_gravity_above_keel", "Centre of gravity above keel"),
        ("structure.roll_gyradius", "Gyradius of roll"),
        ("lines[0].segments[0].length", "Line length, first line"),
        ("lines[1].segments[0].length", "Line length, second line"),
        ("lines[0].segments[0].diameter", "Chain diameter, first line"),
        ("lines[0].anchor.x", "Anchor, first line"),
        ("site.water_depth", "Water depth"),
        ("waves[0].height", "Wave height"),
        ("wind.speed", "Wind speed"),
    )
    root_schema = "BreakwaterCase"

    def nominal(self, problem: Any, shown: Collection[str] = ()) -> Any | None:
        breakwater = replace(problem.breakwater, damping=replace(problem.breakwater.damping, band=(1.0, 1.0)))
        settings = problem.settings.model_copy(update={"drift": False})
        operators = not shown or "response" in shown
        return replace(problem, breakwater=breakwater, settings=settings, nominal=True, operators=operators)

    def at_level(self, problem: Any, level: str) -> Any | None:
        names = [name for name, _ in problem.environment.water_levels]
        if len(names) < 2:
            return None
        # the draught may be that of the first level: the others stay known
        return replace(problem, only_level=level_of_words(names, level))

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.core.store import DatasetStore
        from moyai.structures.breakwater.coefficients_file import planar_coefficients
        from moyai.structures.breakwater.run import run

        store = None if keep is None else DatasetStore(keep)
        coefficients, notices = planar_coefficients(problem)
        return run(problem, progress, store=store, coefficients=coefficients, notices=notices)


KIND = BreakwaterKind()
