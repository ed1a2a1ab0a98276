"""Where the theory of this room ends: the number found, the limit, and what to do."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.floating.statics import Hydrostatics

IMBALANCE_LIMIT = 1.0
ROLL_LIMIT = math.radians(10.0)


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
                remedy="give mass or draught alone and let the program find the other",
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


def check_motion(amplitude: Array, *, draught: float, freeboard: float) -> tuple[Notice, ...]:
    """Check whether motions stay within linear theory of a fixed wetted section.

    Parameters
    ----------
    amplitude : ndarray (..., 3)
        Sway [m], heave [m], roll [rad] amplitudes.
    draught, freeboard : float
        [m].

    Returns
    -------
    tuple of Notice
        ``large-roll`` above 10 degrees, ``large-heave`` above half the smaller of draught and freeboard,
        ``motion-not-finite`` where there is no finite motion.
    """
    largest = np.abs(np.asarray(amplitude, dtype=float)).reshape(-1, 3)
    notices = []
    if not np.all(np.isfinite(largest)):
        notices.append(
            Notice(
                code="motion-not-finite",
                message="a motion is not finite",
                severity="error",
                remedy="look for an undamped resonance or a run that diverged",
            )
        )
    heave, roll = (float(np.nanmax(largest[:, mode], initial=0.0)) for mode in (1, 2))
    if roll > ROLL_LIMIT:
        notices.append(
            Notice(
                code="large-roll",
                message=f"roll of {math.degrees(roll):.3g} degrees is beyond small motions",
                value=roll,
                limit=ROLL_LIMIT,
                remedy="add the roll damping of edges (linear theory has none), or take the figure as an upper bound",
            )
        )
    room = 0.5 * min(draught, freeboard) if freeboard > 0.0 else 0.5 * draught
    if heave > room:
        notices.append(
            Notice(
                code="large-heave",
                message=f"heave of {heave:.3g} m is more than half of draught or freeboard",
                value=heave,
                limit=room,
                remedy="the section in the water changes with the motion; linear coefficients do not",
            )
        )
    return tuple(notices)
