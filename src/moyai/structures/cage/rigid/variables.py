"""Names, units and meanings of everything that a run of a rigid cage writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import Vocabulary

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "mass": ("kg", "mass in air"),
    "mass_without_floats": ("kg", "mass in air of net, frame and weights"),
    "solid_volume": ("m3", "solid volume of net, frame and weights"),
    "float_volume": ("m3", "volume of all floats"),
    "enclosed_volume": ("m3", "volume that the nets enclose"),
    "centre_of_gravity_x": ("m", "centre of gravity from the middle of the cage, along x"),
    "centre_of_gravity_z": ("m", "centre of gravity above the middle of the cage"),
    "inertia": ("kg m2", "moment of inertia about the axis across the waves through the centre of gravity"),
    "submerged_weight": ("N", "weight in water of net, frame and weights"),
    "reserve_buoyancy": ("N", "what the floats carry beyond the whole cage under water"),
    "net_area": ("m2", "outline area of the net"),
    "solidity": ("1", "geometric solidity of the net"),
    "outline_x": ("m", "section of the cage from its middle, along x"),
    "outline_z": ("m", "section of the cage from its middle, upwards"),
    "float_x": ("m", "float from the middle of the cage, along x"),
    "float_z": ("m", "float above the middle of the cage"),
    "float_diameter": ("m", "diameter of a float"),
    "rest_x": ("m", "middle of the cage at rest, x"),
    "rest_z": ("m", "middle of the cage at rest above still water"),
    "rest_roll": ("rad", "rotation at rest"),
    "immersion": ("1", "share of the floats' volume under water"),
    "residual": ("1", "largest unbalanced force over the weight in air"),
    "tension_at_rest": ("N", "tension at rest, at the cage"),
    "line_length": ("m", "unstretched length of the line"),
    "line_stiffness": ("N/m", "stiffness of line and gauge"),
    "attachment_x": ("m", "where the line meets the cage, from its middle, along x"),
    "attachment_z": ("m", "where the line meets the cage, above its middle"),
    "anchor_x": ("m", "anchor, x"),
    "anchor_z": ("m", "anchor above still water"),
    "line_submerged_weight": ("N/m", "weight of the line in water"),
    "breaking_load": ("N", "breaking load of the line"),
    "stiffness": ("N/m", "stiffness at rest, rotation in N and N m/rad"),
    "natural_period": ("s", "undamped natural period at rest, added mass included"),
    "natural_shape": ("1", "shape of the natural mode: sway and heave over the size of the cage, rotation in rad"),
    "wave_height": ("m", "wave height H, or significant height"),
    "period": ("s", "wave period T, or peak period"),
    "orbit_ratio": ("1", "horizontal over vertical axis of the water's orbit at the surface, coth kh"),
    "range": ("m", "mean range of the motion from crest to trough (roll in rad)"),
    "largest_range": ("m", "largest range within a wave period (roll in rad)"),
    "range_ratio": (
        "1",
        "mean range over the wave height, in random seas four deviations over the significant height (sway, heave)",
    ),
    "mean": ("m", "mean of the motion from rest (roll in rad)"),
    "maximum": ("m", "largest value from rest (roll in rad)"),
    "minimum": ("m", "smallest value from rest (roll in rad)"),
    "deviation": ("m", "standard deviation of the motion (roll in rad)"),
    "first_harmonic": ("m", "amplitude of the first harmonic (roll in rad)"),
    "first_phase": ("rad", "phase of the first harmonic after the crest at x = 0"),
    "drift_velocity": ("m/s", "mean velocity of the cage along x"),
    "line_tension_minimum": ("N", "smallest tension"),
    "line_tension_mean": ("N", "mean tension"),
    "line_tension_maximum": ("N", "largest tension"),
    "line_tension_maximum_of_realisation": ("N", "largest tension of the line in each realisation"),
    "largest_offset_of_realisation": ("m", "largest way from where the cage floats freely in each realisation"),
    "seed_of_realisation": ("1", "seed of each realisation"),
    "line_tension_mean_peak": ("N", "mean of the largest tension in each wave period"),
    "steps_per_period": ("1", "time steps in a wave period"),
    "surface_elevation": ("m", "surface at x = 0"),
    "sway": ("m", "centre of gravity from rest, along x"),
    "heave": ("m", "centre of gravity from rest, upwards"),
    "roll": ("rad", "rotation from rest, positive with the top towards +x"),
    "tension": ("N", "tension of the line at either end"),
    "line_tension_peak_since_row": ("N", "largest tension around the row, at the cage"),
    "normal_drag_coefficient": ("1", "drag coefficient of the net at normal flow, on its outline area"),
    "law_line_tension_maximum": ("N", "largest tension of all lines in the governing wave"),
    "law_line_tension": ("N", "largest tension of each line in the governing wave"),
    "law_largest_offset": ("m", "largest way from where the cage floats freely, in the governing wave"),
    "varied_stiffness": ("N/m", "stiffness of the lines"),
}

# Texts, and numbers that count the entries along a dimension
LABELS: dict[str, str] = {
    "mode": "degree of freedom",
    "other_mode": "degree of freedom",
    "situation": "freely floating or moored",
    "translation": "degree of freedom along an axis",
}

# Names that a group holds whenever its analysis was run

#: What a group holds whenever its analysis was run to its end.
ALWAYS = {
    "/[^/]+/cage": (
        "mass mass_without_floats solid_volume float_volume enclosed_volume centre_of_gravity_x "
        "centre_of_gravity_z inertia submerged_weight reserve_buoyancy net_area solidity solidity_listed "
        "outline_x outline_z float_x float_z float_diameter"
    ),
    "/[^/]+/statics": (
        "rest_x rest_z rest_roll immersion residual tension_at_rest line_length line_stiffness attachment_x "
        "attachment_z anchor_x anchor_z line_submerged_weight breaking_load stiffness natural_period "
        "natural_shape"
    ),
    "/[^/]+/waves/[^/]+": (
        "period wave_height wavelength orbit_ratio range largest_range mean maximum minimum deviation "
        "first_harmonic first_phase range_ratio drift_velocity line_tension_minimum line_tension_mean "
        "line_tension_maximum line_tension_mean_peak anchor_tension_maximum slack_share steps_per_period"
    ),
    "/[^/]+/time/[^/]+/[^/]+": "surface_elevation sway heave roll tension line_tension_peak_since_row",
    "/[^/]+/laws(_in_waves/[^/]+/[^/]+)?": (
        "normal_drag_coefficient law_line_tension_maximum law_line_tension law_largest_offset"
    ),
    "/[^/]+/sensitivity/[^/]+": "line_tension_maximum line_tension_mean_peak range",
}

VOCABULARY = Vocabulary.of(
    "rigid cage",
    VARIABLES,
    labels=LABELS,
    always=ALWAYS,
)
labelled = VOCABULARY.describe
