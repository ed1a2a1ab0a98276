"""Names, units and meanings of everything that a breakwater run writes; the one file that owns them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "omega": ("rad/s", "angular frequency"),
    "period": ("s", "wave period"),
    "wavelength": ("m", "wave length L"),
    "wave_number": ("1/m", "wave number k"),
    "wavelength_over_beam": ("1", "wave length over beam, L/B"),
    "wave_direction": ("rad", "heading of the waves, 0 towards +x"),
    "draught": ("m", "draught d"),
    "body_mass": ("kg", "mass of the unit"),
    "displaced_mass": ("kg", "displaced mass of water"),
    "line_vertical_pull": ("N", "downward pull of all lines at rest"),
    "imbalance": ("%", "displacement less weight and line pull, over displacement"),
    "heel": ("rad", "heel at rest, top towards +x"),
    "metacentric_height": ("m", "metacentric height GM"),
    "freeboard": ("m", "freeboard at rest"),
    "centre_of_gravity_x": ("m", "centre of gravity, x"),
    "centre_of_gravity_z": ("m", "centre of gravity, z above still water"),
    "beam": ("m", "beam B"),
    "section_height": ("m", "height of the section, keel to deck"),
    "unit_length": ("m", "length of the unit along the crest"),
    "steady_force": ("N", "steady force of wind and current (roll: N m)"),
    "steady_offset": ("m", "offset under wind and current (roll: rad)"),
    "hydrostatic_stiffness": ("N/m", "hydrostatic stiffness of the unit (N, N m with roll)"),
    "mooring_stiffness": ("N/m", "tangent stiffness of the mooring (N, N m with roll)"),
    "inertia_matrix": ("kg", "inertia of the unit (kg m2 in roll)"),
    "natural_period": ("s", "natural period with lines"),
    "natural_period_without_lines": ("s", "natural period without lines"),
    "mode_shape": ("1", "undamped mode, leading motion 1"),
    "damping_ratio": ("1", "damping over critical at the natural frequency"),
    "line_count": ("1", "number of identical lines"),
    "fairlead_tension": ("N", "tension at the fairlead at rest"),
    "anchor_tension": ("N", "tension at the anchor at rest"),
    "horizontal_tension": ("N", "horizontal tension at rest"),
    "fairlead_vertical_tension": ("N", "vertical tension at the fairlead at rest"),
    "anchor_vertical_tension": ("N", "vertical tension at the anchor at rest, upward on the anchor"),
    "grounded_length": ("m", "length on the bed at rest"),
    "unstretched_length": ("m", "unstretched length"),
    "breaking_load": ("N", "breaking load"),
    "utilisation": ("1", "tension at rest over breaking load"),
    "fairlead_x": ("m", "fairlead x at rest"),
    "fairlead_z": ("m", "fairlead z at rest"),
    "anchor_x": ("m", "anchor x"),
    "anchor_z": ("m", "anchor z"),
    "outline_x": ("m", "hull at rest, x"),
    "outline_z": ("m", "hull at rest, z"),
    "line_x": ("m", "line at rest, x"),
    "line_z": ("m", "line at rest, z"),
    "offset": ("m", "sway offset"),
    "restoring_force": ("N", "horizontal force of all lines on the unit"),
    "vertical_force": ("N", "vertical force of all lines on the unit"),
    "line_tension": ("N", "tension at the fairlead"),
    "line_horizontal_tension": ("N", "horizontal tension"),
    "line_anchor_vertical_tension": ("N", "vertical tension at the anchor"),
    "rao": ("m/m", "motion per wave amplitude (roll: rad/m)"),
    "reflection_coefficient": ("1", "reflection coefficient C_R"),
    "transmission_coefficient": ("1", "transmission coefficient C_T"),
    "dissipation": ("1", "dissipated fraction of the incident energy flux E_L"),
    "drift_coefficient": ("1", "drift coefficient F*"),
    "mean_drift_force": ("N", "mean drift force on the unit along x"),
    "transmission_macagno": ("1", "K_T after Macagno, fixed box (screening)"),
    "transmission_wiegel": ("1", "K_T after Wiegel, fixed plate (screening)"),
    "transmission_ruol": ("1", "K_T after Ruol et al. (screening, constants unconfirmed)"),
    "motion_amplitude": ("m", "amplitude of motion (roll: rad)"),
    "motion_ratio": ("1", "sway, heave over H/2; roll theta B/H"),
    "mean_offset": ("m", "mean offset (roll: rad)"),
    "mean_tension": ("N", "mean tension at the fairlead"),
    "tension_amplitude": ("N", "amplitude of the tension at the fairlead, linear"),
    "maximum_tension": ("N", "largest tension at the fairlead"),
    "minimum_tension": ("N", "smallest tension at the fairlead"),
    "maximum_anchor_vertical_tension": ("N", "largest vertical tension at the anchor"),
    "maximum_utilisation": ("1", "largest tension over breaking load"),
    "relative_elevation": ("m", "amplitude of the water surface relative to the seaward deck edge"),
    "overtopping_share": ("1", "share of waves whose relative elevation exceeds the freeboard"),
    "wave_spectrum": ("m2 s/rad", "spectral density of the incident waves"),
    "transmitted_spectrum": ("m2 s/rad", "spectral density of the transmitted waves"),
    "response_spectrum": ("m2 s/rad", "spectral density of the motion (roll: rad2 s/rad)"),
    "significant_height": ("m", "significant height of the incident waves"),
    "transmitted_significant_height": ("m", "significant height of the transmitted waves"),
    "significant_motion": ("m", "significant double amplitude of the motion (roll: rad)"),
    "most_probable_maximum_motion": ("m", "most probable largest amplitude of the motion (roll: rad)"),
    "most_probable_maximum_tension": ("N", "most probable largest tension, linear"),
    "maximum_motion": ("m", "largest excursion from the mean (roll: rad)"),
    "significant_tension": ("N", "significant double amplitude of the tension"),
    "position": ("m", "position relative to rest (roll: rad)"),
    "tension": ("N", "tension at the fairlead of one line"),
    "surface_elevation": ("m", "incident waves at x = 0"),
    "time": ("s", "time"),
    "damping_fraction": ("1", "damping as a fraction of critical"),
    "line_slack": ("m", "length of line beyond the chord"),
    "number_of_lines": ("1", "number of lines in all"),
}


def labelled(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with ``units`` and ``long_name`` on every variable that this room owns."""
    out = dataset.copy()
    for name in list(out.variables):
        entry = VARIABLES.get(str(name))
        if entry is not None:
            out[name].attrs = {"units": entry[0], "long_name": entry[1], **out[name].attrs}
    return out
