"""From the ``criteria`` of a case, and the defaults of its structure, to what its headlines are judged against.

Keys of the block replace the default of the same name; ``criteria: none`` leaves nothing to judge.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

from moyai.case.line_code import code_criteria, code_criterion
from moyai.case.schema_criteria import LineCriteria
from moyai.core.headline import UNCONFIRMED, Criterion, Sense
from moyai.core.kinds import structure_kind

CASE = "case file"
DEFAULT_CODE = "ISO 19901-7"
UPLIFT_SOURCE = (
    f"default of moyai: drag anchors resist no uplift (API RP 2SK, {UNCONFIRMED}); give 'greatest_uplift' for others"
)
"""Of the lines of breakwaters and networks: the factors that are common to ISO 19901-7 and API RP 2SK."""


#: Headline, sense, unit, words of the keys that are a limit in themselves.
_PLAIN: dict[str, tuple[str, Sense, str, str]] = {
    "greatest_offset": ("offset", "at most", "m", "offset"),
    "greatest_roll_deg": ("roll", "at most", "rad", "roll"),
    "greatest_uplift": ("anchor_vertical_tension", "at most", "N", "uplift on the anchors"),
    "greatest_anchor_load": ("anchor_tension", "at most", "N", "load on the anchors"),
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
    "greatest_bending_moment": ("bending_moment", "at most", "N m", "bending moment of the member"),
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
    found = structure_kind(model.structure.kind).criteria(model, given)
    return tuple(criterion for criterion in found if not math.isnan(criterion.limit))


def line_criteria(given: LineCriteria, default: str, analysis: str, names: Iterable[str | None]) -> Iterator[Criterion]:
    """Yield the criterion of the lines: a factor, a code, or the default code.

    Parameters
    ----------
    given : LineCriteria
        Of the case.
    default : str
        Code where the case names neither a factor nor a code; empty for none.
    analysis : str
        How the tensions are found: ``dynamic``, ``quasi_static`` or ``static``; empty leaves it to the run, with one
        criterion for the numbers of either analysis.
    names : iterable of str or None
        What the lines are made of, as :func:`moyai.case.line_code.make_of` gives it.
    """
    factor = given.line_safety_factor
    if factor is not None:
        yield Criterion(
            "line_safety_factor", "line_utilisation", 1.0 / factor, "at most", CASE,
            "factor of safety of the lines", as_factor=True,
        )  # fmt: skip
    elif (given.code or default) and not analysis:
        yield from code_criteria(given.code or default, names, assumed=not given.code)
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
            yield plain_criterion(key, limit, CASE, (headlines or {}).get(key, ""))


def plain_criterion(key: str, limit: float, source: str, headline: str = "") -> Criterion:
    """Return the criterion of a key that is a limit in itself."""
    usual, sense, unit, words = _PLAIN[key]
    value = math.radians(limit) if unit == "rad" else limit
    return Criterion(key, headline or usual, value, sense, source, words, unit, assumed=source != CASE)
