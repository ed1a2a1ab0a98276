"""Submerged members: forces of waves and currents on them."""

from __future__ import annotations

from moyai.core.kinds import FolderKind


class MemberKind(FolderKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "member"
    package = __name__
    templates = (("member", "template.yaml"),)
    drafts = (("forces",), ("sweep", "forces", "surface"))
    drafts_of_regular_seas = True
    numbers = (
        ("structure.section.diameter", "Diameter"),
        ("structure.section.side", "Side"),
        ("structure.section.width", "Width"),
        ("structure.section.height", "Height of the section"),
        ("structure.start.z", "Level of the start"),
        ("structure.end.z", "Level of the end"),
        ("structure.section_angle_deg", "Turn of the section"),
        ("structure.drag.roughness", "Roughness"),
    )
    root_schema = "MemberCase"


KIND = MemberKind()
