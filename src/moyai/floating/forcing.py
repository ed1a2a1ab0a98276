"""Forces of waves on the time grid of the integrator: regular and irregular excitation, mean and slow drift.

A forcing is sampled at whole and half steps, so that a method with a stage in the middle of the step finds the exact
value there and no interpolation enters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.floating.arrays import finite, positive
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.sums import real_sum
from moyai.sea.components import WaveComponents

STEPS_PER_PERIOD = 40
"""Steps in the mean period of the waves: a phase error of 5e-6, extremes between rows below 0.3 %."""
STEPS_PER_SHORTEST = 20
"""Steps in the shortest period of a sea that matters: a phase error of 8e-5 where a hundredth of the energy is left."""


class Forcing(Protocol):
    """Forces on the body that do not depend on its motion."""

    @property
    def shortest_period(self) -> float:
        """Shortest period that carries force that should be resolved [s]; ``inf`` for steady forces."""

    @property
    def longest_step(self) -> float:
        """Longest step that resolves the waves [s]; ``inf`` for steady forces."""

    def fitted_step(self, time_step: float) -> float:
        """Return a step not longer than ``time_step`` [s] that suits the forcing.

        Parameters
        ----------
        time_step : float
            Longest step that is wanted [s].
        """

    def sample(self, step: float, count: int) -> tuple[Array, Array]:
        """Return forces (count, m) and surface elevation (count,) at times ``step * arange(count)``.

        Parameters
        ----------
        step : float
            Distance of the samples [s].
        count : int
            Number of samples.

        Returns
        -------
        tuple of ndarray (count, m) and (count,)
            Forces of the modes [N, N m] and surface elevation at x = 0 [m].
        """


def cosine_ramp(time: ArrayLike, duration: float) -> Array:
    """Return (1 - cos(pi t / duration)) / 2 up to ``duration``, then 1 [eq:floating-ramp]; all 1 for duration 0."""
    instants = np.asarray(time, dtype=float)
    if duration <= 0.0:
        return np.ones_like(instants)
    return 0.5 * (1.0 - np.cos(np.pi * np.clip(instants / duration, 0.0, 1.0)))


@dataclass(frozen=True)
class CalmWater:
    """No waves: a steady force only, for free decay and static tests."""

    #: [N, N, N m]; shape (m,).
    steady: Array
    #: Length of the cosine ramp of the steady force [s].
    ramp: float = 0.0

    @property
    def shortest_period(self) -> float:
        """Infinite."""
        return math.inf

    @property
    def longest_step(self) -> float:
        """Infinite."""
        return math.inf

    def fitted_step(self, time_step: float) -> float:
        """Return the step unchanged."""
        return time_step

    def sample(self, step: float, count: int) -> tuple[Array, Array]:
        """Return the steady force and a flat surface."""
        shape = cosine_ramp(step * np.arange(count), self.ramp)
        return shape[:, None] * np.asarray(self.steady, dtype=float), np.zeros(count)


@checks_words
@dataclass(frozen=True)
class RegularForcing:
    """A regular wave [eq:floating-regular-forcing].

    Raises
    ------
    InputError
        For a frequency that is not positive and forces that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import RegularForcing
    >>> wave = RegularForcing(1.0, 0.5, np.array([4e5 + 0j]), np.zeros(1), np.array([1e4]))
    >>> force, elevation = wave.sample(0.1, 600)                         # at every 0.1 s
    >>> round(float(force[0, 0])), round(float(elevation[0]), 3)         # 0.5 m times 4e5 N/m and the steady force [N]
    (210000, 0.5)
    """

    #: [rad/s].
    omega: float
    #: [m].
    wave_amplitude: float
    #: Complex force per unit amplitude, phase at x = 0; shape (m,).
    excitation_force: ComplexArray
    #: Mean second-order force [N, N, N m]; shape (m,).
    mean_drift: Array
    #: Wind and current; shape (m,).
    steady: Array
    #: P3 leaves the time law open: the mean force with the ramp of the waves, or times 1 + cos(2 omega t).
    drift_law: Literal["ramped", "pulsating"] = "ramped"
    #: Length of the cosine ramp of all forces [s].
    ramp: float = 0.0

    def __post_init__(self) -> None:
        positive(self.omega, "omega")
        for name in ("excitation_force", "mean_drift", "steady"):
            finite(getattr(self, name), name)

    @property
    def shortest_period(self) -> float:
        """The wave period, half of it when the drift pulsates [s]."""
        period = 2.0 * math.pi / self.omega
        return 0.5 * period if self.drift_law == "pulsating" and np.any(self.mean_drift) else period

    @property
    def longest_step(self) -> float:
        """Longest step that resolves the wave and its drift [s]."""
        return self.shortest_period / STEPS_PER_PERIOD

    def fitted_step(self, time_step: float) -> float:
        """Return the longest step up to ``time_step`` that divides the period [s].

        Parameters
        ----------
        time_step : float
            Longest step that is wanted [s].
        """
        period = 2.0 * math.pi / self.omega
        return period / math.ceil(period / time_step - 1e-9)

    def sample(self, step: float, count: int) -> tuple[Array, Array]:
        """Return forces and the incident surface at x = 0.

        Parameters
        ----------
        step : float
            Distance of the samples, which begin at 0 s [s].
        count : int
            Number of samples.

        Returns
        -------
        tuple of ndarray (count, m) and (count,)
            Forces of the modes [N, N m] and surface elevation at x = 0 [m].
        """
        time = step * np.arange(count)
        shape = cosine_ramp(time, self.ramp)
        carrier = self.wave_amplitude * np.exp(-1j * self.omega * time)
        force = (carrier[:, None] * np.asarray(self.excitation_force)).real
        pulse = 1.0 + np.cos(2.0 * self.omega * time) if self.drift_law == "pulsating" else np.ones(count)
        force = force + pulse[:, None] * np.asarray(self.mean_drift) + np.asarray(self.steady)
        return shape[:, None] * force, shape * carrier.real


@checks_words
@dataclass(frozen=True)
class IrregularForcing:
    """A sum of wave components with slow drift after Newman [eq:floating-irregular-forcing].

    Raises
    ------
    InputError
        For frequencies that are not positive, values that are not finite, and drift that is missing or changes its sign
        where the law does not allow it.

    Examples
    --------
    The same force per metre at every frequency follows the surface; :meth:`of_sea` takes coefficients of a body:

    >>> import numpy as np
    >>> from moyai.floating import IrregularForcing
    >>> from moyai.sea import Water, spectra, synthesise
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> sea = synthesise(spectra.jonswap(1.0, 5.0, 3.3), water, duration=600.0, seed=1)
    >>> per_metre = np.full((len(sea.omega), 1), 1e5 + 0j)
    >>> waves = IrregularForcing(sea.omega, sea.complex_amplitude, per_metre, None, np.zeros(1), drift_law="none")
    >>> force, elevation = waves.sample(0.25, 2400)
    >>> bool(np.allclose(force[:, 0], 1e5 * elevation)), round(4.0 * float(elevation.std()), 2)   # height [m]
    (True, 1.0)
    """

    #: [rad/s], any order, several headings may share a frequency; shape (k,).
    omega: Array
    #: Complex amplitudes ``a exp(i phase)`` at x = 0 [m]; shape (k,).
    amplitude: ComplexArray
    #: Complex force per unit amplitude of each component; shape (k, m).
    excitation_force: ComplexArray
    #: Mean drift force over amplitude squared of each component [N/m2]; shape (k, m).
    drift: Array | None
    #: Wind and current, and the mean drift when ``drift_law`` is ``"ramped"``; shape (m,).
    steady: Array
    #: ``newman``: T_ij = (T_i + T_j)/2, any sign [eq:floating-newman]. ``newman_product``: T_ij = sqrt(T_i T_j), for
    #: drift of one sign. ``ramped``: the mean alone.
    drift_law: Literal["newman", "newman_product", "ramped", "none"] = "newman"
    #: [s].
    ramp: float = 0.0
    #: Share of the wave energy below ``shortest_period``'s frequency.
    energy_share: float = 0.99

    def __post_init__(self) -> None:
        positive(float(np.min(self.omega)), "omega")
        if self.drift_law != "none" and self.drift is None:
            raise InputError("slow drift needs the drift coefficients", parameter="drift", remedy='or drift_law="none"')
        if self.drift_law == "newman_product" and self.drift is not None:
            low, high = np.min(self.drift, axis=0), np.max(self.drift, axis=0)
            if np.any((low < 0.0) & (high > 0.0)):
                raise InputError(
                    "the drift changes sign over the spectrum", parameter="drift", remedy='use drift_law="newman"'
                )
        for name in ("omega", "amplitude", "excitation_force", "steady"):
            finite(getattr(self, name), name)

    @classmethod
    @checks_words
    def of_sea(
        cls,
        sea: WaveComponents,
        hydrodynamics: Hydrodynamics,
        *,
        drift_per_amplitude_squared: ArrayLike | None = None,
        steady: ArrayLike | None = None,
        drift_law: Literal["newman", "newman_product", "ramped", "none"] = "newman",
        ramp: float = 0.0,
    ) -> IrregularForcing:
        """Return the forcing of a sea on a body.

        Parameters
        ----------
        sea : WaveComponents
            Realisation; components without energy are left out.
        hydrodynamics : Hydrodynamics
            Coefficients of the whole unit.
        drift_per_amplitude_squared : array_like (n,) or (n, m) or None
            Mean drift over amplitude squared at the frequencies of the coefficients, along the first mode or all modes
            [N/m2]; from :func:`moyai.floating.far_field.drift_force_per_amplitude_squared`.
        steady : array_like (m,) or None
            Wind and current [N, N, N m].
        drift_law, ramp
            As for the class.

        Raises
        ------
        InputError
            When the sea holds no energy, the drift is not finite, or a heading lies outside the computed ones.
        """
        size = hydrodynamics.size
        amplitude = sea.complex_amplitude
        keep = np.abs(amplitude) > 0.0
        if not np.any(keep):
            raise InputError("the sea holds no energy", parameter="sea")
        omega, amplitude = sea.omega[keep], amplitude[keep]
        single = len(hydrodynamics.heading) == 1
        drift = None
        if drift_per_amplitude_squared is not None:
            given = np.asarray(finite(np.asarray(drift_per_amplitude_squared, dtype=float), "drift"))
            columns = np.zeros((len(hydrodynamics.omega), size))
            columns[:, : 1 if given.ndim == 1 else size] = given.reshape(len(given), -1)
            inside = np.clip(omega, hydrodynamics.omega[0], hydrodynamics.omega[-1])
            drift = np.column_stack([np.interp(inside, hydrodynamics.omega, column) for column in columns.T])
        return cls(
            omega=omega,
            amplitude=amplitude,
            excitation_force=hydrodynamics.excitation_at(omega, None if single else sea.heading[keep]),
            drift=drift,
            steady=np.zeros(size) if steady is None else np.asarray(steady, dtype=float),
            drift_law=drift_law,
            ramp=ramp,
        )

    @property
    def shortest_period(self) -> float:
        """Period below which less than ``1 - energy_share`` of the wave energy lies [s]."""
        order = np.argsort(self.omega)
        energy = np.cumsum(np.abs(self.amplitude[order]) ** 2)
        last = int(np.searchsorted(energy, self.energy_share * energy[-1]))
        return 2.0 * math.pi / float(self.omega[order][min(last, len(order) - 1)])

    @property
    def longest_step(self) -> float:
        """Longest step that resolves the zero-crossing period 2 pi sqrt(m0/m2) and the shortest one [s]."""
        energy = np.abs(self.amplitude) ** 2
        mean = 2.0 * math.pi * math.sqrt(float(np.sum(energy) / np.sum(energy * self.omega**2)))
        return min(mean / STEPS_PER_PERIOD, self.shortest_period / STEPS_PER_SHORTEST)

    @property
    def repeat_period(self) -> float:
        """Time after which components on a uniform grid repeat [s]; ``inf`` when they are on none."""
        unique = np.unique(self.omega)
        if len(unique) < 2:
            return 2.0 * math.pi / float(unique[0])
        base = float(np.min(np.diff(unique)))
        multiples = self.omega / base
        if np.max(np.abs(multiples - np.round(multiples))) > 1e-6:
            return math.inf
        # All multiples at once fix the base better than the smallest difference does
        return 2.0 * math.pi * float(np.sum(np.round(multiples)) / np.sum(self.omega))

    def fitted_step(self, time_step: float) -> float:
        """Return a step [s] that divides the repeat period into a number that Fourier transforms like.

        Parameters
        ----------
        time_step : float
            Longest step that is wanted [s]; returned as it is for a sea that does not repeat.
        """
        repeat = self.repeat_period
        if math.isinf(repeat):
            return time_step
        from scipy.fft import next_fast_len

        return float(repeat / next_fast_len(math.ceil(repeat / time_step - 1e-9)))

    def mean_drift(self) -> Array:
        """Return the mean drift force (m,) of the sea, sum of T_i |a_i|^2."""
        if self.drift is None or self.drift_law == "none":
            return np.zeros(self.excitation_force.shape[1])
        return np.asarray(np.abs(self.amplitude) ** 2 @ self.drift, dtype=float)

    def sample(self, step: float, count: int) -> tuple[Array, Array]:
        """Return forces and the incident surface at x = 0.

        Parameters
        ----------
        step : float
            Distance of the samples, which begin at 0 s [s].
        count : int
            Number of samples.

        Returns
        -------
        tuple of ndarray (count, m) and (count,)
            Forces of the modes [N, N m] and surface elevation at x = 0 [m].
        """
        surface = self.amplitude[:, None]
        products = None
        if self.drift is not None and self.drift_law == "newman":
            products = surface * self.drift, surface
        elif self.drift is not None and self.drift_law == "newman_product":
            share = surface * np.sqrt(np.abs(self.drift))
            products = np.sign(np.sum(self.drift, axis=0)) * share, share
        elevation = real_sum(self.omega, surface, step, count)[:, 0]
        force = real_sum(self.omega, surface * self.excitation_force, step, count, products)
        if self.drift_law == "ramped":
            force += self.mean_drift()
        shape = cosine_ramp(step * np.arange(count), self.ramp)
        force += np.asarray(self.steady, dtype=float)
        force *= shape[:, None]
        return force, shape * elevation
