"""Runs of the paper: a synthetic campaign through the chain of the paper, and the curtain of the site in a typhoon."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import each_counted
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.records.survey.tension_blocks import Blocks
from moyai.reproduce.inputs import problem_of, run_problem
from moyai.reproduce.tabata.campaign import (
    CONVENTIONAL,
    CURTAIN_DEPTH,
    WATER,
    FieldCampaign,
    by_wave,
    campaign,
    paper_maxima,
    process,
)
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import bretschneider_mitsuyasu, jonswap
from moyai.sea.states import IrregularSea
from moyai.structures.curtain.dynamic.model import Mesh
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.model import CurtainProblem, Strengths
from moyai.structures.curtain.seas.anchor_energy import FittingRule, calibrate
from moyai.structures.curtain.seas.energy_by_wave import WaveCalibration
from moyai.structures.curtain.seas.squared_velocity import effective_height, squared_velocity
from moyai.structures.curtain.snaps.events import snaps_in_sea
from moyai.structures.curtain.snaps.flow import flow_over_skirt

SEED = 3
#: H_1/3 of the typhoon in which the curtain stood [m].
TYPHOON = 3.06
CHOSEN = math.radians(50.0)  # directions in which the waves, not the noise of the gauge, set the tension
#: Stiffness of an anchor rope [N/m]: 890 kN/m as printed, and 890 kN for a strain of one over its 46 m, as in the case
ROPES = {"890 kN/m": 890e3, "890 kN": 890e3 / 46.0}


@dataclass(frozen=True)
class Pulls:
    """Highest loads of a run of the span through the highest crest of the typhoon."""

    #: Load of an anchor rope [N].
    rope: float
    #: Load of the wire through the floats [N].
    wire: float
    #: Of the sheet [N/m].
    sheet: float

    def shares(self, strengths: Strengths) -> dict[str, float]:
        """Return load over strength of each part; the anchor with the pull of its rope."""
        return {
            "anchor": self.rope / strengths.anchor.capacity,
            "anchor rope": self.rope / strengths.anchor_line.capacity,
            "wire": self.wire / strengths.upper_cable.capacity,
            "sheet": self.sheet / strengths.sheet.capacity,
        }


@dataclass(frozen=True)
class TabataRuns:
    """The runs that the figures and statements read."""

    #: Synthetic.
    data: FieldCampaign
    #: New type through the chain of the paper.
    new: Blocks
    #: Conventional type through the chain of the paper.
    conventional: Blocks
    #: Loads of the span in the typhoon, a realisation each, by the stiffness of :data:`ROPES`.
    typhoon: Mapping[str, tuple[Pulls, ...]]
    #: The same with one guessed value changed, by the words of the change, for a rope of 890 kN for a strain of one.
    guessed: Mapping[str, Pulls]
    #: The curtain of the site.
    case: CurtainProblem

    @cached_property
    def squared(self) -> Array:
        """Squared velocity of every block by equations (1) and (2) [m2/s2]."""
        height = effective_height(self.new.significant_height, self.new.angle, "paper", 1.8)
        return squared_velocity(
            height, self.new.significant_period, np.abs(self.new.current_normal), CURTAIN_DEPTH, WATER
        )

    @cached_property
    def observed(self) -> tuple[Array, Array]:
        """Largest tensions [N] and speeds of the float [m/s], block by block, as the paper takes them."""
        return paper_maxima(self.conventional)

    @cached_property
    def by_wave(self) -> WaveCalibration:
        """The energy model fitted to single waves."""
        return by_wave(self.conventional)

    @property
    def energy_factor(self) -> tuple[float, float, float]:
        """M of single waves and its interval."""
        return self.by_wave.energy_factor(CONVENTIONAL.float_mass, CONVENTIONAL.rope_stiffness)

    @checks_words
    def paper_factor(self, rule: FittingRule = "mean_zero") -> tuple[float, float, float]:
        """Return M of the paper's maxima and its interval by a rule of fitting."""
        fit = calibrate(*self.observed, 0.0, line_factor=1.0, rule=rule)
        unit = CONVENTIONAL.float_mass * CONVENTIONAL.rope_stiffness
        return fit.product / unit, fit.interval[0] / unit, fit.interval[1] / unit

    @cached_property
    def snaps(self) -> tuple[int, int]:
        """Snaps in twenty minutes of one sea without current, and with 0.3 m/s."""
        curtain = self.case.curtain
        counts = []
        step, duration = 0.05, 1200.0
        sea = synthesise(jonswap(1.2, 4.2, 3.3), WATER, duration=duration, seed=9, time_step=step)
        for current in (0.0, 0.3):
            span = Impact(curtain.span, curtain.length, CURTAIN_DEPTH, 5e5, 5e5, 0.3, WATER)
            flow = flow_over_skirt(
                sea, WATER, draught=CURTAIN_DEPTH, normal_heading=0.0, current=current, duration=duration,
                time_step=step, velocity="skirt_mean",
            )  # fmt: skip
            found = snaps_in_sea(span, flow, drag_coefficient=1.2, slowest=0.05, transient=120.0)
            counts.append(int(found.counted.sum()))
        return counts[0], counts[1]


