"""Which analyses a draft runs: those that are cheap, stage by stage."""

from __future__ import annotations

from dataclasses import replace

from moyai.case.yaml_reader import Document

CHEAP: dict[str, tuple[tuple[str, ...], ...]] = {
    "breakwater": (("statics", "mooring"), ("statics", "frequency"), ("statics", "mooring", "frequency")),
    "curtain": (("statics",), ("impact",), ("statics", "impact")),
    "cage": (("statics",),),
    "network": (("statics",),),
    "units": (("statics",), ("statics", "frequency")),
    "member": (("forces",), ("sweep", "forces", "surface")),
}
"""Analyses of a draft by kind, of those of the case: the first that give what is on the screen, then the last."""
REGULAR_ONLY = ("member",)
"""Kinds whose drafts leave irregular seas out, where there are regular ones."""


def stages_of(document: Document, kind: str, analyses: tuple[str, ...] = ()) -> list[Document]:
    """Return a case with its own cheap analyses, stage by stage; where it has none, with the first of its kind.

    Parameters
    ----------
    document : Document
    kind : str
    analyses : tuple of str
        Taken in place of the cheap ones, with all seas.
    """
    data = document.data
    if analyses:
        return [replace(document, data={**data, "analyses": list(analyses)})]
    stages = CHEAP.get(kind, ())
    own = data.get("analyses", [name for stage in stages[-1:] for name in stage])
    own = [own] if isinstance(own, str) else list(own)
    chosen: list[list[str]] = []
    for stage in stages:
        names = [name for name in own if name in stage]
        if names and names not in chosen:
            chosen.append(names)
    if not chosen:
        chosen = [[stages[0][0]]] if stages else [own[:1]]
    if kind in REGULAR_ONLY and isinstance(data.get("waves"), list):
        regular = [sea for sea in data["waves"] if isinstance(sea, dict) and sea.get("kind") == "regular"]
        data = {**data, "waves": regular or data["waves"]}
    return [replace(document, data={**data, "analyses": names}) for names in chosen]
