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
    "drift_per_amplitude_squared": ("N/m2", "mean drift on the whole row per amplitude squared (moment: N/m)"),
    "connector_force_amplitude": ("N", "amplitude of the force in a connector, axes of the unit before it"),
    "connector_moment_amplitude": ("N m", "amplitude of the moment in a connector, axes of the unit before it"),
    "connector_force_mean": ("N", "mean force in a connector, axes of the unit before it"),
    "connector_moment_mean": ("N m", "mean moment in a connector, axes of the unit before it"),
    "connector_force_largest": ("N", "largest force of a component in a connector"),
    "connector_moment_largest": ("N m", "largest moment of a component in a connector"),
    "connector_resultant_largest": ("N", "largest force in a connector along the direction that bears most"),
    "connector_significant_force": ("N", "significant amplitude of the force in a connector, twice its deviation"),
    "connector_significant_moment": ("N m", "significant amplitude of the moment in a connector"),
    "connector_stiffness_of_curve": ("N/m", "linear stiffness that stands for the curve of a connector"),
    "elongation_lowest": ("m", "lowest elongation of a connector with a curve, mean and waves"),
    "elongation_highest": ("m", "highest elongation of a connector with a curve, mean and waves"),
    "relative_motion_largest": ("m", "largest relative motion of the ends of a connector"),
    "relative_turn_largest": ("rad", "largest relative turn of the ends of a connector"),
    "tension_amplitude": ("N", "amplitude of the tension at the fairlead, linear"),
    "significant_height": ("m", "significant height of the incident waves"),
    "peak_period": ("s", "peak period of the sea"),
    "significant_motion": ("m", "significant double amplitude of the motion (pitch, roll, yaw: rad)"),
    "most_probable_maximum_motion": ("m", "most probable largest amplitude of the motion (pitch, roll, yaw: rad)"),
    "largest_offset": ("m", "largest sway of a unit from rest, mean and waves together"),
    "wave_height_ratio": ("1", "wave height over that of the incident sea, K"),
    "wave_height_ratio_of_point": ("1", "K at a named point"),
    "wave_height_ratio_of_line": ("1", "K along the line behind"),
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
    "component": "component along or about x (across), y (along), z (up) of the unit before the connector",
    "influenced_dof": "motion that is pushed",
    "radiating_dof": "motion that moves",
    "direction": "direction of the mean drift",
    "corner": "corner of a unit in plan",
    "point": "named point",
    "station": "point of the line behind",
    "section_dof": "motion of the section",
}

# Names that a group holds whenever its analysis was run
ALWAYS: dict[str, tuple[str, ...]] = {
    "/[^/]+/statics": ("draught", "freeboard", "unit_x", "plan_x"),
    "/[^/]+/frequency/[^/]+": ("mean_offset", "mean_drift"),
    "/[^/]+/map/[^/]+": ("wave_height_ratio",),
}

VOCABULARY = Vocabulary.of("units", VARIABLES, labels=LABELS, always=ALWAYS)
labelled = VOCABULARY.describe
