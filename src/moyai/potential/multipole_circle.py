"""Circular cylinders in water of infinite depth by multipoles: half immersed (Ursell) and wholly submerged.

Reference values to many digits; nothing of the boundary elements is used. See docs/theory/reference_solvers.md.

References
----------
F. Ursell, On the heaving motion of a circular cylinder on the surface of a fluid, Quarterly Journal of Mechanics and
Applied Mathematics 2 (1949) 218-231. F. Ursell, Surface waves on deep water in the presence of a submerged circular
cylinder, Proceedings of the Cambridge Philosophical Society 46 (1950) 141-158. T. F. Ogilvie, First- and second-order
forces on a cylinder submerged under a free surface, Journal of Fluid Mechanics 16 (1963) 451-472.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import exp1

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.potential.extrapolation import extrapolated_limit

#: Numbers of multipoles; the error falls like their cube because of the logarithm in the field at the waterline
_FINEST = 256
_EXPONENT = 3.0


@dataclass(frozen=True)
class CircleCoefficients:
    """Radiation of a circular cylinder, without dimension."""

    #: a/(rho area) with the area of the immersed section (half or whole circle).
    added_mass: float
    #: b/(rho area omega) with the same area.
    radiation_damping: float
    #: Amplitude of the radiated wave on one side over the amplitude of the motion.
    wave_ratio: float
    #: Relative difference of the power of the damping force and of the two waves.
    energy_defect: float


def half_immersed_circle(relative_wave_number: float, mode: str, *, multipoles: int = _FINEST) -> CircleCoefficients:
    """Return heave or sway of a half-immersed circle in infinite depth, [eq:reference-ursell].

    Parameters
    ----------
    relative_wave_number : float
        K a = omega^2 a / g, from 1e-6 to 20; ``inf`` is the limit phi = 0 on the surface.
    mode : {"sway", "heave"}
        Direction of the motion.
    multipoles : int
        Largest number of multipoles, at least 32; an eighth, a quarter, a half and the whole of it are extrapolated.

    Returns
    -------
    CircleCoefficients
        Good to some eleven digits for K a up to 5, to eight at 20.

    Raises
    ------
    InputError
        When an argument is out of range.
    """
    if mode not in ("sway", "heave"):
        raise InputError(f"mode is {mode!r}", parameter="mode", allowed="sway or heave")
    ka = float(relative_wave_number)
    if math.isinf(ka) and ka > 0.0:
        # phi = 0: heave is the flow of a dipole; the series of sway has the sum 4/pi^2
        return CircleCoefficients(1.0 if mode == "heave" else 4.0 / math.pi**2, 0.0, 0.0, 0.0)
    if not 1e-6 <= ka <= 20.0:
        raise InputError(f"K a is {ka:g}", parameter="relative_wave_number", allowed="1e-6 to 20, or inf")
    if multipoles < 32:
        raise InputError(f"multipoles is {multipoles}", parameter="multipoles", allowed="at least 32")
    counts = [multipoles // 8 * 2**level for level in range(4)]
    levels = np.array([_half_circle(ka, mode == "heave", count) for count in counts])
    added, damping, ratio = (float(value) for value in extrapolated_limit(levels, _EXPONENT))
    far = ratio**2 / (0.5 * np.pi * ka**2)
    return CircleCoefficients(added, damping, ratio, abs(far - damping) / damping)


def _half_circle(ka: float, heave: bool, count: int) -> tuple[float, float, float]:
    """Added mass, damping and wave ratio with ``count`` multipoles, fitted to the wall by weighted least squares."""
    # theta from the downward vertical; the radius is 1
    node, weight = np.polynomial.legendre.leggauss(3 * count)
    theta = 0.25 * np.pi * (node + 1.0)
    weight = 0.25 * np.pi * weight
    value, slope = _multipoles(theta, ka, np.arange(1, count + 1), heave)
    source, source_slope, strength = _wave_source(theta, ka, heave)
    velocity = np.cos(theta) if heave else np.sin(theta)
    columns = np.column_stack([source_slope, slope])
    scale = np.linalg.norm(columns, axis=0)
    root = np.sqrt(weight)[:, None]
    solution, *_ = np.linalg.lstsq(root * columns / scale, root[:, 0] * velocity, rcond=1e-15)
    solution = solution / scale
    potential = np.column_stack([source, value]) @ solution
    # a + i b/omega is minus rho times the integral of phi phi_n over both halves; the immersed area is pi/2
    moment = -2.0 * np.sum(weight * potential * velocity) / (0.5 * np.pi)
    return float(moment.real), float(moment.imag), float(abs(strength * solution[0]) * ka)


def _multipoles(theta: Array, ka: float, order: NDArray[np.int_], heave: bool) -> tuple[Array, Array]:
    """Wave-free potentials on the circle of radius 1 and their radial derivatives."""
    t, m = theta[:, None], order[None, :]
    if heave:
        value = np.cos(2 * m * t) + ka / (2 * m - 1) * np.cos((2 * m - 1) * t)
        slope = -2 * m * np.cos(2 * m * t) - ka * np.cos((2 * m - 1) * t)
    else:
        value = np.sin((2 * m + 1) * t) + ka / (2 * m) * np.sin(2 * m * t)
        slope = -(2 * m + 1) * np.sin((2 * m + 1) * t) - ka * np.sin(2 * m * t)
    return value, slope


def _wave_source(theta: Array, ka: float, heave: bool) -> tuple[ComplexArray, ComplexArray, complex]:
    """Source (heave) or horizontal dipole (sway) at the surface, radial derivative, amplitude of its far field.

    With zeta = depth - i x the source is the mean of :func:`_pole_integral` at zeta and at its conjugate; the dipole is
    the x derivative of the source.
    """
    radius = np.cos(theta) - 1j * np.sin(theta)  # zeta / r
    w, derivative, second = _pole_integral(radius, ka)
    conjugate_w, conjugate_derivative, conjugate_second = _pole_integral(radius.conj(), ka)
    if heave:
        value = 0.5 * (w + conjugate_w)
        slope = 0.5 * (derivative * radius + conjugate_derivative * radius.conj())
        return value, slope, 1j * np.pi
    # d/dx of zeta = depth -+ i x
    value = 0.5 * (-1j * derivative + 1j * conjugate_derivative)
    slope = 0.5 * (-1j * second * radius + 1j * conjugate_second * radius.conj())
    return value, slope, -np.pi * ka + 0j


def _pole_integral(zeta: ComplexArray, ka: float) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Integral of exp(-k zeta)/(k - K) over k > 0 passing below the pole, and its first two derivatives; K = ka."""
    z = ka * zeta
    # The path winds below the pole: for Im z < 0 it ends on the next sheet of the exponential integral
    value = np.exp(-z) * (exp1(-z) + np.where(z.imag > 0.0, 0.0, 2j * np.pi))
    first = -1.0 / zeta - ka * value
    second = 1.0 / zeta**2 - ka * first
    return value, first, second


