"""The memory of the water between all motions of all units: a rational function with common poles, passive.

Coefficients of three-dimensional programs are known over a band of frequencies only. Poles and residues meet them there
together with the added mass at infinite frequency; between and beyond them damping may nowhere be negative.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.validity import IdentityCheck
from moyai.potential.vector_fitting import fit_poles, partial_fractions, starting_poles

#: Accepted error of the fit and accepted negative damping, over the largest response of a pair of motions
FIT, PASSIVE = 0.05, 1e-5
#: Error at which no further poles are tried
GOAL = 0.01
#: Fewest frequencies; real states of one motion that are tried, and the most of them
FEWEST, MOST = 6, 60
ORDERS = (6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 28, 32, 38, 44, 52, 60)
_COLUMNS = 48
_KEPT = 1e-4
#: Most and fewest rounds of the search for a passive fit; weight of the nearest passive damping over that of the data
_ROUNDS, _LEAST, _PULL = 50, 15, 1.0
_MARGIN = 1e-7
_BEYOND = 30.0
_OUTSIDE = 0.3
#: Least real part of a pole over the step of the frequencies about it
_SHARPEST = 0.3


@dataclass(frozen=True, eq=False)
class RowMemory:
    """Memory force ``-Re(sum_k R_k z_k)`` with ``z_k' = p_k z_k + v`` [eq:units-memory]."""

    #: One of each conjugate pair, real parts negative [1/s]; shape (k,).
    poles: ComplexArray
    #: Symmetric; the partner of a complex pole is in; shape (k, m, m).
    residues: ComplexArray
    #: That goes with them; shape (m, m).
    infinite_added_mass: Array
    #: Largest error over the band, over the largest response of the pair of motions.
    error: float
    #: Smallest eigenvalue of the damping over all frequencies, in the same measure.
    least_damping: float
    #: As ``error``, outside of the band of the waves as well.
    error_outside: float

    @property
    def checks(self) -> tuple[IdentityCheck, ...]:
        """Accuracy and passivity."""
        return (
            IdentityCheck(
                "memory meets added mass and damping", self.error, FIT,
                "B - i omega (A - A_inf) over the band, over the largest of the pair",
            ),
            IdentityCheck(
                "memory is passive", max(-self.least_damping, 0.0), PASSIVE, "least eigenvalue of the damping"
            ),
        )  # fmt: skip

    def kernel(self, time: Array) -> Array:
        """Return K(t) (n, m, m)."""
        growth = np.exp(self.poles[None, :] * np.asarray(time, dtype=float)[:, None])
        return np.asarray(np.einsum("tk,kij->tij", growth, self.residues).real)

    def misfit(self, omega: Array, added_mass: Array, damping: Array) -> Array:
        """Return the error (f,) at frequencies [rad/s] with given coefficients, over the largest of each pair."""
        own_mass, own_damping = self.coefficients(omega)
        s = -1j * np.asarray(omega, dtype=float)[:, None, None]
        wanted = damping + s * (added_mass - self.infinite_added_mass)
        apart = own_damping - damping + s * (own_mass - added_mass)
        return np.asarray((np.abs(apart) / _measure(wanted)).max(axis=(1, 2)))

    def coefficients(self, omega: Array) -> tuple[Array, Array]:
        """Return added mass and damping (n, m, m) at frequencies [rad/s]."""
        s = -1j * np.asarray(omega, dtype=float)[:, None]
        half = 0.5 * (1.0 / (s - self.poles))
        other = 0.5 * (1.0 / (s - self.poles.conj()))
        response = np.einsum("tk,kij->tij", half, self.residues) + np.einsum("tk,kij->tij", other, self.residues.conj())
        excess = -response.imag / np.asarray(omega, dtype=float)[:, None, None]
        return np.asarray(self.infinite_added_mass + excess), np.asarray(response.real)


@dataclass(frozen=True, eq=False)
class _Basis:
    """Partial fractions that vanish at zero frequency, with the slope of the added mass."""

    poles: ComplexArray
    null: Array

    @classmethod
    def of(cls, poles: ComplexArray) -> _Basis:
        at_zero = partial_fractions(np.zeros(1, dtype=complex), poles).real
        return cls(poles, np.asarray(np.linalg.svd(at_zero)[2][1:].T))

    def at(self, s: ComplexArray) -> ComplexArray:
        return np.asarray(partial_fractions(s, self.poles) @ self.null)

    def damping(self, omega: Array) -> Array:
        """Real parts (n, b), of every frequency over the size of its row: what is negative stays so."""
        rows = self.at(np.asarray(-1j * omega, dtype=complex)).real
        return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))

    def watched(self, top: float) -> Array:
        """Frequencies at which the damping is looked at: the band, beyond it, and around every pole."""
        around = [
            abs(pole.imag) + abs(pole.real) * np.linspace(-4.0, 4.0, 33) for pole in self.poles if pole.imag != 0.0
        ]
        every = np.concatenate([np.linspace(0.0, 1.5 * top, 501)[1:], np.geomspace(1.5, _BEYOND, 80) * top, *around])
        return np.unique(every[(every > 1e-3 * top) & (every <= _BEYOND * top)])


