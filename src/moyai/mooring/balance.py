"""Where the imbalance of forces on a moored body vanishes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError


def newton_with_line_search(
    imbalance: Callable[[Array], Array],
    jacobian: Callable[[Array], Array],
    start: Array,
    scale: Array,
    free: list[int],
    tolerance: float,
    most: int = 100,
) -> tuple[Array, float, int]:
    """Solve ``imbalance(position) = 0`` in the ``free`` components by damped Newton steps.

    Steps follow the Jacobian, are shortened until the scaled imbalance falls, and lean to steepest descent
    (Levenberg-Marquardt) where the Jacobian is singular, for instance while all lines are slack.

    Raises
    ------
    ConvergenceError
        After ``most`` steps without success.
    """
    position = np.array(start, dtype=float)
    weight = 1.0 / scale[free]
    value = imbalance(position)[free] * weight
    norm = float(np.linalg.norm(value))
    damping = 0.0
    for iteration in range(most):
        if float(np.max(np.abs(value), initial=0.0)) <= tolerance:
            return position, float(np.max(np.abs(value), initial=0.0)), iteration
        matrix = jacobian(position)[np.ix_(free, free)] * weight[:, None]
        columns = np.linalg.norm(matrix, axis=0)
        safe = np.where(columns > 0.0, columns, max(float(columns.max()), 1e-300))
        scaled = matrix / safe
        accepted = False
        for _ in range(12 if float(columns.max()) > 0.0 else 0):
            system = np.vstack([scaled, np.sqrt(damping) * np.eye(len(free))])
            step = np.linalg.lstsq(system, np.concatenate([-value, np.zeros(len(free))]), rcond=1e-14)[0] / safe
            for shrink in (1.0, 0.5, 0.2, 0.05):
                trial = position.copy()
                trial[free] += shrink * step
                trial_value = imbalance(trial)[free] * weight
                trial_norm = float(np.linalg.norm(trial_value))
                if trial_norm < norm * (1.0 - 1e-4 * shrink):
                    accepted = True
                    break
            if accepted:
                break
            damping = max(10.0 * damping, 1e-8)
        if not accepted:
            held = _push_until_held(imbalance, position, free, weight, norm)
            if held is None:
                break
            trial, trial_value = held
            trial_norm = float(np.linalg.norm(trial_value))
            damping = 0.0
        position, value, norm = trial, trial_value, trial_norm
        damping = 0.0 if damping < 1e-7 else 0.1 * damping
    worst = float(np.max(np.abs(value)))
    if worst <= 1e3 * tolerance:  # rounding of stiff lines
        return position, worst, most
    raise ConvergenceError(
        f"no equilibrium of the moored body: imbalance {worst:.2e} of the largest load remains",
        parameter="load",
        remedy="check that the lines and hydrostatics can carry the load, or start nearer",
    )


def _push_until_held(
    imbalance: Callable[[Array], Array],
    position: Array,
    free: list[int],
    weight: Array,
    norm: float,
) -> tuple[Array, Array] | None:
    """Move the body with the imbalance, through slack lines that feel nothing, until something pulls back.

    Returns a position of smaller imbalance and that imbalance (scaled), or None when nothing ever holds the body.
    """
    scaled = imbalance(position)[free] * weight
    way = scaled * weight / float(np.max(weight))

    def at(length: float) -> tuple[Array, Array]:
        trial = position.copy()
        trial[free] += length * way
        return trial, imbalance(trial)[free] * weight

    free_run, length = 0.0, 1e-3 / max(float(np.max(np.abs(way))), 1e-300)
    for _ in range(60):
        trial, value = at(length)
        if float(np.linalg.norm(value)) < norm * (1.0 - 1e-9):
            return trial, value
        if float(value @ scaled) < 0.0:  # gone too far: something pulls back harder than the load
            break
        free_run, length = length, 1.5 * length
    else:
        return None
    for _ in range(80):
        middle = 0.5 * (free_run + length)
        trial, value = at(middle)
        if float(np.linalg.norm(value)) < norm * (1.0 - 1e-9):
            return trial, value
        if float(value @ scaled) < 0.0:
            length = middle
        else:
            free_run = middle
    return None
