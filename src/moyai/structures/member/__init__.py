"""Submerged members: forces of waves and currents on them."""

from __future__ import annotations

from moyai.core.kinds import FolderKind


class MemberKind(FolderKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "member"
    package = __name__
    templates = (("member", "template.yaml"),)
    root_schema = "MemberCase"


KIND = MemberKind()
