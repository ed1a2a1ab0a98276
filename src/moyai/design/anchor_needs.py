"""What an anchor must hold: the factor on the pull of a line, and the sinker that would do, in words.

Theory in docs/theory/design_checks.md.
"""

from __future__ import annotations

from dataclasses import dataclass

from moyai.core.headline import Band
from moyai.core.wording import kilonewton
from moyai.mooring.anchors import gravity_anchor_weight
from moyai.tables.design_codes import anchor_factor, holding_data

#: For which the weight of a sinker is shown.
SINKER = ("concrete", "sand")


@dataclass(frozen=True)
class AnchorNeed:
    """What the largest pull of a line asks of its anchor."""

    #: On the horizontal pull.
    factor: float
    #: Which anchors hold, with factors and the weight of a sinker.
    words: str


def judged_end(value: float, band: Band | None) -> float:
    """Return the end of a band at which criteria are judged, for which an anchor is bought."""
    if band is None:
        return max(value, 0.0)
    return max(value, band.high if band.decides else value if band.judged is None else band.judged[1], 0.0)


def sinker_weight(horizontal: float, uplift: float) -> float:
    """Return the weight in water of the sinker that is shown, for pull and uplift at its anchor [N]."""
    level_factor, up_factor = anchor_factor("gravity_anchor", "horizontal"), anchor_factor("gravity_anchor", "vertical")
    friction = holding_data("sinker", *SINKER).value
    return gravity_anchor_weight(horizontal, uplift, friction, level_factor.value, up_factor.value)


def anchor_need(uplift: float, grounded: float, sinker: float, of: str = "") -> AnchorNeed:
    """Return what an anchor needs at the largest pull of its line.

    Parameters
    ----------
    uplift : float
        On the anchor [N]; where there is none a drag anchor holds.
    grounded : float
        Length of line on the bed [m].
    sinker : float
        Weight in water of the heaviest sinker that any line requires, at the unfavourable end of pull and uplift [N].
    of : str
        Which line that is, where it is another one.
    """
    drag, level_factor = anchor_factor("drag_anchor", "horizontal"), anchor_factor("gravity_anchor", "horizontal")
    up_factor, friction = anchor_factor("gravity_anchor", "vertical"), holding_data("sinker", *SINKER)
    lies = grounded > 0.0 and uplift <= 0.0
    bed = f"{grounded:.3g} m of line left on the bed" if lies else "no line left on the bed"
    heavy = (
        f"a concrete sinker of {kilonewton(sinker)} in water" + f" at line {of}" * bool(of) + f" (friction "
        f"{friction.value:g} on {SINKER[1]}, factors {level_factor.value:g} and {up_factor.value:g}, at the upper end "
        "of pull and uplift)"
    )
    # where the anchor is lifted no drag anchor serves: the factor is that of anchors that hold by weight or as a pile
    factor = drag if uplift <= 0.0 else level_factor
    confirmed = "confirmed" if factor.confirmed else "not confirmed against it"
    asked = f"{factor.value:g} times the pull of one line ({factor.source}, {confirmed})"
    words = (
        f"{asked}; {bed} at the peak; or {heavy}"
        if uplift <= 0.0
        else f"not a drag anchor, {bed} at the peak: {heavy}, or a pile; {asked}"
    )
    return AnchorNeed(factor.value, words)
