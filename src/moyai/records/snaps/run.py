"""From flume runs to impact tensions, similarity numbers, and the models over all of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.records.snaps.model import Exponents, SnapAgreement, SnapFinding, SnapFindings, SnapRun, SnapRuns
from moyai.series.intervals import student_quantile
from moyai.structures.curtain.impact.cable import Impact, impact_numbers
from moyai.structures.curtain.impact.compare import ModelTension, compare_models
from moyai.structures.curtain.impact.release import slack_phase, snap_in_current

NUMBERS = ("froude", "span_ratio", "depth_ratio", "cauchy")
#: Model that is read as a record is
WITH_DRAG = "A with drag"
# Numbers that differ by less are one
_SAME = 1e-6


def measure_snaps(runs: SnapRuns, progress: Progress = silent) -> SnapFindings:
    """Find the impact tension of every run, its similarity numbers, and compare the models with them.

    Parameters
    ----------
    runs : SnapRuns
    progress : Progress

    Raises
    ------
    InputError
        When a record has no impact, peak no higher than the drag level.
    """
    found = []
    for index, run in enumerate(runs.runs):
        progress("runs", index, len(runs.runs))
        found.append(_finding(run, runs))
    progress("runs", len(runs.runs), len(runs.runs))
    measured = np.array([item.run.record.total.impact for item in found])
    models = _common_models(found)
    powers = np.log([similarity(item.run.impact) for item in found])
    exponents = [_exponents("record", np.log(_coefficients(found, measured)), powers)]
    agreements = []
    for model in models:
        tension = np.array([item.comparison.tension(model) for item in found])
        agreements.append(_agreement(model, tension / measured))
        exponents.append(_exponents(model, np.log(_coefficients(found, tension)), powers))
    return SnapFindings(runs, tuple(found), tuple(agreements), tuple(exponents), _notices(found))


def similarity(impact: Impact) -> tuple[float, float, float, float]:
    """Return Fr, B/l, d/h and C_E of a run [eq:impact-numbers]."""
    numbers = impact_numbers(impact, 1.0)
    return numbers.froude_number, impact.span_ratio, impact.draught / impact.water.depth, numbers.cauchy_number


def _finding(run: SnapRun, runs: SnapRuns) -> SnapFinding:
    tension = run.record.total.impact
    if not tension > 0.0:
        raise InputError(
            f"run '{run.name}': the peak of {run.record.total.peak:.3g} N is not above the drag level",
            parameter="runs", allowed="peak above plateau", remedy="check the window, or leave the run out",
        )  # fmt: skip
    impact = run.impact
    if runs.drag_coefficient is not None:
        phase = slack_phase(
            impact, drag_coefficient=runs.drag_coefficient, current=impact.speed, position=0.0, speed=0.0
        )
        impact = phase.started(impact)
    comparison = compare_models(impact, run.skirt, memory=runs.memory)
    if runs.drag_coefficient:
        comparison = replace(comparison, models=(*comparison.models, _with_drag(run.impact, runs.drag_coefficient)))
    return SnapFinding(run, impact_numbers(run.impact, tension), impact.speed, comparison)


def _with_drag(impact: Impact, drag_coefficient: float) -> ModelTension:
    """Return model A with drag, read as a record is: its peak less its own drag level."""
    snap = snap_in_current(
        impact, drag_coefficient=drag_coefficient, current=impact.speed, position=0.0, speed=0.0
    )  # fmt: skip
    assumption = "as A, with drag before and after: peak less drag level, as the record is read"
    return ModelTension(WITH_DRAG, snap.impact_tension, snap.peak_time - snap.taut_time, assumption)


def _common_models(found: Sequence[SnapFinding]) -> list[str]:
    """Return the models in which cables stretch and that every run has.

    Model B holds cables for inextensible; one may lack where its solution does not converge. The march repeats model A.
    """
    names = [item.model for item in found[0].comparison.models]
    chosen = [name for name in names if name != "A marched" and not name.startswith("B ")]
    return [name for name in chosen if all(name in {m.model for m in item.comparison.models} for item in found)]


def _coefficients(found: Sequence[SnapFinding], tension: Array) -> Array:
    """Return C_T of tensions [N], each with the current, span and draught of its run."""
    return np.array(
        [
            impact_numbers(item.run.impact, float(value)).tension_coefficient
            for item, value in zip(found, tension, strict=True)
        ]
    )


def _agreement(model: str, ratio: Array) -> SnapAgreement:
    logs = np.log(ratio)
    scatter = float(np.std(logs, ddof=1))
    reach = student_quantile(0.95, logs.size - 1) * scatter / math.sqrt(logs.size)
    mean = float(np.mean(logs))
    return SnapAgreement(model, math.exp(mean), math.exp(mean - reach), math.exp(mean + reach), scatter, logs.size)


def _exponents(of: str, coefficient: Array, numbers: Array) -> Exponents:
    """Fit the powers of the numbers that vary, by least squares of logarithms, with Student's bounds."""
    varied = [k for k in range(len(NUMBERS)) if np.ptp(numbers[:, k]) > _SAME]
    centred = numbers[:, varied] - numbers[:, varied].mean(axis=0)
    freedom = coefficient.size - len(varied) - 1
    names = tuple(NUMBERS[k] for k in varied)
    # two numbers that vary only together have no powers of their own
    if freedom < 1 or np.linalg.matrix_rank(centred, tol=1e-6 * max(1.0, float(np.abs(centred).max()))) < len(varied):
        unknown = (math.nan,) * len(names)
        return Exponents(of, names, unknown, unknown, unknown, math.nan)
    inverse = np.linalg.inv(centred.T @ centred)
    values = inverse @ centred.T @ (coefficient - coefficient.mean())
    left = coefficient - coefficient.mean() - centred @ values
    scatter = math.sqrt(float(left @ left) / freedom)
    reach = student_quantile(0.95, freedom) * scatter * np.sqrt(np.diag(inverse))
    return Exponents(
        of, names, tuple(map(float, values)), tuple(map(float, values - reach)), tuple(map(float, values + reach)),
        scatter,
    )  # fmt: skip


def _notices(found: Sequence[SnapFinding]) -> tuple[Notice, ...]:
    """Return the notices of all runs, one for each code with the runs it holds for."""
    by_code: dict[str, list[tuple[str, Notice]]] = {}
    for item in found:
        for notice in (*item.run.record.notices, *item.comparison.notices):
            by_code.setdefault(notice.code, []).append((item.run.name, notice))
    merged = []
    for entries in by_code.values():
        names = list(dict.fromkeys(name for name, _ in entries))
        name, first = entries[0]
        more = "" if len(names) == 1 else f" and {len(names) - 1} more of {len(found)} runs"
        merged.append(replace(first, message=f"{first.message} ({name}{more})"))
    return tuple(merged)
