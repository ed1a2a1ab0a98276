"""Coefficients of a three-dimensional program as loads of a body in time: excitation, memory, hydrostatics."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.memory import StateSpaceMemory
from moyai.sea.components import WaveComponents

if TYPE_CHECKING:
    import xarray as xr


DOFS = ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")
#: Accuracy and size of the states of the radiation memory.
STATE_TOLERANCE, MOST_POLES = 1e-3, 24
#: Worst fit of the memory that is taken, over the largest response of each pair of motions.
WORST_FIT = 0.1


@checks_words
@dataclass(frozen=True, eq=False)
class WaveLoads:
    """First-order loads of waves on a body, about one point, in axes of the body at rest [eq:coupled-excitation].

    The axes of the coefficients are those of the body at rest; radiation and restoring turn with the body, the heading
    of the waves is counted from its yaw.

    Examples
    --------
    Heave alone; coefficients of a program come in by :meth:`from_dataset`:

    >>> import numpy as np
    >>> from moyai.coupled import WaveLoads
    >>> from moyai.floating import StateSpaceMemory
    >>> from moyai.sea import WaveComponents, wave_number
    >>> force = np.zeros((2, 1, 6), complex)                             # frequencies, headings, motions [N/m]
    >>> force[:, 0, 2] = 1.5e5, 1.2e5
    >>> loads = WaveLoads(
    ...     omega=np.array([0.6, 1.0]), headings=np.zeros(1), amplitude=force,
    ...     infinite_frequency_added_mass=1e4 * np.eye(6), stiffness=np.diag([0.0, 0.0, 1.6e5, 2e5, 2e5, 0.0]),
    ...     memory=StateSpaceMemory.none(6), displaced_volume=16.0, reference=np.zeros(3),
    ...     equilibrium_position=np.zeros(3),
    ... )
    >>> omega = np.array([1.0])
    >>> wave = WaveComponents(omega, np.array([0.5]), np.zeros(1), np.zeros(1), wave_number(omega, 10.0, 9.81))
    >>> crest = loads.excitation(wave).force(0.0, np.zeros(3), yaw=0.0, growth=1.0)
    >>> round(float(crest[2]))                                           # 0.5 m times 1.2e5 N/m [N]
    60000
    """

    #: [rad/s]; shape (n,).
    omega: Array
    #: Directions of travel [rad], increasing; shape (m,).
    headings: Array
    #: Exciting force per unit amplitude, Re(X exp(-i omega t)), phase at the origin of the coefficients; shape (n, m,
    #: 6).
    amplitude: ComplexArray
    #: Added mass at infinite frequency; shape (6, 6).
    infinite_frequency_added_mass: Array
    #: Hydrostatic stiffness; shape (6, 6).
    stiffness: Array
    memory: StateSpaceMemory
    #: At rest [m3].
    displaced_volume: float
    #: Point that rotations and moments are about, in the axes of the coefficients (z from still water) [m]; shape (3,).
    reference: Array
    #: Where the origin of the body axes stands at rest in site axes [m]; shape (3,).
    equilibrium_position: Array
    #: Yaw at rest [rad].
    equilibrium_yaw: float = 0.0
    #: Origin of the coefficients in body axes, x and y [m].
    origin: tuple[float, float] = (0.0, 0.0)
    #: Phases of the waves at the present place of the body instead of its place at rest.
    follow: bool = False
    #: Identities of the memory.
    checks: tuple[IdentityCheck, ...] = ()
    #: Notices of the memory.
    notices: tuple[Notice, ...] = ()

    @classmethod
    @checks_words
    def from_dataset(
        cls,
        dataset: xr.Dataset,
        *,
        displaced_volume: float,
        equilibrium_position: ArrayLike,
        equilibrium_yaw: float = 0.0,
        origin: tuple[float, float] = (0.0, 0.0),
        stiffness: ArrayLike | None = None,
        follow: bool = False,
        memory: bool = True,
    ) -> WaveLoads:
        """Take over a dataset in Capytaine's names (what :func:`moyai.interop.read.read_coefficients` returns).

        Parameters
        ----------
        dataset : xarray.Dataset
            All six rigid-body degrees of freedom, with infinite-frequency added mass.
        displaced_volume : float
            At rest [m3].
        equilibrium_position : array_like (3,)
            Where the origin of the body axes stands when the body floats as the coefficients say [m].
        equilibrium_yaw, origin, follow
            As for the class.
        stiffness : array_like (6, 6), optional
            Hydrostatic with the weight of the body, about the reference point; that of the dataset when left out.
        memory : bool
            Whether the damping becomes a memory; without it the body radiates nothing.

        Raises
        ------
        InputError
            For missing degrees of freedom, added mass at infinite frequency or stiffness.
        """
        names = [str(name) for name in dataset["radiating_dof"].values]
        if set(names) != set(DOFS):
            raise InputError(
                f"the coefficients have {', '.join(names)}", parameter="loads.coefficients", allowed=", ".join(DOFS),
                remedy="compute all six rigid-body motions",
            )  # fmt: skip
        for needed in ("infinite_frequency_added_mass", "excitation_force"):
            if needed not in dataset:
                raise InputError(
                    f"the coefficients have no {needed.replace('_', ' ')}", parameter="loads.coefficients",
                    remedy="compute it, or give more frequencies so that it can be found from the damping",
                )  # fmt: skip
        if stiffness is None and "hydrostatic_stiffness" not in dataset:
            raise InputError(
                "the coefficients have no hydrostatic stiffness",
                parameter="loads.stiffness",
                remedy="give the stiffness",
            )
        if not (math.isfinite(displaced_volume) and displaced_volume > 0.0):
            raise InputError(
                f"displaced volume is {displaced_volume:g} m3",
                parameter="loads.displaced_volume",
                allowed="greater than 0",
            )
        data = dataset.sel(radiating_dof=list(DOFS), influenced_dof=list(DOFS)).sortby("wave_direction")
        infinite = 0.5 * (data["infinite_frequency_added_mass"].values + data["infinite_frequency_added_mass"].values.T)
        states = StateSpaceMemory.none(6)
        checks: tuple[IdentityCheck, ...] = ()
        notices: tuple[Notice, ...] = ()
        if memory:
            states, checks, notices = _memory(
                data["omega"].values, data["added_mass"].values, data["radiation_damping"].values, infinite
            )
        given = data["hydrostatic_stiffness"].values if stiffness is None else np.asarray(stiffness, dtype=float)
        return cls(
            np.array(data["omega"].values),
            np.array(data["wave_direction"].values),
            np.array(data["excitation_force"].transpose("omega", "wave_direction", "influenced_dof").values),
            infinite,
            np.array(given),
            states,
            float(displaced_volume),
            np.array(data["reference_point"].values, dtype=float),
            np.asarray(equilibrium_position, dtype=float),
            float(equilibrium_yaw),
            origin,
            follow,
            checks,
            notices,
        )

    def about(self, centre: Array, position: Array) -> WaveLoads:
        """Return the loads about the centre of gravity.

        Parameters
        ----------
        centre : ndarray (3,)
            Centre of gravity in body axes [m].
        position : ndarray (3,)
            Of the body at its start, site axes [m]; the loads do not depend on it.
        """
        old = self.reference
        new = np.array(
            [centre[0] - self.origin[0], centre[1] - self.origin[1], centre[2] + self.equilibrium_position[2]]
        )
        dx, dy, dz = old - new
        motion = np.eye(6)
        motion[:3, 3:] = np.array([[0.0, dz, -dy], [-dz, 0.0, dx], [dy, -dx, 0.0]])
        memory = StateSpaceMemory(
            self.memory.poles,
            np.ascontiguousarray(self.memory.inputs @ motion),
            np.ascontiguousarray(motion.T @ self.memory.outputs),
            np.asarray(motion.T @ self.memory.dashpot @ motion),
        )
        return replace(
            self,
            amplitude=self.amplitude @ motion,
            infinite_frequency_added_mass=motion.T @ self.infinite_frequency_added_mass @ motion,
            stiffness=motion.T @ self.stiffness @ motion,
            memory=memory,
            reference=new,
        )

    def excitation(self, waves: WaveComponents | None) -> Excitation | None:
        """Return the exciting force of these waves, or None in calm water.

        Parameters
        ----------
        waves : WaveComponents or None
            The sea; None is calm water.

        Raises
        ------
        InputError
            When the waves are outside the frequencies of the coefficients.
        """
        if waves is None or not np.any(waves.amplitude != 0.0):
            return None
        return Excitation(self, waves)


class Excitation:
    """Exciting force of a sea on a body that may turn; see :class:`WaveLoads`."""

    def __init__(self, loads: WaveLoads, waves: WaveComponents) -> None:
        from scipy.interpolate import CubicSpline

        low, high = float(loads.omega[0]), float(loads.omega[-1])
        strong = waves.amplitude**2 > 1e-6 * float(np.sum(waves.amplitude**2))
        used = waves.omega[strong]
        if used.min() < low * (1.0 - 1e-9) or used.max() > high * (1.0 + 1e-9):
            raise InputError(
                f"waves of {used.min():.4g} to {used.max():.4g} rad/s meet coefficients of {low:.4g} to {high:.4g} "
                "rad/s",
                parameter="loads.omega",
                allowed=f"{low:.4g} to {high:.4g} rad/s",
                remedy="compute the coefficients at more frequencies",
            )
        order = np.clip(waves.omega, low, high)
        if loads.omega.size > 1:
            self.table = np.asarray(CubicSpline(loads.omega, loads.amplitude)(order))
        else:
            self.table = np.repeat(loads.amplitude, order.size, axis=0)
        self.loads, self.waves = loads, waves
        turn = loads.equilibrium_yaw
        c, s = math.cos(turn), math.sin(turn)
        x, y = loads.origin
        self.place = np.array(
            [loads.equilibrium_position[0] + c * x - s * y, loads.equilibrium_position[1] + s * x + c * y]
        )
        # of the centre of gravity from the origin of the coefficients
        self.arm = loads.reference[:2]

    def _at_heading(self, relative: Array) -> ComplexArray:
        """Return the exciting force of every component at its heading relative to the body (n, 6)."""
        known = self.loads.headings
        wrapped = np.mod(relative - known[0] + 1e-12, 2.0 * math.pi) - 1e-12 + known[0]
        span = known[-1] - known[0]
        if known.size == 1 or span == 0.0:
            off = np.abs(np.mod(relative - known[0] + math.pi, 2.0 * math.pi) - math.pi)
            return self._checked(off < HEADING_SLACK, relative, self.table[:, 0])
        closed = span > 2.0 * math.pi - 1.5 * float(np.diff(known).max())
        grid = np.append(known, known[0] + 2.0 * math.pi) if closed else known
        # just before the first heading is also just there
        wrapped = np.where(
            ~np.asarray(closed) & (wrapped > 2.0 * math.pi + known[0] - HEADING_SLACK), known[0], wrapped
        )
        inside = wrapped <= grid[-1] + HEADING_SLACK
        right = np.clip(np.searchsorted(grid, wrapped), 1, grid.size - 1)
        part = np.clip((wrapped - grid[right - 1]) / (grid[right] - grid[right - 1]), 0.0, 1.0)[:, None]
        rows, count = np.arange(relative.size), known.size
        found = (1.0 - part) * self.table[rows, right - 1] + part * self.table[rows, right % count]
        return self._checked(inside, relative, found)

    def _checked(self, inside: NDArray[np.bool_], relative: Array, found: ComplexArray) -> ComplexArray:
        if not np.all(inside | (self.waves.amplitude == 0.0)):
            worst = math.degrees(float(relative[~inside][0]))
            known = ", ".join(f"{math.degrees(value):.4g}" for value in self.loads.headings)
            raise InputError(
                f"a wave meets the body at {worst:.4g} degrees, outside the headings of the coefficients",
                parameter="loads.wave_direction",
                allowed=known,
                remedy="compute more headings",
            )
        return found

    def force(self, time: float, place: Array, yaw: float, growth: float) -> Array:
        """Return force and moment about the centre of gravity in site axes (6,).

        Parameters
        ----------
        time : float
            [s].
        place : ndarray (3,)
            Centre of gravity in site axes [m].
        yaw : float
            Of the body [rad].
        growth : float
            Share of the waves that has grown, 0 to 1 [-].

        Returns
        -------
        ndarray (6,)
            [N, N m].

        Raises
        ------
        InputError
            When a wave meets the body outside the headings of the coefficients.
        """
        waves = self.waves
        c, s = math.cos(yaw), math.sin(yaw)
        x, y = self.place
        if self.loads.follow:
            x, y = place[0] - (c * self.arm[0] - s * self.arm[1]), place[1] - (s * self.arm[0] + c * self.arm[1])
        along = waves.wave_number * (x * np.cos(waves.heading) + y * np.sin(waves.heading))
        turn = waves.amplitude * np.exp(1j * (along - waves.omega * time + waves.phase))
        own = growth * np.real(turn @ self._at_heading(waves.heading - yaw))
        out: Array = own.copy()
        for first in (0, 3):
            out[first], out[first + 1] = c * own[first] - s * own[first + 1], s * own[first] + c * own[first + 1]
        return out


#: A wave this near to a heading counts as at it [rad].
HEADING_SLACK = math.radians(2.0)


def _memory(
    omega: Array, added: Array, damping: Array, infinite: Array
) -> tuple[StateSpaceMemory, tuple[IdentityCheck, ...], tuple[Notice, ...]]:
    """Return the memory of the water as states, with its error.

    Panels give damping that is rough at high frequency, where moments of a small body nearly vanish; the fit is then
    made to the response that the program gave, as closely as a stable and passive model can follow it.

    Raises
    ------
    InputError
        When none follows it within a tenth.
    """
    from moyai.potential.damping_model import fit_damping
    from moyai.potential.state_space import StateSpace, fit_memory, fit_state_space

    even = 0.5 * (damping + np.swapaxes(damping, 1, 2))
    mass = 0.5 * (added + np.swapaxes(added, 1, 2)) - infinite
    response = even - 1j * omega[:, None, None] * mass
    size = np.sqrt(np.abs(response).max(axis=0).diagonal())
    # couplings below a hundredth of their pair are noise of the panels
    small = np.abs(response).max(axis=0) < 0.01 * np.outer(size, size)
    response[:, small], even[:, small] = 0.0, 0.0
    found: list[StateSpace] = []
    try:
        model = fit_damping(omega, even, start="zero")
        found.append(fit_memory(model, tolerance=STATE_TOLERANCE, highest_order=MOST_POLES))
    except (ConvergenceError, InputError):
        for tolerance in (0.003, 0.01, 0.03):
            try:
                steady = np.zeros((6, 6))
                found.append(
                    fit_state_space(
                        omega, response, steady_dashpot=steady, tolerance=tolerance, highest_order=2 * MOST_POLES
                    )
                )
                break
            except ConvergenceError:
                continue
    best = min(found, key=lambda fit: fit.error, default=None)
    if best is None or best.error > WORST_FIT:
        raise InputError(
            "no stable memory follows the radiation of the coefficients",
            parameter="loads.radiation_damping",
            remedy="give more and higher frequencies and finer panels, or leave the memory out",
        )
    reported = Notice(
        "memory",
        f"{len(best.poles)} poles represent the radiation memory, the fitted frequency response within "
        f"{100.0 * best.error:.1g} % of the largest of each pair of motions",
        value=float(best.error),
        limit=0.01,
        severity="information" if best.error <= 0.01 else "warning",
        remedy="finer panels and a lid make the damping smoother",
    )
    kept = tuple(check for check in best.checks if "frequency response" not in check.name)
    return StateSpaceMemory.of(best), kept, (reported,)
