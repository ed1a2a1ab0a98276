"""Runs of the paper: a synthetic campaign through the chain of the paper, and the curtain of the site in a typhoon."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.records.survey.tension_blocks import Blocks
from moyai.reproduce.inputs import problem_of, run_problem
from moyai.reproduce.tabata.campaign import (
    CONVENTIONAL,
    CURTAIN_DEPTH,
    WATER,
    Campaign,
    by_wave,
    campaign,
    paper_maxima,
    process,
)
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.states import IrregularSea
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.model import CurtainProblem
from moyai.structures.curtain.seas.anchor_energy import FittingRule, calibrate
from moyai.structures.curtain.seas.energy_by_wave import WaveCalibration
from moyai.structures.curtain.seas.squared_velocity import effective_height, squared_velocity
from moyai.structures.curtain.snaps.events import snaps_in_sea
from moyai.structures.curtain.snaps.flow import flow_over_skirt

SEED = 3
CHOSEN = math.radians(50.0)  # directions in which the waves, not the noise of the gauge, set the tension
#: Stiffness of an anchor rope [N/m]: 890 kN/m as printed, and 890 kN for a strain of one over its 46 m
ROPES = {"890 kN/m": 890e3, "890 kN": 890e3 / 46.0}


@dataclass(frozen=True)
class Runs:
    """The runs that the figures and statements read."""

    #: Synthetic.
    data: Campaign
    #: Both types through the chain of the paper.
    new: Blocks
    #: Both types through the chain of the paper.
    conventional: Blocks
    #: Highest tensions of an anchor rope in the typhoon, a realisation each, by the stiffness of :data:`ROPES` [N].
    typhoon: Mapping[str, Array]
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


def run(quick: bool = False, progress: Progress = silent) -> Runs:
    """Run everything.

    Parameters
    ----------
    quick : bool
        A shorter campaign, and one realisation of the typhoon in place of five.
    progress : Progress
    """
    case: CurtainProblem = problem_of("tabata", "kansai")
    seeds = range(1, 2 if quick else 6)
    done, steps = 0, len(ROPES) * len(seeds) + 2
    progress("parts of the paper", done, steps)
    data = campaign(SEED, 40 if quick else 120)
    new, conventional = process(data), process(data, conventional=True)
    typhoon = {}
    for name, stiffness in ROPES.items():
        peaks = []
        for seed in seeds:
            done += 1
            progress("parts of the paper", done, steps)
            peaks.append(_pull_in_typhoon(case, stiffness, seed, progress))
        typhoon[name] = np.array(peaks)
    runs = Runs(data, new, conventional, typhoon, case)
    progress("parts of the paper", steps - 1, steps)
    _ = runs.snaps
    progress("parts of the paper", steps, steps)
    return runs


def _pull_in_typhoon(case: CurtainProblem, stiffness: float, seed: int, progress: Progress) -> float:
    """Return the highest tension of an anchor rope [N] about the highest crest of a realisation of the typhoon."""
    anchors, sea, span = case.curtain.anchors, case.environment.sea_states[0], case.settings.dynamic
    assert anchors is not None and isinstance(sea, IrregularSea) and span is not None
    changed = replace(
        case,
        curtain=replace(case.curtain, anchors=replace(anchors, stiffness=stiffness)),
        environment=replace(case.environment, sea_states=(replace(sea, seed=seed),)),
        settings=replace(
            case.settings,
            analyses=("dynamic",),
            dynamic=replace(span, mesh=replace(span.mesh, along=8, down=3), sensitivity=False),
        ),
    )
    tree = run_problem("curtain", changed, progress).tree
    return float(tree["SWL/dynamic"]["anchor_peak"].max())
