"""Net cages: the rigid cage of small models, flexible cages, their moorings and their analyses."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.core.kinds import FolderKind
from moyai.core.vocabulary import Vocabulary, joined


class CageKind(FolderKind):
    """The parts of this folder, each imported when it is asked for; the model of a cage chooses among them."""

    name = "cage"
    package = __name__
    templates = (
        ("cage", "template.yaml"),
        ("rigid_cage", "template_rigid.yaml"),
    )
    drafts = (("statics",),)
    numbers = (
        ("structure.size", "Diameter or side"),
        ("structure.net.wall_depth", "Depth of the net wall"),
        ("structure.net.cone_depth", "Depth of the cone"),
        ("structure.net.twine_diameter", "Twine diameter"),
        ("structure.net.mesh_pitch", "Mesh pitch"),
        ("structure.net.aperture", "Aperture"),
        ("structure.sinkers.mass", "Mass of a sinker"),
        ("structure.mooring.anchor_distance", "Anchor distance"),
        ("structure.mooring.anchor_line[0].length", "Rope of the anchor line"),
        ("structure.mooring.pull_down", "Pull down"),
        ("structure.mooring.stiffness", "Stiffness of a line"),
        ("structure.weight.mass", "Mass as weighed"),
    )
    root_schema = "CageCase"

    def build(self, model: Any, folder: Path, *, case_text: str, case_hash: str) -> Any:
        from moyai.structures.cage.case import build_flexible, build_rigid

        build = {"rigid": build_rigid.build_problem, "flexible": build_flexible.build_problem}[model.structure.model]
        return build(model, folder, case_text=case_text, case_hash=case_hash)

    def derived(self, case: Any) -> Any:
        from moyai.structures.cage.case import derived_flexible, derived_rigid

        if case.model.structure.model == "rigid":
            return derived_rigid.derived_numbers(case)
        return derived_flexible.derived_numbers(case)

    def nominal(self, problem: Any, shown: Collection[str] = ()) -> Any | None:
        settings = problem.settings
        if "statics" not in settings.analyses or not hasattr(settings, "other_laws"):
            return None
        return replace(problem, settings=replace(settings, current_speeds=(), other_laws=False, nominal=True))

    def vocabulary(self) -> Vocabulary:
        return joined("cage", _vocabularies().values())

    def vocabulary_of(self, root: Mapping[Any, Any]) -> Vocabulary:
        return _vocabularies().get(str(root.get("cage_model", "")), self.vocabulary())


def _vocabularies() -> dict[str, Vocabulary]:
    from moyai.structures.cage.flexible.variables import VOCABULARY as FLEXIBLE
    from moyai.structures.cage.rigid.variables import VOCABULARY as RIGID

    return {"rigid": RIGID, "flexible": FLEXIBLE}


KIND = CageKind()