def fit_row_memory(
    omega: Array,
    added_mass: Array,
    damping: Array,
    *,
    band: tuple[float, float] | None = None,
    most: int = MOST,
    goal: float = GOAL,
) -> RowMemory:
    """Fit poles, residues and the added mass at infinite frequency to coefficients over a band.

    Parameters
    ----------
    omega : ndarray (f,)
        Increasing [rad/s].
    added_mass, damping : ndarray (f, m, m)
        Symmetric.
    band : (float, float) or None
        Frequencies of the waves [rad/s], where the fit is held to its data; those outside weigh a third.
    most : int
        Largest number of real states of one motion.
    goal : float
        Error at which no further poles are tried.

    Raises
    ------
    InputError
        When there are too few frequencies.
    ConvergenceError
        When the added mass at infinite frequency is such that the row would have no mass to move.
    """
    if len(omega) < FEWEST:
        raise InputError(
            f"{len(omega)} frequencies are too few for the memory of the water",
            parameter="omega", allowed=f"at least {FEWEST}",
        )  # fmt: skip
    middle = float(np.sqrt(omega[0] * omega[-1]))
    s: ComplexArray = np.asarray(-1j * omega / middle, dtype=complex)
    size = np.sqrt(np.maximum(np.abs(damping).max(axis=0).diagonal(), 1e-300))
    size = np.maximum(size, 1e-3 * np.sqrt(middle * np.abs(added_mass).max(axis=0).diagonal()))
    given: ComplexArray = np.asarray(
        (damping + s[:, None, None] * middle * added_mass) / np.outer(size, size), dtype=complex
    )
    rows, columns = np.triu_indices(len(size))
    shapes = _compressed(given[:, rows, columns])
    low, high = band or (0.0, np.inf)
    inside = (omega >= low * (1.0 - 1e-9)) & (omega <= high * (1.0 + 1e-9))
    weight = np.where(inside, 1.0, _OUTSIDE)
    best: tuple[float, _Basis, Array, Array] | None = None
    for order in [count for count in ORDERS if count <= min(most, 0.9 * len(omega))]:
        start = starting_poles(omega[0] / middle, omega[-1] / middle, order)
        poles = _resolved(fit_poles(s, shapes, weight, start, slope=True), omega / middle)
        basis = _Basis.of(poles)
        found, slope = _residues(basis, s, weight, given)
        error = float(_misfit(basis, s, given, found, slope)[inside].max())
        if best is None or error < 0.9 * best[0]:
            best = error, basis, found, slope
        if error < goal:
            break
    assert best is not None
    _, basis, found, slope = best
    found, slope, least = _passive(basis, s, weight, found, slope)
    misfit = _misfit(basis, s, given, found, slope)
    residues = _complex_residues(basis, found) * middle * np.outer(size, size)
    infinite = slope * np.outer(size, size) / middle
    return RowMemory(
        basis.poles * middle, residues, 0.5 * (infinite + infinite.T), float(misfit[inside].max()), least,
        float(misfit.max()),
    )  # fmt: skip


def _measure(response: ComplexArray) -> Array:
    top = np.abs(response).max(axis=0)
    return np.maximum(np.sqrt(np.outer(top.diagonal(), top.diagonal())), 1e-300)


def _resolved(poles: ComplexArray, omega: Array) -> ComplexArray:
    """Return the poles, none of them sharper than the frequencies about it resolve."""
    step = np.interp(np.abs(poles.imag), 0.5 * (omega[1:] + omega[:-1]), np.diff(omega))
    return np.asarray(np.minimum(poles.real, -_SHARPEST * step) + 1j * poles.imag)


def _compressed(entries: ComplexArray) -> ComplexArray:
    """Return the few columns (f, c) that all entries (f, e) are sums of."""
    stacked = np.concatenate([entries.real, entries.imag])
    left, values, _ = np.linalg.svd(stacked, full_matrices=False)
    keep = int(min(_COLUMNS, (values > _KEPT * values[0]).sum()))
    scaled = left[:, :keep] * values[:keep]
    half = len(entries)
    return np.asarray(scaled[:half] + 1j * scaled[half:])


def _stacked(basis: _Basis, s: ComplexArray, weight: Array) -> Array:
    rows = weight[:, None] * np.column_stack([basis.at(s), s])
    return np.concatenate([rows.real, rows.imag])


def _residues(basis: _Basis, s: ComplexArray, weight: Array, given: ComplexArray) -> tuple[Array, Array]:
    """Return coefficients (b, m, m) and slope (m, m) of the best fit with these poles."""
    count, m = given.shape[0], given.shape[1]
    flat = weight[:, None] * given.reshape(count, -1)
    solved = np.linalg.lstsq(_stacked(basis, s, weight), np.concatenate([flat.real, flat.imag]), rcond=1e-12)[0]
    return solved[:-1].reshape(-1, m, m), solved[-1].reshape(m, m)


