"""Rational approximation of the memory, so that a time step costs the same however long the memory is.

F = -c z, z' = a z + b velocity with a real block-diagonal a; stable and passive, with the exact damping of slow motion.
See docs/theory/memory.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.validity import IdentityCheck
from moyai.potential.damping_model import DampingModel
from moyai.potential.memory import MemoryFunctions, pair_measure
from moyai.potential.vector_fitting import (
    LeastSquares,
    fit_poles,
    partial_fractions,
    starting_poles,
)

_COUPLED = 1e-6
_NOTHING = 1e-5  # of the largest response: D(0) below it is taken for zero
_SLOW = 0.03  # largest weight of slow motions is 1 over this
_ROUNDS = 12
#: More poles must gain this; after so many without gain the data themselves are not passive to the tolerance
_GAIN, _PATIENCE, _NEAR = 0.9, 6, 5.0
_PASSIVITY_POINTS = 2500
_PASSIVE = 0.2  # of the tolerance: the damping of sections that narrow upwards is itself not passive beyond the band
_RANK = 1e-5  # of the tolerance: parts of residues below it are left out
_MARGIN = 5e-3  # of the tolerance: damping that the repair leaves where it lifts


@dataclass(frozen=True)
class StateSpace:
    """Memory force ``-Re(outputs z)`` with ``z' = poles z + inputs velocity``, [eq:memory-state-space]."""

    #: One of each conjugate pair (imaginary part not negative), real parts negative [1/s]; shape (n,).
    poles: ComplexArray
    #: Complex modal form; shape (n, m).
    inputs: ComplexArray
    #: The partner of a complex pole is already in: its factor 2; shape (m, n).
    outputs: ComplexArray
    #: Largest error of the frequency response over the largest response of the pair of modes.
    error: float
    #: Smallest eigenvalue of the damping over all frequencies, in the same measure; not negative if passive.
    least_damping: float
    #: Accuracy, passivity, damping of slow motion.
    checks: tuple[IdentityCheck, ...]

    @property
    def size(self) -> int:
        """Number of modes."""
        return int(self.outputs.shape[0])

    @property
    def order(self) -> int:
        """Number of real states."""
        return int(np.sum(np.where(self.poles.imag > 0.0, 2, 1)))

    @property
    def feedthrough(self) -> Array:
        """Nothing passes directly: K has no delta function (m, m)."""
        return np.zeros((self.size, self.size))

    @property
    def a(self) -> Array:
        """Real block-diagonal system matrix (order, order) [1/s]."""
        return self._real()[0]

    @property
    def b(self) -> Array:
        """Real input matrix (order, m)."""
        return self._real()[1]

    @property
    def c(self) -> Array:
        """Real output matrix (m, order); the force is ``-c z``."""
        return self._real()[2]

    def _real(self) -> tuple[Array, Array, Array]:
        n, m = self.order, self.size
        a, b, c = np.zeros((n, n)), np.zeros((n, m)), np.zeros((m, n))
        row = 0
        for pole, entry, exit_ in zip(self.poles, self.inputs, self.outputs.T, strict=True):
            a[row, row], b[row], c[:, row] = pole.real, entry.real, exit_.real
            if pole.imag > 0.0:
                # states: real and imaginary part of z; Re(o z) = Re o Re z - Im o Im z
                a[row : row + 2, row : row + 2] = [[pole.real, -pole.imag], [pole.imag, pole.real]]
                b[row + 1], c[:, row + 1] = entry.imag, -exit_.imag
                row += 1
            row += 1
        return a, b, c

    def velocity_kernel(self, time: ArrayLike) -> Array:
        """Return the memory kernel K(t) of the states, (t, m, m), in units of damping over time.

        Parameters
        ----------
        time : array_like (t,)
            [s].
        """
        t = np.atleast_1d(np.asarray(time, dtype=float))
        growth = np.exp(self.poles * t[:, None])
        values: Array = np.einsum("ik,tk,kj->tij", self.outputs, growth, self.inputs).real
        return values

    def response(self, omega: ArrayLike) -> ComplexArray:
        """Return the integral of K exp(i omega t), B - i omega (A - A_inf), (k, m, m).

        Parameters
        ----------
        omega : array_like (k,)
            [rad/s].
        """
        return _response(self.poles, self.inputs, self.outputs, np.atleast_1d(np.asarray(omega, dtype=float)))


