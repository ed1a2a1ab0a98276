"""Names, units and meanings of everything that a run of a network writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import Vocabulary

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "sensitivity_peak": ("N", "largest peak of the lines, that the repeated runs are compared with"),
    "time": ("s", "time since the start of the run"),
    "frame": ("s", "time of the frame"),
    "node_position": ("m", "place of the node as built, z above still water"),
    "node_mass": ("kg", "mass of the node, half of its bars included"),
    "bar_start": ("1", "node at the start of the bar"),
    "bar_end": ("1", "node at the end of the bar"),
    "bar_length": ("m", "unstretched length of the bar"),
    "bar_line": ("1", "line or net that the bar belongs to"),
    "bar_thin": ("1", "whether the bar belongs to a net"),
    "line_length": ("m", "unstretched length of the line"),
    "line_weight": ("N", "submerged weight of the line"),
    "line_segments": ("1", "bars of the line"),
    "wave_speed": ("m/s", "slowest elastic wave along the line"),
    "travel_time": ("s", "time of an elastic wave along the line"),
    "breaking_load": ("N", "least breaking load of the line"),
    "part_breaking_load": ("N", "breaking load of the part of a line"),
    "point_node": ("1", "node of the point"),
    "point_diameter": ("m", "diameter of the point, for drawing"),
    "position": ("m", "place of the node, z above still water"),
    "bed_level": ("m", "height of the bed under the node, above still water"),
    "velocity": ("m/s", "velocity of the node"),
    "tension": ("N", "tension of the bar"),
    "sheet_tension": ("N/m", "higher principal tension of the sheet, 0 where it is slack"),
    "line_tension_peak_since_row": ("N", "highest tension along the line since the row before"),
    "line_tension_minimum": ("N", "lowest tension along the line"),
    "part_tension_peak_since_row": ("N", "highest tension along the part of a line since the row before"),
    "stretch_tension": ("N", "highest tension along a stretch of one type of a line of several since the row before"),
    "part_tension_maximum": ("N", "highest tension along the part of a line"),
    "part_peak_time": ("s", "time of the highest tension of the part of a line"),
    "part_tension_mean": ("N", "mean over time of the highest tension along the part of a line"),
    "part_tension_of_check": (
        "N",
        "highest tension of the part of a line in the run and in those that check its mesh",
    ),
    "part_tension_maximum_of_realisation": ("N", "largest tension of the part of a line in each realisation"),
    "start_tension": ("N", "tension at the start of the line"),
    "end_tension": ("N", "tension at the end of the line"),
    "point_position": ("m", "place of the point, z above still water"),
    "start_highest": ("N", "highest tension at the start of the line since the row before"),
    "end_highest": ("N", "highest tension at the end of the line since the row before"),
    "point_load": ("N", "pull of the lines on the point"),
    "point_load_peak_since_row": ("N", "highest pull of the lines on the point since the row before"),
    "solid_position": ("m", "place of the origin of its axes, the middle of boxes and cylinders, z above still water"),
    "solid_angle": ("rad", "roll, pitch and yaw of the body"),
    "solid_rotation": ("1", "from the axes of the body to those of the site"),
    "surface_elevation": ("m", "surface above the origin"),
    "kinetic_energy": ("J", "kinetic energy of what is free"),
    "elastic_energy": ("J", "energy of bars, bending and bed"),
    "work": ("J", "work done on the network since the start"),
    "stiffness": ("N/m", "force that holds the driven point over its displacement"),
    "line_tension_of_mesh": ("N", "highest tension along the line at rest on each mesh"),
    "clear_bars_of_mesh": (
        "1",
        "bars of the line clear of the bed on each mesh, infinite where none or all of it lies there",
    ),
    "part_tension_of_mesh": ("N", "highest tension along the part of a line at rest on each mesh"),
    "net_tension_maximum": ("N", "highest tension in the net at rest, of strips as wide as between its columns"),
    "net_tension_of_mesh": ("N", "highest tension in the net at rest on each mesh, of strips as wide as on the first"),
    "held_level_pull_of_mesh": (
        "N",
        "horizontal part of the pull of the net on its held knots at rest on each mesh",
    ),
    "held_pull_of_mesh": ("N", "pull of the net on its fixed and driven knots together at rest on each mesh"),
    "lift_of_mesh": ("m", "most that points may move on each mesh where a bar at the touchdown is too heavy to lift"),
    "point_load_of_mesh": ("N", "pull of the lines on the point at rest on each mesh"),
    "point_position_of_mesh": ("m", "place of the point at rest on each mesh, z above still water"),
    "solid_position_of_mesh": ("m", "place of the body at rest on each mesh, z above still water"),
    "residual": ("1", "largest force left over the largest force at work"),
    "mode_frequency": ("rad/s", "natural angular frequency, added mass included"),
    "mode_period": ("s", "natural period, added mass included"),
    "longest_period_double_mesh": ("s", "longest natural period with twice the segments"),
    "mode_shape": ("1", "shape of the mode, largest component 1"),
    "line_tension_maximum": ("N", "highest tension along the line"),
    "peak_time": ("s", "time of the highest tension"),
    "start_peak": ("N", "highest tension at the start of the line"),
    "end_peak": ("N", "highest tension at the end of the line"),
    "line_tension_mean": ("N", "mean tension at the line's most loaded end"),
    "deviation": ("N", "standard deviation of the tension at the line's most loaded end"),
    "utilisation": ("1", "highest tension over the breaking load"),
    "slack_time": ("s", "time that the line is slack"),
    "slack_share": ("1", "part of the time that the line is slack"),
    "snap_threshold": ("N", "threshold of a snap"),
    "contact_time": ("s", "when the line comes taut"),
    "contact_slack": ("s", "how long it was slack before"),
    "contact_peak": ("N", "highest tension until it is slack again"),
    "contact_rise": ("s", "rise from a tenth to nine tenths of the peak"),
    "contact_line": ("1", "line that comes taut"),
    "half_step": ("N", "peak with half the step"),
    "double_mesh": ("N", "peak with every bar cut in two"),
    "half_viscosity": ("N", "peak with half the viscosity"),
    "double_viscosity": ("N", "peak with twice the viscosity"),
    "damped": ("N", "peak on a finer mesh of damped bars"),
    "finest": ("N", "peak on the finest mesh of its event"),
    "discretisation_error": ("1", "relative change of the peak with step and mesh together"),
    "viscosity_effect": ("1", "largest relative change of the peak with the viscosity"),
    "point_load_maximum": ("N", "highest pull on the point"),
    "point_load_half_step": ("N", "highest pull on the fixed point with half the step"),
    "point_load_double_mesh": ("N", "highest pull on the fixed point with every bar cut in two"),
    "point_load_damped": ("N", "highest pull on the fixed point on a finer mesh of damped bars"),
    "point_load_finest": ("N", "highest pull on the fixed point on the finest mesh of the event"),
    "line_tension_of_check": ("N", "highest tension of the line in the run and in those that check its mesh"),
    "net_tension_of_check": ("N", "highest tension in the net in the run and in those that check its mesh"),
    "line_tension_maximum_of_realisation": ("N", "largest tension of the line in each realisation"),
    "net_tension_maximum_of_realisation": ("N", "largest tension in the net in each realisation"),
    "point_load_maximum_of_realisation": ("N", "largest pull on the point in each realisation"),
    "point_excursion_of_realisation": (
        "m",
        "largest distance of the point from rest in still water in each realisation",
    ),
    "distance_from_anchor_of_realisation": (
        "m",
        "largest horizontal distance of the point from the only fixed point that holds it in each realisation",
    ),
    "seed_of_realisation": ("1", "seed of each realisation"),
    "point_horizontal_load_maximum": ("N", "highest horizontal pull on the point"),
    "point_upward_load_maximum": ("N", "highest upward pull on the point"),
    "point_downward_load_maximum": ("N", "highest downward pull on the point"),
    "point_excursion": ("m", "largest distance of the point from its place at rest, by direction"),
    "still_place": ("m", "place of the point at rest in still water, from which excursions count"),
    "still_place_of_solid": ("m", "place of the body at rest in still water"),
    "mean_offset": ("m", "horizontal distance of the body's mean place from where the run begins"),
    "heave_range": ("m", "highest less lowest place of the body"),
    "roll_range": ("rad", "largest less smallest roll of the body"),
    "pitch_range": ("rad", "largest less smallest pitch of the body"),
    "yaw_range": ("rad", "largest less smallest yaw of the body"),
    "highest_lean": ("rad", "largest angle between the axis of the body and the vertical"),
    "wave_amplitude": ("m", "amplitude of the wave component"),
    "wave_omega": ("rad/s", "angular frequency of the wave component"),
    "wave_number": ("1/m", "wave number of the wave component"),
    "wave_heading": ("rad", "direction of travel of the wave component"),
    "wave_phase": ("rad", "phase of the wave component at the origin"),
    "body_node": ("1", "nodes that carry something"),
    "body_height": ("m", "its vertical extent"),
    "body_volume": ("m3", "its volume"),
    "body_mass": ("kg", "its mass"),
    "sheet_nodes": ("1", "nodes of the triangles of sheets"),
    "solid_size": ("m", "size of the body along its axes"),
    "solid_part_solid": ("1", "body of the part"),
    "solid_part_start": ("m", "one end, in axes of the body"),
    "solid_part_end": ("m", "other end, in axes of the body"),
    "solid_part_diameter": ("m", "diameter of the part"),
    "held_pull": ("N", "pull of the net on its fixed and driven knots together"),
    "net_tension": ("N", "highest tension in the net since the row before, of strips as wide as between its columns"),
    "net_strip": ("m", "width of netting whose twines a bar of a column gathers"),
    "held_pull_of_check": (
        "N",
        "largest pull of the net on the row that holds it in the run and in those that check its mesh",
    ),
    "is_snap": ("1", "whether the peak exceeds the threshold"),
    "final_position": ("m", "last state"),
    "final_velocity": ("m/s", "velocity of the last state"),
    "final_memory": ("1", "last state of the radiation of the body"),
    "final_poles": ("1", "states of the radiation of the body"),
    "final_motion": ("", "last state of the body, in m, 1, m/s and rad/s"),
    "mode": ("1", "number of the mode"),
    "contact": ("1", "number of the contact"),
}

# Texts, and numbers that count the entries along a dimension
LABELS: dict[str, str] = {
    "point": "point",
    "condition": "condition of the equilibrium",
    "direction": "direction of the force",
    "driven": "driven point",
    "node": "node",
    "bar": "bar",
    "point_kind": "what moves the point",
    "solid": "body",
    "solid_shape": "shape of the body",
    "body_axis": "axis of the body",
    "turn": "angle of the body",
    "member": "realisation",
    "check": "the run itself, or the run that checks its mesh and step",
    "measure": "measure",
    "left": "body of the last state",
    "mesh": "bars in place of one of the case",
    "part": "part of a line of several strengths",
    "stretch": "stretch of one type of a line of several",
}

# Names that a group holds whenever its analysis was run

#: What a group holds whenever its analysis was run to its end.
ALWAYS = {
    "/[^/]+/network": (
        "node_position node_mass bar_start bar_end bar_length bar_line bar_thin line_length line_weight "
        "line_segments wave_speed travel_time breaking_load point_node point_kind point_diameter body_node "
        "body_height body_volume body_mass"
    ),
    "/[^/]+/statics": "position tension residual point_position point_load line_tension_maximum",
    "/[^/]+/modes": "mode_frequency mode_period mode_shape longest_period_double_mesh",
    "/[^/]+/dynamic": "line_tension_maximum line_tension_mean",
    "/[^/]+/time/[^/]+": (
        "kinetic_energy elastic_energy work point_position point_load point_load_peak_since_row "
        "line_tension_peak_since_row"
    ),
    "/[^/]+/time/[^/]+/frames": "position tension final_position final_velocity",
    "/[^/]+/time/[^/]+/contact_count": ("contact_line contact_time contact_slack contact_peak contact_rise is_snap"),
}
#: What one statement of a run writes: a group holds all of it or none.
TOGETHER = {
    "/[^/]+/network": (
        "solid_size solid_shape",
        "solid_part_solid solid_part_start solid_part_end solid_part_diameter",
    ),
    "/[^/]+/statics": (
        "line_tension_maximum line_tension_minimum start_tension end_tension",
        "solid_position solid_angle",
        "point_load_of_mesh point_position_of_mesh lift_of_mesh",
        "net_tension_of_mesh held_pull_of_mesh held_level_pull_of_mesh",
    ),
    "/[^/]+/dynamic": (
        (
            "line_tension_maximum peak_time start_peak end_peak line_tension_mean deviation utilisation slack_time "
            "slack_share contact_count snap_count snap_threshold largest_snap shortest_rise_time"
        ),
        (
            "point_load_maximum point_horizontal_load_maximum point_upward_load_maximum "
            "point_downward_load_maximum point_excursion"
        ),
        ("largest_offset mean_offset heave_range roll_range pitch_range yaw_range highest_lean"),
        (
            "sensitivity_peak half_step double_mesh half_viscosity double_viscosity discretisation_error "
            "viscosity_effect damped finest"
        ),
        "point_load_half_step point_load_double_mesh point_load_damped point_load_finest",
        "part_tension_maximum part_peak_time part_tension_mean",
    ),
    "/[^/]+/time/[^/]+": (
        ("line_tension_peak_since_row line_tension_minimum start_tension end_tension start_highest end_highest"),
        "solid_position solid_angle",
    ),
    "/[^/]+/time/[^/]+/frames": (
        "wave_amplitude wave_omega wave_number wave_heading wave_phase",
        "solid_position solid_rotation",
        "final_motion final_memory final_poles",
    ),
}

VOCABULARY = Vocabulary.of(
    "network",
    VARIABLES,
    labels=LABELS,
    always=ALWAYS,
    together=TOGETHER,
)
labelled = VOCABULARY.describe
