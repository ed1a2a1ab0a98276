"""Impact tension when a slack curtain snaps taut in a current: model A, its closed form, model A2, similarity numbers.

Model A of Sawaragi, Aoki and Liu (1991): the skirt is a rigid plate, the cable stretches, the added mass of the water
carries the momentum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.sea.water import Water
from moyai.structures.curtain.impact.added_mass import flat_skirt_mass
from moyai.structures.curtain.impact.kernels import energy_peak, energy_peaks, spring, taut_shape

_SOURCE = "Sawaragi, Aoki and Liu (1991)"
# Peak time over sqrt(d/g) above which waves made during the impact matter
_SHORT_RISE = 0.6
_LARGEST_STRAIN = 0.02


@dataclass(frozen=True)
class Impact:
    """One span of a curtain that becomes taut while it drifts with the current.

    Raises
    ------
    InputError
        When a number is not positive, the cable is shorter than the span, or the skirt is deeper than the water.

    Examples
    --------
    >>> from moyai.sea import Water
    >>> from moyai.structures import Impact
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> span = Impact(10.0, 10.2, 2.0, upper_stiffness=1e6, lower_stiffness=1e6, speed=0.3, water=water)
    >>> round(span.span_ratio, 3), span.stiffness                        # [-], of both cables [N]
    (0.98, 2000000.0)
    """

    #: Distance B of the supports [m].
    span: float
    #: Unstretched length l >= B of cables and skirt along the span [m].
    length: float
    #: Depth d of the skirt as a flat plate [m].
    draught: float
    #: EA of the upper cable [N]; model A takes the sum of both.
    upper_stiffness: float
    #: EA of the lower cable [N].
    lower_stiffness: float
    #: Speed U0 of the curtain when it becomes taut [m/s].
    speed: float
    #: Depth, density, gravity.
    water: Water

    def __post_init__(self) -> None:
        for name in ("span", "length", "draught", "upper_stiffness", "lower_stiffness", "speed"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0, finite")
        if self.length < self.span:
            raise InputError(
                f"length is {self.length:g} m, shorter than the span of {self.span:g} m: the cable is never slack",
                parameter="length",
                allowed=f"at least {self.span:g} m",
                remedy="the static solution takes a shorter cable, as pretension",
            )
        if self.draught >= self.water.depth:
            raise InputError(
                f"draught is {self.draught:g} m in water {self.water.depth:g} m deep",
                parameter="draught",
                allowed=f"less than {self.water.depth:g} m",
            )

    @property
    def stiffness(self) -> float:
        """Sum of EA of both cables [N]."""
        return self.upper_stiffness + self.lower_stiffness

    @property
    def span_ratio(self) -> float:
        """R = B/l [-]."""
        return self.span / self.length

    @property
    def deep_mass(self) -> float:
        """M0 = 2 rho d^2 / pi, the added mass of the paper [kg/m] [eq:impact-plate-mass]."""
        return 2.0 * self.water.density * self.draught**2 / math.pi


@dataclass(frozen=True)
class ImpactPeak:
    """The spike of the tension."""

    #: Sum of the tensions of both cables [N].
    tension: float
    #: Of mid-span from the just-taut shape [m].
    displacement: float
    #: From the taut instant to the peak [s].
    time: float


def moved_mass(impact: Impact, mass: float | None) -> float:
    """Return the added mass given [kg/m], or M0 of the paper where none is.

    Raises
    ------
    InputError
        When it is not positive.
    """
    if mass is None:
        return impact.deep_mass
    if not (math.isfinite(mass) and mass > 0.0):
        raise InputError(f"mass is {mass:g} kg/m", parameter="mass", allowed="greater than 0, finite")
    return float(mass)


def peak_by_energy(impact: Impact, mass: float | None = None) -> ImpactPeak:
    """Return the peak of model A in the limit of small time steps: kinetic energy becomes work [eq:impact-energy].

    Parameters
    ----------
    impact : Impact
        The span.
    mass : float, optional
        Added mass per metre of span [kg/m]; M0 of the paper by default.
    """
    moved = moved_mass(impact, mass)
    tension, displacement, time, _ = energy_peak(impact.span, impact.length, impact.stiffness, impact.speed, moved)
    return ImpactPeak(tension, displacement, time)


def sweep_peaks(span: ArrayLike, length: ArrayLike, stiffness: ArrayLike, speed: ArrayLike, mass: ArrayLike) -> Array:
    """Return tension [N], displacement [m], time [s], load [N/m] (..., 4) of model A for arrays of parameters.

    Parameters
    ----------
    span, length : array_like
        B and l >= B [m].
    stiffness : array_like
        Sum of EA [N].
    speed : array_like
        U0 [m/s].
    mass : array_like
        Added mass per metre of span [kg/m].

    Raises
    ------
    InputError
        When a number is not positive or a cable is shorter than its span.
    """
    parts = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (span, length, stiffness, speed, mass)))
    for name, values in zip(("span", "length", "stiffness", "speed", "mass"), parts):
        if not (np.isfinite(values).all() and (values > 0.0).all()):
            raise InputError(f"{name} contains {values.min():g}", parameter=name, allowed="greater than 0, finite")
    if (parts[1] < parts[0]).any():
        raise InputError("a length is shorter than its span", parameter="length", allowed="at least the span")
    out = np.empty((parts[0].size, 4))
    energy_peaks(*(np.array(values).ravel() for values in parts), out)
    return out.reshape(*parts[0].shape, 4)


def speed_factor(span_ratio: ArrayLike) -> Array:
    """Return g(R) of the closed form T = g U0 sqrt(m EA), small strain [eq:impact-closed-form].

    It is less than the square root of R, which the energy of the whole span would give [eq:impact-bound].

    Raises
    ------
    InputError
        When a ratio is not within (0, 1].
    """
    ratio = np.asarray(span_ratio, dtype=float)
    if not (np.all(ratio > 0.0) and np.all(ratio <= 1.0)):
        raise InputError("span_ratio is out of range", parameter="span_ratio", allowed="0 < R <= 1")
    out = np.empty(ratio.shape)
    for index in np.ndindex(ratio.shape):
        b = taut_shape(float(ratio[index]))
        if b < 1e-3:
            out[index] = math.sqrt(2.0 / 3.0) * (1.0 - 7.0 * b * b / 60.0)
        else:
            top, bottom = _slopes(b)
            out[index] = math.sqrt(top / (math.sinh(b) * bottom))
    return out


def _slopes(b: float) -> tuple[float, float]:
    """b cosh b - sinh b and b sinh b - cosh b + 1."""
    if b < 0.3:
        s = b * b
        top = b * s * (1.0 / 3.0 + s * (1.0 / 30.0 + s * (1.0 / 840.0 + s / 45360.0)))
        return top, s * (0.5 + s * (0.125 + s * (1.0 / 144.0 + s / 5760.0)))
    return b * math.cosh(b) - math.sinh(b), b * math.sinh(b) - math.cosh(b) + 1.0


def closed_form(impact: Impact, mass: float | None = None) -> ImpactPeak:
    """Return the small-strain peak of model A; time and displacement are infinite for l = B [eq:impact-closed-form].

    Parameters
    ----------
    impact : Impact
        The span.
    mass : float, optional
        Added mass per metre of span [kg/m]; M0 of the paper by default.

    Returns
    -------
    ImpactPeak
        Tension of both cables together [N], displacement of the middle [m] and time [s] after the span became taut.

    Raises
    ------
    InputError
        For an added mass that is not positive.

    Examples
    --------
    >>> from moyai.sea import Water
    >>> from moyai.structures.curtain.impact.cable import Impact, closed_form
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> span = Impact(10.0, 10.2, 2.0, upper_stiffness=1e6, lower_stiffness=1e6, speed=0.3, water=water)
    >>> round(closed_form(span).tension)
    17369
    """
    moved = moved_mass(impact, mass)
    tension = float(speed_factor(impact.span_ratio)) * impact.speed * math.sqrt(moved * impact.stiffness)
    b = taut_shape(impact.span_ratio)
    if b == 0.0:
        return ImpactPeak(tension, math.inf, math.inf)
    top, bottom = _slopes(b)
    rate = 2.0 * top / bottom
    curvature = impact.span / (2.0 * b)
    frequency = math.sqrt(impact.stiffness * rate / (moved * impact.length * curvature))
    return ImpactPeak(tension, impact.speed / frequency, 0.5 * math.pi / frequency)


@dataclass(frozen=True, eq=False)
class EdgeImpact:
    """Model A2: both cables apart."""

    #: [s].
    time: Array
    #: Tension of the upper cable [N].
    upper_tension: Array
    #: Tension of the lower cable [N].
    lower_tension: Array
    #: Largest relative change of kinetic energy plus work of the springs.
    energy_error: float

    @property
    def upper_peak(self) -> float:
        """Largest tension of the upper cable [N]."""
        return float(self.upper_tension.max())

    @property
    def lower_peak(self) -> float:
        """Largest tension of the lower cable [N]."""
        return float(self.lower_tension.max())

    @property
    def sum_peak(self) -> float:
        """Sum of both peaks, which need not fall together [N]."""
        return self.upper_peak + self.lower_peak

    @property
    def simultaneous_peak(self) -> float:
        """Largest sum of both tensions at one instant [N]."""
        return float((self.upper_tension + self.lower_tension).max())


@checks_words
def edge_impact(
    impact: Impact, *, duration: float | None = None, samples: int = 2000, finite_depth: bool = False
) -> EdgeImpact:
    """Solve model A2: upper and lower edge move apart, coupled by the water [eq:impact-edges].

    Parameters
    ----------
    impact : Impact
        The span; its two stiffnesses act on their own edges.
    duration : float, optional
        [s]; 1.75 times the rise of model A by default, so that a later rotation is seen.
    samples : int
        Points of the series.
    finite_depth : bool
        Whether the 2x2 added mass is that in the depth of the water, or in deep water as the paper takes it.
    """
    from scipy.integrate import solve_ivp

    if duration is not None and not (math.isfinite(duration) and duration > 0.0):
        raise InputError(f"duration is {duration:g} s", parameter="duration", allowed="greater than 0, finite")
    if samples < 2:
        raise InputError(f"samples is {samples}", parameter="samples", allowed="at least 2")
    plate = flat_skirt_mass(impact.draught, impact.water if finite_depth else impact.water.with_depth(math.inf))
    inverse = np.linalg.inv(plate.matrix)
    taut = taut_shape(impact.span_ratio)
    stiffness = impact.upper_stiffness, impact.lower_stiffness
    last = 1.75 * peak_by_energy(impact).time if duration is None else float(duration)

    def loads(q: Array) -> tuple[Array, Array]:
        pairs = [spring(q[k], impact.span, impact.span_ratio, taut, stiffness[k]) for k in (0, 1)]
        return np.array([pair[0] for pair in pairs]), np.array([pair[1] for pair in pairs])

    def rate(_time: float, state: Array) -> Array:
        load, _ = loads(state[:2])
        # The last entry is the work done against the springs
        return np.array([*state[2:4], *(-inverse @ load), load @ state[2:4]])

    start = np.array([0.0, 0.0, impact.speed, impact.speed, 0.0])
    time = np.linspace(0.0, last, samples)
    state = solve_ivp(rate, (0.0, last), start, "DOP853", time, rtol=1e-10, atol=1e-13, max_step=0.02 * last).y
    tension = np.array([loads(q)[1] for q in state[:2].T])
    kinetic = 0.5 * np.einsum("it,ij,jt->t", state[2:4], plate.matrix, state[2:4])
    error = float(np.abs((kinetic + state[4]) / kinetic[0] - 1.0).max())
    return EdgeImpact(time, tension[:, 0], tension[:, 1], error)


@dataclass(frozen=True)
class ImpactNumbers:
    """Dimensionless numbers of an impact, equation (7) of the paper [eq:impact-numbers]."""

    #: C_T = T/(rho U^2 B d/2) [-].
    tension_coefficient: float
    #: C_E = sqrt(EA/rho)/(h sqrt(gh)) [-].
    cauchy_number: float
    #: Fr = U/sqrt(gh) [-].
    froude_number: float


def impact_numbers(impact: Impact, tension: float) -> ImpactNumbers:
    """Return the dimensionless numbers that belong to a tension [N]; the depth must be finite.

    Raises
    ------
    InputError
        In infinite depth.
    """
    water = impact.water
    if math.isinf(water.depth):
        raise InputError(
            "the depth is infinite", parameter="water.depth", allowed="finite", remedy="Fr and C_E need it"
        )
    wave_speed = math.sqrt(water.gravity * water.depth)
    return ImpactNumbers(
        tension / (0.5 * water.density * impact.speed**2 * impact.span * impact.draught),
        math.sqrt(impact.stiffness / water.density) / (water.depth * wave_speed),
        impact.speed / wave_speed,
    )


def check_impact(impact: Impact) -> tuple[Notice, ...]:
    """Tell where model A leaves its range."""
    peak, water = peak_by_energy(impact), impact.water
    notices = []
    rise = peak.time / math.sqrt(impact.draught / water.gravity)
    if rise > _SHORT_RISE:
        notices.append(
            Notice(
                "impact-slow",
                f"The tension rises for {rise:.3g} √(d/g); the added mass of infinite frequency is valid below "
                f"{_SHORT_RISE}, and the peak is higher with the memory of the waves",
                rise,
                _SHORT_RISE,
                remedy="use the model with memory",
                source="Cummins form: 2 % at 0.64, 26 % at 1.86",
            )
        )
    strain = peak.tension / impact.stiffness
    if strain > _LARGEST_STRAIN:
        notices.append(
            Notice(
                "impact-strain",
                f"The cable stretches by {100.0 * strain:.2g} %; the closed form is for small strain",
                strain,
                _LARGEST_STRAIN,
                remedy="use the energy form and the cable's own load curve",
                source=_SOURCE,
            )
        )
    ratio = flat_skirt_mass(impact.draught, water).total / impact.deep_mass
    if ratio > 1.01:
        notices.append(
            Notice(
                "impact-bed",
                f"The bed raises the added mass to {ratio:.3g} M0; the paper's M0 is for deep water",
                ratio,
                1.01,
                remedy="give the mass of a flat skirt in this depth",
                source="thin plate at infinite frequency",
            )
        )
    return tuple(notices)
