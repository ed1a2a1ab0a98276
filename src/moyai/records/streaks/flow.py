"""Flow of a long wave's orbital motion around a fixed section with circulation, and the paths of its particles.

The section is a circle or a rectangle in the plane x (to the right), z (up), its centre at the origin. Velocities come
from the complex potential on the outside of a unit circle, so that the wall is met exactly and particles near it stay
outside. Circulation is positive about +y: clockwise with x to the right and z up, the sense of the orbits under waves
that travel towards +x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.compiled import njit
from moyai.core.errors import InputError
from moyai.core.options import checks_words

_TERMS = 400
_SHORT = 12


@checks_words
@dataclass(frozen=True, eq=False)
class SectionMap:
    """Map of the outside of the unit circle onto that of a section, ``Z = x + i z = f(zeta)`` [eq:streaks-map]."""

    kind: Literal["circle", "rectangle"]
    #: Size along x [m].
    breadth: float
    #: Size along z [m].
    height: float
    #: f'(infinity), the radius of the circle of equal outer mapping [m].
    scale: float
    #: Angle of the image of the upper right corner [rad]; 0 for the circle.
    corner: float = 0.0
    #: Coefficients c_n of ``f = scale (zeta + sum c_n zeta**(1 - 2 n))``, n = 1, 2, ...; empty for the circle.
    series: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def area(self) -> float:
        """Area of the section [m2]."""
        return 0.25 * math.pi * self.breadth**2 if self.kind == "circle" else self.breadth * self.height

    @property
    def outline(self) -> Array:
        """Outline as a closed polygon, shape (n, 2) [m]."""
        if self.kind == "circle":
            angle = np.linspace(0.0, 2.0 * math.pi, 181)
            return 0.5 * self.breadth * np.column_stack([np.cos(angle), np.sin(angle)])
        b, h = 0.5 * self.breadth, 0.5 * self.height
        return np.array([[b, -h], [b, h], [-b, h], [-b, -h], [b, -h]])

    @property
    def inertia_coefficients(self) -> tuple[float, float]:
        """Inertia coefficients along x and z in ideal fluid, from the dipole of the map [eq:streaks-dipole]."""
        first = 0.0 if self.kind == "circle" else -math.cos(2.0 * self.corner)
        factor = 2.0 * math.pi * self.scale**2 / self.area
        return factor * (1.0 + first), factor * (1.0 - first)

    def to_plane(self, zeta: ArrayLike) -> ComplexArray:
        """Return x + i z of points of the mapped plane, ``|zeta| >= 1``."""
        point = np.ascontiguousarray(zeta, dtype=np.complex128)
        return np.asarray(_plane(point.ravel(), self.scale, self.series)).reshape(point.shape)

    def to_circle(self, plane: ArrayLike) -> ComplexArray:
        """Return zeta of points x + i z outside the section, by Newton's method from far to near.

        Raises
        ------
        InputError
            When a point lies inside the section.
        """
        target = np.asarray(plane, dtype=complex)
        if np.any(self.contains(target)):
            raise InputError("a point lies inside the section", parameter="points")
        zeta: ComplexArray = np.asarray(target / self.scale, dtype=np.complex128)
        zeta = np.where(np.abs(zeta) < 1.05, 1.05 * np.exp(1j * np.angle(zeta)), zeta)
        for _ in range(60):
            step = (self.to_plane(zeta) - target) / (self.scale * _derivative(zeta, self.corner, self.kind == "circle"))
            size = np.abs(step)
            zeta = zeta - step * np.minimum(1.0, 0.3 / np.maximum(size, 1e-300))
            inside = np.abs(zeta) < 1.0
            zeta = np.where(inside, zeta / np.maximum(np.abs(zeta), 1e-300) * 1.000001, zeta)
            if np.all(size < 1e-12):
                break
        return np.asarray(zeta)

    def contains(self, plane: ArrayLike, margin: float = 0.0) -> NDArray[np.bool_]:
        """Whether points x + i z lie inside the section enlarged by ``margin`` [m]."""
        point = np.asarray(plane, dtype=complex)
        if self.kind == "circle":
            return np.asarray(np.abs(point) < 0.5 * self.breadth + margin)
        inside = (np.abs(point.real) < 0.5 * self.breadth + margin) & (np.abs(point.imag) < 0.5 * self.height + margin)
        return np.asarray(inside)


def circle_map(diameter: float) -> SectionMap:
    """Return the map of a circle of ``diameter`` [m]."""
    if not diameter > 0.0:
        raise InputError(
            f"a diameter of {diameter:g} m is not positive", parameter="diameter", allowed="greater than 0 m"
        )
    return SectionMap("circle", diameter, diameter, 0.5 * diameter)


def rectangle_map(breadth: float, height: float) -> SectionMap:
    """Return the Schwarz-Christoffel map of a rectangle, ``breadth`` along x and ``height`` along z [m].

    The angle of the corner follows from the ratio of the sides, whose lengths are integrals of ``|f'|`` along the unit
    circle [eq:streaks-map].
    """
    from scipy.integrate import quad
    from scipy.optimize import brentq

    for name, value in (("breadth", breadth), ("height", height)):
        if not value > 0.0:
            raise InputError(f"a {name} of {value:g} m is not positive", parameter=name, allowed="greater than 0 m")
    if not 0.02 <= height / breadth <= 50.0:
        raise InputError(
            f"a rectangle of {breadth:g} by {height:g} m is too thin for the map",
            parameter="height",
            allowed="sides with a ratio of at most 50",
        )

    def side(corner: float, low: float, high: float) -> float:
        def stretch(angle: float) -> float:
            return math.sqrt(2.0 * abs(math.cos(2.0 * angle) - math.cos(2.0 * corner)))

        return float(quad(stretch, low, high, epsabs=1e-13, epsrel=1e-12, limit=200)[0])

    def mismatch(corner: float) -> float:
        return side(corner, 0.0, corner) * breadth - side(corner, corner, 0.5 * math.pi) * height

    corner = float(brentq(mismatch, 1e-4, 0.5 * math.pi - 1e-4, xtol=1e-15))
    scale = 0.5 * height / side(corner, 0.0, corner)
    # Coefficients g_n of sqrt(1 - 2 s cos(2 corner) + s^2) by recurrence; integrating gives those of the map
    cosine = math.cos(2.0 * corner)
    root = np.zeros(_TERMS + 1)
    root[0], root[1] = 1.0, -cosine
    for n in range(2, _TERMS + 1):
        root[n] = ((2.0 * n - 3.0) * cosine * root[n - 1] - (n - 3.0) * root[n - 2]) / n
    series = -root[1:] / (2.0 * np.arange(1, _TERMS + 1) - 1.0)
    return SectionMap("rectangle", breadth, height, scale, corner, series)


@njit(cache=True, error_model="numpy")
def _plane(zeta: ComplexArray, scale: float, series: Array) -> ComplexArray:
    """Return the points of the plane; terms of the series that are lost in the rounding are left out."""
    out = np.empty_like(zeta)
    for p in range(zeta.size):
        inverse = 1.0 / zeta[p]
        square = inverse * inverse
        size, count = abs(square), series.size
        if size < 0.999:
            # powers beyond stay below 1e-19
            count = min(count, 1 + int(44.0 / -np.log(max(size, 1e-300))))
        total = 0.0j
        for n in range(count - 1, -1, -1):
            total = total * square + series[n]
        out[p] = scale * (zeta[p] + total * inverse)
    return out


def _derivative(zeta: ComplexArray, corner: float, round_section: bool) -> ComplexArray:
    if round_section:
        return np.ones_like(zeta)
    square = 1.0 / (zeta * zeta)
    turn = np.exp(2j * corner)
    # Two roots instead of one keep to the branch that tends to 1 far away
    return np.asarray(np.sqrt(1.0 - turn * square) * np.sqrt(1.0 - np.conj(turn) * square))


@dataclass(frozen=True, eq=False)
class OrbitalFlow:
    """Orbital flow past a section [eq:streaks-potential]."""

    #: ``None``: the same flow without a model.
    section: SectionMap | None
    #: Wave period [s].
    period: float
    #: Velocity amplitude along x of the undisturbed orbit at the centre, ``u = amplitude_x cos(omega t)`` [m/s].
    amplitude_x: float
    #: Velocity amplitude along z of that orbit, ``w = -amplitude_z sin(omega t)`` [m/s].
    amplitude_z: float
    #: Positive about +y (clockwise with x to the right, z up) [m2/s].
    circulation: float = 0.0
    #: Mean velocity along +x at the level of the centre [m/s].
    mass_transport: float = 0.0
    #: The mass transport grows like ``exp(decay z)`` (twice the wave number in deep water) [1/m].
    decay: float = 0.0
    #: Speed at which the particles sink through the water [m/s].
    settling: float = 0.0

    def __post_init__(self) -> None:
        if not self.period > 0.0:
            raise InputError(f"a period of {self.period:g} s is not positive", parameter="period")
        if self.section is None and self.circulation:
            raise InputError("a flow without section has no circulation", parameter="circulation")

    @property
    def angular_frequency(self) -> float:
        """2 pi / period [rad/s]."""
        return 2.0 * math.pi / self.period


def track_particles(flow: OrbitalFlow, start: ArrayLike, times: ArrayLike, *, steps_per_period: int = 400) -> Array:
    """Follow particles by the classical Runge-Kutta scheme.

    Parameters
    ----------
    flow : OrbitalFlow
    start : array_like, shape (particles, 2)
        Positions x, z at ``times[0]`` [m].
    times : array_like
        Increasing instants [s].
    steps_per_period : int
        Least number of steps in a wave period.

    Returns
    -------
    ndarray, shape (particles, times, 2)
        Positions [m]; NaN from where a particle that sinks or drifts through the water meets the wall.

    Raises
    ------
    InputError
        When a particle starts inside the section, or the times do not increase.
    """
    instants = np.asarray(times, dtype=float)
    if instants.ndim != 1 or np.any(np.diff(instants) <= 0.0):
        raise InputError("the times do not increase", parameter="times")
    points = np.atleast_2d(np.asarray(start, dtype=float))
    plane = points[:, 0] + 1j * points[:, 1]
    section = flow.section
    zeta = section.to_circle(plane) if section is not None else plane
    substeps = np.ceil(np.diff(instants) * steps_per_period / flow.period).astype(np.int64)
    path = _march(
        zeta,
        instants,
        np.maximum(substeps, 1),
        flow.angular_frequency,
        flow.amplitude_x,
        flow.amplitude_z,
        flow.circulation,
        flow.mass_transport,
        flow.decay,
        flow.settling,
        0 if section is None else (1 if section.kind == "circle" else 2),
        1.0 if section is None else section.scale,
        0.0 if section is None else section.corner,
        np.zeros(0) if section is None else section.series[:_SHORT],
    )
    if section is not None:
        with np.errstate(invalid="ignore"):
            path = section.to_plane(path)
    return np.stack([path.real, path.imag], axis=-1)


@njit(cache=True, error_model="numpy")
def _march(zeta, times, substeps, omega, ax, az, gamma, transport, decay, settling, kind, scale, corner, series):  # type: ignore[no-untyped-def]
    """Return zeta of every particle at every instant, [eq:streaks-potential] divided by the stretch of the map."""
    particles, count = zeta.size, times.size
    out = np.empty((particles, count), dtype=np.complex128)
    turn = np.exp(2j * corner)
    for p in range(particles):
        z = zeta[p]
        out[p, 0] = z
        for k in range(count - 1):
            step = (times[k + 1] - times[k]) / substeps[k]
            for m in range(substeps[k]):
                t = times[k] + m * step
                k1 = _rate(z, t, omega, ax, az, gamma, transport, decay, settling, kind, scale, turn, series)
                k2 = _rate(
                    z + 0.5 * step * k1, t + 0.5 * step, omega, ax, az, gamma, transport, decay, settling, kind, scale,
                    turn, series,
                )  # fmt: skip
                k3 = _rate(
                    z + 0.5 * step * k2, t + 0.5 * step, omega, ax, az, gamma, transport, decay, settling, kind, scale,
                    turn, series,
                )  # fmt: skip
                k4 = _rate(
                    z + step * k3, t + step, omega, ax, az, gamma, transport, decay, settling, kind, scale, turn, series
                )
                z = z + step * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
                if kind > 0 and abs(z) < 1.0:
                    z = complex(np.nan, np.nan)
                    break
            out[p, k + 1] = z
            if np.isnan(z.real):
                out[p, k + 2 :] = z
                break
    return out


@njit(cache=True, error_model="numpy")
def _rate(z, t, omega, ax, az, gamma, transport, decay, settling, kind, scale, turn, series):  # type: ignore[no-untyped-def]
    ambient = complex(ax * np.cos(omega * t) + transport, az * np.sin(omega * t))
    if kind == 0:
        height = z.imag
        return ambient.conjugate() + complex(transport * (np.exp(decay * height) - 1.0), -settling)
    inverse = 1.0 / z
    # Circulation about +y runs clockwise, hence the sign of the logarithm
    slope = scale * (ambient - ambient.conjugate() * inverse * inverse) + 1j * gamma / (2.0 * np.pi) * inverse
    square = inverse * inverse
    stretch = complex(scale, 0.0)
    position = z
    if kind == 2:
        stretch = scale * np.sqrt(1.0 - turn * square) * np.sqrt(1.0 - turn.conjugate() * square)
        total = 0.0j
        for n in range(series.size - 1, -1, -1):
            total = total * square + series[n]
        position = z + total * inverse
    velocity = (slope / stretch).conjugate()
    velocity += complex(transport * (np.exp(decay * scale * position.imag) - 1.0), -settling)
    return velocity / stretch