def _misfit(basis: _Basis, s: ComplexArray, given: ComplexArray, found: Array, slope: Array) -> Array:
    """Return the error (f, m, m) over the largest response of each pair of motions."""
    own = np.einsum("fb,bij->fij", basis.at(s), found)
    wanted = given - s[:, None, None] * slope
    return np.asarray(np.abs(own - wanted) / _measure(wanted))


def _passive(basis: _Basis, s: ComplexArray, weight: Array, found: Array, slope: Array) -> tuple[Array, Array, float]:
    """Move the residues as little as can be until damping is nowhere negative [eq:units-passive].

    Nor is the added mass at infinite frequency. Least squares over the band and the nearest matrices without negative
    eigenvalues, damping at every watched frequency and that added mass, by turns (alternating directions of
    multipliers); what is left then is lifted alike in all motions.
    """
    design = _stacked(basis, s, weight)
    watched = basis.watched(float(np.abs(s).max()))
    damping = basis.damping(watched)
    scale = float(np.linalg.norm(np.einsum("wb,bij->wij", damping, found), axis=(1, 2)).max())
    size = found.shape[1]
    rows = np.column_stack([damping, np.zeros(len(damping))])
    rows = np.vstack([rows, np.eye(rows.shape[1])[-1]])
    first = np.concatenate([found, slope[None]]).reshape(-1, size * size)
    normal = design.T @ design
    pull = _PULL * np.trace(normal) / np.trace(rows.T @ rows)
    inverse = np.linalg.inv(normal + pull * rows.T @ rows)
    now, held = first, np.zeros((len(rows), size * size))
    for turn in range(_ROUNDS):
        own = (rows @ now).reshape(-1, size, size)
        if float(np.linalg.eigvalsh(own)[:, 0].min()) >= -0.1 * PASSIVE * scale and (turn == 0 or turn >= _LEAST):
            break
        values, vectors = np.linalg.eigh(own + held.reshape(-1, size, size))
        nearest = (vectors * np.maximum(values, _MARGIN * scale)[:, None, :]) @ vectors.swapaxes(1, 2)
        held = held + (own - nearest).reshape(len(rows), -1)
        now = inverse @ (normal @ first + pull * rows.T @ (nearest.reshape(len(rows), -1) - held))
    short = float(np.linalg.eigvalsh((rows @ now).reshape(-1, size, size))[:, 0].min())
    if short < 0.0:
        triangle: Array = np.asarray(np.linalg.qr(design, mode="r"), dtype=float)
        lift = -1.01 * short * _passive_function(rows, triangle)
        now = now + lift[:, None] * np.eye(size).ravel()
    moved = now.reshape(-1, size, size)
    moved = 0.5 * (moved + moved.swapaxes(1, 2))
    every = np.einsum("wb,bij->wij", basis.at(np.asarray(-1j * watched, dtype=complex)).real, moved[:-1])
    largest = np.abs(np.einsum("fb,bij->fij", basis.at(s), moved[:-1])).max()
    return moved[:-1], moved[-1], float(np.linalg.eigvalsh(every)[:, 0].min() / largest)


def _passive_function(rows: Array, triangle: Array) -> Array:
    """Return coefficients and slope (b + 1,) of the smallest function that is 1 or more in every row."""
    turned = np.linalg.solve(triangle.T, rows.T)
    # least distance (Lawson and Hanson): min |y| with y turned >= 1
    stack = np.vstack([turned, np.ones(len(rows))])
    unit = np.zeros(len(stack))
    unit[-1] = 1.0
    from scipy.optimize import nnls

    rest = stack @ nnls(stack, unit, maxiter=100 * stack.shape[1])[0] - unit
    return np.asarray(np.linalg.solve(triangle, -rest[:-1] / rest[-1]))


def _complex_residues(basis: _Basis, found: Array) -> ComplexArray:
    """Return residues (k, m, m), doubled for poles that stand for a pair."""
    real = np.einsum("nb,bij->nij", basis.null, found)
    out = np.empty((len(basis.poles), *found.shape[1:]), dtype=complex)
    row = 0
    for number, pole in enumerate(basis.poles):
        if pole.imag == 0.0:
            out[number] = real[row]
            row += 1
        else:
            out[number] = 2.0 * (real[row] + 1j * real[row + 1])
            row += 2
    return out


def check_mass(inertia: Array, memory: RowMemory) -> None:
    """Refuse a memory whose added mass leaves the row without mass.

    Raises
    ------
    ConvergenceError
    """
    if float(np.linalg.eigvalsh(inertia + memory.infinite_added_mass)[0]) <= 0.0:
        raise ConvergenceError(
            "the memory of the water leaves the row without mass",
            remedy="give more memory frequencies or smaller panels",
        )
