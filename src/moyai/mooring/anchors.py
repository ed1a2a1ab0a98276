"""Anchors: sinkers by weight and friction, drag anchors by holding power.

Theory in docs/theory/design_checks.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.core.validity import Notice


@dataclass(frozen=True)
class Sinker:
    """A weight on the bed.

    Examples
    --------
    >>> from moyai.mooring import Sinker, check_sinker
    >>> sinker = Sinker(submerged_weight=50e3, friction=0.6, safety_factor=1.5)
    >>> check_sinker(sinker, horizontal=10e3, uplift=5e3).passed         # 0.6 (50 - 5) kN over 10 kN is above 1.5
    True
    """

    #: [N]
    submerged_weight: float
    #: Coefficient on the bed.
    friction: float
    #: Against sliding and lifting.
    safety_factor: float

    def __post_init__(self) -> None:
        for name in ("submerged_weight", "friction", "safety_factor"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{name} is {getattr(self, name):g}", parameter=f"anchor.{name}", allowed="above 0")


@dataclass(frozen=True)
class DragAnchor:
    """An anchor that digs in.

    Examples
    --------
    >>> from moyai.mooring import DragAnchor
    >>> anchor = DragAnchor(weight=20e3, holding_power=5.0, safety_factor=1.5)
    >>> anchor.weight * anchor.holding_power                             # holding capacity [N]
    100000.0
    """

    #: In air [N].
    weight: float
    #: Horizontal holding over weight.
    holding_power: float
    safety_factor: float

    def __post_init__(self) -> None:
        for name in ("weight", "holding_power", "safety_factor"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{name} is {getattr(self, name):g}", parameter=f"anchor.{name}", allowed="above 0")


@dataclass(frozen=True)
class AnchorCheck:
    """Outcome of an anchor."""

    #: Utilisation against sliding [-]; above 1 fails.
    sliding: float
    #: Utilisation against lifting [-]; above 1 fails.
    lifting: float
    notices: tuple[Notice, ...] = ()

    @property
    def utilisation(self) -> float:
        """The larger of both [-]."""
        return max(self.sliding, self.lifting)

    @property
    def passed(self) -> bool:
        """Whether the anchor holds."""
        return bool(self.utilisation <= 1.0)


def check_sinker(sinker: Sinker, horizontal: float, uplift: float) -> AnchorCheck:
    """Compare a sinker with the pull of its line [eq:checks-sinker].

    Parameters
    ----------
    sinker : Sinker
        Weight in water [N], friction on the bed and safety factor [-].
    horizontal, uplift : float
        Parts of the pull at the anchor [N].

    Returns
    -------
    AnchorCheck
        Utilisation against sliding and lifting; the uplift is taken off the weight on the bed.

    Examples
    --------
    >>> from moyai.mooring import check_sinker
    >>> from moyai.mooring.anchors import Sinker
    >>> found = check_sinker(Sinker(submerged_weight=1e5, friction=0.5, safety_factor=1.2), horizontal=2e4, uplift=1e4)
    >>> round(found.sliding, 3), round(found.lifting, 2), found.passed   # 1.2 x 2e4 / (0.5 x 8.8e4)
    (0.545, 0.12, True)
    """
    factor, up = sinker.safety_factor, max(uplift, 0.0)
    resting = sinker.submerged_weight - factor * up
    sliding = math.inf if resting <= 0.0 else factor * abs(horizontal) / (sinker.friction * resting)
    return AnchorCheck(sliding, factor * up / sinker.submerged_weight)


def check_drag_anchor(anchor: DragAnchor, horizontal: float, uplift: float) -> AnchorCheck:
    """Compare a drag anchor with the pull of its line [eq:checks-drag-anchor].

    Notices report any uplift: such anchors are not made for it.

    Parameters
    ----------
    anchor : DragAnchor
        Weight in air [N], holding power and safety factor [-].
    horizontal, uplift : float
        Parts of the pull at the anchor [N].

    Returns
    -------
    AnchorCheck
        Utilisation against sliding; that against lifting is infinite with any uplift.

    Examples
    --------
    >>> from moyai.mooring import DragAnchor, check_drag_anchor
    >>> anchor = DragAnchor(weight=2e4, holding_power=5.0, safety_factor=1.5)
    >>> found = check_drag_anchor(anchor, horizontal=4e4, uplift=0.0)
    >>> round(found.utilisation, 3), found.passed                        # 1.5 x 4e4 / (5 x 2e4)
    (0.6, True)
    """
    sliding = anchor.safety_factor * abs(horizontal) / (anchor.weight * anchor.holding_power)
    notices: tuple[Notice, ...] = ()
    if uplift > 0.0:
        angle = math.atan2(uplift, max(abs(horizontal), 1e-300))
        notices = (
            Notice(
                "anchor-uplift",
                f"the line pulls a drag anchor upwards at {math.degrees(angle):.1f} degrees (limit 0)",
                angle,
                0.0,
                "error",
                remedy="lengthen the line, add weight near the anchor, or use a sinker or pile",
                unit="rad",
            ),
        )
    return AnchorCheck(sliding, math.inf if uplift > 0.0 else 0.0, notices)


def gravity_anchor_weight(
    horizontal: float, uplift: float, friction: float, horizontal_factor: float, vertical_factor: float
) -> float:
    """Return the submerged weight of a sinker with a factor for each direction [eq:checks-sinker-weight], [N].

    Parameters
    ----------
    horizontal, uplift : float
        Parts of the pull at the anchor [N]; a pull downwards does not count.
    friction : float
        Coefficient on the bed.
    horizontal_factor, vertical_factor : float
    """
    if not friction > 0.0:
        raise InputError(f"friction {friction:g}", parameter="friction", allowed="above 0")
    return horizontal_factor * abs(horizontal) / friction + vertical_factor * max(uplift, 0.0)
