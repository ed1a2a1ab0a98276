"""Names, units and meanings of everything that a run of a row writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import Vocabulary

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "omega": ("rad/s", "angular frequency"),
    "period": ("s", "wave period T"),
    "heading": ("rad", "direction in which the waves travel"),
    "wave_direction": ("rad", "direction in which the waves travel"),
    "draught": ("m", "draught of the units"),
    "freeboard": ("m", "deck above still water"),
    "metacentric_height": ("m", "transverse metacentric height GM of a unit"),
    "unit_mass": ("kg", "mass of a unit"),
    "unit_x": ("m", "middle of a unit, x"),
    "unit_y": ("m", "middle of a unit, y"),
    "unit_heading": ("rad", "angle of a unit to the row"),
    "plan_x": ("m", "corners of a unit in plan, x"),
    "plan_y": ("m", "corners of a unit in plan, y"),
    "anchor_x": ("m", "anchor of a line, x"),
    "anchor_y": ("m", "anchor of a line, y"),
    "fairlead_x": ("m", "fairlead of a line, x"),
    "fairlead_y": ("m", "fairlead of a line, y"),
    "anchor_z": ("m", "anchor of a line, above still water"),
    "fairlead_z": ("m", "fairlead of a line, above still water"),
    "outline_x": ("m", "section of a unit at rest, across it"),
    "outline_z": ("m", "section of a unit at rest, above still water"),
    "line_unit": ("1", "number of the unit that a line holds"),
    "grounded_length": ("m", "length on the bed under wind and current"),
    "anchor_curve_tension": ("N", "tension at the fairlead of a line that is drawn away from its anchor"),
    "anchor_curve_horizontal_tension": ("N", "horizontal tension with it"),
    "anchor_curve_vertical_tension": ("N", "vertical tension at the anchor with it, upward on the anchor"),
    "anchor_curve_grounded_length": ("m", "unstretched length on the bed with it"),
    "mooring_x": ("m", "line at rest from its anchor to its fairlead, x"),
    "mooring_y": ("m", "line at rest from its anchor to its fairlead, y"),
    "mooring_z": ("m", "line at rest from its anchor to its fairlead, above still water"),
    "unit_centre_z": ("m", "centre of gravity of a unit above still water"),
    "connector_x": ("m", "place of a connector, x"),
    "connector_y": ("m", "place of a connector, y"),
    "connector_z": ("m", "place of a connector, above still water"),
    "connector_breaking_load": ("N", "breaking load of a connector"),
    "steady_offset": ("m", "offset under wind and current, axes of the unit (pitch, roll, yaw: rad)"),
    "steady_force_of_wind": ("N", "steady force of the wind on a unit, row axes (moments: N m)"),
    "steady_force_of_current": ("N", "steady force of the current on a unit, row axes (moments: N m)"),
    "added_mass": ("kg", "added mass of all motions on all, row axes (with turns: kg m, kg m2)"),
    "radiation_damping": ("kg/s", "radiation damping of all motions on all, row axes (with turns: kg m/s, kg m2/s)"),
    "excitation_force": ("N/m", "excitation per wave amplitude, row axes (moments: N m/m)"),
    "wave_height": ("m", "wave height H"),
    "rao": ("1", "motion per wave amplitude, axes of the unit (pitch, roll, yaw: rad/m)"),
    "motion_amplitude": ("m", "amplitude of motion, axes of the unit (pitch, roll, yaw: rad)"),
    "mean_offset": ("m", "mean offset, axes of the unit (pitch, roll, yaw: rad)"),
    "mean_drift": ("N", "mean drift on the whole row along x and y (moment about z: N m)"),
    "mean_drift_of_unit": ("N", "mean drift of a unit along x and y (moment about its own vertical axis: N m)"),
    "drift_per_amplitude_squared": ("N/m2", "mean drift on the whole row per amplitude squared (moment: N/m)"),
    "hydrostatic_stiffness": ("N/m", "restoring of weight and buoyancy, row axes (with turns: N, N m)"),
    "connector_force_amplitude": ("N", "amplitude of the force in a connector, axes of the gap"),
    "connector_moment_amplitude": ("N m", "amplitude of the moment in a connector, axes of the gap"),
    "connector_force_mean": ("N", "mean force in a connector, axes of the gap"),
    "connector_moment_mean": ("N m", "mean moment in a connector, axes of the gap"),
    "connector_force_largest": ("N", "largest force of a component in a connector"),
    "connector_moment_largest": ("N m", "largest moment of a component in a connector"),
    "connector_resultant_largest": ("N", "largest force in a connector over all directions"),
    "connector_significant_force": ("N", "significant amplitude of the force in a connector, twice its deviation"),
    "connector_significant_moment": ("N m", "significant amplitude of the moment in a connector"),
    "connector_stiffness_of_curve": ("N/m", "linear stiffness that represents the curve of a connector"),
    "connector_loses_contact": ("1", "whether a connector of the row acts and releases in the motion"),
    "connector_endurance_exponent": ("1", "exponent of the curve of endurance of a connector"),
    "curve_lowest": ("m", "elongation at which a measured curve begins"),
    "curve_highest": ("m", "elongation at which a measured curve ends"),
    "least_distance": ("m", "least distance of two units in plan in their mean position; below zero they overlap"),
    "gap_closing_steady": ("m", "closing of a gap without waves at a corner of the hulls"),
    "hulls_meet": ("1", "whether hulls meet, in their mean position or by their motion"),
    "elongation_lowest": ("m", "lowest elongation of a connector with a curve, mean and waves"),
    "elongation_highest": ("m", "highest elongation of a connector with a curve, mean and waves"),
    "stretch_across": ("m", "stretch by motion across of a connector that acts along one direction, where it counts"),
    "gap_width": ("m", "gap between two units at rest"),
    "gap_closing_largest": ("m", "largest closing of a gap at a corner of the hulls, from its width at rest"),
    "relative_motion_largest": ("m", "largest relative motion of the ends of a connector"),
    "relative_turn_largest": ("rad", "largest relative turn of the ends of a connector"),
    "tension_amplitude": ("N", "amplitude of the tension at the fairlead, linear"),
    "maximum_motion": ("m", "largest motion about the mean, axes of the unit (pitch, roll, yaw: rad)"),
    "connector_moment_resultant_largest": ("N m", "largest resultant moment in a connector"),
    "gap_motion_largest": ("m", "largest opening or closing of a gap at a connector, about its mean"),
    "connector_damage_rate": ("1/s", "share of the life of a connector that a second of the sea takes"),
    "connector_resultant_largest_of_realisation": ("N", "largest force in a connector in each realisation"),
    "connector_moment_largest_of_realisation": ("N m", "largest moment of a component in each realisation"),
    "connector_moment_resultant_largest_of_realisation": ("N m", "largest moment in a connector in each realisation"),
    "gap_closing_largest_of_realisation": ("m", "largest closing of a gap in each realisation"),
    "gap_motion_largest_of_realisation": ("m", "largest opening or closing of a gap in each realisation"),
    "connector_damage_rate_of_realisation": ("1/s", "share of the life of a connector a second, by each realisation"),
    "line_tension_maximum_of_realisation": ("N", "largest tension of the line in each realisation"),
    "line_tension_bound_of_realisation": ("N", "tension that events which were not rerun cannot pass"),
    "line_tension_maximum_lines_at_rest": ("N", "largest tension with lines at rest at every instant"),
    "lines_in_motion": ("1", "whether the largest tension is that of a line in motion"),
    "anchor_horizontal_tension_maximum_lines_at_rest": (
        "N",
        "largest horizontal tension at the anchor with lines at rest",
    ),
    "anchor_vertical_tension_maximum_lines_at_rest": ("N", "largest uplift at the anchor with lines at rest"),
    "grounded_length_lines_at_rest": ("m", "least length on the bed with lines at rest"),
    "line_tension_of_anchor_loads": ("N", "largest tension with lines at rest, to which these loads belong"),
    "anchor_horizontal_tension_maximum_lines_at_rest_of_realisation": (
        "N",
        "largest horizontal tension at the anchor with lines at rest in each realisation",
    ),
    "anchor_vertical_tension_maximum_lines_at_rest_of_realisation": (
        "N",
        "largest uplift at the anchor with lines at rest in each realisation",
    ),
    "grounded_length_lines_at_rest_of_realisation": (
        "m",
        "least length on the bed with lines at rest in each realisation",
    ),
    "line_tension_of_anchor_loads_of_realisation": (
        "N",
        "largest tension with lines at rest, to which these loads belong, in each realisation",
    ),
    "anchor_horizontal_tension_maximum_low": (
        "N",
        "largest horizontal tension at the anchor at the low end of the tension",
    ),
    "anchor_horizontal_tension_maximum_high": (
        "N",
        "largest horizontal tension at the anchor at the high end of the tension",
    ),
    "anchor_horizontal_tension_maximum_of_realisation": (
        "N",
        "largest horizontal tension at the anchor in each realisation",
    ),
    "anchor_vertical_tension_maximum_low": ("N", "largest uplift at the anchor at the low end of the tension"),
    "anchor_vertical_tension_maximum_high": ("N", "largest uplift at the anchor at the high end of the tension"),
    "anchor_vertical_tension_maximum_of_realisation": ("N", "largest uplift at the anchor in each realisation"),
    "least_grounded_length": ("m", "least length on the bed"),
    "least_grounded_length_low": ("m", "least length on the bed at the low end of the tension"),
    "least_grounded_length_high": ("m", "least length on the bed at the high end of the tension"),
    "least_grounded_length_of_realisation": ("m", "least length on the bed in each realisation"),
    "maximum_motion_of_realisation": ("m", "largest motion about the mean in each realisation (pitch, roll, yaw: rad)"),
    "largest_offset_of_realisation": ("m", "largest horizontal distance of a unit from rest in each realisation"),
    "seed_of_realisation": ("1", "seed of each realisation"),
    "position": ("m", "motion from rest, axes of the unit (pitch, roll, yaw: rad)"),
    "connector_force": ("N", "force in a connector, axes of the gap"),
    "connector_moment": ("N m", "moment in a connector, axes of the gap"),
    "tension": ("N", "tension at the fairlead"),
    "surface_elevation": ("m", "elevation of the incident waves at the origin of the row"),
    "wave_amplitude": ("m", "amplitude of a wave component"),
    "wave_omega": ("rad/s", "angular frequency of a wave component"),
    "wave_heading": ("rad", "direction of travel of a wave component"),
    "wave_phase": ("rad", "phase of the wave component at the origin"),
    "memory_pole": ("1/s", "pole of the memory of the water, one of each pair"),
    "memory_residue": ("kg/s2", "residue of a pole, its partner in (with turns: kg m/s2, kg m2/s2)"),
    "infinite_frequency_added_mass": ("kg", "added mass at infinite frequency, row axes (with turns: kg m, kg m2)"),
    "significant_height": ("m", "significant height of the incident waves"),
    "peak_period": ("s", "peak period of the sea"),
    "significant_motion": ("m", "significant double amplitude of the motion (pitch, roll, yaw: rad)"),
    "most_probable_maximum_motion": ("m", "most probable largest amplitude of the motion (pitch, roll, yaw: rad)"),
    "largest_offset": ("m", "largest horizontal distance of a unit from rest, mean and waves together"),
    "wave_height_ratio": ("1", "wave height over that of the incident sea, K"),
    "wave_height_ratio_of_point": ("1", "K at a named point"),
    "wave_height_ratio_of_line": ("1", "K along the line behind"),
    "significant_motion_low": ("m", "significant motion with damping at the end of its band that gives less"),
    "significant_motion_high": ("m", "significant motion with damping at the end of its band that gives more"),
    "motion_amplitude_low": ("m", "amplitude of motion with damping at the end of its band that gives less"),
    "motion_amplitude_high": ("m", "amplitude of motion with damping at the end of its band that gives more"),
    "largest_offset_low": ("m", "largest offset with damping at the end of its band that gives less"),
    "largest_offset_high": ("m", "largest offset with damping at the end of its band that gives more"),
    "line_tension_maximum_low": ("N", "largest tension with damping at the end of its band that gives less"),
    "line_tension_maximum_high": ("N", "largest tension with damping at the end of its band that gives more"),
    "connector_resultant_largest_low": ("N", "largest force with damping at the end of its band that gives less"),
    "connector_resultant_largest_high": ("N", "largest force with damping at the end of its band that gives more"),
    "connector_moment_largest_low": ("N m", "largest moment with damping at the end of its band that gives less"),
    "connector_moment_largest_high": ("N m", "largest moment with damping at the end of its band that gives more"),
    "relative_motion_largest_low": ("m", "relative motion with damping at the end of its band that gives less"),
    "relative_motion_largest_high": ("m", "relative motion with damping at the end of its band that gives more"),
    "gap_closing_largest_low": ("m", "closing of the gap with damping at the end of its band that gives less"),
    "gap_closing_largest_high": ("m", "closing of the gap with damping at the end of its band that gives more"),
    "transmission_coefficient_low": ("1", "transmission with damping at the end of its band that gives less"),
    "transmission_coefficient_high": ("1", "transmission with damping at the end of its band that gives more"),
    "wave_height_ratio_of_point_low": ("1", "K at a named point with damping at the end that gives less"),
    "wave_height_ratio_of_point_high": ("1", "K at a named point with damping at the end that gives more"),
    "point_x": ("m", "named point, x"),
    "point_y": ("m", "named point, y"),
    "line_x": ("m", "points of the line behind, x"),
    "line_y": ("m", "points of the line behind, y"),
    "transmission_coefficient": ("1", "transmission over the line behind, root mean square of K"),
    "section_transmission": ("1", "transmission of the two-dimensional section"),
    "section_motion_ratio": ("1", "motion of the middle unit over that of the two-dimensional section"),
    "section_drift_ratio": ("1", "mean drift across on the row over that of the section on its length"),
    "x": ("m", "map, across the row"),
    "y": ("m", "map, along the row"),
}

# Texts, and numbers that count the entries along a dimension
LABELS: dict[str, str] = {
    "unit": "unit, counted from 1",
    "connector": "connector",
    "gap": "gap between two units",
    "component": "component along or about x (along the faces), y (from unit to unit), z (up) of the gap",
    "influenced_dof": "motion that is pushed",
    "radiating_dof": "motion that moves",
    "direction": "direction of the mean drift",
    "corner": "corner of a unit in plan",
    "point": "named point",
    "station": "point of the line behind",
    "section_dof": "motion of the section",
    "member": "realisation",
    "pole": "pole of the memory",
}

# Names that a group holds whenever its analysis was run

#: What a group holds whenever its analysis was run to its end.
ALWAYS = {
    "/[^/]+/statics": (
        "draught freeboard metacentric_height unit_mass unit_x unit_y unit_heading plan_x plan_y anchor_x "
        "anchor_y anchor_z fairlead_x fairlead_y fairlead_z line_unit mooring_x mooring_y mooring_z outline_x "
        "outline_z unit_centre_z breaking_load anchor_curve_tension anchor_curve_horizontal_tension "
        "anchor_curve_vertical_tension anchor_curve_grounded_length line_tension_mean anchor_horizontal_tension "
        "anchor_vertical_tension grounded_length connector_x connector_y connector_z connector_breaking_load "
        "connector_endurance_exponent curve_lowest curve_highest gap_width least_distance gap_closing_steady "
        "steady_offset steady_force_of_wind steady_force_of_current"
    ),
    "/[^/]+/hydrodynamics": ("wave_number added_mass radiation_damping excitation_force hydrostatic_stiffness"),
    "/[^/]+/frequency/[^/]+": (
        "mean_offset largest_offset mean_drift mean_drift_of_unit connector_force_mean connector_moment_mean "
        "connector_force_largest connector_moment_largest connector_resultant_largest "
        "connector_stiffness_of_curve elongation_lowest elongation_highest stretch_across relative_motion_largest "
        "relative_turn_largest gap_closing_largest line_tension_mean line_tension_maximum connector_loses_contact "
        "least_distance hulls_meet drift_per_amplitude_squared"
    ),
    "/[^/]+/map/[^/]+": (
        "wave_height_ratio wave_height_ratio_of_point wave_height_ratio_of_line point_x point_y line_x line_y "
        "transmission_coefficient section_transmission"
    ),
    "/[^/]+/memory": "memory_pole memory_residue infinite_frequency_added_mass added_mass radiation_damping",
    "/[^/]+/time/[^/]+": (
        "mean_offset largest_offset maximum_motion connector_force_mean connector_moment_mean "
        "connector_force_largest connector_moment_largest connector_resultant_largest "
        "connector_moment_resultant_largest connector_damage_rate elongation_lowest elongation_highest "
        "stretch_across relative_motion_largest relative_turn_largest gap_motion_largest gap_closing_largest "
        "line_tension_mean line_tension_maximum line_tension_minimum least_distance hulls_meet "
        "anchor_horizontal_tension_maximum_lines_at_rest anchor_vertical_tension_maximum_lines_at_rest "
        "grounded_length_lines_at_rest line_tension_of_anchor_loads"
    ),
    "/[^/]+/time/[^/]+/[^/]+": (
        "position connector_force connector_moment tension surface_elevation wave_amplitude wave_omega "
        "wave_number wave_heading wave_phase"
    ),
}
#: The ends of a number over the band of the damping.
_BANDS = tuple(
    f"{name} {name[:-4]}_high" for name in VARIABLES if name.endswith("_low") and f"{name[:-4]}_high" in VARIABLES
)
#: What one statement of a run writes: a group holds all of it or none.
TOGETHER = {
    "/[^/]+/frequency/[^/]+": (
        "wave_height rao motion_amplitude connector_force_amplitude connector_moment_amplitude tension_amplitude",
        (
            "significant_height peak_period significant_motion most_probable_maximum_motion "
            "connector_significant_force connector_significant_moment"
        ),
        (
            "anchor_horizontal_tension_maximum_lines_at_rest anchor_vertical_tension_maximum_lines_at_rest "
            "grounded_length_lines_at_rest line_tension_of_anchor_loads"
        ),
        "anchor_horizontal_tension_maximum anchor_vertical_tension_maximum least_grounded_length",
        *_BANDS,
    ),
    "/[^/]+/map/[^/]+": (
        "section_motion_ratio section_drift_ratio",
        *_BANDS,
    ),
    "/[^/]+/time/[^/]+": (
        "significant_motion significant_height",
        (
            "connector_resultant_largest_of_realisation connector_moment_largest_of_realisation "
            "connector_moment_resultant_largest_of_realisation line_tension_maximum_of_realisation "
            "largest_offset_of_realisation gap_motion_largest_of_realisation gap_closing_largest_of_realisation "
            "connector_damage_rate_of_realisation maximum_motion_of_realisation "
            "anchor_horizontal_tension_maximum_lines_at_rest_of_realisation "
            "anchor_vertical_tension_maximum_lines_at_rest_of_realisation "
            "grounded_length_lines_at_rest_of_realisation line_tension_of_anchor_loads_of_realisation"
        ),
        "anchor_horizontal_tension_maximum anchor_vertical_tension_maximum least_grounded_length",
        (
            "anchor_horizontal_tension_maximum_of_realisation anchor_vertical_tension_maximum_of_realisation "
            "least_grounded_length_of_realisation"
        ),
        "line_tension_maximum_lines_at_rest lines_in_motion",
        *_BANDS,
    ),
}

VOCABULARY = Vocabulary.of("units", VARIABLES, labels=LABELS, always=ALWAYS, together=TOGETHER)
labelled = VOCABULARY.describe
