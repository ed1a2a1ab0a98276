"""Moorings at rest: exact elastic catenary, line systems, stiffness."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.mooring.anchors import AnchorCheck as AnchorCheck
    from moyai.mooring.anchors import DragAnchor as DragAnchor
    from moyai.mooring.anchors import Sinker as Sinker
    from moyai.mooring.anchors import check_drag_anchor as check_drag_anchor
    from moyai.mooring.anchors import check_sinker as check_sinker
    from moyai.mooring.catenary import CatenarySolution as CatenarySolution
    from moyai.mooring.catenary import solve_catenary as solve_catenary
    from moyai.mooring.lines import Clump as Clump
    from moyai.mooring.lines import Line as Line
    from moyai.mooring.lines import LineState as LineState
    from moyai.mooring.lines import LineType as LineType
    from moyai.mooring.lines import Segment as Segment
    from moyai.mooring.lines import SpringLine as SpringLine
    from moyai.mooring.shape import LineShape as LineShape
    from moyai.mooring.shape import line_shape as line_shape
    from moyai.mooring.system import LineSystem as LineSystem
    from moyai.mooring.system import MooringEquilibrium as MooringEquilibrium
    from moyai.mooring.system import RestoringCurve as RestoringCurve
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "anchors": "AnchorCheck DragAnchor Sinker check_drag_anchor check_sinker",
            "catenary": "CatenarySolution solve_catenary",
            "lines": "Clump Line LineState LineType Segment SpringLine",
            "shape": "LineShape line_shape",
            "system": "MooringEquilibrium LineSystem RestoringCurve",
        },
    )
