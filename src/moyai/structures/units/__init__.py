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
    drafts = (("statics",), ("statics", "frequency"))
    numbers = (
        ("structure.centre_of_gravity_above_keel", "Centre of gravity above keel"),
        ("structure.roll_gyradius", "Gyradius of roll"),
        ("structure.pitch_gyradius", "Gyradius of pitch"),
        ("structure.damping.fraction_of_critical", "Damping, share of critical"),
        ("structure.connectors[0].above_keel", "Height of the first connector"),
        ("structure.connectors[0].stiffness", "Stiffness of the first connector"),
        ("structure.connectors[0].slack", "Slack of the first connector"),
        ("lines[0].segments[0].length", "Line length, first line"),
        ("lines[0].segments[0].diameter", "Chain diameter, first line"),
        ("structure.section.beam", "Beam"),
        ("structure.draught", "Draught"),
        ("site.water_depth", "Water depth"),
        ("wind.speed", "Wind speed"),
    )
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
