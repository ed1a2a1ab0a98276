"""Whole curtain cases: the figures of the sources through the same analyses that a case file runs."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

from moyai.core.validation import ValidationCase
from moyai.sea.current import uniform
from moyai.sea.environment import Environment
from moyai.sea.states import RegularSea
from moyai.sea.water import Water
from moyai.structures.curtain.assembly import LevelCurtain, assemble
from moyai.structures.curtain.model import (
    AnchorLines,
    AnchorLoadSettings,
    Curtain,
    CurtainProblem,
    CurtainSettings,
    ImpactSettings,
    Strengths,
)
from moyai.structures.curtain.run import run
from moyai.structures.curtain.statics.drag import constant_drag
from moyai.structures.curtain.statics.hanging import FloatLine
from moyai.structures.curtain.statics.section import Skirt

if TYPE_CHECKING:
    import xarray as xr

_PAPER = "Sawaragi, Aoki and Liu (1991), default flume case, prototype of other construction"
_FIELD = "Tabata et al., equations (1) to (5), computed independently"


def _curtain(skirt: Skirt, span: float, length: float, stiffness: float, anchors: AnchorLines | None) -> Curtain:
    return Curtain(
        span=span,
        length=length,
        normal=0.0,
        skirt=skirt,
        toe="free",
        toe_chain=math.nan,
        floats=FloatLine(2352.0, 100.0, 2352.0),
        upper_stiffness=0.5 * stiffness,
        lower_stiffness=0.5 * stiffness,
        drag=constant_drag(1.2, (1.0, 1.0), "validation"),
        law="normal_velocity",
        passing_fraction=1.0,
        may_lie_on_bed=True,
        joint_distance=span,
        anchors=anchors,
        strengths=Strengths(),
        curtain_class="",
    )


@lru_cache(maxsize=1)
def _flume() -> xr.Dataset:
    problem = CurtainProblem(
        "flume",
        _curtain(Skirt(0.15, 0.0, 4.0, 5e4), 0.7, 0.8, 150.0, None),
        Environment(Water(0.4, 1000.0, 9.81), current=uniform(0.3, 0.0)),
        CurtainSettings(analyses=("impact",), impact=ImpactSettings(chord=0.135)),
    )
    return run(problem).tree["SWL/impact"].to_dataset()


def _peak(model: str) -> float:
    return float(_flume()["both_cables_impact_tension"].sel(impact_model=model))


@lru_cache(maxsize=1)
def _airport() -> xr.Dataset:
    problem = CurtainProblem(
        "airport",
        _curtain(Skirt(5.0, 2.0, 255.0, 9e5), 15.0, 16.5, 4e6, AnchorLines(46.0, None, 890e3, 13.7e3)),
        Environment(
            Water(20.0, 1025.0, 9.81),
            sea_states=(RegularSea("highest", 5.508, (7.0,), 0.0),),
            current=uniform(0.2, 0.0),
        ),
        CurtainSettings(analyses=("anchor_loads",), anchor_loads=AnchorLoadSettings(0.2, 518.0)),
    )
    return run(problem).tree["SWL/anchor_loads"].to_dataset()


def _on_bed() -> LevelCurtain:
    problem = CurtainProblem(
        "bed",
        _curtain(Skirt(6.0, 5.0, 200.0, 1e6), 20.0, 23.0, 6e6, None),
        Environment(Water(5.0, 1025.0, 9.81), current=uniform(0.15, 0.0)),
    )
    return assemble(problem, "SWL", 0.0)


CASES: tuple[ValidationCase, ...] = (
    ValidationCase("curtain case: model A of the flume [N]", _PAPER, lambda: _peak("A"), 9.86556, 1e-6,
                   note="printed digits"),
    ValidationCase("curtain case: model A2, sum of the flume [N]", _PAPER,
                   lambda: float(_flume()["impact_upper_tension"].sel(impact_model="A2"))
                   + float(_flume()["impact_lower_tension"].sel(impact_model="A2")), 9.846, 2e-4,
                   note="printed digits"),
    ValidationCase("curtain case: model B energy_mid of the flume [N]", _PAPER, lambda: _peak("B energy_mid"), 287.4,
                   2e-3, note="printed digits"),
    ValidationCase("curtain case: tension coefficient of the flume", _PAPER,
                   lambda: float(_flume()["tension_coefficient"]), 2.088, 3e-4, note="printed digits"),
    ValidationCase("curtain case: marching with 16 steps to the peak", _PAPER,
                   lambda: float(_flume()["march_error"][2]), -0.0383, 2e-3, note="printed digits"),
    ValidationCase("curtain case: drag level after the spike [N]", _PAPER,
                   lambda: float(_flume()["both_cables_plateau_tension"]), 2.92, 2e-3, note="printed digits"),
    ValidationCase("curtain case: squared velocity at the airport [m2/s2]", _FIELD,
                   lambda: float(_airport()["squared_velocity"][0]), 5.6471736, 1e-8, note="printed digits"),
    ValidationCase("curtain case: rope tension without pretension [kN]", _FIELD,
                   lambda: float(_airport()["rope_tension"][0]) / 1e3, 52.4, 1e-3, note="three printed digits"),
    ValidationCase("curtain case: toe of a long skirt rests on the bed [m]", "identity",
                   lambda: _on_bed().statics.section.toe_depth, 5.0, 1e-9, note="root of the hanging length"),
)  # fmt: skip