def _response(poles: ComplexArray, inputs: ComplexArray, outputs: ComplexArray, omega: Array) -> ComplexArray:
    first = np.einsum("ik,tk,kj->tij", outputs, 1.0 / (-1j * omega[:, None] - poles), inputs)
    second = np.einsum("ik,tk,kj->tij", outputs.conj(), 1.0 / (-1j * omega[:, None] - poles.conj()), inputs.conj())
    return np.asarray(0.5 * (first + second), dtype=complex)


def fit_memory(
    memory: MemoryFunctions | DampingModel, *, tolerance: float = 1e-3, highest_order: int = 24
) -> StateSpace:
    """Fit the memory over all frequencies by a state space [eq:memory-state-space].

    Parameters
    ----------
    memory : MemoryFunctions or DampingModel
        From :func:`memory_functions`, or its ``model``: damping of m modes at every frequency [kg/s, kg m/s, kg m2/s].
    tolerance : float
        Error of the frequency response at which the order stops rising, over the largest response of the pair of modes.
    highest_order : int
        Poles at most.

    Returns
    -------
    StateSpace
        Poles [1/s], inputs and outputs of the model, its error and the checks of accuracy and passivity; ``order`` real
        states.

    Raises
    ------
    InputError
        For a tolerance outside 1e-8 to 0.2.
    ConvergenceError
        When the highest order does not fit the memory.

    References
    ----------
    B. Gustavsen and A. Semlyen (1999), Rational approximation of frequency domain responses by vector fitting, IEEE
    Trans. Power Delivery 14(3), 1052-1061 [eq:memory-vector-fitting].

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.potential import fit_memory, memory_functions
    >>> omega = np.linspace(0.05, 20.0, 60)
    >>> damping = (omega**2 * np.exp(-omega)).reshape(-1, 1, 1)
    >>> memory = memory_functions(omega, damping, [[1.0]], np.linspace(0.0, 10.0, 101), start="zero")
    >>> fitted = fit_memory(memory, tolerance=1e-2)
    >>> fitted.size, fitted.error < 0.02, bool(fitted.poles.real.max() < 0.0)
    (1, True, True)
    """
    model = memory.model if isinstance(memory, MemoryFunctions) else memory
    low, high = model.knots[1], model.knots[-1]
    # the knots crowd where the damping turns sharply, which an even grid would step over
    inner = model.knots[2:-1]
    even = np.concatenate([np.linspace(0.0, low, 9)[1:-1], np.geomspace(low, 6.0 * high, 140)])
    omega = np.unique(np.concatenate([even, inner, 0.5 * (inner[1:] + inner[:-1])]))
    return fit_state_space(
        omega,
        model.response(omega),
        steady_dashpot=model.steady,
        tolerance=tolerance,
        highest_order=highest_order,
    )


