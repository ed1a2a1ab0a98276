"""Networks of lines and nets in free arrangement: equilibrium, modes, motion in waves and current."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from moyai.core.kinds import FolderKind
from moyai.core.progress import Progress
from moyai.core.results import Result


class NetworkKind(FolderKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "network"
    package = __name__
    templates = (("network", "template.yaml"),)
    drafts = (("statics",),)
    numbers = (
        ("structure.points.buoy.diameter", "Diameter of the buoy"),
        ("structure.points.buoy.mass", "Mass of the buoy"),
        ("structure.lines.mooring.length", "Length of the line"),
        ("structure.line_types.chain.diameter", "Diameter of the chain"),
    )
    root_schema = "NetworkCase"

    def run(self, problem: Any, progress: Progress, keep: Path | None) -> Result:
        from moyai.structures.network.coefficients import coefficients_of_bodies
        from moyai.structures.network.run import run

        return run(problem, progress, coefficients=coefficients_of_bodies(problem))


KIND = NetworkKind()
