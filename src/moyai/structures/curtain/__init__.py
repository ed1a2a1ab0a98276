"""Silt curtains: statics, impact tension, waves, anchor loads, limits."""

from __future__ import annotations

from moyai.core.kinds import FolderKind


class CurtainKind(FolderKind):
    """The parts of this folder, each imported when it is asked for."""

    name = "curtain"
    package = __name__
    templates = (("curtain", "template.yaml"),)
    root_schema = "CurtainCase"


KIND = CurtainKind()
