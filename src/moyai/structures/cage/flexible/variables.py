"""Names, units and meanings of everything that a run of a flexible cage writes; the one file that owns them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr

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
    "reserve_buoyancy": ("N", "what the collar bears wholly immersed beyond its own weight"),
    "solidity": ("1", "geometric solidity of the net"),
    "line_breaking_load": ("N", "breaking load of the weakest segment"),
    "current_speed": ("m/s", "speed of the current at the surface"),
    "volume_share": ("1", "volume inside the net over that as built"),
    "drag": ("N", "drag of the water on each part, along x and y"),
    "drag_along": ("N", "drag of each part along the current"),
    "total_drag": ("N", "drag of all parts along the current"),
    "pull": ("N", "pull on all anchors together"),
    "balance": ("1", "pull of the anchors against the drag, over the drag"),
    "residual": ("1", "largest force left on a node over the largest tension"),
    "tension_lower": ("N", "tension at the lower end of the line"),
    "tension_upper": ("N", "tension at the upper end of the line"),
    "tension_largest": ("N", "largest tension in the line"),
    "utilisation": ("1", "largest tension over breaking load"),
    "anchor_pull": ("N", "pull on each anchor"),
    "anchor_uplift": ("N", "upward pull on each anchor"),
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
    "worst_volume_share": ("1", "smallest volume over that as built, of all currents"),
    "worst_drag": ("N", "largest drag of all parts along the current, of all currents"),
    "worst_net_deflection": ("m", "largest displacement of a knot of the net, of all currents"),
    "worst_tension": ("N", "largest tension in the line, of all currents"),
    "worst_utilisation": ("1", "largest tension over breaking load, of all currents"),
    "worst_anchor_pull": ("N", "largest pull on each anchor, of all currents"),
    "worst_anchor_uplift": ("N", "largest upward pull on each anchor, of all currents"),
    "worst_collar_stress": ("Pa", "largest von Mises stress of the collar, of all currents"),
    "normal_drag_coefficient": ("1", "drag coefficient of the net at normal flow, on its outline area"),
    "law_volume_share": ("1", "smallest volume over that as built, in the current of the site"),
    "law_drag": ("N", "drag of all parts along the current of the site"),
    "law_tension": ("N", "largest tension of all lines in the current of the site"),
    "law_utilisation": ("1", "largest tension over breaking load in the current of the site"),
    "law_offset": ("m", "largest offset of a collar in the current of the site"),
    "law_anchor_pull": ("N", "largest pull on an anchor in the current of the site"),
    "law_collar_stress": ("Pa", "largest von Mises stress of the collar in the current of the site"),
    "law_residual": ("1", "largest force left on a node over the largest tension"),
    "bottom_lift": ("m", "rise of the knot of the net that is deepest in still water"),
    "position": ("m", "places of the nodes"),
    "tension": ("N", "tension of the bars"),
    "line_tension": ("N", "tension at the upper end of the line"),
    "line_tension_lower": ("N", "tension at the lower end of the line: of anchor lines at the anchor"),
    "tension_maximum_lower": ("N", "highest tension at the lower end of the line: of anchor lines at the anchor"),
    "line_peak": ("N", "highest tension in the line since the row before"),
    "tension_mean": ("N", "mean tension at the upper end"),
    "tension_minimum": ("N", "smallest tension at the upper end"),
    "tension_maximum": ("N", "highest tension in the line"),
    "slack_share": ("1", "share of the time that the line is slack"),
    "snaps": ("1", "number of snaps"),
    "snap_peak": ("N", "highest snap"),
    "wave_elevation": ("m", "water surface over the middle of the cages"),
    "volume_mean": ("1", "mean volume over that as built"),
    "volume_minimum": ("1", "smallest volume over that as built"),
    "collar_range": ("m", "range of the mean place of the collar, largest less smallest"),
    "drag_mean": ("N", "mean drag of each part along x and y"),
    "drag_largest": ("N", "largest horizontal drag of each part"),
}


def described(dataset: xr.Dataset) -> xr.Dataset:
    """Give every variable its units and meaning."""
    for name in dataset.variables:
        if str(name) in VARIABLES:
            units, meaning = VARIABLES[str(name)]
            dataset[name].attrs.update(units=units, long_name=meaning)
    return dataset
