"""Names, units and meanings of everything that a breakwater run writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import Vocabulary
from moyai.potential.variables import VOCABULARY as POTENTIAL

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "omega": ("rad/s", "angular frequency"),
    "period": ("s", "wave period"),
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
    "steady_force_of_wind": ("N", "steady force of wind (roll: N m)"),
    "steady_force_of_current": ("N", "steady force of current (roll: N m)"),
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
    "fairlead_vertical_tension": ("N", "vertical tension at the fairlead at rest"),
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
    "line_shape_x": ("m", "line with its fairlead displaced, x"),
    "line_shape_z": ("m", "line with its fairlead displaced, z"),
    "shift_x": ("m", "displacement of the fairlead from rest, x"),
    "shift_z": ("m", "displacement of the fairlead from rest, z"),
    "offset": ("m", "sway offset"),
    "restoring_force": ("N", "horizontal force of all lines on the unit"),
    "vertical_force": ("N", "vertical force of all lines on the unit"),
    "line_tension": ("N", "tension at the fairlead"),
    "rao": ("m/m", "motion per wave amplitude (roll: rad/m)"),
    "reflection_coefficient": ("1", "reflection coefficient C_R"),
    "transmission_coefficient": ("1", "transmission coefficient C_T"),
    "dissipation": ("1", "dissipated fraction of the incident energy flux E_L"),
    "damping_work": ("1", "work of all damping on the first harmonic, over the incident energy flux"),
    "energy_to_harmonics": (
        "1",
        "energy that lines transfer from the first harmonic into others, over the incident flux",
    ),
    "harmonic_radiation": ("1", "energy radiated in a higher harmonic of the motion, over the incident energy flux"),
    "drift_coefficient": ("1", "drift coefficient F*"),
    "mean_drift_force": ("N", "mean drift force on the unit along x"),
    "transmission_macagno": ("1", "K_T after Macagno, fixed box (screening)"),
    "transmission_wiegel": ("1", "K_T after Wiegel, fixed plate (screening)"),
    "transmission_ruol": ("1", "K_T after Ruol et al. (screening, constants unconfirmed)"),
    "motion_amplitude": ("m", "amplitude of motion (roll: rad)"),
    "motion_ratio": ("1", "sway, heave over H/2; roll theta B/H"),
    "mean_offset": ("m", "mean offset (roll: rad)"),
    "line_tension_mean": ("N", "mean tension at the fairlead"),
    "tension_amplitude": ("N", "amplitude of the tension at the fairlead, linear"),
    "line_tension_maximum": ("N", "largest tension at the fairlead"),
    "line_tension_minimum": ("N", "smallest tension at the fairlead"),
    "maximum_utilisation": ("1", "largest tension over breaking load"),
    "relative_elevation": ("m", "amplitude of the water surface relative to the seaward deck edge"),
    "overtopping_share": ("1", "share of waves whose relative elevation exceeds the freeboard"),
    "wave_spectrum": ("m2 s/rad", "spectral density of the incident waves"),
    "transmitted_spectrum": ("m2 s/rad", "spectral density of the transmitted waves"),
    "response_spectrum": ("m2 s/rad", "spectral density of the motion (roll: rad2 s/rad)"),
    "significant_height": ("m", "significant height of the incident waves"),
    "transmitted_significant_height": ("m", "significant height of the transmitted waves"),
    "transmission_coefficient_low": ("1", "transmission coefficient, lowest in the band of damping"),
    "transmission_coefficient_high": ("1", "transmission coefficient, highest in the band of damping"),
    "motion_amplitude_with_tangent": ("m", "amplitude of motion with the tangent of the lines (roll: rad)"),
    "motion_amplitude_low": ("m", "amplitude of motion, lowest in the band of damping (roll: rad)"),
    "motion_amplitude_high": ("m", "amplitude of motion, highest in the band of damping (roll: rad)"),
    "significant_motion_low": ("m", "significant double amplitude, lowest in the band of damping (roll: rad)"),
    "significant_motion_high": ("m", "significant double amplitude, highest in the band of damping (roll: rad)"),
    "equivalent_damping": ("N s/m", "equivalent linear damping beyond wave radiation, of the unit (roll: N m s)"),
    "equivalent_damping_fraction": ("1", "equivalent damping beyond wave radiation, fraction of critical"),
    "significant_motion": ("m", "significant double amplitude of the motion (roll: rad)"),
    "most_probable_maximum_motion": ("m", "most probable largest amplitude of the motion (roll: rad)"),
    "most_probable_maximum_tension": ("N", "most probable largest tension, linear"),
    "slow_motion_deviation": ("m", "standard deviation of the slow motion (roll: rad)"),
    "slow_sway_deviation_half_damping": ("m", "standard deviation of the slow sway with half the damping"),
    "slow_sway_deviation_double_damping": ("m", "standard deviation of the slow sway with twice the damping"),
    "slow_sway_period": ("s", "natural period of sway at the mean offset"),
    "slow_sway_damping_ratio": ("1", "damping of the slow sway over critical, radiation included"),
    "largest_offset": ("m", "largest sway from rest, mean, slow drift and waves together"),
    "lines_in_motion": ("1", "whether the largest tension is that of a line in motion"),
    "seed_of_realisation": ("1", "seed of the realisation"),
    "line_tension_maximum_of_realisation": ("N", "largest tension at the fairlead in each realisation"),
    "anchor_vertical_tension_maximum_of_realisation": ("N", "largest uplift at the anchor in each realisation"),
    "anchor_horizontal_tension_maximum_of_realisation": (
        "N",
        "largest horizontal tension at the anchor in each realisation",
    ),
    "anchor_vertical_tension_of_storms": (
        "N",
        "uplift at the anchor at the low end, the mean and the high end of the largest of storms alike",
    ),
    "anchor_horizontal_tension_of_storms": (
        "N",
        "horizontal tension at the anchor at the low end, the mean and the high end of the largest of storms alike",
    ),
    "largest_offset_by_dof_of_realisation": ("m", "largest way from rest in each realisation (roll: rad)"),
    "maximum_motion": ("m", "largest excursion from the mean (roll: rad)"),
    "significant_tension": ("N", "significant double amplitude of the tension"),
    "position": ("m", "position relative to rest (roll: rad)"),
    "tension": ("N", "tension at the fairlead of one line"),
    "surface_elevation": ("m", "incident waves at x = 0"),
    "velocity_kernel": ("N/m", "memory K(t) on velocity, of the unit"),
    "acceleration_kernel": ("N s/m", "memory lambda(t) on acceleration, of the unit"),
    "added_mass": ("kg", "added mass of the unit"),
    "radiation_damping": ("kg/s", "radiation damping of the unit"),
    "infinite_frequency_added_mass": ("kg", "added mass at infinite frequency, of the unit"),
    "steady_dashpot": ("kg/s", "radiation damping at zero frequency, of the unit"),
    "mean_drift_force_per_amplitude_squared": ("N/m2", "mean drift force on the unit per wave amplitude squared"),
    "mean_zero_crossing_period": ("s", "mean zero-crossing period of the motion"),
    "significant_relative_elevation": ("m", "significant double amplitude of the relative elevation at the deck edge"),
    "largest_offset_by_dof": ("m", "largest way from rest in each degree of freedom (roll: rad)"),
    "damping_fraction": ("1", "damping as a fraction of critical"),
    "line_slack": ("m", "length of line beyond the chord"),
    "number_of_lines": ("1", "number of lines in all"),
    "line_tension_peak_since_row": ("N", "highest tension at the fairlead since the row before"),
    "grounded_length_history": ("m", "length of a line in motion that touches the bed"),
    "moving_line_x": ("m", "line in motion, x"),
    "moving_line_z": ("m", "line in motion, z"),
    "shape_time": ("s", "times of the shapes of lines in motion"),
    "position_lines_at_rest": ("m", "position with lines at rest at every instant (roll: rad)"),
    "tension_lines_at_rest": ("N", "tension at the fairlead with lines at rest at every instant"),
    "events_in_motion": ("1", "events of a realisation that were rerun with lines in motion, mean over realisations"),
    "event_offset": ("m", "largest offset in events rerun with lines in motion (roll: rad)"),
    "event_offset_lines_at_rest": ("m", "the same in these events with lines at rest at every instant (roll: rad)"),
    "line_tension_bound": (
        "N",
        "tension that no event passes, by the largest ratio of motion over rest that was found",
    ),
    "line_tension_bound_of_realisation": ("N", "the same of each realisation"),
    "line_tension_maximum_lines_at_rest": ("N", "largest tension at the fairlead with lines at rest at every instant"),
    "anchor_vertical_tension_maximum_lines_in_motion": (
        "N",
        "largest vertical tension at the anchor of a line in motion",
    ),
    "least_grounded_length": ("m", "shortest length on the bed"),
    "slack_time": ("s", "time that the line is slack"),
    "longest_slack": ("s", "longest time that the line is slack at once"),
    "peak_change_twice_the_bars": ("1", "change of the largest tension with twice the bars"),
    "peak_change_half_the_step": ("1", "change of the largest tension with half the step"),
    "peak_change_twice_the_damping": ("1", "change of the largest tension with twice the internal damping"),
    "line_number": ("1", "number of the line, from 0"),
    "contact_time": ("s", "time at which the line comes taut"),
    "slack_before": ("s", "time that it was slack before"),
    "contact_peak": ("N", "highest tension until it is slack again"),
    "peak_time": ("s", "time of that"),
    "rise_time": ("s", "rise from a tenth to nine tenths of the peak"),
    "is_snap": ("1", "whether the peak is that of a snap"),
}

# Texts, and numbers that count the entries along a dimension
LABELS: dict[str, str] = {
    "influenced_dof": "degree of freedom that is pushed",
    "radiating_dof": "degree of freedom that moves",
    "mode": "natural mode",
    "harmonic": "harmonic of the wave",
}

# Names that a group holds whenever its analysis was run

#: What a group holds whenever its analysis was run to its end.
ALWAYS = {
    "/[^/]+/statics": (
        "draught body_mass displaced_mass line_vertical_pull imbalance heel metacentric_height freeboard "
        "centre_of_gravity_x centre_of_gravity_z beam section_height unit_length steady_force "
        "steady_force_of_wind steady_force_of_current steady_offset hydrostatic_stiffness mooring_stiffness "
        "inertia_matrix outline_x outline_z natural_period natural_period_without_lines mode_shape damping_ratio "
        "breaking_load"
    ),
    "/[^/]+/mooring": (
        "restoring_force vertical_force line_tension anchor_horizontal_tension anchor_vertical_tension "
        "mooring_stiffness"
    ),
    "/[^/]+/rao": (
        "rao period wavelength wavelength_over_beam transmission_macagno transmission_wiegel transmission_ruol"
    ),
    "/[^/]+/frequency/[^/]+": (
        "omega line_tension_maximum line_tension_mean anchor_vertical_tension_maximum mean_offset mean_drift_force "
        "equivalent_damping equivalent_damping_fraction"
    ),
    "/[^/]+/memory": (
        "velocity_kernel acceleration_kernel added_mass radiation_damping infinite_frequency_added_mass steady_dashpot"
    ),
    "/[^/]+/time/[^/]+": "line_tension_maximum line_tension_mean",
    "/[^/]+/time/[^/]+/[^/]+": "position tension surface_elevation",
    "/[^/]+/time/[^/]+/[^/]+/contacts": (
        "line_number contact_time slack_before contact_peak peak_time rise_time is_snap"
    ),
}
#: What one statement of a run writes: a group holds all of it or none.
TOGETHER = {
    "/[^/]+/statics": (
        (
            "fairlead_tension anchor_tension anchor_horizontal_tension fairlead_vertical_tension "
            "anchor_vertical_tension grounded_length line_count unstretched_length breaking_load utilisation "
            "fairlead_x fairlead_z anchor_x anchor_z line_x line_z"
        ),
        "line_shape_x line_shape_z",
    ),
    "/[^/]+/rao": (
        (
            "reflection_coefficient transmission_coefficient dissipation drift_coefficient "
            "mean_drift_force_per_amplitude_squared"
        ),
    ),
    "/[^/]+/frequency/[^/]+": (
        ("reflection_coefficient transmission_coefficient transmission_coefficient_low transmission_coefficient_high"),
        "dissipation drift_coefficient mean_drift_force_per_amplitude_squared",
        (
            "wavelength wavelength_over_beam rao motion_amplitude motion_amplitude_low motion_amplitude_high "
            "motion_ratio mooring_stiffness relative_elevation tension_amplitude line_tension_minimum"
        ),
        (
            "wave_spectrum response_spectrum significant_height significant_motion significant_motion_low "
            "significant_motion_high most_probable_maximum_motion mean_zero_crossing_period significant_tension "
            "most_probable_maximum_tension anchor_horizontal_tension_maximum anchor_vertical_tension_of_storms "
            "anchor_horizontal_tension_of_storms least_grounded_length largest_offset "
            "overtopping_share significant_relative_elevation"
        ),
        "transmitted_significant_height transmitted_spectrum",
        (
            "slow_motion_deviation slow_sway_deviation_half_damping slow_sway_deviation_double_damping "
            "slow_sway_period slow_sway_damping_ratio"
        ),
    ),
    "/[^/]+/time/[^/]+": (
        (
            "mean_offset maximum_motion mean_drift_force lines_in_motion line_tension_maximum line_tension_mean "
            "anchor_vertical_tension_maximum "
            "anchor_horizontal_tension_maximum least_grounded_length maximum_utilisation"
        ),
        (
            "motion_amplitude motion_ratio wavelength_over_beam line_tension_minimum damping_work energy_to_harmonics "
            "harmonic_radiation"
        ),
        "significant_motion significant_tension significant_height",
        (
            "largest_offset_by_dof largest_offset_by_dof_of_realisation line_tension_maximum_of_realisation "
            "seed_of_realisation"
        ),
        "slack_time longest_slack contact_count snap_count largest_snap shortest_rise_time",
    ),
    "/[^/]+/time/[^/]+/[^/]+": (
        (
            "anchor_tension anchor_vertical_tension grounded_length_history moving_line_x moving_line_z "
            "line_tension_peak_since_row"
        ),
        "position_lines_at_rest tension_lines_at_rest",
    ),
}

VOCABULARY = Vocabulary.of(
    "breakwater",
    VARIABLES,
    labels=LABELS,
    parts={".*/hydrodynamics(_oblique)?": POTENTIAL},
    open_groups=("/measured",),
    always=ALWAYS,
    together=TOGETHER,
)
labelled = VOCABULARY.describe
