"""Directional spectra from a pressure gauge with a current meter, a buoy, an array: any set of linear sensors.

The estimator is of the extended maximum entropy family (Hashimoto and others 1994): the spreading is the exponential of
a Fourier series of the heading, fitted to the cross spectra with the weights of their sampling errors, the order chosen
by Akaike's criterion. Mean heading and spread of a triplet follow also from its first Fourier coefficients in closed
form (Kuik and others 1988).

References
----------
Hashimoto, N., Nagai, T. and Asai, T. (1994): Extension of the maximum entropy principle method for directional wave
spectrum estimation. Proc. 24th Coastal Engineering Conference, 232-246. https://doi.org/10.1061/9780784400890.019

Kuik, A.J., van Vledder, G.Ph. and Holthuijsen, L.H. (1988): A method for the routine analysis of pitch-and-roll buoy
wave data. J. Phys. Oceanogr. 18, 1020-1034.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.reading.sensors import Sensor
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.series.spectra import CrossSpectra

HEADINGS = 180


@dataclass(frozen=True, eq=False)
class DirectionalSpectrum:
    """Spectrum over frequency and heading."""

    #: [Hz]; shape (frequencies,).
    frequency: Array
    #: Directions of travel [rad], evenly spaced over a full turn; shape (headings,).
    heading: Array
    #: [m2/(Hz rad)]; shape (frequencies, headings).
    density: Array
    #: Order of the Fourier series at each frequency.
    order: NDArray[np.int64]
    #: Sum of the squared weighted residuals over their number less the parameters.
    misfit: Array
    notices: tuple[Notice, ...] = ()

    @property
    def spectrum(self) -> Array:
        """Density over frequency alone [m2/Hz]."""
        return np.asarray(self.density.sum(axis=1) * self._turn)

    @property
    def _turn(self) -> float:
        return float(self.heading[1] - self.heading[0])

    def moments(self) -> tuple[Array, Array]:
        """Return mean heading and spread [rad] at each frequency; equation [eq:records-spread-moment]."""
        first = (self.density @ np.exp(1j * self.heading)) / np.maximum(self.density.sum(axis=1), 1e-300)
        return np.angle(first), np.sqrt(np.maximum(2.0 * (1.0 - np.abs(first)), 0.0))

    def figures(self, lowest: float = 0.0, highest: float = math.inf) -> dict[str, float]:
        """Return the values of the whole sea over a band [Hz].

        Returns
        -------
        dict
            ``spectral_height`` [m], ``mean_heading``, ``spread``, ``peak_heading`` (mean heading at the peak
            frequency), ``peak_spread`` [rad].
        """
        chosen = (self.frequency >= lowest) & (self.frequency <= highest)
        if not chosen.any() or not self.density[chosen].sum() > 0.0:
            return dict.fromkeys(("spectral_height", "mean_heading", "spread", "peak_heading", "peak_spread"), math.nan)
        density, step = self.density[chosen], float(self.frequency[1] - self.frequency[0])
        whole = density.sum(axis=0)
        first = complex(whole @ np.exp(1j * self.heading)) / float(whole.sum())
        headings, spreads = self.moments()
        peak = np.flatnonzero(chosen)[int(np.argmax(density.sum(axis=1)))]
        return {
            "spectral_height": 4.0 * math.sqrt(float(whole.sum()) * self._turn * step),
            "mean_heading": float(np.angle(first)),
            "spread": math.sqrt(max(2.0 * (1.0 - abs(first)), 0.0)),
            "peak_heading": float(headings[peak]),
            "peak_spread": float(spreads[peak]),
        }


def directional_spectrum(
    spectra: CrossSpectra,
    sensors: Sequence[Sensor],
    water: Water,
    *,
    lowest: float,
    highest: float,
    largest_order: int | None = None,
) -> DirectionalSpectrum:
    """Estimate the directional spectrum of the sea from the cross spectra of some sensors; [eq:records-entropy].

    Parameters
    ----------
    spectra : CrossSpectra
        In SI, one channel a sensor.
    sensors : sequence of Sensor
        Three or more; not all of one kind at one place.
    water : Water
        Mean depth during the record.
    lowest, highest : float
        Band [Hz].
    largest_order : int, optional
        Highest order of the Fourier series: by default what the number of cross spectra determines, at most 6.

    Returns
    -------
    DirectionalSpectrum

    Raises
    ------
    InputError
        Fewer than three sensors, as many channels as sensors, an empty band.
    """
    count = len(sensors)
    if count < 3 or spectra.matrix.shape[1] != count:
        raise InputError(
            f"{count} sensors for {spectra.matrix.shape[1]} channels",
            parameter="sensors",
            allowed="three or more, equal",
        )
    chosen = (spectra.frequency >= max(lowest, 1e-9)) & (spectra.frequency <= highest)
    if not chosen.any():
        raise InputError(f"no frequency between {lowest:g} and {highest:g} Hz", parameter="lowest, highest")
    frequency = spectra.frequency[chosen]
    omega = 2.0 * math.pi * frequency
    k = np.asarray(wave_number(omega, water.depth, water.gravity), dtype=float)
    turns = (np.arange(HEADINGS) + 0.5) / HEADINGS
    heading = np.asarray(2.0 * math.pi * turns - math.pi, dtype=np.float64)
    responses = np.stack([sensor.response(omega, k, heading, water) for sensor in sensors], axis=1)
    first, second = np.triu_indices(count)
    matrix = spectra.matrix[chosen]
    independent = _rank(responses, first, second)
    most = min(6, (independent - 1) // 2) if largest_order is None else largest_order
    if most < 1:
        raise InputError(
            "these sensors cannot resolve directions", parameter="sensors", remedy="add velocities or positions"
        )
    density = np.zeros((frequency.size, HEADINGS))
    order = np.zeros(frequency.size, dtype=np.int64)
    misfit = np.full(frequency.size, np.nan)
    for i in range(frequency.size):
        products = responses[i, first] * np.conj(responses[i, second])
        kernel, data, error = _equations(matrix[i], products, first, second, spectra.degrees_of_freedom)
        if kernel is None or data is None or error is None:
            continue
        density[i], order[i], misfit[i] = _fit(kernel, data, error, heading, most)
    notices: list[Notice] = []
    bad = np.isfinite(misfit) & (misfit > 3.0)
    if np.count_nonzero(bad) > 0.1 * frequency.size:
        notices.append(
            Notice(
                "directional-misfit",
                f"at {np.count_nonzero(bad)} of {frequency.size} frequencies linear waves in any directions do not "
                "explain the cross spectra within their sampling errors",
                float(np.nanmedian(misfit)),
                3.0,
                remedy="check units, signs, positions and clocks of the sensors, the depth, and currents",
            )
        )
    return DirectionalSpectrum(frequency, heading, density, order, misfit, tuple(notices))


def _rank(responses: ComplexArray, first: NDArray[np.int64], second: NDArray[np.int64]) -> int:
    """Return how many independent real equations the cross spectra give, at the middle frequency."""
    middle = responses[responses.shape[0] // 2]
    products = middle[first] * np.conj(middle[second])
    products = products / np.maximum(np.abs(products).max(axis=1, keepdims=True), 1e-300)
    values = np.linalg.svd(np.vstack([products.real, products.imag]), compute_uv=False)
    return int(np.count_nonzero(values > 1e-2 * values[0]))


def _equations(
    matrix: ComplexArray, products: ComplexArray, first: NDArray[np.int64], second: NDArray[np.int64], freedom: float
) -> tuple[Array | None, Array | None, Array | None]:
    """Return real equations kernel @ (density dtheta) = data, and the standard error of each datum."""
    power = np.real(np.diag(matrix))
    if not (power > 0.0).all():
        return None, None, None
    cross = matrix[first, second]
    # Sampling variances of co- and quadrature spectrum (Jenkins and Watts 1968, section 9.3)
    both = power[first] * power[second]
    co = (both + cross.real**2 - cross.imag**2) / freedom
    quad = (both - cross.real**2 + cross.imag**2) / freedom
    floor = 1e-4 * both / freedom
    auto = first == second
    kernel = np.vstack([products.real, products.imag[~auto]])
    data = np.concatenate([cross.real, cross.imag[~auto]])
    variance = np.concatenate([np.maximum(co, floor), np.maximum(quad[~auto], floor[~auto])])
    # Equations that no direction enters (a pressure against a vertical velocity, for instance) tell nothing
    useful = np.abs(kernel).max(axis=1) > 1e-9 * np.sqrt(np.concatenate([both, both[~auto]]) / power.max())
    return kernel[useful], data[useful], np.sqrt(variance[useful])


def _fit(kernel: Array, data: Array, error: Array, heading: Array, most: int) -> tuple[Array, int, float]:
    """Return density over headings [m2/(Hz rad)], order and misfit of the best order by Akaike's criterion."""
    turn = float(heading[1] - heading[0])
    weighted = kernel * (turn / error[:, None])
    target = data / error
    # Start from the isotropic sea with the least squares of one unknown
    level = weighted.sum(axis=1)
    start = float(level @ target) / float(level @ level)
    if not start > 0.0:
        start = float(np.abs(target).sum() / np.abs(level).sum())
    parameters = np.array([math.log(start)])
    best: tuple[float, Array, int, float] | None = None
    for order in range(1, most + 1):
        basis = np.vstack(
            [np.ones_like(heading)]
            + [shape(n * heading) for n in range(1, order + 1) for shape in (np.cos, np.sin)]
        )  # fmt: skip
        parameters = np.concatenate([parameters, np.zeros(basis.shape[0] - parameters.size)])
        parameters, squares = _descend(parameters, basis, weighted, target)
        criterion = squares + 2.0 * basis.shape[0]
        freedom = max(target.size - basis.shape[0], 1)
        if best is None or criterion < best[0]:
            best = criterion, np.exp(_bounded(parameters @ basis)), order, squares / freedom
    assert best is not None
    return best[1], best[2], best[3]


