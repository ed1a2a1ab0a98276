"""Stream-function waves by Newton's method with the period as a condition and continuation in the height.

The equations are those of Rienecker and Fenton (1981), made dimensionless with the wave number and gravity; the wave
number is one of the unknowns, so a wave of given period costs no more than one of given length, and infinite depth is
a limit of the depth functions rather than a large number [eq:sea-stream-function].

With many components of a steep wave the equations are nearly dependent: the j-th component grows by e^{jkH} from trough
to crest, so that rounding moves the high ones freely. Such a wave is reached over fewer components, with Newton steps
of least squares in unknowns scaled to the crest that leave out what rounding decides.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError
from moyai.sea import dispersion
from moyai.sea.water import Water

#: Smallest part of the height by which the continuation advances before it gives up.
_SMALLEST_ADVANCE = 1.0 / 400.0
#: Singular values of the scaled equations, over the largest, below which rounding decides a direction.
_NOISE = 1e-9
#: Residual of the dimensionless conditions at which a step of least squares ends.
_LEAST_SQUARES_RESIDUAL = 1e-11
#: Ratio of the numbers of components on the way to many of them, and the number that needs no such way.
_LADDER, _FEW = 1.2, 13


@dataclass(frozen=True)
class StreamFunctionProblem:
    """A wave to be found: height, water, current, and either period or wavelength."""

    #: H [m].
    height: float
    #: Depth and gravity.
    water: Water
    #: Angular frequency in the fixed frame [rad/s]; NaN where ``wave_number`` is given.
    omega: float
    #: k [1/m]; NaN where ``omega`` is given.
    wave_number: float
    #: Uniform current along the wave [m/s].
    current: float


@dataclass(frozen=True, eq=False)
class StreamFunctionSolution:
    """Unknowns of a wave, dimensionless with k and g except the wave number."""

    #: k eta at phase angles 0 ... pi. Shape (order + 1,).
    surface: Array
    #: B_j of the stream function, scaled by cosh(j k h); shape (order,).
    coefficients: Array
    #: c (k/g)^1/2 relative to the current.
    celerity: float
    #: Constant of the kinematic condition.
    stream: float
    #: Constant of the dynamic condition.
    head: float
    #: k [1/m].
    wave_number: float

    def vector(self) -> Array:
        """Return the unknowns as one vector, the wave number by its logarithm."""
        tail = [self.celerity, self.stream, self.head, math.log(self.wave_number)]
        return np.concatenate([self.surface, self.coefficients, tail])

    @staticmethod
    def of_vector(vector: Array) -> StreamFunctionSolution:
        """Undo :meth:`vector`."""
        order = (vector.size - 5) // 2
        celerity, stream, head, log_k = (float(item) for item in vector[-4:])
        return StreamFunctionSolution(
            vector[: order + 1].copy(), vector[order + 1 : -4].copy(), celerity, stream, head, math.exp(log_k)
        )

    def refined(self, order: int) -> StreamFunctionSolution:
        """Return the same wave as an estimate with more components."""
        number = np.arange(order + 1)
        surface = np.cos(math.pi * np.outer(number, np.arange(self.coefficients.size + 1)) / order) @ np.concatenate(
            [[0.0], self.elevation_harmonics()]
        )
        coefficients = np.zeros(order)
        coefficients[: self.coefficients.size] = self.coefficients
        return replace(self, surface=surface, coefficients=coefficients)

    def elevation_harmonics(self) -> Array:
        """Return k E_j of the elevation, j = 1 ... order."""
        order = self.coefficients.size
        number = np.arange(order + 1)
        ends = np.where((number == 0) | (number == order), 0.5, 1.0)
        harmonics = 2.0 / order * np.cos(math.pi * np.outer(number, number) / order) @ (ends * self.surface)
        harmonics[-1] *= 0.5
        return np.asarray(harmonics[1:])


def _linear(problem: StreamFunctionProblem, height: float, order: int) -> StreamFunctionSolution:
    water = problem.water
    k = problem.wave_number
    if math.isnan(k):
        k = float(dispersion.wave_number_in_current(problem.omega, water.depth, water.gravity, problem.current))
    celerity = math.sqrt(math.tanh(k * water.depth))
    surface = 0.5 * k * height * np.cos(np.arange(order + 1) * math.pi / order)
    coefficients = np.zeros(order)
    coefficients[0] = 0.5 * k * height / celerity
    return StreamFunctionSolution(surface, coefficients, celerity, 0.0, 0.5 * celerity**2, k)


def _equations(vector: Array, problem: StreamFunctionProblem, height: float) -> tuple[Array, Array]:
    """Return residuals and their exact Jacobian [eq:sea-stream-function]."""
    order = (vector.size - 5) // 2
    eta, b = vector[: order + 1], vector[order + 1 : -4]
    celerity, stream, head = (float(item) for item in vector[-4:-1])
    k, g = math.exp(float(vector[-1])), problem.water.gravity
    depth = k * problem.water.depth
    j = np.arange(1, order + 1)
    angle = np.outer(np.arange(order + 1), j) * (math.pi / order)
    cosine, sine = np.cos(angle), np.sin(angle)
    lift = np.exp(np.outer(eta, j))
    if math.isinf(depth):
        odd = even = lift
        tanh = np.ones(order)
    else:
        below, whole = np.exp(-2.0 * j * (eta[:, None] + depth)), 1.0 + np.exp(-2.0 * j * depth)
        odd, even = lift * (1.0 - below) / whole, lift * (1.0 + below) / whole
        tanh = np.tanh(j * depth)
    oc, ec, os = odd * cosine, even * cosine, odd * sine
    u = ec @ (j * b) - celerity
    w = os @ (j * b)
    u_z, w_z = oc @ (j * j * b), (even * sine) @ (j * j * b)
    residual = np.concatenate(
        [
            oc @ b - celerity * eta + stream,
            0.5 * (u * u + w * w) + eta - head,
            [np.mean(eta[1:-1]) * (order - 1) / order + 0.5 * (eta[0] + eta[-1]) / order],
            [eta[0] - eta[-1] - k * height],
            [0.0],
        ]
    )
    size = 2 * order + 5
    jacobian = np.zeros((size, size))
    rows = np.arange(order + 1)
    jacobian[rows, rows] = u
    jacobian[: order + 1, order + 1 : -4] = oc
    jacobian[: order + 1, -4] = -eta
    jacobian[: order + 1, -3] = 1.0
    second = slice(order + 1, 2 * order + 2)
    jacobian[order + 1 + rows, rows] = u * u_z + w * w_z + 1.0
    jacobian[second, order + 1 : -4] = j * (u[:, None] * ec + w[:, None] * os)
    jacobian[second, -4] = -u
    jacobian[second, -2] = -1.0
    if not math.isinf(depth):
        # derivatives with respect to ln k: of the dimensionless depth only, eta being dimensionless itself
        odd_k, even_k = depth * j * (even - odd * tanh), depth * j * (odd - even * tanh)
        jacobian[: order + 1, -1] = (odd_k * cosine) @ b
        jacobian[second, -1] = u * ((even_k * cosine) @ (j * b)) + w * ((odd_k * sine) @ (j * b))
    jacobian[-3, : order + 1] = np.where((rows == 0) | (rows == order), 0.5, 1.0) / order
    jacobian[-2, 0], jacobian[-2, order], jacobian[-2, -1] = 1.0, -1.0, -k * height
    if math.isnan(problem.omega):
        residual[-1] = float(vector[-1]) - math.log(problem.wave_number)
        jacobian[-1, -1] = 1.0
    else:
        speed = math.sqrt(g * k)
        residual[-1] = (speed * celerity + k * problem.current) / problem.omega - 1.0
        jacobian[-1, -4] = speed / problem.omega
        jacobian[-1, -1] = (0.5 * speed * celerity + k * problem.current) / problem.omega
    return residual, jacobian


def _newton(start: Array, problem: StreamFunctionProblem, height: float) -> Array | None:
    """Solve from an estimate; None where the iteration leaves the range of waves or does not settle."""
    vector = start.copy()
    order = (vector.size - 5) // 2
    before = math.inf
    for _ in range(25):
        residual, jacobian = _equations(vector, problem, height)
        try:
            step = np.linalg.solve(jacobian, residual)
        except np.linalg.LinAlgError:
            return None
        vector = vector - step
        reach = float(np.max(np.abs(vector[: order + 1])))
        if not np.isfinite(vector).all() or reach > 3.0 or abs(float(step[-1])) > 1.0:
            return None
        size = float(np.max(np.abs(step)))
        # converged to rounding when the correction is tiny and no longer shrinks quadratically
        if size < 1e-13 or (size < 1e-9 and size > 0.1 * before):
            return vector
        before = size
    return None


def _newton_of_least_squares(start: Array, problem: StreamFunctionProblem, height: float) -> Array | None:
    """Solve from an estimate where the equations are nearly dependent; None where that leaves the range of waves.

    The unknowns B_j are scaled by their size at the crest, which makes the step of least length the smoothest wave.
    """
    vector = start.copy()
    order = (vector.size - 5) // 2
    for _ in range(25):
        residual, jacobian = _equations(vector, problem, height)
        if float(np.max(np.abs(residual))) < _LEAST_SQUARES_RESIDUAL:
            return vector
        scale = np.ones(vector.size)
        scale[order + 1 : -4] = np.exp(-np.arange(1, order + 1) * max(float(vector[0]), 0.0))
        step = scale * np.linalg.lstsq(jacobian * scale, residual, rcond=_NOISE)[0]
        vector = vector - step
        reach = float(np.max(np.abs(vector[: order + 1])))
        if not np.isfinite(vector).all() or reach > 3.0 or abs(float(step[-1])) > 1.0:
            return None
    return None


def _is_wave(solution: StreamFunctionSolution) -> bool:
    """Tell a wave of one crest from the spurious solutions of the equations."""
    surface = solution.surface
    falling = bool(np.all(np.diff(surface) < 1e-6 * (surface[0] - surface[-1])))
    return falling and solution.celerity > 0.0


def solve_stream_function(
    problem: StreamFunctionProblem, order: int, estimate: StreamFunctionSolution | None = None
) -> StreamFunctionSolution:
    """Solve a wave with ``order`` components.

    Parameters
    ----------
    problem : StreamFunctionProblem
        The wave wanted.
    order : int
        Number of Fourier components.
    estimate : StreamFunctionSolution, optional
        The same wave with fewer components.

    Raises
    ------
    ConvergenceError
        When the continuation stops below the height wanted; the message gives how far it came.
    """
    if estimate is not None:
        refined = _refine(estimate, problem, order)
        if refined is not None:
            return refined
    try:
        return _continue(problem, order)
    except ConvergenceError:
        if estimate is not None or order <= _FEW:
            raise
        fewer = solve_stream_function(problem, max(_FEW, int(order / _LADDER)))
        refined = _refine(fewer, problem, order)
        if refined is None:
            raise
        return refined


def _refine(
    estimate: StreamFunctionSolution, problem: StreamFunctionProblem, order: int
) -> StreamFunctionSolution | None:
    """Return the wave with more components than its estimate, None where none is found."""
    start = estimate.refined(order).vector()
    for newton in (_newton, _newton_of_least_squares):
        found = newton(start, problem, problem.height)
        if found is not None and _is_wave(StreamFunctionSolution.of_vector(found)):
            return StreamFunctionSolution.of_vector(found)
    return None


def _continue(problem: StreamFunctionProblem, order: int) -> StreamFunctionSolution:
    """Return the wave by continuation in the height: each starts from the line through the two lower ones."""
    reached, advance = 0.0, 0.1
    lower: list[tuple[float, Array]] = []
    while reached < 1.0:
        part = min(1.0, reached + advance)
        height = part * problem.height
        if not lower:
            start = _linear(problem, height, order).vector()
        elif len(lower) == 1:
            start = lower[-1][1].copy()
            start[: 2 * order + 1] *= part / lower[-1][0]
        else:
            (first, a), (second, b) = lower[-2:]
            start = b + (b - a) * (part - second) / (second - first)
        found = _newton(start, problem, height)
        if found is None or not _is_wave(StreamFunctionSolution.of_vector(found)):
            advance *= 0.5
            if advance < _SMALLEST_ADVANCE:
                raise ConvergenceError(
                    f"no steady wave of height {problem.height:.4g} m found with {order} components: the solution "
                    f"ends near {reached * problem.height:.4g} m",
                    parameter="height",
                    remedy="the wave breaks before it is so high, or it needs more components",
                )
            continue
        lower = [*lower[-1:], (part, found)]
        reached = part
        advance *= 1.5
    return StreamFunctionSolution.of_vector(lower[-1][1])
