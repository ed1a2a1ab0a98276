"""A measured snap against the impact models: ratios, and the models' time series to draw over the record."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.structures.curtain.impact.cable import Impact, edge_impact, peak_by_energy
from moyai.structures.curtain.impact.compare import Comparison
from moyai.structures.curtain.impact.march import march_impact
from moyai.structures.curtain.impact.memory import impact_with_memory
from moyai.structures.curtain.impact.release import snap_in_current


@dataclass(frozen=True)
class ModelError:
    """A model against a record."""

    #: Name.
    model: str
    #: Impact tension of the model [N].
    tension: float
    #: Impact tension of the record [N].
    observed_tension: float
    #: Rise time of the model [s]; NaN where there is none.
    time: float
    #: Rise time of the record [s]; NaN where there is none.
    observed_time: float

    @property
    def tension_ratio(self) -> float:
        """Model over record."""
        return self.tension / self.observed_tension

    @property
    def time_ratio(self) -> float:
        """Model over record."""
        return self.time / self.observed_time


@dataclass(frozen=True)
class RecordComparison:
    """All models against a record."""

    #: In the order of the comparison; the cables of A2 as ``A2 upper`` and ``A2 lower`` where they were measured.
    lines: tuple[ModelError, ...]
    #: What makes the comparison doubtful.
    notices: tuple[Notice, ...]

    @property
    def nearest(self) -> ModelError:
        """The model whose tension is nearest in proportion."""
        return min(self.lines, key=lambda line: abs(math.log(line.tension_ratio)))


def compare_record(
    comparison: Comparison,
    *,
    impact_tension: float,
    rise_time: float,
    upper_impact: float | None = None,
    lower_impact: float | None = None,
    peak_missed: float = 0.0,
) -> RecordComparison:
    """Compare the impact models with the impact (peak less plateau) of a record; nothing is fitted.

    Parameters
    ----------
    comparison : Comparison
        Of :func:`moyai.structures.curtain.impact.compare.compare_models`, at the speed that the record's curtain had.
    impact_tension : float
        Peak less plateau of the sum of both cables [N].
    rise_time : float
        From taut to peak [s]; NaN where it is not known.
    upper_impact, lower_impact : float, optional
        Of each cable [N].
    peak_missed : float
        Largest share of the peak that the sampling may have missed.

    Raises
    ------
    InputError
        When a tension is not positive.
    """
    given = {"impact_tension": impact_tension, "upper_impact": upper_impact, "lower_impact": lower_impact}
    for name, value in given.items():
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise InputError(
                f"{name} is {value:g} N",
                parameter=name,
                allowed="greater than 0",
                remedy="check the sign of the gauges and the plateau",
            )
    if not (math.isnan(rise_time) or rise_time > 0.0):
        raise InputError(f"rise_time is {rise_time:g} s", parameter="rise_time", allowed="greater than 0")
    lines = []
    for item in comparison.models:
        lines.append(ModelError(item.model, item.tension, impact_tension, item.time, rise_time))
        for side, model, seen in (
            ("upper", item.upper_tension, upper_impact),
            ("lower", item.lower_tension, lower_impact),
        ):
            if item.model == "A2" and seen is not None:
                lines.append(ModelError(f"A2 {side}", model, seen, item.time, rise_time))
    found = RecordComparison(tuple(lines), ())
    notices = []
    ratios = [line.tension_ratio for line in lines if not line.model.startswith(("B literal", "A2 "))]
    if min(ratios) > 1.0 + peak_missed or max(ratios) < 1.0:
        notices.append(
            Notice(
                "record-outside",
                f"The record lies outside the models, which give {min(ratios):.3g} to {max(ratios):.3g} of it",
                found.nearest.tension_ratio,
                1.0,
                remedy="check stiffness, start speed and the gauges before the model",
                source="all impact models of one span",
            )
        )
    return RecordComparison(tuple(lines), tuple(notices))


@dataclass(frozen=True, eq=False)
class ModelSeries:
    """Tension of a model from its taut instant on."""

    #: Name.
    model: str
    #: [s], 0 when the cable becomes taut.
    time: Array
    #: Sum of both cables [N].
    tension: Array


def model_series(
    impact: Impact, *, drag_coefficient: float | None = None, current: float | None = None, memory: bool = True
) -> tuple[ModelSeries, ...]:
    """Return the series of the models that have one, to draw over a record.

    Parameters
    ----------
    impact : Impact
        The span, with the speed at the taut instant.
    drag_coefficient, current : float, optional
        With both, the snap with drag (spike and plateau) is added; it starts with the impact's speed.
    memory : bool
        Whether to add the model with memory.
    """
    peak = peak_by_energy(impact)
    marched = march_impact(impact, time_step=peak.time / 1000.0, duration=2.0 * peak.time)
    apart = edge_impact(impact, finite_depth=True)
    found = [
        ModelSeries("A", np.append(0.0, marched.time), np.append(0.0, marched.tension)),
        ModelSeries("A2", apart.time, apart.upper_tension + apart.lower_tension),
    ]
    if memory:
        waves = impact_with_memory(impact)
        found.append(ModelSeries("A with memory", waves.time, waves.tension))
    if drag_coefficient is not None and current is not None:
        # let go just short of taut, so that the start speed is that of the impact
        snap = snap_in_current(
            impact,
            drag_coefficient=drag_coefficient,
            current=current,
            position=math.copysign(_just_slack(impact), current),
            speed=math.copysign(impact.speed, current),
        )
        after = snap.motion.time >= snap.taut_time
        time, tension = snap.motion.time[after] - snap.taut_time, snap.motion.tension[after]
        found.append(ModelSeries("A with drag", np.append(0.0, time), np.append(0.0, tension)))
    return tuple(found)


def _just_slack(impact: Impact) -> float:
    from moyai.structures.curtain.impact.cycles import slack_sag

    return slack_sag(impact) * (1.0 - 1e-9)
