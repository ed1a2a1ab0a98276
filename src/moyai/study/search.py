"""Search inside a case: up to which value it holds, and which values are best.

Both wrap what runs one case, so that a study of them resumes, spreads over workers and gives
its failures like any other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.case.reader import Case, case_of
from moyai.core.arrays import Array
from moyai.core.errors import CaseError, InputError
from moyai.core.progress import Progress
from moyai.core.quantities import parse_quantity
from moyai.core.results import Result
from moyai.study.axes import Combination, varied
from moyai.study.definition import RunCase
from moyai.study.responses import find_response, read_response
from moyai.study.variations import common_unit

if TYPE_CHECKING:
    import xarray as xr


_INSIDE = 5e-4
"""Distance from a limit that an optimum keeps, relative to the limit."""
_GOVERNS = 0.02
"""Relative distance within which a limit, or share of the range within which its end, is said to govern an optimum."""


@dataclass(frozen=True)
class ResponseLimit:
    """A response that must stay on one side of a value."""

    #: Group and name in the result, perhaps with labels: ``SWL/time/storm/tension[line=seaward]``; its largest entry
    #: counts.
    response: str
    #: The limit.
    value: float
    #: 1 where the response must stay below, -1 where it must stay above.
    sign: int

    def excess(self, tree: xr.DataTree) -> float:
        """Return how far the limit is exceeded, relative to it; zero or less holds.

        Raises
        ------
        InputError
            When the result has no such response.
        """
        found = read_response(tree, self.response, self.sign)
        scale = abs(self.value) if self.value != 0.0 else 1.0
        return self.sign * (found - self.value) / scale


@dataclass(frozen=True)
class LimitRun:
    """Run a case as often as it takes to find up to which value it holds."""

    #: Runs one case.
    run: RunCase
    #: Path that is raised.
    path: str
    #: Start of the range, as a case file holds it.
    first: Any
    #: End of the range, as a case file holds it.
    last: Any
    #: What must hold.
    limits: tuple[ResponseLimit, ...]
    #: Share of the range.
    tolerance: float

    def __call__(self, case: Case, progress: Progress) -> Result:
        low, high, unit = common_unit(self.first, self.last, self.path)
        tried: list[tuple[float, float, str]] = []

        def worst(value: float) -> float:
            excess, which = _excess(self.run, case, self.limits, {self.path: _written(value, unit)}, progress)
            tried.append((value, excess, which))
            progress("limit", len(tried), len(tried) + 5)
            return excess

        if worst(low) > 0.0:
            return self._result(tried, math.nan, unit, f"it does not hold at {low:g} {unit}".strip())
        if worst(high) <= 0.0:
            return self._result(tried, high, unit, f"it holds up to {high:g} {unit}, the largest value tried".strip())
        below, above = low, high
        while above - below > self.tolerance * (high - low):
            middle = 0.5 * (below + above)
            if worst(middle) > 0.0:
                above = middle
            else:
                below = middle
        return self._result(tried, below, unit, "found")

    def _result(self, tried: list[tuple[float, float, str]], limit: float, unit: str, message: str) -> Result:
        import xarray as xr

        factor = _si_factor(unit)
        governing = next((which for value, excess, which in sorted(tried) if excess > 0.0), "")
        data = {
            "limit": ((), limit * factor, {"units": _si_name(unit), "long_name": f"largest {self.path} that holds"}),
            "runs": ((), float(len(tried)), {"units": "1", "long_name": "cases run to find it"}),
            "governing": (
                ("limit_of",),
                [float(one.response == governing) for one in self.limits],
                {"units": "1", "long_name": "1 where this response governs"},
            ),
        }
        names = [one.response for one in self.limits]
        return Result(
            xr.DataTree.from_dict({"/": xr.Dataset(), "/limit": xr.Dataset(data, coords={"limit_of": names})}),
            message=message,
        )


@dataclass(frozen=True)
class OptimiseRun:
    """Run a case as often as it takes to find the best values."""

    #: Runs one case.
    run: RunCase
    #: Path and range of each value.
    variables: tuple[tuple[str, Any, Any], ...]
    #: Response.
    minimise: str
    #: What must hold.
    limits: tuple[ResponseLimit, ...]
    #: Response whose limit comes with the case, empty when there is none.
    trade_off: str
    #: Number of starting points, a Latin hypercube.
    starts: int
    #: Most evaluations from each starting point.
    evaluations: int
    #: Seed of the Latin hypercube.
    seed: int
    #: What the case brings (``@at_most``).
    options: dict[str, Any] = field(default_factory=dict)

    def bind(self, options: dict[str, Any]) -> OptimiseRun:
        """Return the same with what a case brings."""
        return replace(self, options=options)

    def __call__(self, case: Case, progress: Progress) -> Result:
        from scipy.optimize import minimize
        from scipy.stats import qmc

        ranges = [(path, *common_unit(low, high, path)) for path, low, high in self.variables]
        limits = self.limits
        if self.trade_off:
            limits = (*limits, ResponseLimit(self.trade_off, float(self.options["@at_most"]), 1))
        seen: dict[tuple[float, ...], tuple[float, Array]] = {}
        units = ["1"]

        def evaluate(place: np.ndarray) -> tuple[float, float]:
            """Return objective and worst excess at a place of the unit cube."""
            key = tuple(float(round(value, 12)) for value in np.clip(place, 0.0, 1.0))
            if key not in seen:
                change = {path: _written(low + at * (high - low), unit)
                          for (path, low, high, unit), at in zip(ranges, key)}  # fmt: skip
                try:
                    tree = _tree(self.run, case, change, progress)
                    excess = np.array([one.excess(tree) for one in limits])
                    seen[key] = (read_response(tree, self.minimise), excess)
                    units[0] = str(find_response(tree, self.minimise).attrs.get("units", "1"))
                except CaseError:
                    # A refused combination (a line that cannot reach) lies outside; the search turns back from it
                    seen[key] = (math.inf, np.full(len(limits), math.inf))
                progress("optimise", len(seen), self.starts * self.evaluations)
            return seen[key][0], float(seen[key][1].max(initial=-1.0))

        scale = [1.0]

        def objective(place: np.ndarray) -> float:
            value = evaluate(place)[0]
            return value / scale[0] if math.isfinite(value) else 1e3

        def margin(place: np.ndarray) -> float:
            # A little more than asked: the search settles on either side by its own tolerance
            excess = evaluate(place)[1]
            return -excess - _INSIDE if math.isfinite(excess) else -1e3

        points = qmc.LatinHypercube(len(ranges), seed=self.seed).random(self.starts)
        points[0] = 0.5
        settled = False
        for point in points:
            first = evaluate(point)[0]
            scale[0] = abs(first) if math.isfinite(first) and first != 0.0 else 1.0
            bounds = [{"type": "ineq", "fun": lambda x, i=i: x[i]} for i in range(len(ranges))]
            bounds += [{"type": "ineq", "fun": lambda x, i=i: 1.0 - x[i]} for i in range(len(ranges))]
            found = minimize(
                objective, point, method="COBYLA", constraints=[*bounds, {"type": "ineq", "fun": margin}],
                options={"maxiter": self.evaluations, "rhobeg": 0.25, "tol": 1e-3},
            )  # fmt: skip
            settled = settled or bool(found.success)
        return self._result(ranges, seen, limits, units[0], settled)

    def _result(
        self,
        ranges: Sequence[tuple[str, float, float, str]],
        seen: dict[tuple[float, ...], tuple[float, Array]],
        limits: tuple[ResponseLimit, ...],
        objective_unit: str,
        settled: bool,
    ) -> Result:
        import xarray as xr

        worst = {key: float(excess.max(initial=-1.0)) for key, (_, excess) in seen.items()}
        holding = {key: value for key, (value, _) in seen.items() if worst[key] <= 0.0 and math.isfinite(value)}
        if not holding:
            nearest = min(worst.values())
            raise InputError(
                f"no combination within the ranges holds all limits (nearest: {100 * nearest:.3g} % beyond)",
                path="optimise.subject_to",
                remedy="widen the ranges or loosen the limits",
            )
        best = min(holding, key=lambda key: holding[key])
        place = np.array(best)
        data: dict[str, Any] = {
            "objective": (
                (),
                holding[best],
                {"units": objective_unit, "long_name": f"least {self.minimise}"},
            ),
            "margin": ((), -worst[best], {"units": "1", "long_name": "least relative distance from the limits"}),
            "runs": ((), float(len(seen)), {"units": "1", "long_name": "cases run"}),
            "settled": (
                (),
                float(settled),
                {"units": "1", "long_name": "1 where a start of the search settled within its evaluations"},
            ),
            "best": (
                ("variable",),
                [(low + at * (high - low)) * _si_factor(unit) for (_, low, high, unit), at in zip(ranges, best)],
                {"units": "1", "long_name": "best values, in the units of their names"},
            ),
            "governing": (
                ("limit_of",),
                (seen[best][1] > -_GOVERNS).astype(float),
                {"units": "1", "long_name": "1 where the limit of this response governs"},
            ),
            "at_end": (
                ("variable",),
                (place > 1.0 - _GOVERNS).astype(float) - (place < _GOVERNS),
                {"units": "1", "long_name": "-1 or 1 where the lower or upper end of the range governs"},
            ),
        }
        names = [f"{path} [{_si_name(unit)}]" if unit else path for path, _, _, unit in ranges]
        coords = {"variable": names, "limit_of": [one.response for one in limits]}
        found = ", ".join(
            f"{path} = {low + at * (high - low):.4g} {unit}".rstrip()
            for (path, low, high, unit), at in zip(ranges, best)
        )
        return Result(
            xr.DataTree.from_dict({"/": xr.Dataset(), "/optimum": xr.Dataset(data, coords=coords)}),
            message=f"{found}: best of {len(seen)} runs, {len(limits)} limits",
        )


def _excess(
    run: RunCase, case: Case, limits: tuple[ResponseLimit, ...], change: dict[str, Any], progress: Progress
) -> tuple[float, str]:
    tree = _tree(run, case, change, progress)
    return max((one.excess(tree), one.response) for one in limits)


def _tree(run: RunCase, case: Case, change: dict[str, Any], progress: Progress) -> xr.DataTree:
    document = varied(case.document, Combination(0, (), tuple(change.items())))
    result = run(case_of(document, case.path), progress)
    if result.status in ("not_converged", "failed", "interrupted"):
        if result.status == "interrupted":
            raise KeyboardInterrupt
        raise InputError(f"the case did not converge at {change}: {result.message}", path="study")
    tree: xr.DataTree = result.tree
    return tree


def _written(value: float, unit: str) -> Any:
    return f"{value!r} {unit}" if unit else value


def _si_factor(unit: str) -> float:
    return parse_quantity(f"1 {unit}").si if unit else 1.0


def _si_name(unit: str) -> str:
    from moyai.study.axes import si_symbol

    return (si_symbol(parse_quantity(f"1 {unit}").unit.dimension) if unit else "") or "1"
