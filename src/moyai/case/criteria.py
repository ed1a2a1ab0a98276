"""From the ``criteria`` of a case, and the defaults of its structure, to what its headlines are judged against.

Keys of the block replace the default of the same name; ``criteria: none`` leaves nothing to judge.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from moyai.case.line_code import code_criterion
from moyai.case.schema_criteria import LineCriteria
from moyai.core.errors import InputError
from moyai.core.headline import Criterion, Sense
from moyai.core.kinds import structure_kind

CASE = "case file"
UNCONFIRMED = "not confirmed against the standard"
DEFAULT_CODE = "ISO 19901-7"
"""Of the lines of breakwaters and networks: the factors that are common to ISO 19901-7 and API RP 2SK."""
CAGE_CODE = "NS 9415"
CURTAIN_SOURCE = "default of moyai: practice of silt curtains, rope 3, sheet and belts 3 to 5, anchor 1.2 to 2; no code"
UPLIFT_SOURCE = (
    f"default of moyai: drag anchors bear no uplift (API RP 2SK, {UNCONFIRMED}); give 'greatest_uplift' for others"
)
AFLOAT_SOURCE = "default of moyai: upright and afloat"

CURTAIN_FACTORS = {
    "cable": ("cable_utilisation", "factor of safety of the cables", 3.0),
    "sheet": ("fabric_utilisation", "factor of safety of the sheet", 4.0),
    "joint": ("joint_utilisation", "factor of safety of the joints", 3.0),
    "anchor_line": ("anchor_line_utilisation", "factor of safety of the anchor lines", 3.0),
    "anchor": ("anchor_utilisation", "factor of safety of the anchors", 1.5),
}
"""Of ``settings.safety_factors``: headline, words, default."""
_CURTAIN_KEYS = {"sheet": "fabric_safety_factor"}

#: Headline, sense, unit, words of the keys that are a limit in themselves.
_PLAIN: dict[str, tuple[str, Sense, str, str]] = {
    "greatest_offset": ("offset", "at most", "m", "offset"),
    "greatest_roll_deg": ("roll", "at most", "rad", "roll"),
    "greatest_uplift": ("anchor_uplift", "at most", "N", "uplift on the anchors"),
    "greatest_anchor_load": ("anchor_load", "at most", "N", "load on the anchors"),
    "least_freeboard": ("freeboard", "at least", "m", "freeboard"),
    "least_metacentric_height": ("metacentric_height", "at least", "m", "metacentric height"),
    "least_toe_clearance": ("toe_clearance", "at least", "m", "toe clearance"),
    "least_limit_current": ("limit_current", "at least", "m/s", "current that it holds in"),
    "least_limit_wave_height": ("limit_wave_height", "at least", "m", "wave height that it holds in"),
    "least_volume_left": ("volume_left", "at least", "%", "volume left"),
    "greatest_drag": ("drag", "at most", "N", "drag"),
    "greatest_net_tension": ("net_tension", "at most", "N/m", "tension of the net"),
    "greatest_tension": ("line_tension", "at most", "N", "tension of the lines"),
    "greatest_force": ("peak_force", "at most", "N", "force on the member"),
}


def criteria_of(model: Any) -> tuple[Criterion, ...]:
    """Return what the headlines of a case are judged against.

    Parameters
    ----------
    model : Block
        Validated content of a case of any structure.

    Raises
    ------
    InputError
        When a design code has no value for the lines, or two places of the case contradict each other.
    """
    given = getattr(model, "criteria", "none")
    if isinstance(given, str):
        return ()
    kind = model.structure.kind
    found = _OF_STRUCTURE[kind](model, given) if kind in _OF_STRUCTURE else structure_kind(kind).criteria(model)
    return tuple(criterion for criterion in found if not math.isnan(criterion.limit))


def _breakwater(model: Any, given: Any) -> Iterator[Criterion]:
    moored = [line for line in model.lines if line.kind == "catenary"]
    moving = bool(moored) and "time" in model.analyses and all(line.dynamic is True for line in moored)
    yield from line_criteria(
        given,
        DEFAULT_CODE if moored else "",
        "dynamic" if moving else "quasi_static",
        [getattr(part, "catalogue", None) for line in moored for part in line.segments if not hasattr(part, "clump")],
    )
    if given.greatest_uplift is None and moored:
        yield _plain("greatest_uplift", 0.0, UPLIFT_SOURCE)
    yield from given_criteria(given, {"greatest_anchor_load": "anchor_horizontal_load"})
    yield from _transmission(given.greatest_transmission)
    for key in ("least_metacentric_height", "least_freeboard"):
        if getattr(given, key) is None and "statics" in model.analyses:
            yield _plain(key, 0.0, AFLOAT_SOURCE)


def _transmission(limit: Any) -> Iterator[Criterion]:
    seas = limit if isinstance(limit, dict) else {} if limit is None else {"": limit}
    for sea, value in seas.items():
        yield Criterion("greatest_transmission", "transmission", value, "at most", CASE, "transmission K_T", sea=sea)


def _curtain(model: Any, given: Any) -> Iterator[Criterion]:
    for part, (headline, words, _) in CURTAIN_FACTORS.items():
        factor, source = curtain_factor(model, part)
        if source != CASE and not _has_strength(model.structure, part):
            continue
        yield Criterion(
            curtain_key(part), headline, 1.0 / factor, "at most", source, words, as_factor=True, assumed=source != CASE
        )
    for key, headline, unit, words in (
        ("least_effective_depth", "effective_depth", "m", "effective depth"),
        ("least_float_reserve", "float_reserve", "%", "reserve of the floats"),
    ):
        limit = curtain_limit(model, key)
        if limit > 0.0:
            yield Criterion(key, headline, limit, "at least", CASE, words, unit)
    yield from given_criteria(given)


def curtain_key(part: str) -> str:
    """Return the key of ``criteria`` that says the same as ``settings.safety_factors.<part>``."""
    return _CURTAIN_KEYS.get(part, f"{part}_safety_factor")


def curtain_factor(model: Any, part: str) -> tuple[float, str]:
    """Return a factor of safety of a curtain (NaN where it is not judged) and its source.

    Parameters
    ----------
    model : CurtainCase
    part : str
        Key of ``settings.safety_factors``.
    """
    if isinstance(model.criteria, str):
        asked = None
    else:
        asked = getattr(model.criteria, curtain_key(part))
    old = getattr(model.settings.safety_factors, part)
    if asked is not None and old is not None and asked != old:
        raise InputError(
            f"'{curtain_key(part)}' and 'settings.safety_factors.{part}' ({old:g}) say the same thing differently",
            path=f"criteria.{curtain_key(part)}",
            remedy="keep one of them",
        )
    if asked is not None or old is not None:
        return (asked if asked is not None else old), CASE
    return CURTAIN_FACTORS[part][2], CURTAIN_SOURCE


def curtain_limit(model: Any, key: str) -> float:
    """Return ``least_effective_depth`` [m] or ``least_float_reserve`` [-] from either of their places; 0 for none."""
    old = float(getattr(model.settings, key))
    asked = None if isinstance(model.criteria, str) else getattr(model.criteria, key)
    if asked is None or math.isnan(asked):
        return old if asked is None else 0.0
    if old > 0.0 and old != asked:
        raise InputError(
            f"'{key}' is {old:g} under 'settings' and {asked:g} here",
            path=f"criteria.{key}",
            remedy="keep one of them",
        )
    return float(asked)


def _has_strength(unit: Any, part: str) -> bool:
    if part == "cable":
        cables = [cable for cable in (unit.cables.upper, unit.cables.lower) if cable is not None]
        return any(cable.breaking_load is not None or cable.catalogue is not None for cable in cables)
    value = {
        "sheet": unit.skirt.strength,
        "joint": getattr(unit.joints, "strength", None),
        "anchor_line": getattr(unit.anchors, "breaking_load", None),
        "anchor": getattr(unit.anchors, "holding_force", None),
    }[part]
    return value is not None


def _cage(model: Any, given: Any) -> Iterator[Criterion]:
    mooring = model.structure.mooring
    ropes: list[Any] = []
    if getattr(mooring, "kind", "") == "grid":
        ropes = [mooring.frame_rope, mooring.bridle, *mooring.anchor_line]
    elif getattr(mooring, "breaking_load", None) is not None:
        ropes = [mooring]
    yield from line_criteria(
        given,
        CAGE_CODE if ropes else "",
        "dynamic" if "time" in model.analyses else "static",
        [getattr(rope, "catalogue", None) or "rope" for rope in ropes],
    )
    yield from given_criteria(given)


def _network(model: Any, given: Any) -> Iterator[Criterion]:
    types = model.structure.line_types.values()
    strong = [kind for kind in types if getattr(kind, "catalogue", None) or getattr(kind, "breaking_load", None)]
    yield from line_criteria(
        given,
        DEFAULT_CODE if strong else "",
        "dynamic" if "dynamic" in model.analyses else "quasi_static",
        [getattr(kind, "catalogue", None) for kind in types],
    )
    yield from given_criteria(given)


def _member(model: Any, given: Any) -> Iterator[Criterion]:
    yield from given_criteria(given)


def line_criteria(given: LineCriteria, default: str, analysis: str, names: Iterable[str | None]) -> Iterator[Criterion]:
    """Yield the criterion of the lines: a factor, a code, or the default code.

    Parameters
    ----------
    given : LineCriteria
        Of the case.
    default : str
        Code where the case names neither a factor nor a code; empty for none.
    analysis : str
        How the tensions are found: ``dynamic``, ``quasi_static`` or ``static``.
    names : iterable of str or None
        Materials of the lines in the catalogue.
    """
    factor = given.line_safety_factor
    if factor is not None:
        yield Criterion(
            "line_safety_factor", "line_utilisation", 1.0 / factor, "at most", CASE,
            "factor of safety of the lines", as_factor=True,
        )  # fmt: skip
    elif given.code or default:
        yield code_criterion(given.code or default, analysis, names, assumed=not given.code)


def given_criteria(given: Any, headlines: dict[str, str] | None = None) -> Iterator[Criterion]:
    """Yield the criteria of the keys that are a limit in themselves, as the case gives them.

    Parameters
    ----------
    given : Block
        The ``criteria`` of the case; of its keys those that every structure shares, ``greatest_offset`` and the like.
    headlines : dict of str to str, optional
        Name of the headline by the key, where it is not the usual one.
    """
    for key in type(given).model_fields:
        limit = getattr(given, key)
        if key in _PLAIN and limit is not None:
            yield _plain(key, limit, CASE, (headlines or {}).get(key, ""))


def _plain(key: str, limit: float, source: str, headline: str = "") -> Criterion:
    usual, sense, unit, words = _PLAIN[key]
    value = math.radians(limit) if unit == "rad" else limit
    return Criterion(key, headline or usual, value, sense, source, words, unit, assumed=source != CASE)


_OF_STRUCTURE: dict[str, Callable[[Any, Any], Iterator[Criterion]]] = {
    "breakwater": _breakwater,
    "curtain": _curtain,
    "cage": _cage,
    "network": _network,
    "member": _member,
}
