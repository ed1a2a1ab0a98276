"""Several records of one floating body side by side: seeds of a sea, each the same as by itself to the last bit."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.floating.arrays import finite
from moyai.floating.forcing import Forcing
from moyai.floating.lanes_kernel import LANES, run_lanes
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.time import (
    SECONDS_BETWEEN_LOOKS,
    CumminsModel,
    Simulation,
    Status,
    choose_time_step,
    exponential_weights,
    packed_body,
    packed_lines,
    simulate,
)


def simulate_together(
    model: CumminsModel,
    forcings: Sequence[Forcing],
    *,
    duration: float,
    time_step: float | None = None,
    expected_motion: ArrayLike | None = None,
    progress: Progress = silent,
) -> list[Simulation]:
    """Integrate the motion of a floating body in several seas of one length side by side [eq:floating-cummins].

    A record is the same to the last bit as :func:`moyai.floating.time.simulate` gives it, whatever the others do. Up
    to eight are marched at a time, from rest. Where their steps differ or the memory is no state space they are run
    one after the other.

    Parameters
    ----------
    model : CumminsModel
        The body.
    forcings : sequence of Forcing
        Waves, drift and steady loads of each record.
    duration : float
        [s], ramp included.
    time_step : float or None
        ``None``: chosen by :func:`moyai.floating.time.choose_time_step`.
    expected_motion : array_like (m,) or None
        For the choice of the time step [m, rad].
    progress : Progress
        Called now and then; may raise KeyboardInterrupt.

    Returns
    -------
    list of Simulation
        In the order of the seas; interrupted ones hold what was computed, and end the list.

    Raises
    ------
    InputError
        When an argument is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import CumminsModel, IrregularForcing, simulate, simulate_together
    >>> from moyai.floating.memory import StateSpaceMemory
    >>> one, omega = np.eye(1), np.array([0.8, 1.0, 1.2])
    >>> heave = CumminsModel(2e5 * one, 8e5 * one, 4e5 * one, StateSpaceMemory.none(1), modes=("heave",))
    >>> def sea(phase):
    ...     amplitude = 0.3 * np.exp(1j * phase * omega)
    ...     return IrregularForcing(omega, amplitude, np.full((3, 1), 4e5 + 0j), None, np.zeros(1), "none", ramp=6.0)
    >>> both = simulate_together(heave, [sea(1.0), sea(2.0)], duration=60.0)
    >>> bool(np.array_equal(both[1].position, simulate(heave, sea(2.0), duration=60.0).position))
    True
    """
    steps = {_step(model, forcing, time_step, expected_motion) for forcing in forcings}
    if len(forcings) < 2 or len(steps) > 1 or not isinstance(model.memory, StateSpaceMemory):
        alone: list[Simulation] = []
        for forcing in forcings:
            one = simulate(
                model, forcing, duration=duration, time_step=time_step, expected_motion=expected_motion,
                progress=progress,
            )  # fmt: skip
            alone.append(one)
            if one.status == "interrupted":
                break
        return alone
    (step,) = steps
    notices = () if time_step is not None else (choose_time_step(model, forcings[0], expected_motion)[1],)
    out: list[Simulation] = []
    for first in range(0, len(forcings), LANES):
        found = _marched(model, model.memory, forcings[first : first + LANES], duration, step, progress)
        out += [replace(one, notices=notices) for one in found]
        if any(one.status == "interrupted" for one in found):
            break
    return out


def _step(model: CumminsModel, forcing: Forcing, time_step: float | None, expected_motion: ArrayLike | None) -> float:
    if time_step is None:
        return choose_time_step(model, forcing, expected_motion)[0]
    return forcing.fitted_step(time_step)


def _marched(
    model: CumminsModel, memory: StateSpaceMemory, forcings: Sequence[Forcing], duration: float, step: float,
    progress: Progress,
) -> list[Simulation]:  # fmt: skip
    size, count = len(model.modes), len(forcings)
    steps = math.ceil(duration / step - 1e-9)
    started = clock.process_time()
    elevations: list[Array] = []
    force = np.zeros((count, 0, 0))
    for lane, forcing in enumerate(forcings):
        own, elevation = forcing.sample(0.5 * step, 2 * steps + 1)
        if not lane:
            force = np.empty((count, *own.shape))
        force[lane] = finite(own, "force")
        elevations.append(elevation[::2].copy())
    sampled = clock.process_time() - started
    lines, rest, line_count = packed_lines(model.mooring, size)
    starts = np.repeat(lines[5][None], LANES, axis=0)
    rows = steps + 1
    saved = tuple(np.zeros((count, rows, columns)) for columns in (size, size, size, line_count))
    now = np.zeros((size, LANES)), np.zeros((LANES, line_count))
    if model.mooring is not None:
        saved[2][:, 0, :3], saved[3][:, 0] = model.mooring.force_and_tension(np.zeros(3))
    limit = np.full(size, 1e30 if model.mooring is None else 1e3 * model.mooring.reach)
    weights = exponential_weights(memory.poles, step)
    inputs, outputs = np.ascontiguousarray(memory.inputs), np.ascontiguousarray(memory.outputs)
    q, v = np.zeros((size, LANES)), np.zeros((size, LANES))
    real, imaginary = np.zeros((len(memory.poles), LANES)), np.zeros((len(memory.poles), LANES))
    good, going = np.zeros(LANES, dtype=np.int64), np.arange(LANES) < count
    started = clock.process_time()
    interrupted, done, piece = False, 0, 64
    try:
        while done < steps and going.any():
            number, began = min(piece, steps - done), clock.perf_counter()
            run_lanes(
                q, v, real, imaginary, done, number, step, force, packed_body(model), lines[:5], starts, rest, weights,
                inputs, outputs, limit, 1, (*saved, *now), good, going,
            )  # fmt: skip
            done += number
            spent = clock.perf_counter() - began
            progress("time domain", done * step, steps * step)
            if spent < SECONDS_BETWEEN_LOOKS:
                piece = min(4 * piece, max(64, int(number * SECONDS_BETWEEN_LOOKS / max(spent, 1e-6))))
    except KeyboardInterrupt:
        interrupted = True
    cost = {"excitation": sampled / count, "steps": float(steps), "kernel": (clock.process_time() - started) / count}
    out = []
    for lane in range(count):
        rows, message = int(good[lane]) + 1, ""
        status: Status = "converged"
        if not going[lane]:
            status = "diverged"
            message = f"the motion grew without bound after {good[lane] * step:.4g} s; the rows before it are good"
        elif interrupted:
            status, message = "interrupted", f"interrupted at {good[lane] * step:.4g} s of {steps * step:.4g} s"
        position, velocity, mooring_force, tension = (item[lane, :rows] for item in saved)
        time = step * np.arange(rows, dtype=np.float64)
        out.append(
            Simulation(
                time, position, velocity, mooring_force, tension, elevations[lane][:rows], step, status, message,
                cost=cost,
            )
        )  # fmt: skip
    return out
