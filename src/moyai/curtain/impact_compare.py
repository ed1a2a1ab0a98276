"""All impact models on one span, with their spread."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import get_args

from moyai.core.validity import Notice
from moyai.curtain.added_mass import flat_skirt_mass
from moyai.curtain.impact import Impact, check_impact, closed_form, edge_impact, peak_by_energy
from moyai.curtain.impact_march import march_impact
from moyai.curtain.impact_skirt import Skirt, Variant, cable_and_skirt_impact, skirt_impact


@dataclass(frozen=True)
class ModelTension:
    """One line of the comparison.

    Parameters
    ----------
    model : str
        Name of the model.
    tension : float
        Largest sum of the cable tensions [N].
    time : float
        From the taut instant to the peak [s]; NaN where the model gives none.
    assumption : str
        What the model takes for granted.
    """

    model: str
    tension: float
    time: float
    assumption: str


@dataclass(frozen=True)
class Comparison:
    """All models on one span.

    Parameters
    ----------
    models : tuple of ModelTension
        One line each.
    notices : tuple of Notice
        Where model A leaves its range.
    """

    models: tuple[ModelTension, ...]
    notices: tuple[Notice, ...]

    @property
    def spread(self) -> float:
        """Largest over smallest tension of the models that are not known to be wrong (model B literal)."""
        values = [item.tension for item in self.models if item.model != "B literal"]
        return max(values) / min(values)


def compare_models(impact: Impact, skirt: Skirt | None = None) -> Comparison:
    """Return the peaks of all models that the data allow.

    Parameters
    ----------
    impact : Impact
        The span.
    skirt : Skirt, optional
        Needed by models B and AB.
    """
    exact = peak_by_energy(impact)
    marched = march_impact(impact, time_step=exact.time / 200.0, duration=1.5 * exact.time).peak
    small = closed_form(impact)
    shallow = peak_by_energy(impact, flat_skirt_mass(impact.draught, impact.water).total)
    edges = edge_impact(impact)
    lines = [
        ModelTension(
            "A marched", marched.tension, marched.time, "rigid flat skirt; 200 steps to the peak, as the paper"
        ),
        ModelTension("A", exact.tension, exact.time, "rigid flat skirt, cable stretches, deep-water mass"),
        ModelTension("A closed form", small.tension, small.time, "as A, small strain"),
        ModelTension("A in this depth", shallow.tension, shallow.time, "as A, mass of the flat skirt in this depth"),
        ModelTension("A2", edges.simultaneous_peak, math.nan, "rigid flat skirt, cables apart"),
    ]
    if skirt is not None:
        if impact.length > impact.span:
            for variant in get_args(Variant):
                found = skirt_impact(impact, skirt, variant)
                lines.append(ModelTension(f"B {variant}", found.tension, found.time, "skirt stretches, cables do not"))
        both = cable_and_skirt_impact(impact, skirt)
        lines.append(ModelTension("AB", both.tension, both.time, "cable and skirt stretch, curved mass"))
    return Comparison(tuple(lines), check_impact(impact))
