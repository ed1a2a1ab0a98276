"""Lines that come taut in an irregular sea: their tension at rest where the row is most likely when they pull most.

The tangent at the mean position does not show how far a line is from being straight.
"""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.floating.irregular import integration_weights, response_statistics
from moyai.structures.units.row_lines import RowLines


def largest_at_rest(
    lines: RowLines, rest: Array, omega: Array, motion: ComplexArray, density: Array, duration: float
) -> Array:
    """Return the tension (lines,) [N] of every line at rest at its largest [eq:units-taut].

    The larger of two positions of its unit counts: the mean one given the most probable largest linear tension, and
    given the most probable largest distance of its fairlead from its anchor.

    Parameters
    ----------
    lines : RowLines
    rest : ndarray (m,)
        Mean position.
    omega : ndarray (n,)
        [rad/s].
    motion : ndarray (n, h, m)
        About it, per unit wave amplitude.
    density : ndarray (n, h)
        Of the sea [m2 s/rad].
    duration : float
        That the largest values are expected in [s].
    """
    unit, count = lines.unit, len(rest) // 6
    if not len(unit):
        return np.zeros(0)
    gradient = lines.at(rest).tension_gradient.reshape(len(unit), count, 6)[np.arange(len(unit)), unit]
    # by the motions of the unit: linear tension, distance from the anchor
    by_motion = np.stack([gradient, lines.spans(rest)[1]])
    own = motion.reshape(*motion.shape[:2], count, 6)
    weighted = own * (integration_weights(omega)[:, None] * density)[..., None, None]
    covariance = np.real(np.moveaxis(own.conj(), 2, 0).reshape(count, -1, 6).swapaxes(1, 2)
                         @ np.moveaxis(weighted, 2, 0).reshape(count, -1, 6))  # fmt: skip
    of_line = np.einsum("nhli,kli->nhkl", own[:, :, unit], by_motion)
    most = response_statistics(omega, of_line, density).most_probable_maximum(duration)
    together = np.einsum("lij,klj->kli", covariance[unit], by_motion)
    variance = np.einsum("kli,kli->kl", by_motion, together)
    share = np.divide(most, variance, out=np.zeros_like(most), where=variance > 0.0)
    positions = rest.reshape(-1, 6)[unit] + share[..., None] * together
    return np.asarray(lines.tensions_of(positions).max(axis=0))
