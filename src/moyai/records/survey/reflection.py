"""Incident and reflected waves from two, three or more gauges in a row, by least squares.

With two gauges the equations have one solution, that of Goda and Suzuki (1976); with three and equal weights the least
squares are those of Mansard and Funke (1980); more gauges follow the same formula. Gauges whose spacing is near a
multiple of half the wavelength say the same thing twice: the condition number shows it.

References
----------
.. [1] Goda, Y. and Suzuki, Y. (1976): Estimation of incident and reflected waves in random wave experiments. Proc. 15th
   Coastal Engineering Conference, 828-845. https://doi.org/10.1061/9780872620834.048
.. [2] Mansard, E.P.D. and Funke, E.R. (1980): The measurement of incident and reflected spectra using a least squares
   method. Proc. 17th Coastal Engineering Conference, 154-172. https://doi.org/10.1061/9780872622647.008
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.validity import Notice

# Errors of the gauges are multiplied by at most the condition number. Goda and Suzuki accept spacings between 0.05 and
# 0.45 wavelengths; at these ends it is cot(9 degrees) = 6.31: the limit follows theirs.
LARGEST_CONDITION = 6.32


@dataclass(frozen=True, eq=False)
class Separation:
    """Incident and reflected waves at one or more frequencies; equation [eq:two-wave-model]."""

    #: Complex amplitudes at x = 0 of waves towards +x, in the unit of the gauges; shape (frequencies,).
    incident: ComplexArray
    #: Complex amplitudes at x = 0 of waves towards -x, in the unit of the gauges; shape (frequencies,).
    reflected: ComplexArray
    #: Condition number of the 2 x 2 problem: 1 is ideal, infinite is singular; shape (frequencies,).
    condition: Array
    #: Root mean square over the gauges of what two waves leave unexplained (zero by construction for two gauges); shape
    #: (frequencies,).
    residual: Array
    #: Standard error of the two complex amplitudes from the residual; NaN for two gauges, which leave none; shape
    #: (frequencies, 2).
    standard_error: Array
    #: One for each frequency that is badly conditioned.
    notices: tuple[Notice, ...] = ()

    @property
    def reflection_coefficient(self) -> ComplexArray:
        """Complex ratio of the reflected to the incident amplitude at x = 0."""
        return self.reflected / self.incident

    @property
    def reflection_error(self) -> Array:
        """Standard error of the modulus of the reflection coefficient, to first order."""
        ratio = np.abs(self.reflection_coefficient)
        return np.hypot(self.standard_error[:, 1], ratio * self.standard_error[:, 0]) / np.abs(self.incident)


def separate_waves(
    positions: ArrayLike, amplitudes: ArrayLike, wave_number: ArrayLike, *, largest_condition: float = LARGEST_CONDITION
) -> Separation:
    """Separate incident and reflected waves; equations [eq:two-wave-model] and [eq:two-wave-solution].

    Parameters
    ----------
    positions : array_like, shape (gauges,)
        Positions along the direction of the incident wave [m], any origin; phases of the answer refer to x = 0.
    amplitudes : array_like, shape (gauges,) or (frequencies, gauges)
        Complex amplitudes ``Re(X exp(-i omega t))`` of the gauges.
    wave_number : array_like, scalar or shape (frequencies,)
        Wave number k [rad/m].
    largest_condition : float
        Condition number above which a notice is given.

    Returns
    -------
    Separation

    Raises
    ------
    InputError
        Fewer than two gauges, gauges at one place, or values that are not finite.
    """
    x = np.asarray(positions, dtype=float)
    gauges = np.atleast_2d(np.asarray(amplitudes, dtype=complex))
    k = np.atleast_1d(np.asarray(wave_number, dtype=float))
    if x.ndim != 1 or x.size < 2 or np.unique(x).size < 2:
        raise InputError(
            f"{np.unique(x).size} gauge positions", parameter="positions", allowed="two or more different positions"
        )
    if gauges.shape != (k.size, x.size):
        raise InputError(
            f"amplitudes of shape {gauges.shape} for {k.size} wave numbers and {x.size} gauges", parameter="amplitudes"
        )
    if not (np.all(np.isfinite(gauges)) and np.all(np.isfinite(k)) and np.all(k > 0.0)):
        raise InputError("amplitudes must be finite and wave numbers positive", parameter="amplitudes")
    # Positions from their middle: conditioning does not depend on where the tank has its origin
    origin = x.mean()
    phase = np.exp(1j * k[:, None] * (x - origin))
    design = np.stack([phase, phase.conj()], axis=-1)
    # The normal matrix [[n, s*], [s, n]] has eigenvalues n +- |s|, s the sum of exp(2 i k x): an exact condition number
    coupling = np.abs(np.sum(phase**2, axis=-1))
    small = np.maximum(x.size - coupling, 0.0)
    with np.errstate(divide="ignore"):
        condition = np.sqrt((x.size + coupling) / small)
    solution = np.stack([np.linalg.lstsq(design[i], gauges[i], rcond=None)[0] for i in range(k.size)])
    misfit = gauges - np.einsum("fgj,fj->fg", design, solution)
    residual = np.sqrt(np.mean(np.abs(misfit) ** 2, axis=-1))
    shift = np.exp(-1j * k * origin)
    error = np.full((k.size, 2), np.nan)
    if x.size > 2:
        variance = np.sum(np.abs(misfit) ** 2, axis=-1) / (x.size - 2)
        with np.errstate(divide="ignore", invalid="ignore"):
            diagonal = x.size / (x.size**2 - coupling**2)
            error = np.repeat(np.sqrt(variance * diagonal)[:, None], 2, axis=1)
    notices = tuple(
        Notice(
            code="gauge-spacing",
            message=(
                f"at wavelength {2.0 * np.pi / k[i]:.4g} m the gauge spacings {_spacings(x)} m are near a multiple "
                f"of half the wavelength: errors of the gauges are multiplied by up to {condition[i]:.3g}"
            ),
            value=float(condition[i]),
            limit=largest_condition,
            remedy="use other gauges or leave this frequency out",
            source="Goda and Suzuki (1976): spacing between 0.05 and 0.45 wavelengths",
        )
        for i in range(k.size)
        if condition[i] > largest_condition
    )
    return Separation(solution[:, 0] * shift, solution[:, 1] / shift, condition, residual, error, notices)


def _spacings(positions: Array) -> str:
    return ", ".join(f"{spacing:.4g}" for spacing in np.diff(np.sort(positions)))
