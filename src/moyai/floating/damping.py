"""Damping beyond wave radiation: fraction of critical, linear, quadratic, and the linear equivalents of the latter."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.floating.arrays import finite

EquivalentDamping = Callable[[Array, float], Array]
"""Hook of drag-linearised lines: amplitude (regular) or standard deviation times sqrt(2) (irregular) of the velocities
(m,) and a frequency [rad/s] -> equivalent linear damping (m, m)."""


def critical_damping(inertia: Array, added_mass: Array, stiffness: Array) -> Array:
    """Return the critical damping of each mode, 2 sqrt((M + A)_jj (K_H + K_M)_jj) [eq:floating-critical-damping].

    Parameters
    ----------
    inertia, stiffness : ndarray (m, m)
        Inertia and total restoring.
    added_mass : ndarray (..., m, m)
        At the wave frequency (frequency domain) or at the mode's natural frequency (irregular time domain).

    Returns
    -------
    ndarray (..., m)
        Zero for a mode without restoring.
    """
    mass = np.diagonal(inertia + added_mass, axis1=-2, axis2=-1)
    restoring = np.diagonal(stiffness, axis1=-2, axis2=-1)
    return 2.0 * np.sqrt(np.maximum(mass * restoring, 0.0))


@dataclass(frozen=True)
class LinearDamping:
    """Damping that the user adds to wave radiation.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import LinearDamping
    >>> damping = LinearDamping.of_modes(critical_fraction=[0.0, 0.0, 0.05])
    >>> at_roll = damping.at(np.diag([1.0, 1.0, 4.0]), np.zeros((3, 3)), np.diag([0.0, 1.0, 1.0]))
    >>> round(float(at_roll[2, 2]), 3)                                   # 0.05 times 2 sqrt(4 * 1) [N m s]
    0.2
    """

    #: Constant part [N s/m, N s, N m s]; shape (m, m).
    matrix: Array
    #: zeta of each mode, of the critical damping with added mass; zero for modes that are left alone; shape (m,).
    critical_fraction: Array

    def __post_init__(self) -> None:
        finite(self.matrix, "matrix")
        finite(self.critical_fraction, "critical_fraction")
        if np.any(np.asarray(self.critical_fraction) < 0.0):
            raise InputError(
                "a fraction of critical damping is negative", parameter="critical_fraction", allowed="0 or more"
            )

    @classmethod
    def none(cls, size: int) -> LinearDamping:
        """Return no damping for ``size`` modes.

        Parameters
        ----------
        size : int
            Number of modes m.
        """
        return cls(np.zeros((size, size)), np.zeros(size))

    @classmethod
    def of_modes(cls, *, linear: ArrayLike | None = None, critical_fraction: ArrayLike | None = None) -> LinearDamping:
        """Return damping from one number a mode.

        Parameters
        ----------
        linear : array_like (m,), optional
            Damping of each mode [N s/m, N m s].
        critical_fraction : array_like (m,), optional
            Damping over the critical one of each mode, 0 or more [-]; added to ``linear``.

        Raises
        ------
        InputError
            When neither is given, or for a value that is not finite or a fraction that is negative.
        """
        if linear is None and critical_fraction is None:
            raise InputError("neither linear damping nor a fraction of critical is given", parameter="damping")
        diagonal = np.zeros_like(np.asarray(critical_fraction, dtype=float)) if linear is None else linear
        diagonal = np.asarray(diagonal, dtype=float)
        fraction = np.zeros(len(diagonal)) if critical_fraction is None else np.asarray(critical_fraction, dtype=float)
        return cls(np.diag(diagonal), fraction)

    def at(self, inertia: Array, added_mass: Array, stiffness: Array) -> Array:
        """Return the damping matrix (..., m, m) with added mass (..., m, m) and total restoring (m, m).

        Parameters
        ----------
        inertia : ndarray (m, m)
            Mass and moments of inertia [kg, kg m, kg m2].
        added_mass : ndarray (..., m, m)
            [kg, kg m, kg m2].
        stiffness : ndarray (m, m)
            Restoring of hydrostatics and mooring together [N/m, N, N m].
        """
        diagonal = self.critical_fraction * critical_damping(inertia, added_mass, stiffness)
        return self.matrix + diagonal[..., :, None] * np.eye(diagonal.shape[-1])


@dataclass(frozen=True)
class QuadraticDamping:
    """Forces ``-sum_k J_k^T c_k |J_k v| J_k v``: quadratic in linear measures of the velocities.

    A row of the unit matrix is the quadratic damping of that mode (b2 of roll); a row that gives the velocity of a
    fairlead along some axis is the drag of a line there [eq:floating-quadratic-damping].

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import QuadraticDamping
    >>> damping = QuadraticDamping.of_modes([0.0, 0.0, 30.0])
    >>> damping.force(np.array([0.0, 0.0, 0.2])).round(3).tolist()       # -30 |v| v in roll [N m]
    [0.0, 0.0, -1.2]
    """

    #: Rows J_k; shape (k, m).
    directions: Array
    #: c_k, for roll b2 [N m s2]; shape (k,).
    coefficients: Array
    count: int = field(init=False)

    def __post_init__(self) -> None:
        directions, coefficients = np.asarray(self.directions, float), np.asarray(self.coefficients, float)
        if directions.ndim != 2 or coefficients.shape != directions.shape[:1]:
            raise InputError(
                f"{coefficients.shape} coefficients for directions of the shape {directions.shape}",
                parameter="coefficients",
            )
        if np.any(coefficients < 0.0):
            raise InputError(
                "a quadratic damping coefficient is negative", parameter="coefficients", allowed="0 or more"
            )
        finite(directions, "directions")
        finite(coefficients, "coefficients")
        object.__setattr__(self, "directions", directions)
        object.__setattr__(self, "coefficients", coefficients)
        object.__setattr__(self, "count", len(coefficients))

    @classmethod
    def of_modes(cls, coefficients: ArrayLike) -> QuadraticDamping:
        """Return quadratic damping of single modes, one coefficient each (zero for none).

        Parameters
        ----------
        coefficients : array_like (m,)
            Force over speed squared, 0 or more [N s2/m2, N m s2].

        Raises
        ------
        InputError
            For a coefficient that is negative or not finite.
        """
        values = np.atleast_1d(np.asarray(coefficients, dtype=float))
        rows = np.flatnonzero(values)
        return cls(np.eye(len(values))[rows], values[rows])

    def force(self, velocity: Array) -> Array:
        """Return the force (m,) at the velocities (m,).

        Parameters
        ----------
        velocity : ndarray (m,)
            Of the modes [m/s, rad/s].

        Returns
        -------
        ndarray (m,)
            [N, N m].
        """
        measure = self.directions @ velocity
        return -self.directions.T @ (self.coefficients * np.abs(measure) * measure)

    def _assembled(self, equivalent: Array) -> Array:
        values: Array = np.einsum("ki,...k,kj->...ij", self.directions, equivalent, self.directions)
        return values

    def equivalent_regular(self, measure_amplitude: Array) -> Array:
        """Return the linear damping (..., m, m) of equal work at amplitudes (..., k) of J_k v.

        Implements b = 8/(3 pi) c |J v| [eq:floating-equal-work].

        Parameters
        ----------
        measure_amplitude : ndarray (..., k)
            Amplitude of each measure J_k v [m/s, rad/s].
        """
        return self._assembled(8.0 / (3.0 * math.pi) * self.coefficients * measure_amplitude)

    def carried_regular(self, measure_amplitude: Array, water_motion: ComplexArray) -> ComplexArray:
        """Return the force (..., m) of water that moves by (..., k) in the measures, equivalent as in regular waves.

        Parameters
        ----------
        measure_amplitude : ndarray (..., k)
            Amplitude of each measure of the relative velocity [m/s, rad/s].
        water_motion : ndarray of complex (..., k)
            Velocity of the water in each measure [m/s, rad/s].
        """
        equivalent = 8.0 / (3.0 * math.pi) * self.coefficients * measure_amplitude
        return np.asarray((equivalent * water_motion) @ self.directions)

    def carried_irregular(self, measure_deviation: Array, water_motion: ComplexArray) -> ComplexArray:
        """Return the force (..., m) of water that moves by (..., k) in the measures, equivalent as in a sea.

        Parameters
        ----------
        measure_deviation : ndarray (..., k)
            Standard deviation of each measure of the relative velocity [m/s, rad/s].
        water_motion : ndarray of complex (..., k)
            Velocity of the water in each measure [m/s, rad/s].
        """
        equivalent = math.sqrt(8.0 / math.pi) * self.coefficients * measure_deviation
        return np.asarray((equivalent * water_motion) @ self.directions)

    def equivalent_irregular(self, measure_deviation: Array) -> Array:
        """Return the linear damping (..., m, m) of least error at Gaussian standard deviations (..., k) of J_k v.

        Implements b = sqrt(8/pi) c sigma [eq:floating-stochastic].

        Parameters
        ----------
        measure_deviation : ndarray (..., k)
            Standard deviation of each measure J_k v [m/s, rad/s].
        """
        return self._assembled(math.sqrt(8.0 / math.pi) * self.coefficients * measure_deviation)
