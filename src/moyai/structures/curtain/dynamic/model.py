"""A span of a curtain for dynamics: what it is made of, its mesh, and the network that stands for it.

Axes of the span: x downstream, y along the span from support to support, z up from still water. The span is turned to
the site by the headings of waves and current, not the other way round.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from moyai.core.arrays import IntArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.structures.curtain.dynamic.section import SectionMesh

_TIGHT = 1e-9


#: How the names of anchor lines begin, and of what leads them to the toe of a skirt that is held at both edges.
ANCHOR_LINE, AT_TOE = "anchor line", "at the toe"


@dataclass(frozen=True)
class AnchoredSupport:
    """What holds both ends of the span when they are buoys: an anchor line upstream and one downstream of each.

    The neighbours of the span are alike, so that each buoy and its lines belong to two spans by halves. Lines of a span
    with a lower cable that is held are led to both edges, half of their stiffness to each.
    """

    #: Of one straight line [m].
    line_length: float
    #: Angle from the horizontal [rad].
    slope: float
    #: EA of a line [N].
    stiffness: float
    #: Of both lines in still water [N].
    pretension: float
    #: Of the buoy with its added mass [kg].
    mass: float


@checks_words
@dataclass(frozen=True)
class CurtainSpan:
    """One span of a curtain for dynamics.

    Raises
    ------
    InputError
        For numbers that are not positive, a curtain without slack, or a skirt that does not bulge.
    """

    #: Distance of the supports [m].
    span: float
    #: Unstretched length of cables and skirt between the supports [m].
    length: float
    #: Of the skirt along itself, unstretched [m].
    skirt_length: float
    #: Straight distance of its edges when the cables come taut [m]; ``skirt_length`` for a flat one.
    chord: float
    #: EA of the upper cable [N].
    upper_stiffness: float
    #: EA of the lower cable [N]; 0 for no lower cable.
    lower_stiffness: float
    #: Of the upper cable with floats and fittings, per length [kg/m].
    upper_mass: float
    #: Of the lower cable with ballast, per length [kg/m].
    lower_mass: float
    #: Of the sheet along its depth [N/m].
    sheet_stiffness: float
    #: Per area [kg/m2].
    sheet_mass: float
    #: Displaced by lower cable and ballast per length [m2].
    lower_volume: float = 0.0
    #: Of the sheet along the span [N/m]; 0 for a sheet that is slack along the span (a ten-thousandth of
    #: ``sheet_stiffness`` then keeps its columns in order).
    span_stiffness: float = 0.0
    #: Of the sheet in shear [N/m]; 0 for the same sheet.
    shear_stiffness: float = 0.0
    #: Per area [m].
    sheet_volume: float = 0.0
    #: On the normal velocity.
    drag_coefficient: float = 0.0
    #: Of the floats per length [m2].
    float_volume: float = 0.0
    #: Their height [m]; 0 volume: the upper edge stays at its level.
    float_height: float = 0.0
    #: Whether the lower cable is held at its level, may rise but ends at the supports, or ends freely.
    edges: Literal["held", "risen", "free"] = "held"
    #: None: fixed.
    support: AnchoredSupport | None = None

    def __post_init__(self) -> None:
        positive = (
            "span", "length", "skirt_length", "chord", "upper_stiffness", "upper_mass", "lower_mass", "sheet_stiffness",
            "sheet_mass",
        )  # fmt: skip
        for name in positive:
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} is {value:g}", parameter=f"span.{name}", allowed="greater than 0, finite")
        rest = (
            "lower_stiffness", "lower_volume", "span_stiffness", "shear_stiffness", "sheet_volume", "drag_coefficient",
            "float_volume", "float_height",
        )  # fmt: skip
        for name in rest:
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise InputError(f"{name} is {value:g}", parameter=f"span.{name}", allowed="0 or more, finite")
        if self.length <= self.span:
            raise InputError(
                f"the curtain of {self.length:g} m is not longer than its span of {self.span:g} m",
                parameter="span.length",
                allowed=f"more than {self.span:g} m",
                remedy="a curtain without slack does not snap; statics takes it",
            )
        if self.chord > self.skirt_length * (1.0 + _TIGHT):
            raise InputError(
                f"the chord of {self.chord:g} m is longer than the skirt of {self.skirt_length:g} m",
                parameter="span.chord",
                allowed=f"at most {self.skirt_length:g} m",
            )
        if self.float_volume > 0.0 and self.float_height <= 0.0:
            raise InputError("floats without height", parameter="span.float_height", allowed="greater than 0")
        if (self.span_stiffness > 0.0) != (self.shear_stiffness > 0.0) and self.shear_stiffness > 0.0:
            raise InputError(
                "a shear stiffness without span stiffness",
                parameter="span.shear_stiffness",
                remedy="give both, or neither",
            )


@checks_words
@dataclass(frozen=True)
class Mesh:
    """Cells along the span and over the skirt, and the viscosity."""

    #: Cells along the curtain.
    along: int
    #: Cells down the skirt.
    down: int
    #: BA of the cables [N s]; None: 5 % of critical on the mesh.
    cable_viscosity: float | None = None
    #: [s]; None: the same of the skirt.
    skirt_damping_time: float | None = None
    #: Whether turning and stretching sections keep the energy of the water (:class:`MassBlocks`). In waves the cloth
    #: gathers, and these forces, which act on the light cloth itself, blow it up unless ``normal_reach`` spans its
    #: folds.
    convective: bool = True
    #: Distance along the cable, to either side of a section, over which its normal is taken [m]; 0: to the neighbours.
    #: Folds shorter than a part of the draught move no water of their own, but they turn the normals between neighbours
    #: at every step, and with them the added mass.
    normal_reach: float = 0.0
    turning: bool = True

    def __post_init__(self) -> None:
        if not (math.isfinite(self.normal_reach) and self.normal_reach >= 0.0):
            raise InputError(
                f"normal_reach is {self.normal_reach:g}", parameter="mesh.normal_reach", allowed="0 or more"
            )
        if self.along < 4 or self.down < 2:
            raise InputError(
                f"a mesh of {self.along} x {self.down} cells",
                parameter="mesh",
                allowed="at least 4 along the span and 2 over the skirt",
            )
        for name in ("cable_viscosity", "skirt_damping_time"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value >= 0.0):
                raise InputError(f"{name} is {value:g}", parameter=f"mesh.{name}", allowed="0 or more")


@dataclass(frozen=True, eq=False)
class CurtainNetwork:
    """A span ready to run."""

    span: CurtainSpan
    mesh: Mesh
    #: Strands ``upper cable``, ``lower cable`` and ``anchor line ...``.
    network: Network
    #: Where it starts.
    state: State
    #: Nodes, from support to support and from top to toe; shape (along + 1, down + 1).
    grid: IntArray
    #: The skirt's section.
    section: SectionMesh

    def bars(self, name: str) -> IntArray:
        """Return the bars of a strand, of an anchor line those at both edges; none where there is no such strand."""
        names = (name, name.replace(ANCHOR_LINE, AT_TOE)) if name.startswith(ANCHOR_LINE) else (name,)
        found = [strand.bars for strand in self.network.strands if strand.name in names]
        return np.concatenate(found) if found else np.zeros(0, dtype=np.int64)

    @property
    def lines(self) -> tuple[str, ...]:
        """Names of the anchor lines."""
        return tuple(s.name for s in self.network.strands if s.name.startswith(ANCHOR_LINE))


__all__ = ["AnchoredSupport", "CurtainNetwork", "CurtainSpan", "Mesh"]
