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
    "point_node": ("1", "node of the point"),
    "point_diameter": ("m", "diameter of the point, for drawing"),
    "position": ("m", "place of the node, z above still water"),
    "bed_level": ("m", "height of the bed under the node, above still water"),
    "velocity": ("m/s", "velocity of the node"),
    "tension": ("N", "tension of the bar"),
    "sheet_tension": ("N/m", "higher principal tension of the sheet, 0 where it is slack"),
    "line_tension_peak_since_row": ("N", "highest tension along the line since the row before"),
    "line_tension_minimum": ("N", "lowest tension along the line"),
    "start_tension": ("N", "tension at the start of the line"),
    "end_tension": ("N", "tension at the end of the line"),
    "point_position": ("m", "place of the point, z above still water"),
    "start_highest": ("N", "highest tension at the start of the line since the row before"),
    "end_highest": ("N", "highest tension at the end of the line since the row before"),
    "load": ("N", "pull of the lines on the point"),
    "highest_load": ("N", "highest pull of the lines on the point since the row before"),
    "solid_position": ("m", "place of the origin of its axes, the middle of boxes and cylinders, z above still water"),
    "solid_angle": ("rad", "roll, pitch and yaw of the body"),
    "solid_rotation": ("1", "from the axes of the body to those of the site"),
    "surface_elevation": ("m", "surface above the origin"),
    "kinetic_energy": ("J", "kinetic energy of what is free"),
    "elastic_energy": ("J", "energy of bars, bending and bed"),
    "work": ("J", "work done on the network since the start"),
    "stiffness": ("N/m", "force that holds the driven point over its displacement"),
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
    "contacts": ("1", "times that the slack line comes taut"),
    "snaps": ("1", "contacts whose peak exceeds the threshold"),
    "snap_threshold": ("N", "threshold of a snap"),
    "largest_snap": ("N", "highest peak of a snap"),
    "shortest_rise": ("s", "shortest rise from a tenth to nine tenths of a snap's peak"),
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
    "load_peak": ("N", "highest pull on the point"),
    "load_half_step": ("N", "highest pull on the fixed point with half the step"),
    "load_double_mesh": ("N", "highest pull on the fixed point with every bar cut in two"),
    "load_damped": ("N", "highest pull on the fixed point on a finer mesh of damped bars"),
    "load_finest": ("N", "highest pull on the fixed point on the finest mesh of the event"),
    "line_tension_of_check": ("N", "highest tension of the line in the run and in those that check its mesh"),
    "net_tension_of_check": ("N", "highest tension in the net in the run and in those that check its mesh"),
    "line_tension_maximum_of_realisation": ("N", "largest tension of the line in each realisation"),
    "net_tension_maximum_of_realisation": ("N", "largest tension in the net in each realisation"),
    "load_of_realisation": ("N", "largest pull on the point in each realisation"),
    "excursion_of_realisation": ("m", "largest distance of the point from rest in still water in each realisation"),
    "distance_from_anchor_of_realisation": (
        "m",
        "largest horizontal distance of the point from the only fixed point that holds it in each realisation",
    ),
    "seed_of_realisation": ("1", "seed of each realisation"),
    "load_horizontal": ("N", "highest horizontal pull on the point"),
    "load_upwards": ("N", "highest upward pull on the point"),
    "load_downwards": ("N", "highest downward pull on the point"),
    "excursion": ("m", "largest distance of the point from its place at rest, by direction"),
    "still_place": ("m", "place of the point at rest in still water, from which excursions count"),
    "still_place_of_solid": ("m", "place of the body at rest in still water"),
    "offset": ("m", "largest horizontal distance of the body from where the run begins"),
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
}

# Names that a group holds whenever its analysis was run

#: What a group holds whenever its analysis was run to its end.
ALWAYS = {
    "/[^/]+/network": (
        "node_position node_mass bar_start bar_end bar_length bar_line bar_thin line_length line_weight "
        "line_segments wave_speed travel_time breaking_load point_node point_kind point_diameter body_node "
        "body_height body_volume body_mass"
    ),
    "/[^/]+/statics": "position tension residual point_position load line_tension_maximum",
    "/[^/]+/modes": "mode_frequency mode_period mode_shape longest_period_double_mesh",
    "/[^/]+/dynamic": "line_tension_maximum line_tension_mean",
    "/[^/]+/time/[^/]+": (
        "kinetic_energy elastic_energy work point_position load highest_load line_tension_peak_since_row"
    ),
    "/[^/]+/time/[^/]+/frames": "position tension final_position final_velocity",
    "/[^/]+/time/[^/]+/contacts": ("contact_line contact_time contact_slack contact_peak contact_rise is_snap"),
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
    ),
    "/[^/]+/dynamic": (
        (
            "line_tension_maximum peak_time start_peak end_peak line_tension_mean deviation utilisation slack_time "
            "slack_share contacts snaps snap_threshold largest_snap shortest_rise"
        ),
        "load_peak load_horizontal load_upwards load_downwards excursion",
        ("offset mean_offset heave_range roll_range pitch_range yaw_range highest_lean"),
        (
            "sensitivity_peak half_step double_mesh half_viscosity double_viscosity discretisation_error "
            "viscosity_effect damped finest"
        ),
        "load_half_step load_double_mesh load_damped load_finest",
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
