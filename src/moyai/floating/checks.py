"""Where the theory of this package ends: the number found, the limit, and what to do."""

from __future__ import annotations

import math

from moyai.core.validity import Notice
from moyai.floating.statics import Hydrostatics

IMBALANCE_LIMIT = 1.0


def roll_notices(roll: float, *, freeboard: float, draught: float, beam: float, where: str) -> tuple[Notice, ...]:
    """Check that a roll keeps the waterline of linear restoring.

    Parameters
    ----------
    roll : float
        Largest amplitude [rad].
    freeboard, draught, beam : float
        Of the body at rest [m].
    where : str
        Level and sea.
    """
    deck, bilge = math.atan2(2.0 * freeboard, beam), math.atan2(2.0 * draught, beam)
    limit = min(deck, bilge)
    if not roll > limit > 0.0:
        return ()
    what = "puts the deck edge under water" if deck <= bilge else "lifts the bilge out of the water"
    return (
        Notice(
            "roll-beyond-linear",
            f"{where}: a roll of {math.degrees(roll):.3g} deg {what}, which begins at {math.degrees(limit):.3g} deg; "
            "the linear restoring moment is extrapolated: roll, and tensions in this sea, are approximate",
            value=roll, limit=limit, severity="warning",
            remedy="raise the deck, widen the section or damp roll", unit="rad",
        ),
    )  # fmt: skip


def check_statics(statics: Hydrostatics, *, vertical_pull: float, gravity: float) -> tuple[Notice, ...]:
    """Check balance and stability of a body at rest.

    Parameters
    ----------
    statics : Hydrostatics
        Of the whole unit.
    vertical_pull : float
        Downward pull of all lines [N].
    gravity : float
        [m/s2].

    Returns
    -------
    tuple of Notice
        ``imbalance`` above 1 % of the displacement, ``unstable`` for a metacentric height that is not positive.
    """
    notices = []
    imbalance = statics.imbalance(vertical_pull, gravity=gravity)
    if not abs(imbalance) <= IMBALANCE_LIMIT:
        notices.append(
            Notice(
                code="imbalance",
                message=(
                    f"displacement of {statics.displaced_mass:.5g} kg less mass of {statics.mass:.5g} kg and line pull "
                    f"of {vertical_pull / gravity:.4g} kg leaves {imbalance:.3g} % of the displacement"
                ),
                value=abs(imbalance),
                limit=IMBALANCE_LIMIT,
                remedy="give mass or draught alone; the program computes the other",
            )
        )
    if statics.metacentric_height <= 0.0:
        notices.append(
            Notice(
                code="unstable",
                message=f"metacentric height {statics.metacentric_height:.3g} m: the free body cannot float upright",
                value=statics.metacentric_height,
                limit=0.0,
                severity="error",
                remedy="lower the centre of gravity or widen the waterline",
            )
        )
    return tuple(notices)
