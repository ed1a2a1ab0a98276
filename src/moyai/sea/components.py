"""The sea as a sum of linear wave components: elevation, kinematics, responses, Stokes drift."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.compiled import njit
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.single import plain
from moyai.sea import kinematics
from moyai.sea.kinematics import Stretching
from moyai.sea.time_sum import sum_over_time
from moyai.sea.water import Water


@dataclass(frozen=True, eq=False)
class WaveComponents:
    """A sea as a sum of linear waves a cos(k (x cos b + y sin b) - omega t + phase) [eq:sea-elevation].

    Raises
    ------
    InputError
        When the arrays differ in length, are empty or hold a value that is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.sea import Water, WaveComponents, wave_number
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> omega = np.array([0.8, 1.2])
    >>> sea = WaveComponents(
    ...     omega, amplitude=np.array([0.5, 0.3]), phase=np.zeros(2), heading=np.zeros(2),
    ...     wave_number=wave_number(omega, 10.0, 9.81), water=water,
    ... )
    >>> round(sea.elevation(0.0), 3), round(sea.significant_height, 3)   # both crests at the origin [m], 4 sqrt(m0) [m]
    (0.8, 1.649)
    """

    #: Angular frequencies in the fixed frame [rad/s], positive.
    omega: Array
    #: Amplitudes [m].
    amplitude: Array
    #: Phases at the origin [rad].
    phase: Array
    #: Directions of travel [rad].
    heading: Array
    #: Wave numbers [1/m].
    wave_number: Array
    #: Needed for velocities, accelerations and pressures.
    water: Water | None = None
    #: Frequencies seen by an observer who drifts with the current [rad/s]; equal to ``omega`` in still water.
    intrinsic_omega: Array | None = None
    #: Common step of which all frequencies are whole multiples [rad/s]: opens the way to Fourier transforms.
    frequency_step: float | None = None

    def __post_init__(self) -> None:
        names = ("omega", "amplitude", "phase", "heading", "wave_number", "intrinsic_omega")
        size = np.size(self.omega)
        for name in names:
            given = getattr(self, name)
            array = np.array(self.omega if given is None else given, dtype=np.float64)
            if array.ndim != 1 or array.size != size or size == 0:
                raise InputError(f"{name} has shape {array.shape}", parameter=name, allowed=f"({max(size, 1)},)")
            if not np.isfinite(array).all():
                raise InputError(f"{name} holds a value that is not finite", parameter=name, allowed="finite")
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def __len__(self) -> int:
        return int(self.omega.size)

    @property
    def variance(self) -> float:
        """Variance of the elevation, half the sum of the squared amplitudes [m2]."""
        return 0.5 * float(np.sum(self.amplitude**2))

    @property
    def significant_height(self) -> float:
        """Significant height 4 sqrt(variance) [m]."""
        return 4.0 * math.sqrt(self.variance)

    @property
    def repeat_period(self) -> float:
        """Time after which the sea repeats itself [s]; infinite where the frequencies share no step."""
        return math.inf if self.frequency_step is None else 2.0 * math.pi / self.frequency_step

    @property
    def complex_amplitude(self) -> ComplexArray:
        """a e^{i phase} [m], so that the elevation at the origin is the real part of its sum with e^{-i omega t}."""
        return np.asarray(self.amplitude * np.exp(1j * self.phase))

    def travel(self, x: ArrayLike, y: ArrayLike) -> ComplexArray:
        """Return e^{i k (x cos b + y sin b)} at points [m], shape (*points, components).

        Parameters
        ----------
        x, y : array_like (*points)
            Site axes [m], broadcast together.
        """
        px, py = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        along = px[..., None] * np.cos(self.heading) + py[..., None] * np.sin(self.heading)
        return np.asarray(np.exp(1j * (self.wave_number * along)))

    def elevation(self, time: ArrayLike, x: ArrayLike = 0.0, y: ArrayLike = 0.0) -> Any:
        """Return the surface elevation at all times at all points.

        Parameters
        ----------
        time : array_like
            Times [s]. On a uniform grid the sum runs through one Fourier transform where the components share a
            frequency step that fits the grid, otherwise through a recurrence; on other times it is summed directly.
        x, y : array_like
            Points [m], broadcast together.

        Returns
        -------
        float or ndarray, shape (*time.shape, *points.shape)
            Elevation above still water [m]; a float for one instant at one point.

        See Also
        --------
        elevation_along : one point for each time.
        """
        return plain(self.respond(self.travel(x, y), time))

    def elevation_along(self, time: ArrayLike, x: ArrayLike, y: ArrayLike) -> Array:
        """Return the elevation [m] along a track: time [s], x and y [m] broadcast together point by point.

        Parameters
        ----------
        time : array_like (...)
            [s].
        x, y : array_like (...)
            Where the track is at these times, site axes [m].
        """
        t, px, py = np.broadcast_arrays(*(np.asarray(item, float) for item in (time, x, y)))
        out = np.empty(t.size)
        _along_track(
            self.omega,
            self.amplitude,
            self.phase,
            self.heading,
            self.wave_number,
            *(np.ascontiguousarray(item).reshape(-1) for item in (px, py, t)),
            out,
        )
        return out.reshape(t.shape)

    def respond(self, transfer: ArrayLike, time: ArrayLike) -> Array:
        """Return the time series of linear responses to this sea.

        Parameters
        ----------
        transfer : array_like, shape (..., components)
            Complex response per unit complex amplitude at each component's frequency and heading (convention
            e^{-i omega t}, phase referred to x = y = 0).
        time : array_like
            Times [s].

        Returns
        -------
        ndarray, shape (*time.shape, ...)
            Re of the sum of transfer a e^{i phase} e^{-i omega t}.
        """
        rows = np.asarray(transfer, dtype=np.complex128) * self.complex_amplitude
        return sum_over_time(self.omega, rows, np.asarray(time, dtype=np.float64), self.frequency_step)

    def envelope(self, time: ArrayLike, x: float = 0.0, y: float = 0.0) -> Array:
        """Return the wave envelope |sum a e^{i (phase + k x - omega t)}| [m] at one point, for slow drift forces.

        Parameters
        ----------
        time : array_like (...)
            [s].
        x, y : float
            Of the point, site axes [m].
        """
        travel = self.travel(x, y)
        parts = self.respond(np.stack([travel, -1j * travel]), time)
        return np.asarray(np.hypot(parts[..., 0], parts[..., 1]))

    def _water(self) -> Water:
        if self.water is None:
            raise InputError("the components have no water", parameter="water", remedy="give water=Water(depth, ...)")
        return self.water

    @checks_words
    def kinematics(
        self, time: float, x: ArrayLike, y: ArrayLike, z: ArrayLike, stretching: Stretching
    ) -> tuple[Array, Array, Array]:
        """Return elevation, velocity and acceleration at nodes at one time.

        Parameters
        ----------
        time : float
            [s].
        x, y, z : array_like
            Nodes [m], broadcast together.
        stretching : {"constant", "linear", "wheeler"}
            Treatment above still water; see :func:`moyai.sea.kinematics.stretching_code`.

        Returns
        -------
        elevation : ndarray, shape (*points.shape,)
            [m]; nodes with z above it are dry, and what to do with them is the caller's choice.
        velocity, acceleration : ndarray, shape (*points.shape, 3)
            [m/s], [m/s2].
        """
        nodes = np.broadcast_arrays(*(np.asarray(item, dtype=np.float64) for item in (x, y, z)))
        shape = nodes[0].shape
        # copies, since arrays that were broadcast cannot be handed to compiled kernels for good
        flat = [np.array(item).reshape(-1) for item in nodes]
        elevation = np.empty(flat[0].size)
        velocity, acceleration = np.empty((flat[0].size, 3)), np.empty((flat[0].size, 3))
        kinematics.linear_velocity_acceleration(
            *self.kernel_arguments(),
            *flat,
            float(time),
            kinematics.stretching_code(stretching),
            elevation,
            velocity,
            acceleration,
        )
        return elevation.reshape(shape), velocity.reshape((*shape, 3)), acceleration.reshape((*shape, 3))

    def kernel_arguments(self) -> tuple[Any, ...]:
        """Return (omega, intrinsic_omega, amplitude, phase, heading, wave_number, depth) for compiled kernels."""
        return (
            self.omega,
            self.intrinsic_omega,
            self.amplitude,
            self.phase,
            self.heading,
            self.wave_number,
            float(self._water().depth),
        )

    @cached_property
    def orbit_rows(self) -> Array:
        """What :func:`moyai.sea.kinematics.sum_orbits` takes of the components, shape (9, components)."""
        omega, sigma, amplitude, phase, heading, number, depth = self.kernel_arguments()
        fall = -2.0 * number * depth
        return np.stack(
            [
                omega, sigma, amplitude, phase, number, np.cos(heading), np.sin(heading), -1.0 / np.expm1(fall),
                np.exp(fall),
            ]
        )  # fmt: skip

    @checks_words
    def transfer_functions(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, stretching: Stretching = "constant"
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return complex velocity [1/s] and acceleration [1/s2] per unit amplitude at fixed points.

        Shape (*points.shape, 3, components), phase referred to x = y = 0; feed them to :meth:`respond`. Wheeler's
        stretching is not linear in the wave and refused.

        Parameters
        ----------
        x, y, z : array_like (*points)
            Site axes, z from still water upwards [m], broadcast together.
        stretching : {"constant", "linear"}
            What holds above still water; see :meth:`kinematics`.

        Raises
        ------
        InputError
            For another stretching, or components without water.
        """
        code = kinematics.stretching_code(stretching)
        if stretching == "wheeler":
            raise InputError(
                "Wheeler stretching has no transfer function",
                parameter="stretching",
                allowed="constant, linear",
                remedy="use kinematics() or velocity()",
            )
        nodes = np.broadcast_arrays(*(np.asarray(item, dtype=np.float64) for item in (x, y, z)))
        # copies, since arrays that were broadcast cannot be handed to compiled kernels for good
        flat = [np.array(item).reshape(-1) for item in nodes]
        velocity = np.empty((flat[0].size, 3, len(self)), dtype=np.complex128)
        acceleration = np.empty_like(velocity)
        kinematics.transfer_velocity_acceleration(
            self.omega,
            self.intrinsic_omega,
            self.heading,
            self.wave_number,
            float(self._water().depth),
            *flat,
            code,
            velocity,
            acceleration,
        )
        shape = (*nodes[0].shape, 3, len(self))
        return velocity.reshape(shape), acceleration.reshape(shape)

    def _over_time(
        self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike, stretching: Stretching, which: int
    ) -> Array:
        if stretching != "wheeler":
            return self.respond(self.transfer_functions(x, y, z, stretching)[which - 1], time)
        times = np.asarray(time, dtype=np.float64)
        values = [self.kinematics(float(t), x, y, z, stretching)[which] for t in times.reshape(-1)]
        return np.asarray(values).reshape((*times.shape, *values[0].shape))

    @checks_words
    def velocity(
        self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike, stretching: Stretching = "constant"
    ) -> Array:
        """Return the water velocity [m/s] at all times at all points, shape (*time.shape, *points.shape, 3).

        Parameters
        ----------
        time : array_like (*time)
            [s].
        x, y, z : array_like (*points)
            Site axes, z from still water upwards [m], broadcast together.
        stretching : {"constant", "linear", "wheeler"}
            What holds above still water.

        Raises
        ------
        InputError
            For another stretching, or components without water.
        """
        return self._over_time(time, x, y, z, stretching, 1)

    @checks_words
    def acceleration(
        self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike, stretching: Stretching = "constant"
    ) -> Array:
        """Return the water acceleration [m/s2], shape as :meth:`velocity` [eq:sea-linear-kinematics].

        Parameters
        ----------
        time : array_like (*time)
            [s].
        x, y, z : array_like (*points)
            Site axes, z from still water upwards [m], broadcast together.
        stretching : {"constant", "linear", "wheeler"}
            What holds above still water.

        Raises
        ------
        InputError
            For another stretching, or components without water.
        """
        return self._over_time(time, x, y, z, stretching, 2)

    def dynamic_pressure(self, time: ArrayLike, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Return the dynamic pressure [Pa], shape (*time.shape, *points.shape) [eq:sea-pressure].

        rho g cosh k(z+h) / cosh kh times the elevation, constant above still water.

        Parameters
        ----------
        time : array_like (*time)
            [s].
        x, y, z : array_like (*points)
            Site axes, z from still water upwards [m], broadcast together.

        Raises
        ------
        InputError
            For components without water.
        """
        water = self._water()
        px, py, pz = np.broadcast_arrays(*(np.asarray(item, dtype=np.float64) for item in (x, y, z)))
        ratio = kinematics.depth_functions(self.wave_number, water.depth, pz[..., None])[2]
        return self.respond(water.density * water.gravity * ratio * self.travel(px, py), time)

    def stokes_drift(self, z: ArrayLike) -> Array:
        """Return the Stokes drift of the sea at heights z [m], x and y parts, shape (*z.shape, 2) [m/s].

        Parameters
        ----------
        z : array_like (...)
            Heights above still water [m].

        Raises
        ------
        InputError
            For components without water.
        """
        drift = kinematics.stokes_drift(
            self.amplitude, np.asarray(self.intrinsic_omega), self.wave_number, self._water().depth, z
        )
        direction = np.stack([np.cos(self.heading), np.sin(self.heading)], axis=-1)
        return np.asarray(drift @ direction)


@njit(cache=True, error_model="numpy")
def _along_track(
    omega: Array,
    amplitude: Array,
    phase: Array,
    heading: Array,
    wave_number: Array,
    x: Array,
    y: Array,
    t: Array,
    out: Array,
) -> None:
    cosines, sines = np.cos(heading), np.sin(heading)
    for n in range(t.size):
        total = 0.0
        for i in range(omega.size):
            along = x[n] * cosines[i] + y[n] * sines[i]
            total += amplitude[i] * math.cos(wave_number[i] * along - omega[i] * t[n] + phase[i])
        out[n] = total
