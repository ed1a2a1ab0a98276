"""Screening formulas for the transmission of floating breakwaters, shown next to linear theory, never instead of it.

Sources: Macagno (1954); Wiegel (1960), thin plate; Ruol, Martinelli and Pezzutto (2013, J. Waterway, Port, Coastal and
Ocean Engineering 139(1), 1-8) for chain-moored pi-type sections. Against the linear solution for the fixed box Macagno
is two to three times too high in short waves (docs/validation/breakwater.md).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.validity import Notice

RUOL_CENTRE = (
    0.7919  # chi_0 of Ruol et al. (2013), not compared with the publication: marked unconfirmed in the notices
)
RUOL_WIDTH = 0.1922  # sigma of Ruol et al. (2013), likewise
RUOL_BEAM_FACTOR = 0.35  # added mass of heave as a depth of 0.35 beams, likewise


def _hyperbolic_ratio(wave_number: Array, water_depth: float, draught: float) -> Array:
    """Return sinh(kh) / cosh(k(h-d)) from exponentials of negative arguments only."""
    k = wave_number
    if np.isinf(water_depth):
        return np.exp(k * draught)
    gap = water_depth - draught
    return np.exp(k * draught) * (-np.expm1(-2.0 * k * water_depth)) / (1.0 + np.exp(-2.0 * k * gap))


def transmission_macagno(wave_number: ArrayLike, water_depth: float, beam: float, draught: float) -> Array:
    """Transmission of a fixed rectangular box after Macagno [eq:breakwater-macagno].

    Parameters
    ----------
    wave_number : array_like
        k [1/m].
    water_depth, beam, draught : float
        h (may be infinite), B, d [m].

    Returns
    -------
    ndarray
        K_T.
    """
    k = np.asarray(wave_number, dtype=float)
    with np.errstate(over="ignore"):
        term = 0.5 * k * beam * _hyperbolic_ratio(k, water_depth, draught)
        return np.asarray(1.0 / np.sqrt(1.0 + term**2))


def transmission_wiegel(wave_number: ArrayLike, water_depth: float, draught: float) -> Array:
    """Transmission below a fixed thin plate after Wiegel, by the energy flux below the plate [eq:breakwater-wiegel].

    Parameters
    ----------
    wave_number : array_like
        k [1/m].
    water_depth, draught : float
        h (may be infinite), d [m].

    Returns
    -------
    ndarray
        K_T.
    """
    k = np.asarray(wave_number, dtype=float)
    if np.isinf(water_depth):
        return np.asarray(np.exp(-k * draught))
    gap = water_depth - draught
    scale = np.exp(-2.0 * k * water_depth)
    upper = 2.0 * k * gap * scale + 0.5 * (np.exp(-2.0 * k * draught) - np.exp(-2.0 * k * (water_depth + gap)))
    lower = 2.0 * k * water_depth * scale + 0.5 * (1.0 - np.exp(-4.0 * k * water_depth))
    return np.asarray(np.sqrt(upper / lower))


def transmission_ruol(
    omega: ArrayLike, wave_number: ArrayLike, water_depth: float, beam: float, draught: float, gravity: float
) -> Array:
    """Transmission of a chain-moored pi-type breakwater after Ruol et al. [eq:breakwater-ruol].

    Parameters
    ----------
    omega, wave_number : array_like
        Angular frequency [rad/s] and wave number [1/m].
    water_depth, beam, draught, gravity : float
        h, B, d [m], g [m/s2]; the draught counts to the lower edge of the side plates.

    Returns
    -------
    ndarray
        K_T.
    """
    chi = np.sqrt(gravity / (draught + RUOL_BEAM_FACTOR * beam)) / np.asarray(omega, dtype=float)
    shift = (chi - RUOL_CENTRE) / RUOL_WIDTH
    correction = 1.0 / (1.0 + shift * np.exp(-(shift**2)))
    return np.asarray(correction * transmission_macagno(wave_number, water_depth, beam, draught))


def check_screening(water_depth: float, draught: float) -> tuple[Notice, ...]:
    """Say what the screening formulas do not hold."""
    notices = [
        Notice(
            "screening-formulas",
            "Macagno, Wiegel and Ruol are screening values; the constants of Ruol et al. (2013) are not confirmed "
            "against the paper",
            severity="information",
            source="domain knowledge; Ruol et al. 2013",
        )
    ]
    if not np.isinf(water_depth) and draught / water_depth > 0.8:
        notices.append(
            Notice(
                "screening-clearance",
                f"draught is {draught / water_depth:.2f} of the water depth; the screening formulas assume a gap that "
                "does not throttle the flow",
                value=draught / water_depth,
                limit=0.8,
            )
        )
    return tuple(notices)
