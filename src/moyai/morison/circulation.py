"""The circulation that orbital flow builds around a member at low Keulegan-Carpenter numbers.

Arai et al. measured a circulation in the sense of the orbit, Gamma = gamma V^2 T, whose Magnus force explains the fall
of the inertia coefficient like KC^2. Here it is a state that relaxes towards gamma v_x v_y T [eq:circulation-state].
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.morison.orbits import orbit_amplitudes, orbit_product

Purpose = Literal["extreme", "response"]
Start = Literal["settled", "calm"]

#: Published strengths of the circulation, all as gamma of Gamma = gamma V^2 T
STRENGTHS: dict[str, float] = {
    # 18.0 KC^2 cm2/s at f = 0.95 Hz, B = 4.5 cm
    "arai": 18.0e-4 / (0.95 * 0.045**2),
    # C_M = 2 - (2/pi^2) KC^2
    "otsuka": 1.0,
    # C_M = 2 - 0.21 KC^2
    "chaplin": 0.21 * math.pi**2 / 2.0,
}
#: Circulation at the edge of the Stokes layer, over V^2 T (small KC, circular orbit): Eulerian and of particles
LAMINAR_EDGE = 3.0
LAMINAR_EDGE_LAGRANGIAN = 5.0
#: Keulegan-Carpenter number up to which the law was measured, and up to which its value at the limit is held
LAW_LIMIT = 2.0
HELD_LIMIT = 3.0
#: Wave periods that the state takes to relax
RELAXATION_PERIODS = 5.0


@checks_words
@dataclass(frozen=True, eq=False)
class CirculationLaw:
    """How strong the circulation is and when it is counted.

    Raises
    ------
    InputError
        For an unknown name, a strength that is negative or beyond the laminar ceiling of particles, or tables that do
        not rise.

    Examples
    --------
    >>> from moyai.morison import CirculationLaw
    >>> CirculationLaw(strength=0.2).gamma()                             # a number is taken as it is [-]
    0.2
    """

    #: gamma of Gamma = gamma v_x v_y T: a number, or ``arai`` (0.936), ``otsuka`` (1), ``chaplin`` (1.036).
    strength: float | str = "arai"
    #: ``extreme``: no circulation, which keeps the larger force (the reduction is on the safe side to leave out).
    #: ``response``: with circulation, for prediction of response and fatigue. One of "extreme", "response".
    purpose: Purpose = "extreme"
    #: tau in wave periods.
    relaxation_periods: float = RELAXATION_PERIODS
    #: Whether the state begins at its mean target or at zero; one of "settled", "calm".
    start: Start = "settled"
    #: Rows (KC, reduction of C_M in a circular orbit) by the user, KC increasing; between the first and the last KC
    #: they replace the law.
    table: tuple[tuple[float, float], ...] = field(default=())
    #: Rows (beta, gamma) that replace ``strength``.
    beta_table: tuple[tuple[float, float], ...] = field(default=())

    def __post_init__(self) -> None:
        if isinstance(self.strength, str) and self.strength not in STRENGTHS:
            raise InputError(
                f"unknown circulation '{self.strength}'",
                parameter="strength",
                allowed="a number, " + ", ".join(STRENGTHS),
            )
        if not 0.0 <= self.gamma() <= LAMINAR_EDGE_LAGRANGIAN:
            raise InputError(
                f"strength is {self.gamma():g}",
                parameter="strength",
                allowed=f"0 to {LAMINAR_EDGE_LAGRANGIAN:g}, the laminar ceiling of particles",
            )
        if not (math.isfinite(self.relaxation_periods) and self.relaxation_periods > 0.0):
            raise InputError(
                f"relaxation_periods is {self.relaxation_periods:g}", parameter="relaxation_periods", allowed="above 0"
            )
        _check_rows("table", self.table, 2)
        _check_rows("beta_table", self.beta_table, 1)
        for beta, gamma in self.beta_table:
            if not 0.0 <= gamma <= LAMINAR_EDGE_LAGRANGIAN:
                raise InputError(
                    f"gamma is {gamma:g} at beta {beta:g}",
                    parameter="beta_table",
                    allowed=f"0 to {LAMINAR_EDGE_LAGRANGIAN:g}, the laminar ceiling of particles",
                )
        if any(fall < 0.0 for _, fall in self.table):
            raise InputError("table holds a reduction below 0", parameter="table", allowed="at least 0")

    @property
    def counted(self) -> bool:
        """Whether the circulation is counted at all."""
        return self.purpose == "response"

    def gamma(self, beta: float = math.nan) -> float:
        """Return gamma at a frequency parameter beta = B^2 f / nu (end values are kept outside the table).

        Parameters
        ----------
        beta : float
            Frequency parameter [-]; without it the strength of the law holds.
        """
        if self.beta_table and math.isfinite(beta):
            rows = np.asarray(self.beta_table)
            return float(np.interp(math.log(beta), np.log(rows[:, 0]), rows[:, 1]))
        return STRENGTHS[self.strength] if isinstance(self.strength, str) else float(self.strength)

    @property
    def largest(self) -> float:
        """Largest Keulegan-Carpenter number for which the law or the table speaks [-]."""
        return max(HELD_LIMIT, self.table[-1][0]) if self.table else HELD_LIMIT

    def share(self, keulegan_carpenter: ArrayLike, breadth: float, area: float, gamma: float) -> Array:
        """Return the factor on gamma v_x v_y T at a Keulegan-Carpenter number.

        One up to KC = 2; then the reduction of C_M keeps its value of KC = 2 up to KC = 3; beyond it nothing is
        counted, which is the safe side, unless the user's table speaks [eq:circulation-share].

        Parameters
        ----------
        keulegan_carpenter : array_like (...)
            [-].
        breadth : float
            Of the section [m].
        area : float
            Of the section [m2].
        gamma : float
            Strength of the circulation [-].
        """
        number = np.asarray(keulegan_carpenter, dtype=float)
        square = np.maximum(number, 1e-12) ** 2
        share = np.where(number <= LAW_LIMIT, 1.0, np.where(number <= HELD_LIMIT, LAW_LIMIT**2 / square, 0.0))
        if self.table and gamma > 0.0:
            rows = np.asarray(self.table)
            law = gamma * square * breadth**2 / (2.0 * math.pi * area)
            inside = (number >= rows[0, 0]) & (number <= rows[-1, 0])
            share = np.where(inside, np.interp(number, rows[:, 0], rows[:, 1]) / law, share)
            share = np.where(number > rows[-1, 0], 0.0, share)
        return np.asarray(share)

    def strength_at(self, keulegan_carpenter: ArrayLike, breadth: float, area: float, gamma: float) -> Array:
        """Return the gamma that is counted at a Keulegan-Carpenter number: the law's by its share, or the table's.

        Unlike :meth:`share` it also knows the table of a law whose own strength is zero.

        Parameters
        ----------
        keulegan_carpenter : array_like (...)
            [-].
        breadth : float
            Of the section [m].
        area : float
            Of the section [m2].
        gamma : float
            Strength of the law [-].
        """
        number = np.asarray(keulegan_carpenter, dtype=float)
        if gamma > 0.0 or not self.table:
            return np.asarray(gamma * self.share(number, breadth, area, gamma))
        # any strength stands in: the table replaces it, and outside the table the law gives nothing
        rows = self.table
        inside = (number >= rows[0][0]) & (number <= rows[-1][0])
        return np.asarray(np.where(inside, self.share(number, breadth, area, 1.0), 0.0))

    def reduction(self, keulegan_carpenter: ArrayLike, breadth: float, area: float, gamma: float) -> Array:
        """Return the fall of C_M in a circular orbit, gamma KC^2 B^2 / (2 pi A) with the gamma that is counted.

        Parameters
        ----------
        keulegan_carpenter : array_like (...)
            [-].
        breadth : float
            Of the section [m].
        area : float
            Of the section [m2].
        gamma : float
            Strength of the law [-].
        """
        number = np.asarray(keulegan_carpenter, dtype=float)
        counted = self.strength_at(number, breadth, area, gamma)
        return np.asarray(counted * number**2 * breadth**2 / (2.0 * math.pi * area))


def _check_rows(name: str, rows: tuple[tuple[float, float], ...], least: int) -> None:
    if not rows:
        return
    values = np.asarray(rows, dtype=float)
    if values.ndim != 2 or values.shape[1] != 2 or not np.isfinite(values).all():
        raise InputError(f"{name} needs rows of two numbers", parameter=name)
    if len(values) < least or not (np.diff(values[:, 0]) > 0.0).all() or values[0, 0] <= 0.0:
        raise InputError(f"{name} does not rise from above 0", parameter=name, allowed=f"at least {least} rows, rising")


def settled_circulation(gamma: float, first: ArrayLike, second: ArrayLike, period: ArrayLike) -> Array:
    """Return gamma v_x v_y T [m2/s] of an elliptic orbit with its axes along the section [eq:circulation-law].

    Parameters
    ----------
    gamma : float
        Strength, see ``STRENGTHS``.
    first, second : array_like
        Velocity amplitudes v_x, v_y [m/s].
    period : array_like
        T [s].
    """
    return np.asarray(gamma * np.asarray(first) * np.asarray(second) * np.asarray(period))


def inertia_reduction(
    circulation: ArrayLike, omega: float, area: float, first: ArrayLike, second: ArrayLike
) -> tuple[Array, Array]:
    """Return the fall of the inertia coefficients along both axes that a circulation makes [eq:circulation-reduction].

    Parameters
    ----------
    circulation : array_like
        Gamma [m2/s].
    omega, area : float
        Angular frequency [rad/s], area of the section [m2].
    first, second : array_like
        Velocity amplitudes [m/s]; the ratio of the other one to it scales the fall along an axis.
    """
    whole = np.asarray(circulation) / (omega * area)
    return np.asarray(whole * np.asarray(second) / first), np.asarray(whole * np.asarray(first) / second)


def magnus_force(density: float, circulation: ArrayLike, velocity: ArrayLike) -> Array:
    """Return rho Gamma (-w, u) [N/m] for velocities (u, w) of shape (..., 2) [eq:circulation-magnus]."""
    u = np.asarray(velocity, dtype=float)
    strength = density * np.asarray(circulation, dtype=float)
    return np.stack([-strength * u[..., 1], strength * u[..., 0]], axis=-1)


def target_circulation(
    law: CirculationLaw,
    velocity: ArrayLike,
    acceleration: ArrayLike,
    omega: ArrayLike,
    *,
    breadth: float,
    area: float,
    gamma: float | None = None,
) -> Array:
    """Return gamma v_x v_y T of the momentary orbit, with the factor of the Keulegan-Carpenter number [m2/s].

    Parameters
    ----------
    law : CirculationLaw
    velocity, acceleration : array_like, shape (..., 2)
        Orbital motion relative to the member, without current, in axes of the section.
    omega : array_like
        Angular frequency, broadcast against the leading axes [rad/s].
    breadth, area : float
        Of the section [m], [m2].
    gamma : float, optional
        Strength; that of the law when absent.
    """
    strength = law.gamma() if gamma is None else gamma
    period = 2.0 * math.pi / np.asarray(omega, dtype=float)
    major, _ = orbit_amplitudes(velocity, acceleration, omega)
    counted = law.strength_at(major * period / breadth, breadth, area, strength)
    return np.asarray(counted * orbit_product(velocity, acceleration, omega) * period)


def relaxed(target: ArrayLike, step: float, relaxation: ArrayLike, start: ArrayLike) -> Array:
    """Return the state of dGamma/dt = (target - Gamma) / tau on a uniform time grid [eq:circulation-state].

    Parameters
    ----------
    target : array_like, shape (times, ...)
        Linear between the times.
    step : float
        Time step [s].
    relaxation : array_like
        tau [s], broadcast over the trailing axes.
    start : array_like
        State at the first time.

    Returns
    -------
    ndarray, shape of ``target``
        Exact for a target that is linear between the times, whatever the step.
    """
    wanted = np.asarray(target, dtype=float)
    ratio = step / np.asarray(relaxation, dtype=float)
    decay = np.exp(-ratio)
    # weights of the old and the new target in the exact step
    rise = -np.expm1(-ratio) / ratio
    old, new = rise - decay, 1.0 - rise
    out = np.empty_like(wanted)
    out[0] = start
    for n in range(1, len(wanted)):
        out[n] = decay * out[n - 1] + old * wanted[n - 1] + new * wanted[n]
    return out
