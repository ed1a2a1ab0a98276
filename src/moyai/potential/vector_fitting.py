"""Poles common to all entries of a frequency response, and residues under linear conditions.

Poles by relaxed vector fitting: B. Gustavsen, Improving the pole relocating properties of vector fitting, IEEE
Transactions on Power Delivery 21 (2006) 1587-1592. Everything here is scaled: unit frequency and unit response.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from moyai.core.arrays import Array, ComplexArray

_ITERATIONS = 24
_LEAST_DAMPING = 1e-4


def starting_poles(low: float, high: float, count: int) -> ComplexArray:
    """Return ``count`` stable poles (one of each pair, upper half plane), spread over the band; an odd one is real."""
    pairs = count // 2
    frequency = np.geomspace(low, high, pairs) if pairs > 1 else np.array([np.sqrt(low * high)][:pairs])
    poles = frequency * (-0.3 + 1.0j)
    if count % 2:
        poles = np.append(poles, -np.sqrt(low * high))
    return np.asarray(poles, dtype=complex)


def partial_fractions(s: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """Return the basis (k, n) with real coefficients: both parts of a pair's residue, or a real residue."""
    columns = []
    for pole in poles:
        first = 1.0 / (s - pole)
        if pole.imag == 0.0:
            columns.append(first)
        else:
            second = 1.0 / (s - pole.conj())
            columns += [first + second, 1j * (first - second)]
    return np.array(columns).T


def _stacked(matrix: ComplexArray) -> Array:
    return np.concatenate([matrix.real, matrix.imag], axis=0)


def fit_poles(
    s: ComplexArray, entries: ComplexArray, weight: Array, poles: ComplexArray, *, slope: bool = False
) -> ComplexArray:
    """Relocate poles until they settle, [eq:memory-vector-fitting].

    Parameters
    ----------
    s : ndarray (k,)
        Points on the imaginary axis.
    entries : ndarray (k, e)
        Entries of the response.
    weight : ndarray (k,)
        Weight of every point.
    poles : ndarray
        Where to start; one of each pair.
    slope : bool
        Whether every entry has a part proportional to ``s`` next to the poles.
    """
    for _ in range(_ITERATIONS):
        basis = partial_fractions(s, poles)
        own = np.column_stack([basis, s]) if slope else basis
        size = own.shape[1]
        blocks = []
        for entry in entries.T:
            # unknowns: residues of the entry, then those of sigma with its constant
            left = weight[:, None] * np.column_stack([own, -entry[:, None] * basis, -entry])
            triangle: Array = np.asarray(np.linalg.qr(_stacked(left), mode="r"))
            blocks.append(triangle[size:, size:])
        # Relaxation: the mean of the real part of sigma is 1, which rules out the trivial solution
        scale = float(np.linalg.norm(weight[:, None] * entries)) / len(s)
        mean = scale * np.append(basis.real.sum(axis=0), len(s))
        system = np.vstack([*blocks, mean])
        right = np.zeros(len(system))
        right[-1] = scale * len(s)
        norm = np.linalg.norm(system, axis=0)
        solution = np.linalg.lstsq(system / norm, right, rcond=None)[0] / norm
        constant = solution[-1]
        if abs(constant) < 1e-8:
            constant = np.copysign(1e-8, constant)
        moved = _zeros(poles, solution[:-1] / constant)
        settled = len(moved) == len(poles) and np.allclose(np.sort_complex(moved), np.sort_complex(poles), rtol=1e-6)
        poles = moved
        if settled:
            break
    return poles


def _zeros(poles: ComplexArray, residues: Array) -> ComplexArray:
    """Zeros of 1 + sum of residues over (s - pole), mirrored into the stable half plane: the next poles."""
    size = len(residues)
    matrix, inputs = np.zeros((size, size)), np.zeros(size)
    row = 0
    for pole in poles:
        if pole.imag == 0.0:
            matrix[row, row], inputs[row] = pole.real, 1.0
            row += 1
        else:
            matrix[row : row + 2, row : row + 2] = [[pole.real, pole.imag], [-pole.imag, pole.real]]
            inputs[row] = 2.0
            row += 2
    values = np.linalg.eigvals(matrix - np.outer(inputs, residues))
    values = np.where(np.abs(values.imag) < 1e-10 * np.abs(values), values.real + 0j, values)
    kept = values[values.imag >= 0.0]
    # a pole on the axis would ring for ever
    damping = np.maximum(np.abs(kept.real), _LEAST_DAMPING * np.abs(kept))
    turned: ComplexArray = -damping + 1j * kept.imag
    return turned


@dataclass(frozen=True, eq=False)
class LeastSquares:
    """Least squares with conditions, as a problem of least distance (Lawson and Hanson).

    All that meets the equalities is ``particular + back y``, its residual ``|y - target|`` and a constant.
    """

    particular: Array
    back: Array
    target: Array

    @classmethod
    def of(cls, matrix: Array, right: Array, equal: tuple[Array, Array]) -> LeastSquares:
        """Return the problem of the least ``|matrix x - right|``.

        Parameters
        ----------
        matrix, right : ndarray (k, n), (k,)
        equal : (E, f)
            Conditions ``E x = f``; may have no rows.
        """
        e, f = equal
        size = matrix.shape[1]
        particular: Array = np.zeros(size)
        null: Array = np.eye(size)
        if len(e):
            particular = np.asarray(np.linalg.lstsq(e, f, rcond=None)[0], dtype=float)
            null = np.linalg.svd(e)[2][np.linalg.matrix_rank(e) :].T
        reduced = matrix @ null
        left, values, turned = np.linalg.svd(reduced, full_matrices=False)
        keep = values > 1e-12 * values[0]
        back = null @ (turned[keep].T / values[keep])
        return cls(particular, back, left[:, keep].T @ (right - matrix @ particular))

    def solution(self, at_least: tuple[Array, Array] | None = None) -> Array:
        """Return the unknowns, with ``G x >= h`` for (G, h) where they are given."""
        y = self.target
        if at_least is not None and len(at_least[0]):
            g, h = at_least
            condition = g @ self.back
            bound = h - g @ self.particular - condition @ self.target
            # least distance: min |u| with condition u >= bound
            scale = np.linalg.norm(condition, axis=1)
            scale[scale == 0.0] = 1.0
            stack = np.vstack([(condition / scale[:, None]).T, bound / scale])
            unit = np.zeros(len(stack))
            unit[-1] = 1.0
            dual, _ = nnls(stack, unit, maxiter=50 * stack.shape[1])
            rest = stack @ dual - unit
            if abs(rest[-1]) > 1e-14:
                y = self.target - rest[:-1] / rest[-1]
        best: Array = self.particular + self.back @ y
        return best
