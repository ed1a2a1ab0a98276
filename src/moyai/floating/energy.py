"""Work of a steady motion in time by harmonic: what damping, lines and radiated waves take [eq:floating-work].

A motion on nonlinear lines holds harmonics of the wave. Lines at rest at every instant lose nothing, yet they carry
energy from the first harmonic into the others, where it is radiated and damped: reflection and transmission of the
first harmonic alone then do not account for the energy of the wave.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.options import checks_words
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import QuadraticDamping
from moyai.floating.time import Simulation
from moyai.series.harmonics import fit_last_periods

HARMONICS = 3
ENERGY_TOLERANCE = 0.02
"""Of the loss of the first harmonic, that damping may leave unexplained."""
LEAST_LOSS = 0.05
"""Of the incident energy; below it the tolerance is 0.1 % of that, the accuracy of the coefficients."""
SHOWN_LOSS = 0.25
"""Of the incident energy; below it other harmonics may take 0.5 % of that, less than R and T are shown to."""


def unexplained_share(loss: ArrayLike, work: ArrayLike, least: float = LEAST_LOSS) -> Array:
    """Return what of the loss of the first harmonic its work does not explain, over the loss [eq:floating-work].

    Parameters
    ----------
    loss, work : array_like
        Over the incident energy flux.
    least : float
        Loss below which the share is taken of this instead.
    """
    lost, taken = np.asarray(loss, dtype=float), np.asarray(work, dtype=float)
    return np.asarray(np.abs(lost - taken) / np.maximum(np.abs(lost), least))


@dataclass(frozen=True)
class HarmonicWork:
    """Mean power that a motion gives away, one entry per harmonic [W]."""

    #: To linear damping beyond radiation; shape (n,).
    damping: Array
    #: To quadratic damping, less what moving water drives through it; shape (n,).
    drag: Array
    #: To the lines: what they lose and what they carry into other harmonics; shape (n,).
    lines: Array
    #: To radiated waves; NaN in the first harmonic, whose waves meet those of the fixed body; shape (n,).
    radiation: Array
    #: To the lines in all harmonics: what they lose; zero for lines at rest at every instant.
    lines_in_all: float


def drag_force(quadratic: QuadraticDamping | None, velocity: Array, water: Array | None = None) -> Array:
    """Return the force of quadratic damping (t, m) at velocities (t, m).

    Parameters
    ----------
    quadratic : QuadraticDamping or None
    velocity : ndarray (t, m)
    water : ndarray (t, w) or None
        Motion of the water in the last w measures.
    """
    if quadratic is None:
        return np.zeros_like(velocity)
    measure = velocity @ quadratic.directions.T
    if water is not None and water.shape[1]:
        measure[:, -water.shape[1] :] -= water
    return -(quadratic.coefficients * np.abs(measure) * measure) @ quadratic.directions


@checks_words
def harmonic_work(
    run: Simulation,
    period: float,
    periods: int,
    damping: Array,
    hydrodynamics: Hydrodynamics,
    drag: Array,
    *,
    one_frequency: bool = False,
) -> HarmonicWork:
    """Return the work of the last periods of a steady motion [eq:floating-work].

    Parameters
    ----------
    run : Simulation
        Converged, with every step kept.
    period : float
        Of the waves [s].
    periods : int
        That are analysed.
    damping : ndarray (m, m)
        Linear damping beyond radiation.
    hydrodynamics : Hydrodynamics
        Radiation damping of the whole unit over a band; its ends are held beyond it.
    drag : ndarray (t, m)
        Force of quadratic damping, from :func:`drag_force`.
    one_frequency : bool
        The motion radiates at every harmonic as at the first (time domain of oblique waves).
    """
    omega = 2.0 * math.pi / period
    order = np.arange(1, HARMONICS + 1)

    def amplitude(series: Array) -> ComplexArray:
        return fit_last_periods(run.time, series, omega, periods=periods, count=HARMONICS).amplitude

    velocity = -1j * omega * order[:, None] * amplitude(run.position)

    def taken(force: ComplexArray) -> Array:
        return np.asarray(-0.5 * np.sum(force.conj() * velocity, axis=1).real)

    at = np.full(HARMONICS, omega) if one_frequency else omega * order
    radiation = [hydrodynamics.at(np.array([each]), hold=True).radiation_damping[0] for each in at]
    waves = 0.5 * np.einsum("ni,nij,nj->n", velocity.conj(), np.array(radiation), velocity).real
    waves[0] = math.nan
    window = run.time > run.time[-1] - (periods - 1e-6) * period
    return HarmonicWork(
        damping=0.5 * np.einsum("ni,ij,nj->n", velocity.conj(), damping, velocity).real,
        drag=taken(amplitude(drag)),
        lines=taken(amplitude(run.mooring_force)),
        radiation=waves,
        lines_in_all=-float(np.mean(np.sum(run.mooring_force[window] * run.velocity[window], axis=1))),
    )
