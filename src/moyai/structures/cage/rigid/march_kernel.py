"""Compiled time stepping of a rigid cage: fixed steps, and adaptive ones that land where a line goes taut or slack."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.structures.cage.rigid.load_kernel import line_state, slope, tautness, tension_of
from moyai.structures.cage.rigid.water_kernel import PackedCage


@njit(cache=True, error_model="numpy")
def march_fixed(
    p: PackedCage, y: Array, step: float, first: int, count: int, every: int, rows: Array, tension: Array, peak: Array
) -> int:
    """Runge-Kutta of fourth order with a fixed step, ``count`` of them from step number ``first``, its state included.

    Writes every ``every``-th state and returns the rows written so far, less than 0 where the state is lost.
    """
    size = y.size
    k = np.empty((4, size))
    stage = np.empty(size)
    force, mass, work = np.empty(3), np.empty((3, 3)), np.empty(6)
    taut = np.full(p.lines.shape[0], -1.0)
    written = -(-first // every)
    for n in range(first, first + count + 1):
        for i in range(p.lines.shape[0]):
            pull = tension_of(p, i, y, work)
            row = min((n + every // 2) // every, rows.shape[0] - 1)
            peak[row, i] = max(peak[row, i], pull)
            if n % every == 0:
                tension[written, i] = pull
        if n % every == 0:
            rows[written] = y
            written += 1
        if n == first + count:
            break
        now = n * step
        slope(p, now, y, taut, k[0], force, mass, work)
        for i in range(size):
            stage[i] = y[i] + 0.5 * step * k[0, i]
        slope(p, now + 0.5 * step, stage, taut, k[1], force, mass, work)
        for i in range(size):
            stage[i] = y[i] + 0.5 * step * k[1, i]
        slope(p, now + 0.5 * step, stage, taut, k[2], force, mass, work)
        for i in range(size):
            stage[i] = y[i] + step * k[2, i]
        slope(p, now + step, stage, taut, k[3], force, mass, work)
        for i in range(size):
            y[i] += step / 6.0 * (k[0, i] + 2.0 * k[1, i] + 2.0 * k[2, i] + k[3, i])
        if not math.isfinite(y[0]):
            return -written
    return written


@njit(cache=True, error_model="numpy")
def _dense(share: float, step: float, y: Array, difference: Array, k: Array, fifth: Array, out: Array) -> None:
    """Evaluate the continuous extension of the Dormand-Prince pair, fourth order, at a share of the step."""
    rest = 1.0 - share
    for i in range(y.size):
        slope_part = step * k[0, i] - difference[i]
        last = difference[i] - step * k[6, i] - slope_part
        out[i] = y[i] + share * (difference[i] + rest * (slope_part + share * (last + rest * fifth[i])))


@njit(cache=True, error_model="numpy")
def _step(
    p: PackedCage, t: float, y: Array, h: float, taut: Array, k: Array, new: Array, stage: Array, work: Array
) -> None:
    """One step of the Dormand-Prince pair: ``k[0]`` is given, ``k[6]`` and the new state come back [eq:cage-pair]."""
    force, mass, wave = work[:3], work[3:12].reshape((3, 3)), work[12:18]
    size = y.size
    for i in range(size):
        stage[i] = y[i] + h * k[0, i] / 5.0
    slope(p, t + h / 5.0, stage, taut, k[1], force, mass, wave)
    for i in range(size):
        stage[i] = y[i] + h * (3.0 / 40.0 * k[0, i] + 9.0 / 40.0 * k[1, i])
    slope(p, t + 0.3 * h, stage, taut, k[2], force, mass, wave)
    for i in range(size):
        stage[i] = y[i] + h * (44.0 / 45.0 * k[0, i] - 56.0 / 15.0 * k[1, i] + 32.0 / 9.0 * k[2, i])
    slope(p, t + 0.8 * h, stage, taut, k[3], force, mass, wave)
    for i in range(size):
        stage[i] = y[i] + h * (
            19372.0 / 6561.0 * k[0, i]
            - 25360.0 / 2187.0 * k[1, i]
            + 64448.0 / 6561.0 * k[2, i]
            - 212.0 / 729.0 * k[3, i]
        )
    slope(p, t + 8.0 / 9.0 * h, stage, taut, k[4], force, mass, wave)
    for i in range(size):
        stage[i] = y[i] + h * (
            9017.0 / 3168.0 * k[0, i]
            - 355.0 / 33.0 * k[1, i]
            + 46732.0 / 5247.0 * k[2, i]
            + 49.0 / 176.0 * k[3, i]
            - 5103.0 / 18656.0 * k[4, i]
        )
    slope(p, t + h, stage, taut, k[5], force, mass, wave)
    for i in range(size):
        new[i] = y[i] + h * (
            35.0 / 384.0 * k[0, i]
            + 500.0 / 1113.0 * k[2, i]
            + 125.0 / 192.0 * k[3, i]
            - 2187.0 / 6784.0 * k[4, i]
            + 11.0 / 84.0 * k[5, i]
        )
    slope(p, t + h, new, taut, k[6], force, mass, wave)


@njit(cache=True, error_model="numpy")
def _switched(p: PackedCage, y: Array, taut: Array, work: Array) -> bool:
    """Whether a line pulls that did not at the start of the step, or the other way round."""
    for i in range(p.lines.shape[0]):
        line_state(p, i, y, work)
        if (tautness(p, i, work) > 0.0) != (taut[i] > 0.0):
            return True
    return False


@njit(cache=True, error_model="numpy")
def _decide(p: PackedCage, y: Array, taut: Array, work: Array) -> None:
    for i in range(p.lines.shape[0]):
        line_state(p, i, y, work)
        taut[i] = 1.0 if tautness(p, i, work) > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def _note_peaks(
    p: PackedCage, t: float, y: Array, begin: float, spacing: float, peak: Array, total: Array, work: Array
) -> None:
    row = int((t - begin) / spacing + 0.5)
    if row < 0 or row >= peak.shape[0]:
        return
    for i in range(p.lines.shape[0]):
        pull = tension_of(p, i, y, work)
        peak[row, i] = max(peak[row, i], pull)
        total[i] = max(total[i], pull)


@njit(cache=True, error_model="numpy")
def march(
    p: PackedCage,
    t: float,
    end: float,
    y: Array,
    first_step: float,
    longest: float,
    longest_taut: float,
    tolerance: float,
    scale: Array,
    begin: float,
    spacing: float,
    rows: Array,
    tension: Array,
    peak: Array,
    counts: NDArray[np.int64],
) -> tuple[float, float]:
    """Adaptive Dormand-Prince steps from ``t`` to ``end`` that land where a line goes taut or slack [eq:cage-event].

    Parameters
    ----------
    t, end : float
        [s].
    y : array, shape (6,)
        State, changed in place.
    first_step, longest, longest_taut : float
        First step, longest steps with slack lines and with taut ones [s].
    tolerance : float
        Local error allowed, of ``scale`` plus the size of the state.
    scale : array, shape (6,)
        Natural size of each state.
    begin, spacing : float
        Row ``i`` of the output belongs to ``begin + i spacing`` [s].
    rows, tension, peak : array
        Output: state, tension and largest tension around every row.
    counts : array of int, shape (4,)
        Raised by: steps taken, steps refused, events, evaluations.

    Returns
    -------
    float, float
        Time reached (before ``end`` when the step shrank to nothing or the motion left all bounds), next step [s].
    """
    size = y.size
    lines = p.lines.shape[0]
    k = np.empty((7, size))
    new, stage, difference, fifth, between = (
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
    )
    work, wave = np.empty(18), np.empty(6)
    taut, total = np.empty(lines), np.zeros(lines)
    _decide(p, y, taut, wave)
    force, mass = work[:3], work[3:12].reshape((3, 3))
    slope(p, t, y, taut, k[0], force, mass, work[12:18])
    h = min(first_step, longest)
    row = math.ceil((t - begin) / spacing - 1e-9)
    checks = 6
    while t < end * (1.0 - 1e-15):
        most = longest
        for i in range(lines):
            if taut[i] > 0.0:
                most = longest_taut
        h = min(h, end - t, most)
        if h < 1e-13 * max(abs(end), 1.0) or abs(y[3]) + abs(y[4]) > 1e2 * scale[3]:
            # a hundred times the speed of free fall through the cage: it has left all bounds
            return t, h
        _step(p, t, y, h, taut, k, new, stage, work)
        counts[3] += 6
        error = 0.0
        for i in range(size):
            estimate = h * (
                71.0 / 57600.0 * k[0, i]
                - 71.0 / 16695.0 * k[2, i]
                + 71.0 / 1920.0 * k[3, i]
                - 17253.0 / 339200.0 * k[4, i]
                + 22.0 / 525.0 * k[5, i]
                - 1.0 / 40.0 * k[6, i]
            )
            error += (estimate / (tolerance * (scale[i] + abs(y[i])))) ** 2
        error = math.sqrt(error / size)
        if not error <= 1.0:
            counts[1] += 1
            h *= max(0.2, 0.9 * error**-0.2) if error < 1e30 else 0.2
            continue
        for i in range(size):
            difference[i] = new[i] - y[i]
            fifth[i] = h * (
                -12715105075.0 / 11282082432.0 * k[0, i]
                + 87487479700.0 / 32700410799.0 * k[2, i]
                - 10690763975.0 / 1880347072.0 * k[3, i]
                + 701980252875.0 / 199316789632.0 * k[4, i]
                - 1453857185.0 / 822651844.0 * k[5, i]
                + 69997945.0 / 29380423.0 * k[6, i]
            )
        # where within the step a line goes taut or slack first, if at all
        share = 1.0
        low = 0.0
        happened = False
        for n in range(1, checks + 1):
            at = n / checks
            if n == checks:
                between[:] = new
            else:
                _dense(at, h, y, difference, k, fifth, between)
            if _switched(p, between, taut, wave):
                happened, share = True, at
                break
            low = at
        if happened:
            counts[2] += 1
            for _ in range(60):
                if (share - low) * h < 1e-12:
                    break
                middle = 0.5 * (low + share)
                _dense(middle, h, y, difference, k, fifth, between)
                if _switched(p, between, taut, wave):
                    share = middle
                else:
                    low = middle
        reached = t + share * h
        while row < rows.shape[0] and begin + row * spacing <= reached + 1e-12:
            at = min(1.0, max(0.0, (begin + row * spacing - t) / h))
            _dense(at, h, y, difference, k, fifth, between)
            rows[row] = between
            for i in range(lines):
                tension[row, i] = tension_of(p, i, between, wave)
            row += 1
        for n in range(1, checks + 1):
            at = share * n / checks
            _dense(at, h, y, difference, k, fifth, between)
            _note_peaks(p, t + at * h, between, begin, spacing, peak, total, wave)
        counts[0] += 1
        grow = 5.0 if error < 1e-12 else min(5.0, max(0.2, 0.9 * error**-0.2))
        if happened and share < 1.0:
            _dense(share, h, y, difference, k, fifth, between)
            y[:] = between
        else:
            y[:] = new
        t = reached
        if happened:
            # the rates jump or bend here: begin afresh on the other side
            _decide(p, y, taut, wave)
            slope(p, t, y, taut, k[0], force, mass, work[12:18])
            counts[3] += 1
        else:
            k[0] = k[6]
        h *= grow
    return t, h
