"""All impact models on one span, with their spread."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import get_args

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.structures.curtain.impact.added_mass import arc_skirt_mass, flat_skirt_mass
from moyai.structures.curtain.impact.cable import Impact, check_impact, closed_form, edge_impact, peak_by_energy
from moyai.structures.curtain.impact.march import march_impact
from moyai.structures.curtain.impact.memory import impact_with_memory
from moyai.structures.curtain.impact.skirt import (
    BulgedSkirt,
    JointPeak,
    SkirtPeak,
    Variant,
    cable_and_skirt_impact,
    curved_impact,
    skirt_impact,
)

# Sagitta increment over cable displacement below which model A does without the skirt
_STIFF_SKIRT = 0.02
_BED = 1.01
_STRAIN = 0.05


@dataclass(frozen=True)
class ModelTension:
    """One line of the comparison."""

    #: Name of the model.
    model: str
    #: Largest sum of the cable tensions [N].
    tension: float
    #: From the taut instant to the peak [s]; NaN where the model gives none.
    time: float
    #: What the model takes for granted.
    assumption: str
    #: Largest tension of the upper cable [N]; NaN where the model does not give it apart.
    upper_tension: float = math.nan
    #: Largest tension of the lower cable [N]; NaN where the model does not give it apart.
    lower_tension: float = math.nan
    #: Largest tension of the skirt [N/m]; NaN where the model has none.
    skirt_tension: float = math.nan
    #: Whether it counts in the spread: not model B with the start that is known to be wrong.
    counts: bool = True


@dataclass(frozen=True)
class Comparison:
    """All models on one span."""

    #: One line each.
    models: tuple[ModelTension, ...]
    #: Where models leave their range.
    notices: tuple[Notice, ...]

    @property
    def spread(self) -> float:
        """Largest over smallest tension of the models used for design."""
        values = [item.tension for item in self.models if item.counts]
        return max(values) / min(values)

    def tension(self, model: str) -> float:
        """Return the tension of a model by its name [N]."""
        return next(item.tension for item in self.models if item.model == model)


@checks_words
def compare_models(impact: Impact, skirt: BulgedSkirt | None = None, *, memory: bool = True) -> Comparison:
    """Return the peaks of all models that the data allow.

    The paper's model A and its closed form take the added mass of deep water; the others that of this depth.

    Parameters
    ----------
    impact : Impact
        The span.
    skirt : Skirt, optional
        Needed by models B and AB and the curved mass.
    memory : bool
        Whether to solve the model with memory too; its kernel takes about a second for a new ratio of depth to draught.
    """
    exact = peak_by_energy(impact)
    marched = march_impact(impact, time_step=exact.time / 200.0, duration=1.5 * exact.time).peak
    small = closed_form(impact)
    shallow = peak_by_energy(impact, flat_skirt_mass(impact.draught, impact.water).total)
    edges = edge_impact(impact, finite_depth=True)
    both_at = float(edges.time[int((edges.upper_tension + edges.lower_tension).argmax())])
    lines = [
        ModelTension(
            "A marched", marched.tension, marched.time, "rigid flat skirt; 200 steps to the peak, as the paper"
        ),
        ModelTension("A", exact.tension, exact.time, "rigid flat skirt, cable stretches, deep-water mass"),
        ModelTension("A closed form", small.tension, small.time, "as A, small strain"),
        ModelTension("A in this depth", shallow.tension, shallow.time, "as A, mass of the flat skirt in this depth"),
    ]
    notices = list(check_impact(impact))
    if memory:
        try:
            waves = impact_with_memory(impact)
            lines.append(
                ModelTension("A with memory", waves.peak.tension, waves.peak.time, "as A in this depth, with its waves")
            )
        except ConvergenceError as error:
            notices.append(Notice("impact-no-memory", str(error), remedy="take stiffer cables"))
    lines.append(
        ModelTension(
            "A2",
            edges.simultaneous_peak,
            both_at,
            "rigid flat skirt, cables apart",
            edges.upper_peak,
            edges.lower_peak,
        )
    )
    if skirt is not None:
        curved = curved_impact(impact, skirt, finite_depth=True)
        lines.append(ModelTension("A curved skirt", curved.tension, curved.time, "as A, mass of the just-taut arc"))
        largest = 0.0
        if impact.length > impact.span:
            for variant in get_args(Variant):
                try:
                    found: SkirtPeak = skirt_impact(impact, skirt, variant, finite_depth=True)
                except InputError as error:
                    left_out = f"model B {variant} is left out: {error.fault.message}"
                    notices.append(Notice("impact-skirt-range", left_out, severity="information"))
                    continue
                lines.append(
                    ModelTension(
                        f"B {variant}",
                        found.tension,
                        found.time,
                        "skirt stretches, cables do not",
                        0.5 * found.tension,
                        0.5 * found.tension,
                        found.skirt_tension,
                        counts=variant != "literal",
                    )
                )
                largest = max(largest, found.skirt_tension)
        both = cable_and_skirt_impact(impact, skirt, finite_depth=True)
        lines.append(
            ModelTension(
                "AB",
                both.tension,
                both.time,
                "cable and skirt stretch, curved mass",
                skirt_tension=both.skirt_tension,
            )
        )
        notices += [*both.notices, *check_skirt(impact, skirt, both, largest)]
    return Comparison(tuple(lines), tuple(notices))


def check_skirt(impact: Impact, skirt: BulgedSkirt, both: JointPeak, stretched_tension: float) -> tuple[Notice, ...]:
    """Tell where the skirt matters to model A, where the bed matters to the arc, and where model B stretches far.

    Parameters
    ----------
    impact, skirt : Impact, Skirt
        The span.
    both : JointPeak
        Result of model AB.
    stretched_tension : float
        Largest skirt tension of model B [N/m].
    """
    notices = []
    share = both.sagitta_increment / both.displacement
    if share > _STIFF_SKIRT:
        notices.append(
            Notice(
                "impact-soft-skirt",
                f"The skirt's middle moves {100.0 * share:.3g} % of the cable's way: model A leaves out a stretch that "
                "lowers the peak",
                share,
                _STIFF_SKIRT,
                severity="information",
                remedy="take model AB",
                source="heuristic: below 2 % models A (curved mass) and AB agree within 1 %",
            )
        )
    deep = float(arc_skirt_mass(skirt.chord, impact.water.with_depth(math.inf)).at(skirt.sagitta)[0])
    here = float(arc_skirt_mass(skirt.chord, impact.water).at(skirt.sagitta)[0])
    if here / deep > _BED:
        notices.append(
            Notice(
                "impact-arc-bed",
                f"The bed raises the added mass of the arc to {here / deep:.3g} of that in deep water",
                here / deep,
                _BED,
                severity="information",
                remedy="models A2, B and AB take the mass in this depth",
                source="thin plate at infinite frequency",
            )
        )
    strain = stretched_tension / skirt.stiffness
    if strain > _STRAIN:
        notices.append(
            Notice(
                "impact-skirt-strain",
                f"The skirt of model B stretches by {100.0 * strain:.3g} %: beyond most sheets' straight part",
                strain,
                _STRAIN,
                remedy="check the sheet's load curve",
                source="elastic skirt of model B",
            )
        )
    return tuple(notices)
