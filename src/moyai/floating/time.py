"""Motion of a moored floating body in time: Cummins' equation with memory, nonlinear lines and drift."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import check_kind, checks_words
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.floating import kernel
from moyai.floating.arrays import finite, square_matrix
from moyai.floating.damping import QuadraticDamping
from moyai.floating.forcing import Forcing
from moyai.floating.lines import PlanarMooring
from moyai.floating.memory import ConvolutionMemory, Memory, StateSpaceMemory

STEPS_PER_NATURAL_PERIOD = 24
"""Steps in the shortest natural period with the stiffest lines that occur; 2.2 are the limit of stability."""
SHORTER_WITH_CONVOLUTION = 3.0
"""Divides the step where the memory is a convolution, which is of second order: its error is then below 5e-4."""
SECONDS_BETWEEN_LOOKS = 0.25
"""CPU time of one call of the kernel, so that an interrupt is seen soon."""


@dataclass(frozen=True)
class CumminsModel:
    """A floating body in time.

    Raises
    ------
    InputError
        For matrices of another size, inertia that is not positive definite, and a memory of another kind or size.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import CumminsModel, StateSpaceMemory
    >>> one = np.eye(1)
    >>> heave = CumminsModel(2e5 * one, 8e5 * one, 4e5 * one, StateSpaceMemory.none(1), modes=("heave",))
    >>> float(np.sqrt(heave.stiffness / heave.inertia)[0, 0])            # natural frequency without damping [rad/s]
    2.0
    """

    #: M + A_inf, mass and infinite-frequency added mass; shape (m, m).
    inertia: Array
    #: Hydrostatic restoring, and linear moorings; shape (m, m).
    stiffness: Array
    #: Beyond radiation; shape (m, m).
    linear_damping: Array
    memory: Memory
    #: Nonlinear lines on the first three modes; their force at rest balances weight and buoyancy and is subtracted.
    mooring: PlanarMooring | None = None
    quadratic: QuadraticDamping | None = None
    modes: tuple[str, ...] = ("sway", "heave", "roll")

    def __post_init__(self) -> None:
        size = len(self.modes)
        for name in ("inertia", "stiffness", "linear_damping"):
            square_matrix(getattr(self, name), size, name)
        eigenvalues = np.linalg.eigvalsh(0.5 * (self.inertia + np.transpose(self.inertia)))
        if eigenvalues[0] <= 0.0:
            raise InputError("inertia with infinite-frequency added mass is not positive definite", parameter="inertia")
        if not isinstance(self.memory, StateSpaceMemory | ConvolutionMemory):
            raise InputError(
                f"{type(self.memory).__name__} is no memory", parameter="memory",
                allowed="StateSpaceMemory or ConvolutionMemory",
                remedy="take a solution through moyai.potential.memory_functions and fit_memory",
            )  # fmt: skip
        if self.memory.size != size:
            raise InputError(f"the memory has {self.memory.size} modes", parameter="memory", allowed=f"{size}")
        if self.mooring is not None and size < 3:
            raise InputError(f"lines on a body of {size} modes", parameter="mooring", allowed="sway, heave, roll first")


Status = Literal["converged", "diverged", "interrupted"]


@checks_words
@dataclass(frozen=True)
class Simulation:
    """A simulated motion. Rows are instants."""

    #: [s]; shape (n,).
    time: Array
    #: Position relative to rest [m, rad]; shape (n, m).
    position: Array
    #: Velocity [m/s, rad/s]; shape (n, m).
    velocity: Array
    #: Of all nonlinear lines, at-rest force included [N, N m]; shape (n, m).
    mooring_force: Array
    #: Fairlead tension of one copy of each line [N]; shape (n, l).
    tension: Array
    #: Incident surface at x = 0 [m]; shape (n,).
    elevation: Array
    #: Of the integrator [s].
    time_step: float
    #: Diverged and interrupted runs hold what was computed: the last row is the last good state; one of "converged",
    #: "diverged", "interrupted".
    status: Status
    message: str
    #: Why this time step, and this memory.
    notices: tuple[Notice, ...] = ()
    #: CPU seconds of the parts, and the number of steps.
    cost: Mapping[str, float] = field(default_factory=dict)


def choose_time_step(
    model: CumminsModel, forcing: Forcing, expected_motion: ArrayLike | None = None
) -> tuple[float, Notice]:
    """Choose the time step of [eq:floating-etd] and say why.

    The method is of fourth order with a memory of states. A convolution is of second order: its step is a third of it.

    Parameters
    ----------
    model : CumminsModel
        The body.
    forcing : Forcing
        Waves, drift and steady loads; a regular wave sets steps that divide its period.
    expected_motion : array_like (m,) or None
        Amplitudes at which the lines' stiffness is looked up, next to the undisturbed position [m, rad]; for instance
        twice the linear motion.

    Returns
    -------
    time_step : float
        [s], already fitted to the forcing.
    notice : Notice
        Which of wave periods, stiffest natural period, damping and memory decides.

    Raises
    ------
    InputError
        When neither wave nor restoring sets a time scale.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import CumminsModel, RegularForcing, choose_time_step
    >>> from moyai.floating.memory import StateSpaceMemory
    >>> one = np.eye(1)
    >>> heave = CumminsModel(2e5 * one, 8e5 * one, 4e5 * one, StateSpaceMemory.none(1), modes=("heave",))
    >>> wave = RegularForcing(1.0, 0.5, np.array([4e5 + 0j]), np.zeros(1), np.zeros(1))
    >>> step, notice = choose_time_step(heave, wave)
    >>> round(2.0 * np.pi / step), notice.code                           # steps a wave period
    (48, 'time-step')
    """
    limits: dict[str, float] = {}
    if math.isfinite(forcing.longest_step):
        limits["the periods of the waves"] = forcing.longest_step
    offsets = (
        np.zeros(len(model.modes)) if expected_motion is None else np.abs(np.asarray(expected_motion, dtype=float))
    )
    rate = 0.0
    for sign in (0.0, 1.0, -1.0) if model.mooring is not None else (0.0,):
        restoring = np.array(model.stiffness, dtype=float)
        if model.mooring is not None:
            restoring[:3, :3] += model.mooring.stiffness(sign * offsets[:3])
        rate = max(rate, math.sqrt(_largest(model.inertia, restoring)))
    start = (
        model.memory.kernel(0.0)[0] if isinstance(model.memory, StateSpaceMemory) else model.memory.velocity_kernel[0]
    )
    rates = {
        "the shortest natural period with the stiffest lines": rate,
        "the damping": _largest(model.inertia, model.linear_damping + model.memory.dashpot),
        "the start of the memory": math.sqrt(_largest(model.inertia, start)),
    }
    for name, value in rates.items():
        if value > 0.0:
            limits[name] = 2.0 * math.pi / value / STEPS_PER_NATURAL_PERIOD
    if not limits:
        raise InputError(
            "neither wave nor restoring sets a time scale", parameter="time_step", remedy="give a time step"
        )
    reason = min(limits, key=lambda name: limits[name])
    convolution = isinstance(model.memory, ConvolutionMemory)
    longest = limits[reason] / (SHORTER_WITH_CONVOLUTION if convolution else 1.0)
    step = forcing.fitted_step(longest)
    notice = Notice(
        code="time-step",
        message=f"time step {step:.4g} s, set by {reason}",
        value=step,
        limit=longest,
        severity="information",
        remedy="give a shorter step to see its effect; the method is of "
        + ("second order, as its memory is a convolution" if convolution else "fourth order"),
    )
    return step, notice


def _largest(inertia: Array, matrix: Array) -> float:
    """Return the largest absolute eigenvalue of inverse inertia times a matrix."""
    return float(np.max(np.abs(np.linalg.eigvals(np.linalg.solve(inertia, matrix)))))


def exponential_weights(poles: ComplexArray, step: float) -> tuple[ComplexArray, ...]:
    """Return exp(hL/2), exp(hL) and the weights Q, f1, f2, f3 of ETDRK4 [eq:floating-etd].

    Weights are means over a circle around each h L (Kassam and Trefethen 2005), exact to rounding where the closed
    forms lose all digits.
    """
    scaled = np.asarray(poles, dtype=np.complex128) * step
    points = 64
    circle = np.exp(2j * np.pi * (np.arange(points) + 0.5) / points)
    x = scaled[:, None] + circle[None, :]
    grown = np.exp(x)
    return (
        np.exp(scaled / 2.0),
        np.exp(scaled),
        step * np.mean((np.exp(x / 2.0) - 1.0) / x, axis=1),
        step * np.mean((-4.0 - x + grown * (4.0 - 3.0 * x + x**2)) / x**3, axis=1),
        step * np.mean((2.0 + x + grown * (x - 2.0)) / x**3, axis=1),
        step * np.mean((-4.0 - 3.0 * x - x**2 + grown * (4.0 - x)) / x**3, axis=1),
    )


def simulate(
    model: CumminsModel,
    forcing: Forcing,
    *,
    duration: float,
    time_step: float | None = None,
    save_interval: float | None = None,
    initial_position: ArrayLike | None = None,
    initial_velocity: ArrayLike | None = None,
    expected_motion: ArrayLike | None = None,
    motion_limit: ArrayLike | None = None,
    progress: Progress = silent,
) -> Simulation:
    """Integrate the motion of a floating body [eq:floating-cummins].

    Parameters
    ----------
    model : CumminsModel
        Inertia, restoring, damping, memory and lines of the body.
    forcing : Forcing
        Waves, drift and steady loads.
    duration : float
        [s], ramp included.
    time_step : float or None
        ``None``: chosen by :func:`choose_time_step`. A given step may be shortened to divide the wave period.
    save_interval : float or None
        Output every so many seconds, rounded to whole steps; ``None`` for every step.
    initial_position, initial_velocity : array_like (m,) or None
        Zero by default [m, rad; per second]; the memory starts empty.
    expected_motion : array_like (m,) or None
        For the choice of the time step [m, rad].
    motion_limit : array_like (m,) or None
        A larger motion counts as diverged; by default a thousand times the span of the lines, or none without lines.
    progress : Progress
        Called now and then with the simulated time; may raise KeyboardInterrupt.

    Returns
    -------
    Simulation
        Never raises on divergence or interruption: the status says so, and what was computed is there.

    Raises
    ------
    InputError
        When an argument is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import CumminsModel, RegularForcing, StateSpaceMemory, simulate
    >>> one = np.eye(1)
    >>> heave = CumminsModel(2e5 * one, 8e5 * one, 4e5 * one, StateSpaceMemory.none(1), modes=("heave",))
    >>> wave = RegularForcing(1.0, 0.5, np.array([4e5 + 0j]), np.zeros(1), np.zeros(1), ramp=6.0)
    >>> run = simulate(heave, wave, duration=60.0)
    >>> run.status, run.position.shape[1]
    ('converged', 1)
    >>> round(float(run.position[-200:].max()), 2)                       # 2e5 / |8e5 - 2e5 - 4e5 i| [m]
    0.28
    """
    check_kind(model, CumminsModel, "model")
    size = len(model.modes)
    if not duration > 0.0 or not math.isfinite(duration):
        raise InputError(f"duration is {duration:g} s", parameter="duration", allowed="greater than 0")
    notices: list[Notice] = []
    if time_step is None:
        step, notice = choose_time_step(model, forcing, expected_motion)
        notices.append(notice)
    else:
        if not time_step > 0.0:
            raise InputError(f"time step is {time_step:g} s", parameter="time_step", allowed="greater than 0")
        step = forcing.fitted_step(time_step)
    steps = math.ceil(duration / step - 1e-9)
    every = 1 if save_interval is None else max(1, round(save_interval / step))
    q, v = (
        np.zeros(size) if item is None else np.array(finite(np.asarray(item, dtype=float), "initial state"))
        for item in (initial_position, initial_velocity)
    )
    started = clock.process_time()
    force, elevation = forcing.sample(0.5 * step, 2 * steps + 1)
    force = np.ascontiguousarray(finite(force, "force"))
    cost = {"excitation": clock.process_time() - started, "steps": float(steps)}
    lines, rest, line_count = packed_lines(model.mooring, size)
    body = packed_body(model)
    rows = steps // every + 1
    columns = (size, size, size, line_count)
    saved = (*(np.zeros((rows, each)) for each in columns), np.zeros(size), np.zeros(line_count))
    saved[0][0], saved[1][0] = q, v
    if model.mooring is not None:
        saved[2][0, :3], saved[3][0] = model.mooring.force_and_tension(q[:3])
    limit = np.full(size, np.inf) if motion_limit is None else np.asarray(motion_limit, dtype=float)
    if motion_limit is None and model.mooring is not None:
        limit = np.full(size, 1e3 * model.mooring.reach)
    limit = np.where(np.isinf(limit), 1e30, limit)
    advance, memory_notice = _stepper(model.memory, q, v, step, force, body, lines, rest, limit, every, saved)
    notices.extend(memory_notice)
    started = clock.process_time()
    done, status, message = _drive(advance, steps, step, progress)
    cost["kernel"] = clock.process_time() - started
    good = done // every + 1
    return Simulation(
        time=step * every * np.arange(good, dtype=np.float64),
        position=saved[0][:good],
        velocity=saved[1][:good],
        mooring_force=saved[2][:good],
        tension=saved[3][:good],
        elevation=elevation[:: 2 * every][:good],
        time_step=step,
        status=status,
        message=message,
        notices=tuple(notices),
        cost=cost,
    )


def packed_lines(mooring: PlanarMooring | None, size: int) -> tuple[tuple[Any, ...], Array, int]:
    """Return the lines as kernel arrays, their force at rest and their number."""
    if mooring is None:
        none: tuple[Any, ...] = (
            np.zeros((0, 16)),
            np.zeros((0, 8), dtype=np.int64),
            np.zeros(1),
            np.zeros(1, dtype=np.int64),
            np.zeros(3),
            np.zeros(0),
        )
        return none, np.zeros(size), 0
    rest = np.zeros(size)
    rest[:3] = mooring.force(np.zeros(3))
    return mooring.packed(), rest, mooring.count


def packed_body(model: CumminsModel) -> tuple[Array, ...]:
    """Return a body as kernel arrays: inverse inertia, damping, stiffness, rows and factors of quadratic damping."""
    size = len(model.modes)
    quadratic = model.quadratic
    return (
        np.ascontiguousarray(np.linalg.inv(model.inertia)),
        np.ascontiguousarray(np.asarray(model.linear_damping, dtype=float) + model.memory.dashpot),
        np.ascontiguousarray(model.stiffness, dtype=float),
        np.zeros((0, size)) if quadratic is None else np.ascontiguousarray(quadratic.directions),
        np.zeros(0) if quadratic is None else np.ascontiguousarray(quadratic.coefficients),
    )


def _stepper(
    memory: Memory,
    q: Array,
    v: Array,
    step: float,
    force: Array,
    body: tuple[Array, ...],
    lines: tuple[Array, ...],
    rest: Array,
    limit: Array,
    every: int,
    saved: tuple[Array, ...],
) -> tuple[Any, tuple[Notice, ...]]:
    """Return ``advance(first, steps) -> (status, good steps)`` for the given memory, and what there is to say."""
    if isinstance(memory, StateSpaceMemory):
        z = np.zeros(len(memory.poles), dtype=np.complex128)
        weights = exponential_weights(memory.poles, step)
        inputs, outputs = np.ascontiguousarray(memory.inputs), np.ascontiguousarray(memory.outputs)

        def advance_states(first: int, count: int) -> tuple[int, int]:
            found: tuple[int, int] = kernel.run_state_space(
                q, v, z, first, count, step, force, body, lines, rest, weights, inputs, outputs, limit, every, saved
            )
            return found

        return advance_states, ()
    values = memory.on_steps(0.5 * step)
    history = np.zeros((values.shape[0] // 2 + 1, len(q)))

    def advance_convolution(first: int, count: int) -> tuple[int, int]:
        found: tuple[int, int] = kernel.run_convolution(
            q, v, history, first, count, step, force, body, lines, rest, values, limit, every, saved
        )
        return found

    notice = Notice(
        code="memory-length",
        message=f"memory of {memory.time[-1]:.4g} s as a convolution of {history.shape[0]} steps",
        value=float(memory.time[-1]),
        severity="information",
    )
    return advance_convolution, (notice,)


def _drive(advance: Any, steps: int, step: float, progress: Progress) -> tuple[int, Status, str]:
    """Call the kernel in pieces of a fraction of a second, so that an interrupt and the listener get their turn."""
    done, piece = 0, 64
    try:
        while done < steps:
            count = min(piece, steps - done)
            began = clock.perf_counter()
            code, good = advance(done, count)
            done += good
            if code == kernel.DIVERGED:
                where = done * step
                return (
                    done,
                    "diverged",
                    f"the motion grew without bound after {where:.4g} s; the rows before it are good",
                )
            spent = clock.perf_counter() - began
            progress("time domain", done * step, steps * step)
            if spent < SECONDS_BETWEEN_LOOKS:
                # The first call may have compiled; grow towards the wanted duration without leaping past it
                piece = min(4 * piece, max(64, int(count * SECONDS_BETWEEN_LOOKS / max(spent, 1e-6))))
    except KeyboardInterrupt:
        return done, "interrupted", f"interrupted at {done * step:.4g} s of {steps * step:.4g} s"
    return done, "converged", ""
