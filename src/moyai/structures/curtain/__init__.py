"""Silt curtains: statics, impact tension, waves, anchor loads, limits."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Any

from moyai.core.kinds import FolderKind


class CurtainKind(FolderKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "curtain"
    package = __name__
    templates = (("curtain", "template.yaml"),)
    drafts = (("statics",), ("impact",), ("statics", "impact"))
    numbers = (
        ("structure.skirt.length", "Depth of the skirt"),
        ("structure.span", "Span"),
        ("structure.length", "Length of the curtain"),
        ("structure.toe.chain_mass", "Chain at the toe"),
        ("structure.skirt.submerged_weight", "Weight of the sheet under water"),
        ("structure.floats.buoyancy", "Buoyancy of the floats"),
        ("structure.drag.coefficient", "Drag coefficient"),
        ("structure.passing_fraction", "Share of flow under the toe"),
    )
    root_schema = "CurtainCase"

    def nominal(self, problem: Any, shown: Collection[str] = ()) -> Any | None:
        if not {"statics", "impact"} & set(problem.settings.analyses):
            return None
        return replace(problem, settings=replace(problem.settings, nominal=True))


KIND = CurtainKind()
