"""Curves of model A under the points of a set of flume runs: one number varies, the others are those of the runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.records.snaps.model import SnapFinding
from moyai.structures.curtain.impact.cable import sweep_peaks

_POINTS = 40
_ALL = "all cables"


@dataclass(frozen=True, eq=False)
class ModelCurve:
    """C_T of model A over one number."""

    #: ``froude``, ``span_ratio``, ``depth_ratio`` or ``cauchy``.
    number: str
    #: Material whose runs give the other numbers, by their medians.
    cable: str
    x: Array
    coefficient: Array


def model_curves(found: Sequence[SnapFinding]) -> tuple[ModelCurve, ...]:
    """Return the curves over Fr, B/l and d/h for each material of cable, over C_E for all runs together.

    The curtain starts with the share of the current that it has in the median of the runs.
    """
    curves = []
    for cable in dict.fromkeys(item.run.cable for item in found):
        chosen = [item for item in found if item.run.cable == cable]
        curves += [_curve(number, cable, chosen) for number in ("froude", "span_ratio", "depth_ratio")]
    curves.append(_curve("cauchy", _ALL, found))
    return tuple(curve for curve in curves if curve is not None)


def _curve(number: str, cable: str, chosen: Sequence[SnapFinding]) -> ModelCurve | None:
    impacts = [item.run.impact for item in chosen]
    table = np.array(
        [(i.speed, i.length, i.draught, i.stiffness, i.span, i.water.depth, i.water.density, i.water.gravity)
         for i in impacts]
    )  # fmt: skip
    speed, length, draught, stiffness, span, depth, density, gravity = np.median(table, axis=0)[:, None] * np.ones(
        _POINTS
    )
    share = float(np.median([item.start_speed / item.run.impact.speed for item in chosen]))
    wave_speed = np.sqrt(gravity * depth)
    columns = {
        "froude": table[:, 0] / np.sqrt(table[:, 7] * table[:, 5]),
        "span_ratio": table[:, 4] / table[:, 1],
        "depth_ratio": table[:, 2] / table[:, 5],
        "cauchy": np.sqrt(table[:, 3] / table[:, 6]) / (table[:, 5] * np.sqrt(table[:, 7] * table[:, 5])),
    }
    low, high = float(columns[number].min()), float(columns[number].max())
    if high - low < 1e-6 * high:
        return None
    x: Array = np.geomspace(low, high, _POINTS)
    if number == "froude":
        speed = x * wave_speed
    elif number == "span_ratio":
        length = span / x
    elif number == "depth_ratio":
        draught = x * depth
    else:
        stiffness = (x * depth * wave_speed) ** 2 * density
    tension = sweep_peaks(span, length, stiffness, share * speed, 2.0 * density * draught**2 / math.pi)[..., 0]
    return ModelCurve(number, cable, x, tension / (0.5 * density * speed**2 * span * draught))
