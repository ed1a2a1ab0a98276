"""Names, units and meanings of everything that a run of a member writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import Vocabulary

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "strip": ("m", "distance of the middle of the strip from the start of the member"),
    "strip_x": ("m", "middle of the strip, x"),
    "strip_y": ("m", "middle of the strip, y"),
    "strip_z": ("m", "middle of the strip, z above still water"),
    "outline_x": ("m", "outline of the section along its first axis"),
    "outline_z": ("m", "outline of the section along its second axis"),
    "axis_direction": ("1", "direction of the first and second axis of the section in space"),
    "area": ("m2", "area of the section A"),
    "width": ("m", "extent of the section along its first axis"),
    "height": ("m", "extent of the section along its second axis"),
    "length": ("m", "length of the member"),
    "inclination": ("rad", "angle between the member and the horizontal"),
    "ideal_inertia_coefficient": ("1", "inertia coefficient in ideal fluid, tensor in axes of the section"),
    "principal_inertia_coefficient": ("1", "principal inertia coefficients in ideal fluid"),
    "principal_angle": ("rad", "angle of the axis of the smaller one from the first axis"),
    "inertia_error": ("1", "estimated relative error of the ideal inertia coefficients"),
    "wave_height": ("m", "wave height H, or significant height"),
    "period": ("s", "wave period T, or peak period"),
    "keulegan_carpenter": ("1", "Keulegan-Carpenter number u T / B"),
    "coefficient_keulegan_carpenter": ("1", "Keulegan-Carpenter number with the current, for drag and inertia"),
    "reynolds": ("1", "Reynolds number u B / nu"),
    "beta": ("1", "frequency parameter B2 f / nu"),
    "orbit_ratio": ("1", "smaller over larger axis of the orbit across the member"),
    "velocity_amplitude": ("m/s", "velocity amplitude along each axis of the section"),
    "inertia_coefficient": ("1", "inertia coefficient along the axis, before the circulation"),
    "plain_inertia_coefficient": ("1", "inertia coefficient that the inertia force alone shows"),
    "effective_inertia_coefficient": ("1", "inertia coefficient that inertia and Magnus force show together"),
    "drag_coefficient": ("1", "drag coefficient"),
    "circulation": ("m2/s", "circulation, positive clockwise in axes of the section"),
    "settled_circulation": ("m2/s", "circulation gamma vx vy T that the law gives, counted or not"),
    "laminar_circulation": ("m2/s", "circulation at the edge of the laminar layer, 3 vx vy T"),
    "wet_share": ("1", "share of time and length under water"),
    "maximum_strip_force": ("N/m", "largest force per length along each axis of the section"),
    "maximum_force": ("N", "largest force on the member, by direction"),
    "force_deviation": ("N", "standard deviation of the force on the member"),
    "mean_force": ("N", "mean force on the member"),
    "maximum_total_force": ("N", "largest resultant force on the member"),
    "maximum_moment": ("N m", "largest moment about the middle of the member, by direction"),
    "maximum_total_force_of_realisation": ("N", "largest resultant force on the member in each realisation of the sea"),
    "seed_of_realisation": ("1", "seed of each realisation of the sea"),
    "maximum_end_force": ("N", "largest resultant at each end of the member, as it is held"),
    "maximum_bending_moment": ("N m", "largest bending moment in the member, as it is held"),
    "maximum_bending_moment_along": ("N m", "largest bending moment at each station along the member"),
    "maximum_end_force_of_realisation": ("N", "largest resultant at an end in each realisation of the sea"),
    "maximum_bending_moment_of_realisation": ("N m", "largest bending moment in each realisation of the sea"),
    "station": ("m", "where bending moments are taken, distance from the start of the member"),
    "inertia_end_force": ("N", "inertia force at the most loaded end, along the axes of the section"),
    "drag_end_force": ("N", "drag force at the most loaded end, along the axes of the section"),
    "magnus_end_force": ("N", "Magnus force at the most loaded end, along the axes of the section"),
    "inertia_bending_moment": ("N m", "bending moment of inertia forces where it is largest, by axis of the load"),
    "drag_bending_moment": ("N m", "bending moment of drag forces where it is largest, by axis of the load"),
    "magnus_bending_moment": ("N m", "bending moment of Magnus forces where it is largest, by axis of the load"),
    "surface_elevation": ("m", "surface above the middle of the member"),
    "force": ("N", "force on the member"),
    "inertia_force": ("N", "inertia force on the member"),
    "drag_force": ("N", "drag force on the member"),
    "magnus_force": ("N", "Magnus force on the member"),
    "arai_inertia_coefficient": ("1", "circulation of Arai et al., gamma = 0.936"),
    "otsuka_inertia_coefficient": ("1", "circulation of Otsuka and Ikeda, gamma = 1"),
    "chaplin_inertia_coefficient": ("1", "circulation of Chaplin, gamma = 1.036"),
    "planar_inertia_coefficient": (
        "1",
        "planar flow: laminar theory of a circle (KC below 1), ideal fluid of other sections, held",
    ),
    "laminar_inertia_coefficient": ("1", "laminar ceiling of the circulation, gamma = 3"),
    "arai_circulation": ("m2/s", "circulation of Arai et al., circular orbit"),
    "otsuka_circulation": ("m2/s", "circulation that Otsuka and Ikeda's formula amounts to"),
    "chaplin_circulation": ("m2/s", "circulation that Chaplin's formula amounts to"),
    "surface_angle": ("rad", "angle around the section from its first axis, counter-clockwise"),
    "surface_speed_ratio": ("1", "speed along the surface over that of the stream, potential flow with circulation"),
    "magnus_force_per_length": ("N/m", "amplitude of the Magnus force, circular orbit"),
    "near_surface_inertia_coefficient": ("1", "inertia coefficient under the free surface by potential theory"),
    "near_surface_change": ("1", "its departure from the ideal one, over the ideal one"),
    "radiation_ratio": ("1", "wave damping over omega rho A"),
    "phase": ("rad", "phase of the orbit"),
    "strip_keulegan_carpenter": ("1", "Keulegan-Carpenter number along the member"),
    "strip_reynolds": ("1", "Reynolds number along the member"),
}

# Texts, and numbers that count the entries along a dimension
LABELS: dict[str, str] = {
    "other_axis": "axis",
    "component": "component of the force",
}

# Names that a group holds whenever its analysis was run

#: What a group holds whenever its analysis was run to its end.
ALWAYS = {
    "/[^/]+/member": (
        "area width height length inclination principal_angle inertia_error strip_x strip_y strip_z outline_x "
        "outline_z axis_direction ideal_inertia_coefficient principal_inertia_coefficient"
    ),
    "/[^/]+/sweep": (
        "inertia_coefficient planar_inertia_coefficient laminar_inertia_coefficient circulation "
        "laminar_circulation magnus_force_per_length arai_inertia_coefficient arai_circulation "
        "chaplin_inertia_coefficient chaplin_circulation otsuka_inertia_coefficient otsuka_circulation"
    ),
    "/[^/]+/waves/[^/]+": (
        "period wave_height wavelength keulegan_carpenter coefficient_keulegan_carpenter reynolds beta "
        "orbit_ratio velocity_amplitude inertia_coefficient plain_inertia_coefficient "
        "effective_inertia_coefficient drag_coefficient circulation settled_circulation laminar_circulation "
        "maximum_force mean_force force_deviation maximum_total_force maximum_moment maximum_end_force "
        "maximum_bending_moment maximum_bending_moment_along maximum_strip_force strip_keulegan_carpenter "
        "strip_reynolds wet_share"
    ),
    "/[^/]+/time/[^/]+/[^/]+": (
        "surface_elevation force inertia_force inertia_end_force inertia_bending_moment drag_force drag_end_force "
        "drag_bending_moment magnus_force magnus_end_force magnus_bending_moment circulation"
    ),
    "/[^/]+/surface/[^/]+": "near_surface_inertia_coefficient near_surface_change radiation_ratio",
}
#: What one statement of a run writes: a group holds all of it or none.
TOGETHER = {
    "/[^/]+/waves/[^/]+": (
        (
            "maximum_total_force_of_realisation maximum_end_force_of_realisation "
            "maximum_bending_moment_of_realisation seed_of_realisation"
        ),
    ),
}

VOCABULARY = Vocabulary.of(
    "member",
    VARIABLES,
    labels=LABELS,
    always=ALWAYS,
    together=TOGETHER,
)
labelled = VOCABULARY.describe
