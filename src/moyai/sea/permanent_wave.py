"""A wave of permanent form given by its Fourier harmonics: elevation, velocity, acceleration, pressure, residuals.

Exponentials never exceed one, so that any depth works, infinite depth included.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.core.options import checks_words
from moyai.core.single import plain
from moyai.core.validity import Notice
from moyai.sea.water import Water

Theory = Literal["airy", "stokes", "stream_function"]

RESIDUAL = 1e-5
"""Free-surface residual that a stream-function wave keeps between its collocation points, over g H."""


@njit(cache=True, error_model="numpy")
def fourier_wave_kernel(
    angle: Array, z: Array, depth: float, crest: float, wave_number: float, harmonics: Array, out: Array
) -> None:
    """Fill u, w, du/dx, du/dz of a permanent wave at points given by phase angle and height [eq:sea-fourier-wave].

    ``harmonics`` are the velocity amplitudes [m/s] at crest level, so every factor e^{jk(z - crest)} is at most 1;
    points above the crest are taken at its level. ``out`` has shape (4, points).
    """
    for n in range(angle.size):
        level = min(max(z[n], -depth), crest)
        u = w = slope_x = slope_z = 0.0
        for i in range(harmonics.size):
            jk = (i + 1) * wave_number
            lift = harmonics[i] * math.exp(jk * (level - crest))
            if math.isinf(depth):
                even = odd = lift
            else:
                below = math.exp(-2.0 * jk * (level + depth))
                whole = 1.0 + math.exp(-2.0 * jk * (crest + depth))
                even, odd = lift * (1.0 + below) / whole, lift * (1.0 - below) / whole
            cosine, sine = math.cos((i + 1) * angle[n]), math.sin((i + 1) * angle[n])
            u += even * cosine
            w += odd * sine
            slope_x -= jk * even * sine
            slope_z += jk * odd * cosine
        out[0, n], out[1, n], out[2, n], out[3, n] = u, w, slope_x, slope_z


@checks_words
@dataclass(frozen=True, eq=False)
class NonlinearWave:
    """A wave of permanent form, crest at x = y = 0 when t = 0; made by :func:`nonlinear_wave`."""

    #: ``airy``, ``stokes`` or ``stream_function``.
    theory: Theory
    #: Order, or number of Fourier components.
    order: int
    #: H [m].
    height: float
    #: T in the fixed frame [s].
    period: float
    #: L [m].
    wavelength: float
    #: Direction of travel [rad].
    heading: float
    #: Depth, density, gravity.
    water: Water
    #: Uniform current along the heading [m/s].
    current_along_wave: float
    #: E_j of the elevation, sum of E_j cos j(kx - omega t) [m].
    elevation_harmonics: Array
    #: Amplitudes of the horizontal velocity harmonics at crest level [m/s].
    crest_velocities: Array
    #: Speed of the crest relative to the current [m/s].
    relative_celerity: float

    @property
    def wave_number(self) -> float:
        """Wave number k [1/m]."""
        return 2.0 * math.pi / self.wavelength

    @property
    def omega(self) -> float:
        """Angular frequency in the fixed frame [rad/s]."""
        return 2.0 * math.pi / self.period

    @property
    def celerity(self) -> float:
        """Speed of the crest in the fixed frame [m/s]."""
        return self.relative_celerity + self.current_along_wave

    @property
    def crest(self) -> float:
        """Crest height above still water [m]."""
        return float(np.sum(self.elevation_harmonics))

    @property
    def trough(self) -> float:
        """Trough height above still water, negative [m]."""
        signs = np.where(np.arange(1, self.elevation_harmonics.size + 1) % 2 == 0, 1.0, -1.0)
        return float(np.sum(signs * self.elevation_harmonics))

    def _angle(self, time: ArrayLike, x: ArrayLike, y: ArrayLike) -> tuple[Array, tuple[int, ...]]:
        t = np.asarray(time, dtype=np.float64)
        px, py = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        along = px * math.cos(self.heading) + py * math.sin(self.heading)
        turn = self.wave_number * along.reshape(-1)[None, :] - self.omega * t.reshape(-1)[:, None]
        return turn, (*t.shape, *px.shape)

    def elevation(self, time: ArrayLike, x: ArrayLike = 0.0, y: ArrayLike = 0.0) -> Any:
        """Return the surface elevation [m] at all times [s] at all points [m], shape (*time.shape, *points.shape).

        A single instant at a single point gives a float.

        Parameters
        ----------
        time : array_like (*time)
            [s].
        x, y : array_like (*points)
            Site axes [m], broadcast together.
        """
        angle, shape = self._angle(time, x, y)
        return plain(self._elevation_at(angle).reshape(shape))

    def _elevation_at(self, angle: Array) -> Array:
        order = np.arange(1, self.elevation_harmonics.size + 1)
        height: Array = np.cos(angle[..., None] * order) @ self.elevation_harmonics
        return height

    def _fields(
        self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike
    ) -> tuple[Array, Array, tuple[int, ...]]:
        """Return u, w, du/dx, du/dz (4, points), the phase angles and the shape of times and points."""
        px, py, pz = np.broadcast_arrays(*(np.asarray(item, dtype=np.float64) for item in (x, y, z)))
        angle, shape = self._angle(time, px, py)
        # copies: a view that cannot be written to would be another kernel
        level = np.array(np.broadcast_to(pz.reshape(-1), angle.shape)).reshape(-1)
        out = np.empty((4, angle.size))
        fourier_wave_kernel(np.ascontiguousarray(angle).reshape(-1), level, *self.kernel_arguments(), out)
        return out, angle, shape

    def kernel_arguments(self) -> tuple[float, float, float, Array]:
        """Return (depth, crest, wave_number, crest_velocities) for :func:`fourier_wave_kernel`."""
        return float(self.water.depth), self.crest, self.wave_number, self.crest_velocities

    def _in_space(self, along: Array, vertical: Array, shape: tuple[int, ...]) -> Array:
        out = np.empty((along.size, 3))
        out[:, 0], out[:, 1], out[:, 2] = along * math.cos(self.heading), along * math.sin(self.heading), vertical
        return out.reshape((*shape, 3))

    def velocity(self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Return the water velocity, current included.

        Parameters
        ----------
        time : array_like
            [s].
        x, y, z : array_like
            Points [m], broadcast together; the series is continued above the surface up to crest level.

        Returns
        -------
        ndarray, shape (*time.shape, *points.shape, 3)
            [m/s].
        """
        fields, _, shape = self._fields(time, x, y, z)
        return self._in_space(fields[0] + self.current_along_wave, fields[1], shape)

    @checks_words
    def acceleration(
        self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike, *, convective: bool = True
    ) -> Array:
        """Return the acceleration of water particles [m/s2], or the local one with ``convective=False``.

        Shape as :meth:`velocity`.

        Parameters
        ----------
        time : array_like (*time)
            [s].
        x, y, z : array_like (*points)
            Site axes, z from still water upwards [m], broadcast together.
        convective : bool
            Whether the particle is followed.
        """
        fields, _, shape = self._fields(time, x, y, z)
        if not convective:
            return self._in_space(-self.celerity * fields[2], -self.celerity * fields[3], shape)
        return self._acceleration_of(fields, shape)

    def _acceleration_of(self, fields: Array, shape: tuple[int, ...]) -> Array:
        u, w, slope_x, slope_z = fields
        # steady in the frame of the crest; dw/dx = du/dz without rotation, dw/dz = -du/dx by continuity
        relative = u - self.relative_celerity
        return self._in_space(relative * slope_x + w * slope_z, relative * slope_z - w * slope_x, shape)

    @property
    def bernoulli_constant(self) -> float:
        """Mean over the surface of q^2/2 + g eta in the frame of the crest [m2/s2]."""
        return float(np.mean(self._surface_head(256)))

    def _surface_head(self, points: int) -> Array:
        x = np.linspace(0.0, 0.5 * self.wavelength, 2 * points + 1)[1::2]
        eta = self._along_crest_line(x)
        u, w = self._at_surface(x, eta)
        return 0.5 * ((u - self.relative_celerity) ** 2 + w**2) + self.water.gravity * eta

    def _along_crest_line(self, along: Array) -> Array:
        height = self.elevation(0.0, along * math.cos(self.heading), along * math.sin(self.heading))
        return np.asarray(height, dtype=np.float64)

    def _at_surface(self, along: Array, eta: Array) -> tuple[Array, Array]:
        out = np.empty((4, along.size))
        fourier_wave_kernel(self.wave_number * along, eta, *self.kernel_arguments(), out)
        return out[0], out[1]

    def orbital_motion(self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, Array, Array]:
        """Return elevation [m], velocity without the current [m/s] and acceleration of water [m/s2] at points.

        Shapes (*time.shape, *points.shape) and (*time.shape, *points.shape, 3).

        Parameters
        ----------
        time : array_like (*time)
            [s].
        x, y, z : array_like (*points)
            Site axes, z from still water upwards [m], broadcast together.
        """
        fields, angle, shape = self._fields(time, x, y, z)
        velocity = self._in_space(fields[0], fields[1], shape)
        return self._elevation_at(angle).reshape(shape), velocity, self._acceleration_of(fields, shape)

    def dynamic_pressure(self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Return the pressure above the still-water hydrostatic one [Pa], shape (*time.shape, *points.shape).

        By Bernoulli in the frame of the crest, so that the total pressure vanishes at the surface.

        Parameters
        ----------
        time : array_like (*time)
            [s].
        x, y, z : array_like (*points)
            Site axes, z from still water upwards [m], broadcast together.
        """
        (u, w, _, _), _, shape = self._fields(time, x, y, z)
        head = self.bernoulli_constant - 0.5 * ((u - self.relative_celerity) ** 2 + w**2)
        values: Array = (self.water.density * head).reshape(shape)
        return values

    def notices(self) -> tuple[Notice, ...]:
        """Return a warning where a stream-function wave misses its free surface by more than :data:`RESIDUAL`."""
        worst = max(self.surface_residuals())
        if self.theory != "stream_function" or worst <= RESIDUAL:
            return ()
        return (
            Notice(
                "wave-residual",
                f"the stream-function wave of H {self.height:.4g} m and T {self.period:.4g} s misses the conditions of "
                f"its surface by {worst:.2g} of g H with {self.order} components; the crest is near breaking",
                value=worst,
                limit=RESIDUAL,
                remedy="take a lower wave, or read its crest velocity with this error",
                source="Rienecker and Fenton (1981)",
            ),
        )

    def surface_residuals(self, points: int = 64) -> tuple[float, float]:
        """Return how far the wave is from the exact free-surface conditions.

        Parameters
        ----------
        points : int
            Places between crest and trough where they are taken.

        Returns
        -------
        kinematic : float
            Largest departure of the stream function from its mean along the surface, over c H.
        dynamic : float
            Largest departure of the Bernoulli head from its mean along the surface, over g H.
        """
        if self.height == 0.0:
            return 0.0, 0.0
        x = np.linspace(0.0, 0.5 * self.wavelength, 2 * points + 1)[1::2]
        eta = self._along_crest_line(x)
        depth, crest, k, harmonics = self.kernel_arguments()
        stream = -self.relative_celerity * eta
        for i, amplitude in enumerate(harmonics):
            jk = (i + 1) * k
            lift = amplitude * np.exp(jk * (eta - crest)) / jk
            if not math.isinf(depth):
                lift = lift * -np.expm1(-2.0 * jk * (eta + depth)) / (1.0 + math.exp(-2.0 * jk * (crest + depth)))
            stream = stream + lift * np.cos(jk * x)
        head = self._surface_head(points)
        kinematic = float(np.max(np.abs(stream - np.mean(stream)))) / (self.relative_celerity * self.height)
        dynamic = float(np.max(np.abs(head - np.mean(head)))) / (self.water.gravity * self.height)
        return kinematic, dynamic
