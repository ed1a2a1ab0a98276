"""The impact when the curtain becomes taut: start speed, all models side by side, what the load table takes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.errors import InputError
from moyai.core.validity import IdentityCheck, Notice
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.impact.cable import EdgeImpact, Impact, edge_impact, peak_by_energy
from moyai.structures.curtain.impact.compare import Comparison, compare_models
from moyai.structures.curtain.impact.kernels import spring, taut_shape
from moyai.structures.curtain.impact.march import march_impact
from moyai.structures.curtain.impact.release import slack_phase
from moyai.structures.curtain.impact.skirt import BulgedSkirt as BulgingSkirt
from moyai.structures.curtain.model import ImpactSettings

_NO_CABLE = 1e-6
#: A skirt reaches at most so much of the depth in the impact models, whose plate ends above the bed
_DEEPEST = 0.98


@dataclass(frozen=True, eq=False)
class ImpactAnswer:
    """What the impact analysis of a level found."""

    #: The span, with its start speed.
    impact: Impact
    #: All models.
    comparison: Comparison
    #: Model A2, for the shares of the cables.
    edges: EdgeImpact
    #: Whose tension the load table takes.
    design_model: str
    #: Of both cables together [N].
    design_tension: float
    #: The skirt that bulges; None where no chord is known.
    skirt: BulgingSkirt | None
    #: Ends of the band of the tension over ``design_tension`` [-]: the lowest of the models of the design with start
    #: speed of low drag, and the design model with that of high drag [eq:impact-band].
    uncertainty: tuple[float, float]

    @property
    def shares(self) -> tuple[float, float]:
        """Peaks of the upper and of the lower cable over that of their sum [-]."""
        whole = self.edges.simultaneous_peak
        return self.edges.upper_peak / whole, self.edges.lower_peak / whole


def impact_of(unit: LevelCurtain, settings: ImpactSettings, speed: float) -> Impact:
    """Return the span of a level for the impact models.

    Parameters
    ----------
    unit : LevelCurtain
    settings : ImpactSettings
    speed : float
        Of the curtain when it becomes taut [m/s].

    Raises
    ------
    InputError
        As :class:`moyai.structures.curtain.impact.cable.Impact`.
    """
    curtain = unit.curtain
    upper = curtain.upper_stiffness
    lower = curtain.lower_stiffness if curtain.lower_stiffness > 0.0 else _NO_CABLE * upper
    share = 0.5 if settings.cables == "one" else 1.0
    draught = settings.draught
    if draught is None:
        draught = min(curtain.skirt.length, _DEEPEST * unit.water.depth)
    return Impact(
        curtain.span,
        curtain.length,
        draught,
        share * upper,
        share * lower,
        speed,
        unit.water,
    )


def drag_coefficient(unit: LevelCurtain, draught: float) -> float:
    """Return C_D of the flat plate that stands for the skirt [-]."""
    blockage = 0.0 if math.isinf(unit.water.depth) else draught / unit.water.depth
    return unit.hanging.drag.coefficient(blockage)


def start_speed(unit: LevelCurtain, settings: ImpactSettings) -> tuple[float, str]:
    """Return the speed at the taut instant [m/s] and where it comes from.

    Raises
    ------
    InputError
        Without a current, or when a release never makes the curtain taut.
    """
    if settings.start_speed is not None:
        return settings.start_speed, "given"
    current = unit.normal_speed
    if not current > 0.0:
        raise InputError(
            "the start speed of the impact needs a current along the normal",
            parameter="settings.impact.start",
            remedy="give a current, or the start speed of the impact",
        )
    if settings.start == "current":
        return current, "current, mean over the skirt"
    impact = impact_of(unit, settings, current)
    phase = slack_phase(
        impact,
        drag_coefficient=drag_coefficient(unit, impact.draught),
        current=current,
        position=settings.release_position or 0.0,
        speed=0.0,
    )
    return abs(phase.speed), f"drift from release, {100.0 * phase.share:.3g} % of the current"


def start_speed_range(unit: LevelCurtain, settings: ImpactSettings) -> tuple[float, float]:
    """Return the low and the high end of the start speed over that as given [-].

    Only the drift from a release depends on the drag, and on the place of the release, which no drift makes faster than
    the current: where the case does not state the place, that is the high end.
    """
    if settings.start_speed is not None or settings.start == "current":
        return 1.0, 1.0
    given = start_speed(unit, settings)[0]
    law = unit.hanging.drag
    low, high = (
        start_speed(replace(unit, hanging=replace(unit.hanging, drag=law.scaled(factor))), settings)[0] / given
        for factor in law.range
    )
    return low, high if settings.release_position is not None else max(high, unit.normal_speed / given)


def bulging_skirt(unit: LevelCurtain, settings: ImpactSettings) -> BulgingSkirt | None:
    """Return the arc of the skirt for models B and AB, or None where the data do not give one.

    Raises
    ------
    InputError
        When a given chord leaves no arc.
    """
    skirt = unit.curtain.skirt
    if math.isinf(skirt.stiffness):
        return None
    if settings.chord is not None:
        return BulgingSkirt(skirt.length, settings.chord, skirt.stiffness)
    if unit.curtain.toe != "held" or unit.surface_speed == 0.0:
        return None
    if skirt.length > unit.water.depth or unit.rests_on_bed:
        return None
    section = unit.statics.section
    try:
        return BulgingSkirt(skirt.length, math.hypot(section.effective_depth, section.flare), skirt.stiffness)
    except InputError:
        return None


def solve_impact(unit: LevelCurtain, settings: ImpactSettings, speed: float | None = None) -> ImpactAnswer:
    """Solve all models of the impact at a level.

    Parameters
    ----------
    unit : LevelCurtain
    settings : ImpactSettings
    speed : float, optional
        At the taut instant [m/s]; by the settings when not given.

    Raises
    ------
    InputError
        When the curtain is shorter than its span, or a number is out of range.
    """
    taken = start_speed(unit, settings)[0] if speed is None else speed
    impact = impact_of(unit, settings, taken)
    skirt = bulging_skirt(unit, settings)
    comparison = compare_models(impact, skirt)
    fit = [item for item in comparison.models if counts(item.model) and math.isfinite(item.tension)]
    design = max(fit, key=lambda item: item.tension)
    slow, fast = start_speed_range(unit, settings) if speed is None else (1.0, 1.0)
    least = min(item.tension for item in fit) / design.tension
    band = (slow * least, fast)
    return ImpactAnswer(impact, comparison, edge_impact(impact), design.model, design.tension, skirt, band)


def counts(model: str) -> bool:
    """Whether a model counts in the load table.

    Model B leaves out that cables stretch, the closed form is for small strain and the marching has its time step:
    they are shown next to the models that they approximate.
    """
    return not model.startswith("B ") and "closed form" not in model and "marched" not in model


def skirt_tension(answer: ImpactAnswer, tension: float) -> float:
    """Return the tension of the skirt per width [N/m] that goes with a sum of cable tensions [N].

    Each cable carries half of the load on the section, sigma d0/2; the skirt is an arc that stretches.
    """
    return math.nan if answer.skirt is None else answer.skirt.edge_tension(0.5 * line_load(answer, tension))


def line_load(answer: ImpactAnswer, tension: float) -> float:
    """Return the load per length of curtain [N/m] that goes with a sum of cable tensions [N], T/a just taut."""
    impact = answer.impact
    b = taut_shape(impact.span_ratio)
    return float(2.0 * b * tension / impact.span)


def impact_notices(unit: LevelCurtain, settings: ImpactSettings, answer: ImpactAnswer) -> tuple[Notice, ...]:
    """Return where the models leave their range, and what was left out for want of data."""
    # the design tension with memory of the waves has no need of a short rise
    memory = "memory" in answer.design_model
    notices = [item for item in answer.comparison.notices if not (memory and item.code == "impact-slow")]
    if settings.time_step is not None:
        rise = peak_by_energy(answer.impact).time
        notices += march_impact(answer.impact, time_step=settings.time_step, duration=1.6 * rise).notices
    if unit.curtain.lower_stiffness == 0.0:
        notices.append(
            Notice(
                "impact-no-lower-cable",
                "there is no lower cable: the rigid skirt of model A hangs on the upper cable alone, the lower edge "
                "of model A2 is free",
                severity="information",
                source="model A2",
            )
        )
    if answer.skirt is None:
        notices.append(
            Notice(
                "impact-no-arc",
                "models B and AB and the tension of the skirt need the chord of the impact and a skirt that stretches",
                severity="information",
                remedy="give the straight distance of the skirt's edges when it becomes taut, and its stiffness",
            )
        )
    if settings.draught is None and unit.curtain.skirt.length > _DEEPEST * unit.water.depth:
        notices.append(
            Notice(
                "impact-on-bed",
                f"the impact models end the skirt {(1.0 - _DEEPEST) * unit.water.depth:.3g} m above the bed",
                severity="information",
            )
        )
    return tuple(notices)


def impact_checks(unit: LevelCurtain, answer: ImpactAnswer) -> tuple[IdentityCheck, ...]:
    """Return the identities of the impact: energy of model A and of A2, marching without a step but for a draft."""
    impact = answer.impact
    peak = peak_by_energy(impact)
    work = _work(impact, peak.displacement)
    kinetic = 0.5 * impact.deep_mass * impact.speed**2
    energies = (
        IdentityCheck(
            f"{unit.name}: energy of model A", abs(work / kinetic - 1.0), 1e-8, "work of the cables = m U^2/2"
        ),
        IdentityCheck(
            f"{unit.name}: energy of model A2", answer.edges.energy_error, 1e-6, "kinetic energy + work = m U^2/2"
        ),
    )
    if unit.nominal:
        return energies
    fine = march_impact(impact, time_step=peak.time / 2000.0, duration=1.2 * peak.time).peak.tension
    coarse = march_impact(impact, time_step=peak.time / 1000.0, duration=1.2 * peak.time).peak.tension
    return (
        *energies,
        IdentityCheck(
            f"{unit.name}: marching without a step is model A",
            abs((2.0 * fine - coarse) / peak.tension - 1.0),
            1e-4,
            "first-order extrapolation of the marched peak = energy form",
        ),
    )


def _work(impact: Impact, displacement: float) -> float:
    """Integrate the load of the cables over a displacement [N], by itself, not by the solver's own sum."""
    taut = taut_shape(impact.span_ratio)
    nodes, weights = np.polynomial.legendre.leggauss(80)
    places = 0.5 * displacement * (nodes + 1.0)

    def load(x: float) -> float:
        return float(spring(x, impact.span, impact.span_ratio, taut, impact.stiffness)[0])

    return float(0.5 * displacement * sum(w * load(x) for x, w in zip(places, weights)))
