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
    """A weight on the bed."""

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
    """An anchor that digs in."""

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

    #: ``sliding``, ``lifting``: Utilisation against each; above 1 fails.
    sliding: float
    #: ``sliding``, ``lifting``: Utilisation against each; above 1 fails.
    lifting: float
    notices: tuple[Notice, ...] = ()

    @property
    def utilisation(self) -> float:
        """The larger of both."""
        return max(self.sliding, self.lifting)

    @property
    def passed(self) -> bool:
        """Whether the anchor holds."""
        return bool(self.utilisation <= 1.0)


def check_sinker(sinker: Sinker, horizontal: float, uplift: float) -> AnchorCheck:
    """Hold a sinker against the pull of its line.

    Parameters
    ----------
    sinker : Sinker
    horizontal, uplift : float
        Parts of the pull at the anchor [N].

    Returns
    -------
    AnchorCheck
        [eq:checks-sinker]; the uplift is taken off the weight on the bed.
    """
    factor, up = sinker.safety_factor, max(uplift, 0.0)
    resting = sinker.submerged_weight - factor * up
    sliding = math.inf if resting <= 0.0 else factor * abs(horizontal) / (sinker.friction * resting)
    return AnchorCheck(sliding, factor * up / sinker.submerged_weight)


def check_drag_anchor(anchor: DragAnchor, horizontal: float, uplift: float) -> AnchorCheck:
    """Hold a drag anchor against the pull of its line [eq:checks-drag-anchor].

    Notices tell of any uplift: such anchors are not made for it.
    """
    sliding = anchor.safety_factor * abs(horizontal) / (anchor.weight * anchor.holding_power)
    notices: tuple[Notice, ...] = ()
    if uplift > 0.0:
        angle = math.degrees(math.atan2(uplift, max(abs(horizontal), 1e-300)))
        notices = (
            Notice(
                "anchor-uplift",
                f"the line pulls a drag anchor upwards at {angle:.1f} degrees (limit 0)",
                angle,
                0.0,
                "error",
                remedy="lengthen the line, add weight near the anchor, or use a sinker or pile",
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
