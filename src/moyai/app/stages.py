"""Which analyses a draft runs: those that are cheap, stage by stage."""

from __future__ import annotations

from dataclasses import replace

from moyai.case.yaml_reader import CaseDocument
from moyai.core.kinds import structure_kind


def stages_of(document: CaseDocument, kind: str) -> list[CaseDocument]:
    """Return a case with its own cheap analyses, stage by stage; where it has none, with the first of its kind.

    Parameters
    ----------
    document : Document
    kind : str
    """
    data = document.data
    known = structure_kind(kind)
    own = data.get("analyses", [name for stage in known.drafts[-1:] for name in stage])
    own = [own] if isinstance(own, str) else list(own)
    found = [[name for name in own if name in stage] for stage in known.drafts]
    chosen = [names for at, names in enumerate(found) if names and names not in found[:at]]
    seas = data.get("waves")
    if known.drafts_of_regular_seas and isinstance(seas, list):
        regular = [sea for sea in seas if isinstance(sea, dict) and sea.get("kind") == "regular"]
        data = {**data, "waves": regular or seas}
    first = [[name] for stage in known.drafts[:1] for name in stage[:1]] or [own[:1]]
    return [replace(document, data={**data, "analyses": names}) for names in chosen or first]
