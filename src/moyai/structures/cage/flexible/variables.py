"""Names, units and meanings of everything that a run of a flexible cage writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import Vocabulary

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "node_rest": ("m", "places of the nodes as built"),
    "bar_start": ("1", "first node of each bar"),
    "bar_end": ("1", "last node of each bar"),
    "bar_line": ("1", "line that a bar belongs to, -1 for the cage"),
    "bar_kind": ("1", "0 net, 1 collar, 2 sinker tube, 3 line, 4 bracket"),
    "panel_corners": ("1", "nodes around each net panel, -1 for none"),
    "collar_nodes": ("1", "nodes of the inner ring of each collar"),
    "rest_volume": ("m3", "volume inside the net as built"),
    "net_area": ("m2", "outline area of the net of one cage"),
    "net_mass": ("kg", "mass in air of the net of one cage"),
    "submerged_weight": ("N", "weight in water of net and weights of one cage"),
    "reserve_buoyancy": ("N", "buoyancy of the collar, wholly immersed, less its own weight"),
    "solidity": ("1", "geometric solidity of the net"),
    "breaking_load": ("N", "breaking load of the weakest segment"),
    "current_speed": ("m/s", "speed of the current at the surface"),
    "volume_share": ("1", "volume inside the net over that as built"),
    "drag": ("N", "drag of the water on each part, along x and y"),
    "drag_along": ("N", "drag of each part along the current"),
    "total_drag": ("N", "drag of all parts along the current"),
    "pull": ("N", "pull on all anchors together"),
    "balance": ("1", "pull of the anchors against the drag, over the drag"),
    "residual": ("1", "largest force left on a node over the largest tension"),
    "lower_end_tension": ("N", "tension at the lower end of the line"),
    "upper_end_tension": ("N", "tension at the upper end of the line"),
    "line_tension_maximum": ("N", "largest tension along the line"),
    "utilisation": ("1", "largest tension over breaking load"),
    "anchor_vertical_tension": (
        "N",
        "upward tension at the anchor, 0 where it is downward",
    ),
    "collar_place": ("m", "mean place of the collar"),
    "collar_ovality": ("1", "largest less smallest diameter of the collar over their mean, each over that as built"),
    "collar_warp": ("m", "largest distance of the collar from its mean plane"),
    "collar_stress": ("Pa", "largest von Mises stress around the collar's ring"),
    "collar_axial": ("N", "axial force around the collar's ring, tension positive"),
    "collar_in_plane": ("N m", "bending moment in the plane of the ring"),
    "collar_out_of_plane": ("N m", "bending moment out of the plane of the ring"),
    "collar_torsion": ("N m", "torsion around the ring"),
    "collar_stress_largest": ("Pa", "largest von Mises stress of the collar"),
    "net_deflection": (
        "m",
        "largest displacement of a knot of the net against the collar, from still water",
    ),
    "net_tension": ("N/m", "largest tension of the net over the width that a bar of its mesh represents"),
    "net_tension_peak_since_row": ("N/m", "highest tension of the net over its width since the row before"),
    "worst_net_tension": ("N/m", "largest tension of the net over its width, of all currents"),
    "worst_volume_share": ("1", "smallest volume over that as built, of all currents"),
    "worst_drag": ("N", "largest drag of all parts along the current, of all currents"),
    "worst_net_deflection": ("m", "largest displacement of a knot of the net, of all currents"),
    "worst_line_tension_maximum": ("N", "largest tension in the line, of all currents"),
    "worst_utilisation": ("1", "largest tension over breaking load, of all currents"),
    "worst_anchor_tension": ("N", "largest tension at the anchor, of all currents"),
    "worst_anchor_vertical_tension": ("N", "largest uplift at the anchor, of all currents"),
    "worst_collar_stress": ("Pa", "largest von Mises stress of the collar, of all currents"),
    "normal_drag_coefficient": ("1", "drag coefficient of the net at normal flow, on its outline area"),
    "law_volume_share": ("1", "smallest volume over that as built, in the current of the site"),
    "law_drag": ("N", "drag of all parts along the current of the site"),
    "law_line_tension_maximum": ("N", "largest tension of all lines in the current of the site"),
    "law_line_tension": ("N", "largest tension of each line in the current of the site"),
    "law_largest_offset": ("m", "largest offset of a collar in the current of the site"),
    "law_net_tension": ("N/m", "largest tension of the net over its width in the current of the site"),
    "law_anchor_tension_maximum": ("N", "largest tension at an anchor in the current of the site"),
    "law_collar_stress": ("Pa", "largest von Mises stress of the collar in the current of the site"),
    "law_residual": ("1", "largest force left on a node over the largest tension"),
    "bottom_lift": ("m", "rise of the knot of the net that is deepest in still water"),
    "position": ("m", "places of the nodes"),
    "tension": ("N", "tension of the bars"),
    "line_tension": ("N", "tension at the upper end of the line"),
    "lower_end_tension_maximum": ("N", "highest tension at the lower end of the line: of anchor lines at the anchor"),
    "line_tension_peak_since_row": ("N", "highest tension in the line since the row before"),
    "line_tension_mean": ("N", "mean tension at the upper end"),
    "line_tension_minimum": ("N", "smallest tension at the upper end"),
    "wave_elevation": ("m", "water surface over the middle of the cages"),
    "volume_mean": ("1", "mean volume over that as built"),
    "volume_minimum": ("1", "smallest volume over that as built"),
    "collar_range": ("m", "range of the mean place of the collar, largest less smallest"),
    "drag_mean": ("N", "mean drag of each part along x and y"),
    "drag_largest": ("N", "largest horizontal drag of each part"),
    "anchor_node": ("1", "node of the anchor"),
    "buoy_node": ("1", "node of the buoy"),
    "sinker_node": ("1", "node of the weight"),
    "drag_time": ("s", "time"),
    "frame_time": ("s", "time of the frame"),
}

# Texts, and numbers that count the entries along a dimension
LABELS: dict[str, str] = {
    "part": "part of the cage",
    "anchor": "anchor",
    "cage": "cage",
    "horizontal": "horizontal axis",
    "line_kind": "kind of line",
    "quantity": "quantity, with its unit",
    "variant": "what is varied",
    "value": "value of the quantity",
}

# Names that a group holds whenever its analysis was run

#: What a group holds whenever its analysis was run to its end.
ALWAYS = {
    "/[^/]+/cage": (
        "node_rest bar_start bar_end bar_kind bar_line panel_corners collar_nodes rest_volume net_area net_mass "
        "submerged_weight reserve_buoyancy solidity breaking_load anchor_node buoy_node sinker_node"
    ),
    "/[^/]+/statics": (
        "current_speed volume_share drag drag_along total_drag pull balance residual collar_place collar_ovality "
        "collar_warp net_tension net_deflection bottom_lift position tension lower_end_tension upper_end_tension "
        "line_tension_maximum utilisation worst_volume_share worst_net_deflection worst_net_tension "
        "worst_line_tension_maximum worst_utilisation worst_drag"
    ),
    "/[^/]+/laws": (
        "normal_drag_coefficient law_line_tension law_volume_share law_drag law_line_tension_maximum "
        "law_net_tension law_largest_offset law_residual law_anchor_tension_maximum law_collar_stress"
    ),
    "/[^/]+/time/[^/]+/[^/]+": (
        "volume_share volume_mean volume_minimum collar_place collar_range net_tension_peak_since_row "
        "wave_elevation drag drag_mean drag_largest position tension line_tension_maximum line_tension_mean "
        "line_tension_peak_since_row"
    ),
    "/[^/]+/sensitivity/[^/]+": "value",
    "/[^/]+/laws_in_waves/[^/]+/[^/]+": "value",
}
#: What one statement of a run writes: a group holds all of it or none.
TOGETHER = {
    "/[^/]+/statics": (
        "anchor_tension anchor_vertical_tension worst_anchor_tension worst_anchor_vertical_tension",
        (
            "collar_stress collar_axial collar_in_plane collar_out_of_plane collar_torsion collar_stress_largest "
            "worst_collar_stress"
        ),
    ),
    "/[^/]+/time/[^/]+/[^/]+": (
        (
            "line_tension lower_end_tension line_tension_peak_since_row lower_end_tension_maximum anchor_tension "
            "anchor_tension_maximum anchor_vertical_tension_maximum line_tension_mean line_tension_minimum "
            "line_tension_maximum utilisation slack_share snap_count largest_snap"
        ),
        "collar_stress collar_stress_largest",
    ),
}

VOCABULARY = Vocabulary.of(
    "flexible cage",
    VARIABLES,
    labels=LABELS,
    always=ALWAYS,
    together=TOGETHER,
)
described = VOCABULARY.describe
