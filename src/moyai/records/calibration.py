"""Fit the parameters of any model to observations: least squares with bounds, and how far the answer can be trusted.

The model is a function of its parameters; it may be a formula or a whole simulation. Next to the estimate stand its
covariance, a bootstrap, the fit with each storm left out, and a warning where the observations do not give the
parameters apart.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.series.intervals import student_quantile

Model = Callable[[Array], ArrayLike]
"""From parameters to predictions, one for each observation."""

LARGEST_CONDITION = 1e3
"""Condition number of the scaled sensitivities above which parameters count as inseparable."""


@dataclass(frozen=True)
class Parameter:
    """A parameter to be found.

    Examples
    --------
    >>> from moyai.records import Parameter
    >>> drag = Parameter("drag coefficient", start=1.0, lower=0.2, upper=3.0)
    >>> drag.lower < drag.start < drag.upper
    True
    """

    name: str
    #: First guess.
    start: float
    #: Lower bound.
    lower: float = -math.inf
    #: Upper bound.
    upper: float = math.inf
    unit: str = ""

    def __post_init__(self) -> None:
        if not self.lower < self.upper:
            raise InputError(
                f"bounds {self.lower:g} and {self.upper:g}", parameter=self.name, allowed="lower below upper"
            )
        if not self.lower <= self.start <= self.upper:
            raise InputError(
                f"first guess {self.start:g}", parameter=self.name, allowed=f"{self.lower:g} to {self.upper:g}"
            )


@dataclass(frozen=True, eq=False)
class LeftOut:
    """The fit without one group of observations, and how it predicts that group."""

    group: str
    #: Parameters found without the group.
    values: Array
    #: Mean of prediction minus observation in the group, in the unit of the observations.
    bias: float
    #: Root mean square of prediction minus observation in the group, in the unit of the observations.
    rms: float
    count: int


@dataclass(frozen=True, eq=False)
class Calibration:
    """Parameters of a model found from observations; equation [eq:records-calibration]."""

    parameters: tuple[Parameter, ...]
    #: Estimates; shape (parameters,).
    values: Array
    #: Standard errors of the estimates; shape (parameters,).
    errors: Array
    covariance: Array
    #: Of the model at the estimate.
    prediction: Array
    #: Prediction minus observation at the estimate.
    residual: Array
    #: Mean of the residual.
    bias: float
    #: Root mean square of the residual.
    rms: float
    #: Condition number of the scaled sensitivities.
    condition: float
    #: 95 % interval of the bootstrap, widened for few observations; of the covariance (Student) where there was none;
    #: shape (parameters, 2).
    interval: Array
    #: Bootstrap estimates; shape (draws, parameters).
    samples: Array
    left_out: tuple[LeftOut, ...]
    #: Calls of the model.
    evaluations: int
    notices: tuple[Notice, ...]

    @property
    def correlation(self) -> Array:
        """Correlation of the estimates [-]."""
        scale = np.sqrt(np.diag(self.covariance))
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(self.covariance / np.outer(scale, scale))

    def as_dict(self) -> dict[str, float]:
        """Return the estimates by name."""
        return {parameter.name: float(value) for parameter, value in zip(self.parameters, self.values)}


class _Fitter:
    def __init__(
        self,
        model: Model,
        observed: Array,
        weight: Array,
        parameters: Sequence[Parameter],
        step: float = 1e-6,
    ) -> None:
        self.model, self.observed, self.weight, self.parameters = model, observed, weight, parameters
        self.step = step
        self.lower = np.array([parameter.lower for parameter in parameters])
        self.upper = np.array([parameter.upper for parameter in parameters])
        self.scale = np.array([_scale_of(parameter) for parameter in parameters])
        self.calls = 0

    def predict(self, values: Array) -> Array:
        self.calls += 1
        prediction = np.asarray(self.model(np.array(values)), dtype=float).reshape(-1)
        if prediction.size != self.observed.size:
            raise InputError(
                f"the model gives {prediction.size} predictions for {self.observed.size} observations",
                parameter="model",
            )
        if not np.isfinite(prediction).all():
            reported = ", ".join(f"{p.name} = {value:.6g}" for p, value in zip(self.parameters, values))
            raise InputError(
                f"no number from the model for observation {int(np.argmin(np.isfinite(prediction))) + 1} at {reported}",
                parameter="model",
                remedy="narrow the bounds, or correct the model there",
            )
        return prediction

    def solve(self, start: Array, chosen: Array | None = None) -> Array:
        from scipy.optimize import least_squares

        weight = self.weight if chosen is None else self.weight * chosen

        def residual(scaled: Array) -> Array:
            return np.asarray((self.predict(scaled * self.scale) - self.observed) * weight)

        low, high = self.lower / self.scale, self.upper / self.scale
        # The search wants to begin inside the bounds
        room = np.where(np.isfinite(high - low), high - low, 1.0) * 1e-9
        inside = np.clip(start / self.scale, low + room, high - room)
        steps = np.full(start.size, self.step)
        found = least_squares(
            residual,
            inside,
            bounds=(low, high),
            x_scale="jac",
            diff_step=steps,
            # A hundredth of the step of the slopes is the least that they resolve, and far below any standard error
            xtol=max(1e-2 * self.step, 1e-12),
            ftol=max(1e-2 * self.step, 1e-12),
            gtol=1e-12,
        )
        if found.status <= 0:
            raise ConvergenceError(
                f"the fit stopped after {found.nfev} steps without converging: {found.message}",
                remedy="give better first guesses or narrower bounds",
            )
        return np.asarray(found.x * self.scale)

    def sensitivity(self, values: Array) -> Array:
        """Return the weighted derivatives by the parameters, central where the bounds allow it."""
        columns = []
        for place in range(values.size):
            change = 1e2 * self.step * max(abs(values[place]), 1e-3 * self.scale[place])
            ahead, behind = values.copy(), values.copy()
            ahead[place] = min(values[place] + change, self.upper[place])
            behind[place] = max(values[place] - change, self.lower[place])
            difference = self.predict(ahead) - self.predict(behind)
            columns.append(difference / (ahead[place] - behind[place]) * self.weight)
        return np.column_stack(columns)


def _scale_of(parameter: Parameter) -> float:
    if parameter.start != 0.0:
        return abs(parameter.start)
    finite = [abs(bound) for bound in (parameter.lower, parameter.upper) if math.isfinite(bound) and bound != 0.0]
    return max(finite) if finite else 1.0


def calibrate(
    model: Model,
    observed: ArrayLike,
    parameters: Sequence[Parameter],
    *,
    error: ArrayLike | float | None = None,
    groups: Sequence[str] | None = None,
    bootstrap: int = 0,
    seed: int = 1,
    step: float = 1e-6,
    progress: Progress = silent,
) -> Calibration:
    """Fit a model to observations; equation [eq:records-calibration].

    Parameters
    ----------
    model : callable
        ``model(values) -> predictions``.
    observed : array_like
        Observations.
    parameters : sequence of Parameter
        What is unknown, in the order of ``values``.
    error : array_like or float, optional
        Standard errors of the observations; without them all weigh alike and the scatter gives the error.
    groups : sequence of str, optional
        Storm, campaign or run of each observation: left out one by one, and drawn whole by the bootstrap. Errors are
        those of whole groups where there are eight or more.
    bootstrap : int
        Number of draws; 0 for none.
    seed : int
        Of the draws.
    step : float
        Relative change of a parameter by which slopes are found in the search; a simulation with some noise of its
        own wants more, 1e-3 perhaps.
    progress : Progress
        Called after every draw.

    Returns
    -------
    Calibration
        Values with their errors and covariance, and what each group says when it is left out.

    Raises
    ------
    InputError
        Fewer observations than parameters, values that are not finite, a model that gives the wrong number of
        predictions or none.
    ConvergenceError
        When the least squares do not converge.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.records import Parameter, calibrate
    >>> speed, drag = np.array([0.5, 1.0, 1.5, 2.0]), [0.26, 1.01, 2.24, 4.0]
    >>> found = calibrate(lambda values: values[0] * speed**2, drag, [Parameter("k", 0.5, 0.0, 10.0)])
    >>> found.values.round(2).tolist()
    [1.0]
    """
    data = np.asarray(observed, dtype=float).reshape(-1)
    count, size = data.size, len(parameters)
    if size == 0 or count < size:
        raise InputError(f"{count} observations for {size} parameters", parameter="observed", allowed=f"{size} or more")
    if not np.isfinite(data).all():
        raise InputError(f"observation {int(np.argmin(np.isfinite(data))) + 1} is no number", parameter="observed")
    weight = np.ones(count)
    if error is not None:
        sigma = np.broadcast_to(np.asarray(error, dtype=float), (count,))
        if not (np.isfinite(sigma) & (sigma > 0.0)).all():
            raise InputError("standard errors", parameter="error", allowed="greater than 0")
        weight = 1.0 / sigma
    if groups is not None and len(groups) != count:
        raise InputError(f"{len(groups)} groups for {count} observations", parameter="groups")
    fitter = _Fitter(model, data, weight, parameters, step)
    progress("calibration", 0, 1)
    values = fitter.solve(np.array([parameter.start for parameter in parameters]))
    prediction = fitter.predict(values)
    residual = prediction - data
    sensitivity = fitter.sensitivity(values)
    covariance, condition = _covariance(sensitivity, residual * weight, values, fitter.scale, error is not None)
    samples = _draws(fitter, values, groups, bootstrap, seed, progress)
    left_out = _leave_out(fitter, values, groups, progress)
    independent = _independent(count, groups)
    weighted = residual * weight
    notices = [
        *_notices(parameters, values, covariance, condition, left_out),
        *(_misfit(weighted, count - size) if error is not None else _unknown_error(count - size)),
        *_alike_in_groups(weighted, groups, independent),
    ]
    whole = independent < count and len(left_out) == independent
    if whole:
        covariance = _covariance_of_groups(left_out)
    errors = np.sqrt(np.diag(covariance))
    # the scatter of groups counts their own mean alone, that of observations all parameters
    freedom = independent - (1 if whole and samples.shape[0] < _FEWEST_DRAWS else size)
    interval = _interval(values, errors, samples, freedom, error is not None and not whole)
    progress("calibration", 1, 1)
    return Calibration(
        tuple(parameters),
        values,
        errors,
        covariance,
        prediction,
        residual,
        float(residual.mean()),
        math.sqrt(float(np.mean(residual**2))),
        condition,
        interval,
        samples,
        left_out,
        fitter.calls,
        tuple(notices),
    )


_WHOLE_GROUPS = 8
"""From so many groups on whole ones count as observations: in the bootstrap and in the errors."""
_FEWEST_DRAWS = 20
"""From so many draws on the interval is theirs."""


def _independent(count: int, groups: Sequence[str] | None) -> int:
    """Return how many observations, or groups drawn whole, the bootstrap chooses from."""
    names = len(set(groups)) if groups is not None else 0
    return names if names >= _WHOLE_GROUPS else count


def _interval(values: Array, errors: Array, samples: Array, freedom: int, known_error: bool) -> Array:
    """Return 95 % intervals: of the draws where there are enough, else of the covariance.

    A scatter found from few observations is uncertain itself, for which Student's distribution allows; draws from few
    observations scatter too little besides, by the root of the share of the degrees of freedom.
    """
    reach = 1.959964 if known_error else (student_quantile(0.95, freedom) if freedom > 0 else math.nan)
    if samples.shape[0] < _FEWEST_DRAWS:
        return np.column_stack([values - reach * errors, values + reach * errors])
    bounds = np.asarray(np.quantile(samples, (0.025, 0.975), axis=0).T, dtype=np.float64)
    if freedom <= 0:
        return bounds
    wider = math.sqrt((freedom + values.size) / freedom) * student_quantile(0.95, freedom) / 1.959964
    return np.asarray(values[:, None] + wider * (bounds - values[:, None]))


def _covariance(
    sensitivity: Array, residual: Array, values: Array, scale: Array, known_error: bool
) -> tuple[Array, float]:
    """Return the covariance, and the condition number of sensitivities to relative changes of the parameters."""
    relative = sensitivity * np.maximum(np.abs(values), 1e-3 * scale)
    norms = np.linalg.norm(relative, axis=0)
    if (norms == 0.0).any():
        condition = math.inf
    else:
        singular = np.linalg.svd(relative, compute_uv=False)
        condition = float(singular[0] / singular[-1]) if singular[-1] > 0.0 else math.inf
    normal = sensitivity.T @ sensitivity
    inverse = np.linalg.pinv(normal, rcond=1e-14, hermitian=True)
    flat = np.linalg.norm(sensitivity, axis=0) == 0.0
    inverse[flat, flat] = math.inf
    freedom = residual.size - values.size
    variance = 1.0 if known_error else (float(residual @ residual) / freedom if freedom > 0 else math.nan)
    return np.asarray(inverse * variance), condition


def _draws(
    fitter: _Fitter, values: Array, groups: Sequence[str] | None, draws: int, seed: int, progress: Progress
) -> Array:
    """Return estimates with observations (or whole groups of them) drawn with replacement."""
    random = np.random.default_rng(seed)
    count = fitter.observed.size
    names = list(dict.fromkeys(groups)) if groups is not None else []
    out = []
    for draw in range(draws):
        if len(names) >= _WHOLE_GROUPS:
            drawn = random.integers(0, len(names), len(names))
            times = np.bincount(drawn, minlength=len(names))
            assert groups is not None
            chosen = np.array([times[names.index(group)] for group in groups], dtype=float)
        else:
            chosen = np.bincount(random.integers(0, count, count), minlength=count).astype(float)
        if np.count_nonzero(chosen) < values.size:
            continue
        try:
            out.append(fitter.solve(values, np.sqrt(chosen)))
        except ConvergenceError:
            continue
        progress("bootstrap", draw + 1, draws)
    return np.array(out).reshape(len(out), values.size)


def _leave_out(fitter: _Fitter, values: Array, groups: Sequence[str] | None, progress: Progress) -> tuple[LeftOut, ...]:
    if groups is None or len(set(groups)) < 2:
        return ()
    labels = np.asarray(groups, dtype=object)
    names = list(dict.fromkeys(groups))
    out = []
    for number, name in enumerate(names):
        inside = labels == name
        if np.count_nonzero(~inside) < values.size:
            continue
        found = fitter.solve(values, np.where(inside, 0.0, 1.0))
        rest = (fitter.predict(found) - fitter.observed)[inside]
        rms = math.sqrt(float(np.mean(rest**2)))
        out.append(LeftOut(name, found, float(rest.mean()), rms, int(inside.sum())))
        progress("leaving out", number + 1, len(names))
    return tuple(out)


def _covariance_of_groups(left_out: Sequence[LeftOut]) -> Array:
    """Return the covariance by the fits that leave out a group each [eq:records-groups]."""
    values = np.array([left.values for left in left_out])
    apart = values - values.mean(axis=0)
    return np.asarray((1.0 - 1.0 / len(values)) * apart.T @ apart)


def _alike_in_groups(weighted: Array, groups: Sequence[str] | None, independent: int) -> tuple[Notice, ...]:
    """Return a notice where few groups differ by more than their observations do, which count as independent then."""
    from scipy.special import fdtrc

    names = list(dict.fromkeys(groups)) if groups is not None else []
    within = weighted.size - len(names)
    if len(names) < 2 or independent < weighted.size or within < 1:
        return ()
    of_group = np.array([names.index(group) for group in groups or ()])
    count = np.bincount(of_group)
    mean = np.bincount(of_group, weighted) / count
    inner = float(np.sum((weighted - mean[of_group]) ** 2)) / within
    outer = float(count @ (mean - weighted.mean()) ** 2) / (len(names) - 1)
    if not inner > 0.0 or float(fdtrc(len(names) - 1, within, outer / inner)) > 1e-2:
        return ()
    ratio = math.sqrt(outer / inner)
    message = (
        f"the residuals of {len(names)} groups differ {ratio:.3g} times as much as those within them explain: errors "
        "and intervals, which take the observations as independent, are too small"
    )
    remedy = f"add groups; {_WHOLE_GROUPS} and more count as whole ones"
    return (Notice("calibration-groups", message, ratio, 1.0, remedy=remedy),)


def _unknown_error(freedom: int) -> tuple[Notice, ...]:
    """Return a notice where as many parameters as observations leave no scatter to find errors from."""
    if freedom > 0:
        return ()
    message = "as many parameters as observations: their errors are not known"
    return (Notice("calibration-error", message, float(freedom), 1.0, remedy="add observations, or give their errors"),)


def _misfit(weighted: Array, freedom: int) -> tuple[Notice, ...]:
    """Return a notice where the model misses the observations by more than their stated errors explain."""
    from scipy.special import chdtrc

    total = float(weighted @ weighted)
    if freedom < 1 or float(chdtrc(freedom, total)) > 1e-3:
        return ()
    ratio = math.sqrt(total / freedom)
    message = (
        f"the model misses the observations by {ratio:.3g} times their stated errors: the errors of the parameters, "
        "which follow from them, are too small"
    )
    return (Notice("misfit", message, ratio, 1.0, remedy="check the model, or do not give errors of the measurements"),)


def _notices(
    parameters: Sequence[Parameter],
    values: Array,
    covariance: Array,
    condition: float,
    left_out: Sequence[LeftOut],
) -> tuple[Notice, ...]:
    notices = []
    errors = np.sqrt(np.diag(covariance))
    if condition > LARGEST_CONDITION:
        pair = _worst_pair(parameters, covariance)
        message = f"the observations do not distinguish the parameters (condition number {condition:.3g}){pair}"
        remedy = "fix one of them, fit their product, or add observations that differ in it"
        notices.append(Notice("identifiability", message, condition, LARGEST_CONDITION, remedy=remedy))
    for parameter, value, error in zip(parameters, values, errors):
        reach = 1e-6 * max(abs(value), 1e-12)
        if value - parameter.lower <= reach or parameter.upper - value <= reach:
            message = f"{parameter.name} is at its bound {value:.6g}"
            notices.append(Notice("parameter-bound", message, float(value), float(value), remedy="question the bound"))
        elif error > 0.5 * abs(value):
            message = f"{parameter.name} = {value:.4g} is known to {error:.3g} only"
            notices.append(Notice("parameter-uncertain", message, float(error / max(abs(value), 1e-300)), 0.5))
    for left in left_out:
        moved = np.abs(left.values - values) / np.maximum(errors, 1e-300)
        if moved.max() > 4.0:
            name = parameters[int(np.argmax(moved))].name
            message = f"without '{left.group}' {name} moves by {moved.max():.1f} standard errors"
            notices.append(Notice("leave-one-out", message, float(moved.max()), 4.0))
    return tuple(notices)


def _worst_pair(parameters: Sequence[Parameter], covariance: Array) -> str:
    if len(parameters) < 2 or not np.isfinite(covariance).all():
        return ""
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    correlation = np.abs(covariance / np.outer(scale, scale)) - np.eye(len(parameters))
    first, second = np.unravel_index(int(np.argmax(correlation)), correlation.shape)
    return f"; worst: {parameters[int(first)].name} with {parameters[int(second)].name}"


@dataclass(frozen=True, eq=False)
class ProfileOfFit:
    """Least sum of squares over the other parameters, along one."""

    name: str
    #: Values of the parameter.
    values: Array
    #: Sum of weighted squares at each of them.
    squares: Array
    #: Where the sum rises by no more than 3.84 standard variances: 95 % interval; infinite on an open side.
    interval: tuple[float, float]


def profile(
    model: Model,
    observed: ArrayLike,
    calibration: Calibration,
    name: str,
    values: ArrayLike,
    *,
    error: ArrayLike | float | None = None,
) -> ProfileOfFit:
    """Return the profile of one parameter of a fit: where it is flat, the parameter is not identified.

    Parameters
    ----------
    model, observed, error
        As given to :func:`calibrate`.
    calibration : Calibration
        Its answer.
    name : str
        Of the parameter.
    values : array_like
        Values to hold it at, in increasing order.
    """
    names = [parameter.name for parameter in calibration.parameters]
    if name not in names:
        raise InputError(f"no parameter '{name}'", parameter="name", allowed=", ".join(names))
    place = names.index(name)
    data = np.asarray(observed, dtype=float).reshape(-1)
    weight = np.ones(data.size) if error is None else 1.0 / np.broadcast_to(np.asarray(error, float), data.shape)
    others = [parameter for parameter in calibration.parameters if parameter.name != name]
    trail = np.asarray(values, dtype=float)
    squares = np.empty(trail.size)
    for i, value in enumerate(trail):

        def held(rest: Array, value: float = value) -> ArrayLike:
            return model(np.insert(rest, place, value))

        fitter = _Fitter(held, data, weight, others)
        rest = np.delete(calibration.values, place)
        found = fitter.solve(rest) if others else rest
        squares[i] = float(np.sum(((fitter.predict(found) - data) * weight) ** 2))
    least = float(np.sum((calibration.residual * weight) ** 2))
    variance = 1.0 if error is not None else least / max(data.size - len(names), 1)
    rise = (squares - least) / variance - 3.84
    inside = np.flatnonzero(rise <= 0.0)
    low, high = -math.inf, math.inf
    if inside.size:
        first, last = int(inside[0]), int(inside[-1])
        if first > 0:
            low = float(np.interp(0.0, [rise[first], rise[first - 1]], [trail[first], trail[first - 1]]))
        if last < trail.size - 1:
            high = float(np.interp(0.0, [rise[last], rise[last + 1]], [trail[last], trail[last + 1]]))
    return ProfileOfFit(name, trail, squares, (low, high))