@dataclass(frozen=True)
class SubmergedCircle:
    """Submerged circular cylinder in infinite depth, without dimension; sway and heave are equal."""

    #: a/(rho pi a^2).
    added_mass: float
    #: b/(rho pi a^2 omega).
    radiation_damping: float
    #: Amplitude of the radiated wave on one side over the amplitude of the motion.
    wave_ratio: float
    #: Of the cylinder held fixed; its modulus is 1, since no wave is reflected.
    transmission_coefficient: complex
    #: Relative difference of the power of the damping force and of the two waves.
    energy_defect: float


def submerged_circle(relative_wave_number: float, submergence: float) -> SubmergedCircle:
    """Return radiation and transmission of a submerged circle in infinite depth, [eq:reference-submerged].

    Parameters
    ----------
    relative_wave_number : float
        K a = omega^2 a / g, greater than 0, at most 20.
    submergence : float
        Depth of the centre over the radius, at least 1.02.

    Raises
    ------
    InputError
        When an argument is out of range.
    """
    ka, depth = float(relative_wave_number), float(submergence)
    if not 0.0 < ka <= 20.0:
        raise InputError(f"K a is {ka:g}", parameter="relative_wave_number", allowed="greater than 0, at most 20")
    if not (1.02 <= depth < math.inf):
        raise InputError(f"submergence is {depth:g} radii", parameter="submergence", allowed="at least 1.02")
    # The coefficients fall like the inverse powers of the root of s + 1/s = 2 submergence
    decay = math.log(depth + math.sqrt(depth**2 - 1.0))
    count = min(80, 12 + int(36.0 / decay / 2.0))
    n = np.arange(1, count + 1)
    log_factorial = np.cumsum(np.log(np.maximum(np.arange(2 * count + 1), 1)))
    image = _image_integrals(2 * count, ka, depth, log_factorial)
    row, column = n[:, None], n[None, :]
    grow = np.exp(log_factorial[row + column - 1] - log_factorial[column - 1] - log_factorial[row])
    mirror = (-1.0) ** (row + column) * grow * image[row + column - 1]
    system = row * mirror - np.diag(n)
    motion = (n == 1).astype(float)
    wave = np.exp(-ka * depth) * (-1.0) ** n * ka ** n.astype(float) * 2j * np.pi / np.exp(log_factorial[n - 1])
    incident = -np.exp(-ka * depth) * (-ka) ** n.astype(float) / np.exp(log_factorial[n - 1])
    answer = np.linalg.solve(system, np.column_stack([motion, incident]))
    moment = -(answer[0, 0] + mirror[0] @ answer[:, 0])
    ratio = abs(wave @ answer[:, 0]) * ka
    damping = ratio**2 / (np.pi * ka**2)
    return SubmergedCircle(
        added_mass=float(moment.real),
        radiation_damping=float(moment.imag),
        wave_ratio=float(ratio),
        transmission_coefficient=complex(1.0 + 2.0 * (wave @ answer[:, 1])),
        energy_defect=float(abs(damping - moment.imag) / abs(moment.imag)),
    )


def _image_integrals(highest: int, ka: float, depth: float, log_factorial: Array) -> ComplexArray:
    """Integrals of k^p (k + K)/(k - K) exp(-2 k depth) over k, passing below the pole, divided by p factorial."""
    double = 2.0 * depth
    pole = np.empty(highest, dtype=complex)
    pole[0] = _pole_integral(np.array([double - 0j]), ka)[0][0].real + 1j * np.pi * np.exp(-ka * double)
    for p in range(1, highest):
        # divided by p factorial at every step
        pole[p] = (1.0 / double**p + ka * pole[p - 1]) / p
    power = np.arange(highest)
    return np.asarray(double ** -(power + 1.0) + 2.0 * ka * pole, dtype=complex)