def fit_state_space(
    omega: ArrayLike,
    response: ArrayLike,
    *,
    steady_dashpot: ArrayLike,
    tolerance: float = 1e-3,
    highest_order: int = 24,
) -> StateSpace:
    """Fit a stable, passive state-space model to the frequency response of the memory.

    Parameters
    ----------
    omega : array_like (n,)
        Increasing, greater than 0 [rad/s]; beyond the highest the response should be small.
    response : array_like (n, m, m)
        B - i omega (A - A_inf), symmetric.
    steady_dashpot : array_like (m, m)
        D(0): reproduced exactly, but for noise below 1e-5 of the largest response and negative eigenvalues.
    tolerance : float
        Largest error over the largest response of the pair of modes.
    highest_order : int
        Most poles (counting both of a pair) that one group of coupled modes may take.

    Returns
    -------
    StateSpace

    Raises
    ------
    InputError
        When shapes disagree or something is not finite.
    ConvergenceError
        When even five times the tolerance is not reached. Between the two the best model is returned and its check
        of accuracy fails: data whose tails are not passive cannot be met more closely by a passive model.
    """
    w, h, steady = _checked(omega, response, steady_dashpot, tolerance)
    measure = pair_measure(np.abs(h))
    unit = np.sqrt(np.diag(measure))
    scaled, goal = h / np.outer(unit, unit), _physical(steady / np.outer(unit, unit))
    steady = goal * np.outer(unit, unit)
    m = len(unit)
    poles: list[complex] = []
    inputs: list[ComplexArray] = []
    outputs: list[ComplexArray] = []
    for group in _groups(scaled):
        index = np.ix_(group, group)
        part = scaled[:, index[0], index[1]]
        if float(np.abs(part).max()) < 1e-12:
            continue
        found, residues = _fit_group(w, part, goal[index], tolerance, highest_order)
        for pole, residue in zip(found, residues, strict=True):
            for entry, exit_ in _rank_terms(residue, pole, _RANK * tolerance):
                full_in, full_out = np.zeros(m, dtype=complex), np.zeros(m, dtype=complex)
                full_in[group], full_out[group] = entry, exit_
                poles.append(pole)
                inputs.append(full_in * unit)
                outputs.append(full_out * unit)
    shape = (len(poles), m)
    result = (
        np.array(poles, dtype=complex),
        np.array(inputs, dtype=complex).reshape(shape),
        np.array(outputs, dtype=complex).reshape(shape).T,
    )
    return _judged(result, w, h, steady, unit, tolerance)


def _checked(
    omega: ArrayLike, response: ArrayLike, steady_dashpot: ArrayLike, tolerance: float
) -> tuple[Array, ComplexArray, Array]:
    w, h = np.asarray(omega, dtype=float), np.asarray(response, dtype=complex)
    steady = np.asarray(steady_dashpot, dtype=float)
    if w.ndim != 1 or len(w) < 8 or (w <= 0.0).any() or (np.diff(w) <= 0.0).any() or not np.isfinite(w).all():
        raise InputError("omega is not positive and increasing, or has fewer than 8 entries", parameter="omega")
    if h.ndim != 3 or h.shape[0] != len(w) or h.shape[1] != h.shape[2] or not np.isfinite(h).all():
        raise InputError(f"response has the shape {h.shape} or is not finite", parameter="response")
    if steady.shape != h.shape[1:] or not np.isfinite(steady).all():
        raise InputError(f"steady dashpot has the shape {steady.shape} or is not finite", parameter="steady_dashpot")
    if not 1e-8 <= tolerance <= 0.2:
        raise InputError(f"tolerance is {tolerance:g}", parameter="tolerance", allowed="1e-8 to 0.2")
    return w, 0.5 * (h + np.swapaxes(h, 1, 2)), 0.5 * (steady + steady.T)


def _physical(steady: Array) -> Array:
    """Take rounding and interpolation noise out of D(0): entries that are nothing, eigenvalues below zero."""
    values, vectors = np.linalg.eigh(np.where(np.abs(steady) < _NOTHING, 0.0, steady))
    return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)


def _groups(scaled: ComplexArray) -> list[NDArray[np.intp]]:
    """Modes that are coupled, directly or through others."""
    linked = np.abs(scaled).max(axis=0) > _COUPLED
    reach = np.linalg.matrix_power(linked.astype(int) + np.eye(len(linked), dtype=int), len(linked)) > 0
    seen: list[NDArray[np.intp]] = []
    for row in range(len(linked)):
        members = np.flatnonzero(reach[row])
        if members[0] == row:
            seen.append(members)
    return seen


