"""Names, units and meanings of everything that a run of a network writes; the one file that owns them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from moyai.core.labels import with_labels

if TYPE_CHECKING:
    import xarray as xr

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
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
    "velocity": ("m/s", "velocity of the node"),
    "tension": ("N", "tension of the bar"),
    "sheet_tension": ("N/m", "higher principal tension of the sheet, 0 where it is slack"),
    "line_tension": ("N", "highest tension along the line since the row before"),
    "line_least_tension": ("N", "lowest tension along the line"),
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
    "mode_shape": ("1", "shape of the mode, largest component 1"),
    "peak": ("N", "highest tension of the run"),
    "peak_time": ("s", "time of the highest tension"),
    "start_peak": ("N", "highest tension at the start of the line"),
    "end_peak": ("N", "highest tension at the end of the line"),
    "mean": ("N", "mean tension at the line's most loaded end"),
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
    "discretisation_error": ("1", "relative change of the peak with step and mesh together"),
    "viscosity_effect": ("1", "largest relative change of the peak with the viscosity"),
    "load_peak": ("N", "highest pull on the point"),
    "load_horizontal": ("N", "highest horizontal pull on the point"),
    "load_upwards": ("N", "highest upward pull on the point"),
    "load_downwards": ("N", "highest downward pull on the point"),
    "excursion": ("m", "largest distance of the point from its place at rest, by direction"),
    "wave_amplitude": ("m", "amplitude of the wave component"),
    "wave_omega": ("rad/s", "angular frequency of the wave component"),
    "wave_number": ("1/m", "wave number of the wave component"),
    "wave_heading": ("rad", "direction of travel of the wave component"),
    "wave_phase": ("rad", "phase of the wave component at the origin"),
}


def labelled(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with ``units`` and ``long_name`` on every variable that this room owns."""
    return with_labels(dataset, VARIABLES)
