"""The governing load of every component: the steady load with what the hierarchy of models lets count."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from moyai.structures.curtain.hierarchy import CREST, CYCLES, ENERGY, IMPACT, ModelRole, Role, role_of

#: Beginning of the words of a source in the load table, and the model behind it
_SOURCES = {
    "drag under the crest": CREST,
    "energy model": ENERGY,
    "slack and taut cycles": CYCLES,
    "impact": IMPACT,
}

#: What governs where the load in a weaker current than that of the case is the larger one
WEAKER = "in a weaker current"

Row = Mapping[str, float | str]


def model_of(source: str) -> str:
    """Return the model of the hierarchy that a source of the load table belongs to; empty for none."""
    return next((model for words, model in _SOURCES.items() if source.startswith(words)), "")


def governing_load(row: Row, roles: Iterable[ModelRole]) -> dict[str, float | str]:
    """Return ``governing_load``, ``governing`` and ``load_bound`` of a component [eq:curtain-hierarchy].

    The whole span includes current, waves and snaps together, so nothing is added, and it governs where it was run.
    Otherwise the larger of wave and impact is added to the steady load; where the model behind it is only a bound, the
    load is one too. A component that the whole span does not give keeps the bound of the others.

    Parameters
    ----------
    row : mapping
        ``component``, ``steady_load``, ``wave_load``, ``impact_load``, ``dynamic_load`` [N or N/m], their sources.
    roles : iterable of ModelRole
    """
    known = tuple(roles)
    steady, moved = float(row["steady_load"]), float(row["dynamic_load"])
    if math.isfinite(moved):
        if steady > moved:
            return {"governing_load": steady, "governing": "steady", "load_bound": ""}
        return {"governing_load": moved, "governing": "dynamic", "load_bound": ""}
    if math.isnan(steady):
        return {"governing_load": math.nan, "governing": "", "load_bound": ""}
    # what dips for an instant comes up again: floats are judged at rest
    added = {} if row["component"] == "float" else {"wave": row["wave_load"], "impact": row["impact_load"]}
    counted = {name: float(value) for name, value in added.items() if float(value) > 0.0}
    if "impact" in counted and role_of(known, model_of(str(row["impact_source"]))) == "bound":
        # a bound stands at its upper end, whatever a value comes to
        counted["impact"] = max(counted["impact"], float(row.get("impact_high", counted["impact"])))
    what, more = max(counted.items(), key=lambda item: item[1], default=("", 0.0))
    # a snap that is run and loads the component in a way that the data do not show leaves a bound from below
    missing = "at least" if any(math.isnan(float(value)) for value in added.values()) else ""
    if not what:
        return {"governing_load": steady, "governing": "steady", "load_bound": missing}
    role: Role = role_of(known, model_of(str(row[f"{what}_source"])))
    return {
        "governing_load": steady + more,
        "governing": f"steady and {what}",
        "load_bound": missing or ("" if role == "governs" else "at most"),
    }


__all__ = ["WEAKER", "governing_load", "model_of"]