def _fit_group(
    w: Array, h: ComplexArray, steady: Array, tolerance: float, highest_order: int
) -> tuple[ComplexArray, ComplexArray]:
    """Raise the number of poles until the passive fit is good enough; in scaled units of the response."""
    unit = math.sqrt(w[0] * w[-1])
    x = w / unit
    s: ComplexArray = np.asarray(1j * x, dtype=complex)
    rows, columns = np.triu_indices(h.shape[1])
    # the transform with exp(+i omega t) is the conjugate
    entries = h[:, rows, columns].conj()
    # Slow motions (drift on soft moorings) are damped by little: below the peak the little counts by its own size
    size = np.sqrt(np.abs(np.einsum("tii->t", h.real)) / np.abs(np.einsum("tii->t", h.real)).max())
    weight = np.where(np.arange(len(x)) < np.argmax(size), 1.0 / np.maximum(size, _SLOW), 1.0)
    best, kept, since = math.inf, None, 0
    for count in range(2, highest_order + 1):
        poles = fit_poles(s, entries, weight, starting_poles(x[0] * 2.0, x[-1] / 4.0, count))
        residues = _residues(x, poles, entries, weight, steady[rows, columns], (rows, columns), _MARGIN * tolerance)
        error = float(np.abs(partial_fractions(s, poles) @ residues - entries).max())
        since += 1
        if error < _GAIN * best:
            best, kept, since = error, (poles, residues), 0
        if best <= tolerance or (since >= _PATIENCE and best <= _NEAR * tolerance):
            break
    if kept is None or best > _NEAR * tolerance:
        raise ConvergenceError(
            f"the memory is fitted to {best:.2g} of its largest response with {highest_order} poles",
            parameter="tolerance",
            allowed=f"asked for {tolerance:g}",
            remedy="raise the tolerance or the highest order, or check that the frequencies resolve the damping",
        )
    return kept[0] * unit, _complex_residues(*kept, rows, columns) * unit


