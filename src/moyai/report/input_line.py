"""One line of the first page: in which water, seas, current and wind the numbers were found, as the case gives them."""

from __future__ import annotations

from typing import Any

from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError
from moyai.core.results import Result

# key: words before its value, unit of a number without one
_SITE = {"water_depth": ("water depth", "m"), "return_period_years": ("return period", "years")}
_WAVES = {
    "significant_height": ("significant height", "m"),
    "height": ("height", "m"),
    "heights": ("heights", "m"),
    "peak_period": ("peak period", "s"),
    "period": ("period", "s"),
    "periods": ("periods", "s"),
    "heading_deg": ("heading", "degrees"),
    "from_bearing_deg": ("from bearing", "degrees"),
    "duration": ("during", "s"),
    "file": ("file", ""),
}
_FLOW = {"speed": ("", "m/s"), "heading_deg": ("heading", "degrees"), "from_bearing_deg": ("from bearing", "degrees")}


def input_line(result: Result) -> str:
    """Return the conditions of a result in one line, with the first signs of the case's hash; empty without a case.

    Parameters
    ----------
    result : Result
    """
    text = str(result.held.attrs.get("case_text", ""))
    try:
        case = parse_yaml(text).data if text.strip() else None
    except CaseError:
        case = None
    if not isinstance(case, dict):
        return ""
    site, waves = case.get("site"), case.get("waves")
    parts = [_said(site, _SITE), _levels(site)]
    seas = waves if isinstance(waves, list) else [] if waves is None else [waves]
    parts += [_sea(sea, number) for number, sea in enumerate(seas, 1)]
    for name in ("current", "wind"):
        words = _said(case.get(name), _FLOW)
        parts.append(f"{name} {words}" if words else "")
    words = "; ".join(part for part in parts if part)
    mark = str(result.held.attrs.get("case_hash", ""))[:8]
    ending = f" Case {mark}." if mark else ""
    return f"Conditions: {words}.{ending}" if words else ""


def _sea(sea: Any, number: int) -> str:
    if not isinstance(sea, dict):
        return ""
    name = sea.get("name", f"sea {number}")
    kind = str(sea.get("kind", "regular")).replace("_", " ")
    return ", ".join(part for part in (f"{name}: {kind}", _said(sea, _WAVES)) if part)


def _levels(site: Any) -> str:
    levels = site.get("water_levels") if isinstance(site, dict) else None
    if not isinstance(levels, dict) or not levels:
        return ""
    return "levels " + ", ".join(f"{name} {_value(level, 'm')}" for name, level in levels.items())


def _said(block: Any, keys: dict[str, tuple[str, str]]) -> str:
    if not isinstance(block, dict):
        return ""
    found = ((words, _value(block[key], unit)) for key, (words, unit) in keys.items() if key in block)
    return ", ".join(f"{words} {value}".strip() for words, value in found if value)


def _value(value: Any, unit: str) -> str:
    if isinstance(value, bool) or value is None:
        return ""
    if isinstance(value, int | float):
        return f"{value:g} {unit}".rstrip()
    if isinstance(value, list):
        ends = [_value(item, unit) for item in value]
        return ", ".join(ends) if len(ends) <= 3 else f"{ends[0]} to {ends[-1]}, {len(ends)} values"
    if isinstance(value, dict):
        ends = [_value(value.get(end), unit) for end in ("from", "to")]
        return " to ".join(ends) if all(ends) else ""
    return str(value)


__all__ = ["input_line"]