def _bounded(exponent: Array) -> Array:
    top = exponent.max()
    return np.asarray(np.clip(exponent, top - 40.0, min(top, 300.0)))


# A weak prior keeps the series of a sea from one direction from growing without end: standard deviation of the
# coefficients of order n is _PRIOR / n
_PRIOR = 12.0


def _descend(parameters: Array, basis: Array, weighted: Array, target: Array) -> tuple[Array, float]:
    """Minimise by Levenberg's method; return parameters and the sum of squares without the prior."""
    size = parameters.size
    prior = np.zeros(size)
    prior[1:] = np.repeat(np.arange(1, (size - 1) // 2 + 1), 2) / _PRIOR
    damping = 1e-2

    def cost(p: Array) -> tuple[float, Array, Array]:
        density = np.exp(_bounded(p @ basis))
        residual = weighted @ density - target
        return float(residual @ residual + np.sum((prior * p) ** 2)), residual, density

    value, residual, density = cost(parameters)
    for _ in range(80):
        jacobian = (weighted * density) @ basis.T
        normal = jacobian.T @ jacobian + np.diag(prior**2)
        slope = jacobian.T @ residual + prior**2 * parameters
        improved = False
        for _ in range(12):
            step = np.linalg.solve(normal + damping * np.diag(np.diag(normal) + 1e-12), -slope)
            step *= min(1.0, 3.0 / max(float(np.abs(step).max()), 1e-300))
            trial = parameters + step
            new, new_residual, new_density = cost(trial)
            if new < value:
                gain = value - new
                parameters, value, residual, density = trial, new, new_residual, new_density
                damping = max(damping / 5.0, 1e-10)
                improved = True
                break
            damping *= 4.0
        if not improved or gain < 1e-8 * (1.0 + value):
            break
    return parameters, float(residual @ residual)


# --------------------------------------------------------------------------------------- closed form of triplets


@dataclass(frozen=True, eq=False)
class FourierDirections:
    """First Fourier coefficients of the spreading at each frequency; equation [eq:records-triplet]."""

    #: [Hz].
    frequency: Array
    #: Surface elevation [m2/Hz], from the vertical channel.
    spectrum: Array
    #: Fourier coefficient of cos [-].
    a1: Array
    #: Fourier coefficient of sin [-].
    b1: Array
    #: Fourier coefficient of cos 2 [-].
    a2: Array
    #: Fourier coefficient of sin 2 [-].
    b2: Array
    #: Horizontal over vertical energy against linear theory [-]: 1 in a sea that obeys it.
    check_ratio: Array

    def figures(self, lowest: float = 0.0, highest: float = math.inf) -> dict[str, float]:
        """Return energy-weighted mean heading and spread, and those at the peak [rad]."""
        chosen = (self.frequency >= lowest) & (self.frequency <= highest)
        weight = np.where(chosen & np.isfinite(self.a1), self.spectrum, 0.0)
        if not weight.sum() > 0.0:
            return dict.fromkeys(("mean_heading", "spread", "peak_heading", "peak_spread"), math.nan)
        first = complex(np.nansum(weight * (self.a1 + 1j * self.b1))) / float(weight.sum())
        peak = int(np.argmax(weight))
        at_peak = complex(self.a1[peak], self.b1[peak])
        return {
            "mean_heading": float(np.angle(first)),
            "spread": math.sqrt(max(2.0 * (1.0 - abs(first)), 0.0)),
            "peak_heading": float(np.angle(at_peak)),
            "peak_spread": math.sqrt(max(2.0 * (1.0 - abs(at_peak)), 0.0)),
        }


def fourier_directions(spectra: CrossSpectra, sensors: Sequence[Sensor], water: Water) -> FourierDirections:
    """Return the Fourier coefficients of a triplet at one place: a vertical quantity and two horizontal ones.

    Parameters
    ----------
    spectra : CrossSpectra
        Channels: vertical, x, y.
    sensors : sequence of Sensor
        In the same order.
    water : Water

    Returns
    -------
    FourierDirections

    Raises
    ------
    InputError
        When the sensors are no triplet.
    """
    if [sensor.powers for sensor in sensors] != [(0, 0), (1, 0), (0, 1)]:
        raise InputError(
            "these sensors are no triplet", parameter="sensors", allowed="a vertical quantity, one along x, one along y"
        )
    if len({(sensor.x, sensor.y) for sensor in sensors}) > 1:
        raise InputError("the sensors of a triplet are at one place", parameter="sensors")
    frequency, matrix = spectra.frequency, spectra.matrix
    omega = 2.0 * math.pi * np.maximum(frequency, 1e-6)
    k = np.asarray(wave_number(omega, water.depth, water.gravity), dtype=float)
    scale = np.stack([sensor.magnitude(omega, k, water) for sensor in sensors], axis=1)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        normal = matrix / (scale[:, :, None] * np.conj(scale[:, None, :]))
        vertical, horizontal = normal[:, 0, 0].real, (normal[:, 1, 1] + normal[:, 2, 2]).real
        mean = np.sqrt(vertical * horizontal)
        coefficients = (
            normal[:, 1, 0].real / mean,
            normal[:, 2, 0].real / mean,
            (normal[:, 1, 1] - normal[:, 2, 2]).real / horizontal,
            2.0 * normal[:, 1, 2].real / horizontal,
        )
        ratio = np.sqrt(horizontal / vertical)
    vertical = np.where((frequency > 0.0) & np.isfinite(vertical), vertical, 0.0)
    return FourierDirections(frequency, vertical, *coefficients, ratio)