def _columns_to_matrix(residues: Array, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> Array:
    """(n, e) of the upper triangle to (n, m, m)."""
    size = int(rows.max()) + 1
    out = np.empty((len(residues), size, size))
    out[:, rows, columns] = residues
    out[:, columns, rows] = residues
    return out


def _residues(
    x: Array,
    poles: ComplexArray,
    entries: ComplexArray,
    weight: Array,
    steady: Array,
    triangle: tuple[NDArray[np.intp], NDArray[np.intp]],
    margin: float,
) -> Array:
    """Least squares for all entries with the exact value at zero frequency, then cuts until the fit is passive."""
    rows, columns = triangle
    basis = partial_fractions(np.asarray(1j * x, dtype=complex), poles)
    stacked = np.tile(weight, 2)[:, None] * np.concatenate([basis.real, basis.imag])
    both = np.tile(weight, 2)[:, None]
    right = both * np.concatenate([entries.real, entries.imag])
    at_zero: Array = partial_fractions(np.zeros(1, dtype=complex), poles).real
    count = len(rows)
    # dips sit next to lightly damped poles and may be narrower than the steps of an even grid
    near_poles = np.abs(poles.imag)[:, None] + np.abs(poles.real)[:, None] * np.linspace(-4.0, 4.0, 17)
    even = np.geomspace(0.05 * x[0], 200.0 * x[-1], _PASSIVITY_POINTS)
    dense = np.unique(np.concatenate([even, near_poles[(near_poles > even[0]) & (near_poles < even[-1])]]))
    dense_basis = partial_fractions(np.asarray(1j * dense, dtype=complex), poles).real
    # Conditions compare damping at all frequencies on one footing: the fit falls like omega^-2, and where nothing is
    # left at zero frequency (sway, roll) it starts with omega^2
    lift = 1.0 + (dense / x[-1]) ** 2
    if not steady.any():
        lift = lift * (1.0 + 1.0 / dense**2)
        floor = np.full(len(dense), margin)
    else:
        floor = margin * dense**2 / (dense**2 + 1.0)
    cuts: list[Array] = []
    bounds: list[float] = []
    # block system: unknowns ordered entry by entry
    matrix = np.kron(np.eye(count), stacked)
    goal = right.T.ravel()
    equal: tuple[Array, Array] = (np.asarray(np.kron(np.eye(count), at_zero), dtype=float), steady)
    double = np.where(rows == columns, 1.0, 2.0)
    problem = LeastSquares.of(matrix, goal, equal)
    solution = problem.solution().reshape(count, -1).T
    for _ in range(_ROUNDS):
        damping = (
            np.einsum("tn,nij->tij", dense_basis, _columns_to_matrix(solution, rows, columns)) * lift[:, None, None]
        )
        values, vectors = np.linalg.eigh(damping)
        lowest = values[:, 0] - 0.5 * floor
        if (lowest > -1e-13).all():
            break
        before, after = np.append(np.inf, lowest[:-1]), np.append(lowest[1:], np.inf)
        dips = np.flatnonzero((lowest < 0.0) & (lowest <= before) & (lowest <= after))
        # neighbours as well: the dip moves when it is lifted
        near = np.unique(np.clip(dips[:, None] + np.array([-6, -2, 0, 2, 6]), 0, len(dense) - 1))
        for place in near:
            for direction in vectors[place].T[values[place] < 1e-3]:
                quadratic = double * direction[rows] * direction[columns]
                cuts.append(np.outer(quadratic, dense_basis[place] * lift[place]).ravel())
                bounds.append(floor[place])
        limits = (np.array(cuts), np.array(bounds))
        solution = problem.solution(limits).reshape(count, -1).T
    return solution


def _complex_residues(
    poles: ComplexArray, residues: Array, rows: NDArray[np.intp], columns: NDArray[np.intp]
) -> ComplexArray:
    """Residue matrices (n, m, m), one for each pole of the list."""
    out, row = [], 0
    whole = _columns_to_matrix(residues, rows, columns)
    for pole in poles:
        if pole.imag == 0.0:
            out.append(whole[row] + 0j)
            row += 1
        else:
            out.append(whole[row] + 1j * whole[row + 1])
            row += 2
    return np.array(out)


def _rank_terms(residue: ComplexArray, pole: complex, cut: float) -> list[tuple[ComplexArray, ComplexArray]]:
    """Split a residue into terms (input, output) of rank one and drop those that cannot be seen."""
    factor = 2.0 if pole.imag > 0.0 else 1.0
    # a real pole has a real residue and must keep real factors
    kept = residue if pole.imag > 0.0 else residue.real
    left, values, right = (np.asarray(part) for part in np.linalg.svd(kept))
    terms: list[tuple[ComplexArray, ComplexArray]] = []
    for k, value in enumerate(values):
        if value * factor > cut * abs(pole.real):
            root = math.sqrt(value)
            entry, leaving = right[k] * (root + 0j), left[:, k] * (factor * root + 0j)
            terms.append((np.asarray(entry, dtype=complex), np.asarray(leaving, dtype=complex)))
    return terms


def _judged(
    parts: tuple[ComplexArray, ComplexArray, ComplexArray],
    w: Array,
    h: ComplexArray,
    steady: Array,
    unit: Array,
    tolerance: float,
) -> StateSpace:
    """Measure accuracy, passivity and the damping of slow motion of the finished model."""
    poles, inputs, outputs = parts
    scale = np.outer(unit, unit)
    error = float(np.max(np.abs(_response(poles, inputs, outputs, w) - h) / scale))
    wide = np.concatenate([[0.0], np.geomspace(1e-3 * w[0], 1e4 * w[-1], 4000)])
    answer = _response(poles, inputs, outputs, wide).real / scale
    # damping beyond the band falls like omega^-2: judged with that taken out
    lowest = np.linalg.eigvalsh(0.5 * (answer + np.swapaxes(answer, 1, 2)))[:, 0] * (1.0 + (wide / w[-1]) ** 2)
    least = float(lowest.min())
    slow = float(np.max(np.abs(answer[0] - steady / scale)))
    checks = (
        IdentityCheck(
            "state space: frequency response", error, 1.05 * tolerance, "largest error over largest response"
        ),
        IdentityCheck(
            "state space: passive",
            max(0.0, -least),
            _PASSIVE * tolerance,
            "the memory gives energy at no frequency, to a part of the error of the fit",
        ),
        IdentityCheck("state space: damping of slow motion", slow, 1e-6, "the response at zero frequency is D(0)"),
    )
    return StateSpace(poles, inputs, outputs, error, least, checks)
