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
    return max(value, 0.0) if band is None or band.judged is None else max(value, band.judged[1], 0.0)


def anchor_need(uplift: float, grounded: float, judged: tuple[float, float]) -> AnchorNeed:
    """Return what an anchor needs at the largest pull of its line.

    Parameters
    ----------
    uplift : float
        On the anchor [N]; where there is none a drag anchor holds.
    grounded : float
        Length of line on the bed [m].
    judged : tuple of two float
        Horizontal pull and uplift at the unfavourable end of their bands [N]: a sinker is bought for these.
    """
    drag, level_factor = anchor_factor("drag_anchor", "horizontal"), anchor_factor("gravity_anchor", "horizontal")
    up_factor, friction = anchor_factor("gravity_anchor", "vertical"), holding_data("sinker", *SINKER)
    weight = gravity_anchor_weight(*judged, friction.value, level_factor.value, up_factor.value)
    lies = grounded > 0.0 and uplift <= 0.0
    bed = f"{grounded:.3g} m of line left on the bed" if lies else "no line left on the bed"
    sinker = (
        f"a concrete sinker of {kilonewton(weight)} in water (friction {friction.value:g} on {SINKER[1]}, factors "
        f"{level_factor.value:g} and {up_factor.value:g}, at the upper end of pull and uplift)"
    )
    # where the anchor is lifted no drag anchor serves: the factor is that of anchors that hold by weight or as a pile
    factor = drag if uplift <= 0.0 else level_factor
    confirmed = "confirmed" if factor.confirmed else "not confirmed against it"
    asked = f"{factor.value:g} times the pull of one line ({factor.source}, {confirmed})"
    words = (
        f"{asked}; {bed} at the peak; or {sinker}"
        if uplift <= 0.0
        else f"not a drag anchor, {bed} at the peak: {sinker}, or a pile; {asked}"
    )
    return AnchorNeed(factor.value, words)
