"""Keys of the case file, checks between them, and the problem that they describe."""

import math
from typing import Any, Literal

from pydantic import Field

from moyai.case.build_sea import current_of
from moyai.case.criteria import criteria_of
from moyai.case.headings import heading_of
from moyai.case.schema_criteria import GreatestLength, LineCriteria
from moyai.case.schema_environment import SiteCurrentKeys, SiteKeys
from moyai.case.schema_lines import OwnSegment
from moyai.case.schema_types import Block, Mass, Name, PositiveLength, PositiveNumber
from moyai.mooring import LineType, Segment
from moyai.sea import Water
from moyai_spar.model import SparProblem


class Spar(Block):
    """A vertical cylinder."""

    kind: Literal["spar"] = Field(description="Spar buoy on one chain.")
    diameter: PositiveLength = Field(description="Diameter.")
    height: PositiveLength = Field(description="Height, keel to top.")
    mass: Mass = Field(description="Mass without the chain.")
    drag_coefficient: PositiveNumber = Field(description="Drag coefficient across the axis.")
    chain: OwnSegment = Field(description="The chain between the keel and the bed.")


class SparCriteria(LineCriteria):
    """What a spar has to keep."""

    greatest_offset: GreatestLength = Field(default=None, description="Largest distance from the anchor.")


class SparCase(Block):
    """A spar from its site to its chain."""

    moyai: Literal[1] = Field(description="Version of the case file format.")
    title: Name = Field(description="Title of the report.")
    site: SiteKeys = Field(description="The water of the site.")
    current: SiteCurrentKeys = Field(description="Steady current.")
    structure: Spar = Field(description="The spar.")
    criteria: SparCriteria = Field(default_factory=SparCriteria, description="What the design has to keep.")


def check(model: SparCase, findings: Any) -> None:
    """Record what has no equilibrium."""
    if math.isinf(model.site.water_depth):
        findings.fault(("site", "water_depth"), "a chain needs a bed", remedy="give the depth")
        return
    problem = build_problem(model, "", "")
    if problem.free_draught >= min(
        model.structure.height, model.site.water_depth + min(model.site.water_levels.values())
    ):
        findings.fault(("structure", "mass"), "the spar sinks, or stands on the bed")
    elif problem.current.depth_mean_drag(-problem.free_draught, 0.0, problem.heading) <= 0.0:
        findings.fault(("current",), "without a current the place of the spar is not determined")


def build_problem(model: SparCase, case_text: str, case_hash: str) -> SparProblem:
    """Return the problem of a case."""
    spar, chain, site = model.structure, model.structure.chain, model.site
    water = Water(site.water_depth, site.density, site.gravity)
    weight = (chain.submerged_weight or 0.0) + (chain.submerged_mass or 0.0) * site.gravity
    kind = LineType("chain", weight, chain.axial_stiffness, chain.breaking_load or math.inf)
    return SparProblem(
        spar.diameter, spar.height, spar.mass, spar.drag_coefficient, Segment(kind, chain.length), water,
        tuple(site.water_levels.items()), current_of(model.current, water, site.x_axis_bearing_deg),
        heading_of(model.current, site.x_axis_bearing_deg, "current"), criteria_of(model),
        {"structure": "spar", "title": model.title, "case_text": case_text, "case_hash": case_hash},
    )  # fmt: skip