def run(quick: bool = False, progress: Progress = silent) -> TabataRuns:
    """Run everything.

    Parameters
    ----------
    quick : bool
        A shorter campaign, and one realisation of the typhoon in place of five, and no guessed value changed.
    progress : Progress
    """
    case: CurtainProblem = problem_of("tabata", "kansai")
    assert case.settings.dynamic is not None
    case = _meshed(case, replace(case.settings.dynamic.mesh, along=8, down=3))
    seeds = {"890 kN": range(1, 2 if quick else 6), "890 kN/m": range(1, 2)}
    data = campaign(SEED, 40 if quick else 120)
    new, conventional = process(data), process(data, conventional=True)
    changes = {} if quick else dict(_changes(case))
    ropes = [(_with_rope(case, ROPES[name]), seed) for name in ROPES for seed in seeds[name]]
    changed = [(_with_rope(one, ROPES["890 kN"]), 1) for one in changes.values()]
    pulls = each_counted("runs of the paper", lambda one, heard: _in_typhoon(*one, heard), [*ropes, *changed], progress)
    found = iter(pulls)
    typhoon = {name: tuple(islice(found, len(seeds[name]))) for name in ROPES}
    guessed = dict(zip(changes, found, strict=True))
    runs = TabataRuns(data, new, conventional, typhoon, guessed, case)
    _ = runs.snaps
    return runs


def _with_rope(case: CurtainProblem, stiffness: float) -> CurtainProblem:
    """Return the case with ropes of a stiffness [N/m]."""
    anchors = case.curtain.anchors
    assert anchors is not None
    return replace(case, curtain=replace(case.curtain, anchors=replace(anchors, stiffness=stiffness)))


def _changes(case: CurtainProblem) -> Iterator[tuple[str, CurtainProblem]]:
    """Yield the case with each guessed value of the span at another place of its range."""
    curtain, sea = case.curtain, case.environment.sea_states[0]
    assert isinstance(sea, IrregularSea)

    def span(**changed: Any) -> CurtainProblem:
        return replace(case, curtain=replace(curtain, **changed))

    def waves(**changed: Any) -> CurtainProblem:
        seas = (replace(sea, **changed), *case.environment.sea_states[1:])
        return replace(case, environment=replace(case.environment, sea_states=seas))

    yield "5 % longer than the span", span(length=1.05 * curtain.span)
    yield "waves at 45 degrees", waves(heading=math.radians(45.0))
    yield "20 % longer than the span", span(length=1.2 * curtain.span)
    yield "waves at 70 degrees", waves(heading=math.radians(70.0))
    for period in (6.0, 8.0):
        spectrum = bretschneider_mitsuyasu(TYPHOON, period)
        yield f"T_1/3 of {period:g} s", waves(spectrum=spectrum)
    for factor, word in ((0.5, "half"), (2.0, "twice")):
        yield f"{word} the stiffness of the wire", span(upper_stiffness=factor * curtain.upper_stiffness)
        yield (
            f"{word} the stiffness of the sheet",
            span(skirt=replace(curtain.skirt, stiffness=factor * curtain.skirt.stiffness)),
        )
    mesh = case.settings.dynamic.mesh  # type: ignore[union-attr]
    assert mesh.cable_viscosity is not None and mesh.skirt_damping_time is not None
    damped = replace(mesh, cable_viscosity=0.5 * mesh.cable_viscosity, skirt_damping_time=0.5 * mesh.skirt_damping_time)
    yield "half the internal damping of wire and sheet", _meshed(case, damped)
    for end, value in zip(("lower", "upper"), curtain.drag.range, strict=True):
        yield f"drag at the {end} end of its range", span(drag=curtain.drag.scaled(value))


def _meshed(case: CurtainProblem, mesh: Mesh) -> CurtainProblem:
    """Return the case with its whole span on another mesh."""
    span = case.settings.dynamic
    assert span is not None
    return replace(case, settings=replace(case.settings, dynamic=replace(span, mesh=mesh)))


def _in_typhoon(case: CurtainProblem, seed: int, progress: Progress) -> Pulls:
    """Return the highest loads about the highest crest of a realisation of the typhoon."""
    sea, span = case.environment.sea_states[0], case.settings.dynamic
    assert isinstance(sea, IrregularSea) and span is not None
    changed = replace(
        case,
        environment=replace(case.environment, sea_states=(replace(sea, seed=seed),)),
        settings=replace(
            case.settings,
            analyses=("dynamic",),
            dynamic=replace(span, sensitivity=False),
        ),
    )
    found = run_problem("curtain", changed, progress).tree["SWL/dynamic"].to_dataset()
    names = ("anchor_line_tension_maximum", "upper_peak", "skirt_peak")
    return Pulls(*(float(found[name].max()) for name in names))
