"""Names, units and meanings of everything that a curtain run writes; the one file that owns them."""

from __future__ import annotations

from moyai.core.vocabulary import Vocabulary
from moyai.structures.curtain.statics.steady_load import QUANTITIES

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "wave_amplitude": ("m", "amplitude of a component of the waves"),
    "wave_omega": ("rad/s", "angular frequency of a component of the waves"),
    "wave_wave_number": ("1/m", "wave number of a component of the waves"),
    "wave_heading": ("rad", "heading of the waves, or of a component of them"),
    "wave_phase": ("rad", "phase of a component of the waves"),
    # statics
    "span": ("m", "distance of the supports B"),
    "unstretched_length": ("m", "unstretched length of the curtain between the supports l"),
    "span_ratio": ("1", "span over unstretched length B/l"),
    "skirt_length": ("m", "unstretched length of the skirt L"),
    "hanging_length": ("m", "unstretched length of the part of the skirt that hangs"),
    "surface_speed": ("m/s", "surface speed of the current"),
    "weaker_current": ("m/s", "surface speed of a weaker current"),
    "normal_speed": ("m/s", "mean over the skirt of the current's component along the normal"),
    "flow_angle": ("rad", "angle of the current from the normal of the span"),
    "froude_number": ("1", "Froude number U/sqrt(gh)"),
    "load_ratio": ("1", "load of the current over the toe load, qL/W"),
    "drowning_speed": ("m/s", "surface speed that uses up the float reserve; infinite: not reached"),
    "joint_spacing": ("m", "largest distance of the joints"),
    "anchor_spacing": ("m", "largest distance of the anchors at the same span ratio"),
    "flooded_net_weight": ("N/m", "weight less buoyancy with flooded floats"),
    "flooded_sinks": ("1", "whether the flooded curtain sinks by itself"),
    "air_to_surface": ("m3/m", "air that lifts the flooded curtain again"),
    "holding_buoyancy": ("N/m", "upward force that holds the flooded curtain off the bed"),
    "drag_coefficient": ("1", "drag coefficient in use"),
    "blockage": ("1", "depth of the curtain over that of the water"),
    "effective_depth": ("m", "vertical reach of the skirt"),
    "flare": ("m", "downstream reach of the toe"),
    "toe_depth": ("m", "depth of the toe"),
    "toe_gap": ("m", "clearance between toe and bed"),
    "toe_speed": ("m/s", "mean speed under the toe"),
    "toe_speed_ratio": ("1", "mean speed under the toe over that of the undisturbed current there"),
    "toe_speed_undisturbed": ("m/s", "mean speed of the undisturbed current between toe and bed"),
    "section_load": ("N/m", "load of the current per length of curtain"),
    "top_load": ("N/m", "share of the load at the top"),
    "toe_hold": ("N/m", "share of the load at a held toe"),
    "top_pull": ("N/m", "downward pull of the skirt on its floats"),
    "sheet_tension": ("N/m", "largest tension of the skirt"),
    "cable_tension": ("N", "tension of all cables together"),
    "upper_tension": ("N", "tension of the upper cable"),
    "lower_tension": ("N", "tension of the lower cable"),
    "sag": ("m", "largest deflection in plan"),
    "strain": ("1", "strain of the cables"),
    "end_angle": ("rad", "larger angle between curtain and span at a support"),
    "anchor_horizontal_tension": ("N", "horizontal part of the tension at the anchor of an inner support"),
    "end_anchor_horizontal_tension": ("N", "horizontal force on the more loaded support of a lone span"),
    "anchor_tension": ("N", "tension of the anchor line of an inner support, straight from its anchor"),
    "float_reserve": ("N/m", "buoyancy left"),
    "float_reserve_ratio": ("1", "buoyancy left over buoyancy"),
    "slack_float_reserve_ratio": ("1", "buoyancy left over buoyancy at slack water"),
    "slack_float_reserve_ratio_low": ("1", "buoyancy left over buoyancy at slack water with the heaviest toe"),
    "slack_float_reserve_ratio_high": ("1", "buoyancy left over buoyancy at slack water with the lightest toe"),
    "slack_toe_gap": ("m", "clearance of the toe from the bed at slack water"),
    "planning_load": ("N", "load of the span by a planning formula"),
    "planning_drag_coefficient": ("1", "drag coefficient that the formula amounts to"),
    "planning_confirmed": ("1", "whether the formula was read in its source"),
    # the governing steady load and what stands next to it
    **{
        f"steady_{name}{end}": (unit, f"{words}, governing steady load{reported}")
        for name, unit, words in QUANTITIES
        for end, reported in (("", ""), ("_low", ", lower end of its band"), ("_high", ", upper end of its band"))
    },
    "steady_load_bound": ("N/m", "weights of toe and sheet: no load normal to the sheet can exceed it with a free toe"),
    "cause_line_load": ("N/m", "load per length with one thing varied"),
    "cause_cable_tension": ("N", "tension of all cables with one thing varied"),
    "cause_anchor_horizontal_tension": ("N", "horizontal force on an inner anchor with one thing varied"),
    "cause_effective_depth": ("m", "vertical reach of the skirt with one thing varied"),
    "compared_line_load": ("N/m", "load per length of curtain by the model"),
    "compared_span_load": ("N", "load of the span by the model"),
    "compared_ratio": ("1", "load by the model over the governing steady load"),
    "direction_span_load": ("N", "downstream load of one span with the current turned"),
    "direction_cable_tension": ("N", "tension of all cables with the current turned"),
    "direction_anchor_horizontal_tension": ("N", "horizontal force on an inner anchor with the current turned"),
    "steady_direction": ("rad", "angle of the current from the normal of the span"),
    # load laws
    "law_effective_depth": ("m", "vertical reach under the law"),
    "law_flare": ("m", "downstream reach of the toe under the law"),
    "law_top_tension": ("N/m", "tension at the top of the skirt under the law"),
    "law_horizontal_load": ("N/m", "downstream force on the top under the law"),
    "law_top_angle": ("rad", "angle of the skirt at its top under the law"),
    "law_section_x": ("m", "section under the law, downstream"),
    "law_section_z": ("m", "section under the law, height"),
    "law_plan_tension": ("N", "tension of all cables under the law"),
    "law_sag": ("m", "deflection at mid-span under the law"),
    "law_downstream_end_force": ("N", "downstream force on each support under the law"),
    "law_inward_end_force": ("N", "force along the span on each support under the law"),
    "law_plan_x": ("m", "plan under the law, downstream"),
    "law_plan_y": ("m", "plan under the law, along the span"),
    "line_load": ("N/m", "load per length of curtain that the laws of the plan share"),
    "pressure": ("N/m2", "pressure that the laws of the section share"),
    # equations of the paper
    "paper_cable_tension_inextensible": ("N", "tension of all cables, equation (6)"),
    "paper_cable_tension": ("N", "tension of all cables with stretch, equation (4)"),
    "paper_sag": ("m", "sag with stretch, equation (5)"),
    "paper_shape_number": ("1", "shape number b = B/2a with stretch"),
    "paper_skirt_tension": ("N/m", "tension of the skirt, equation (2)"),
    "paper_edge_load": ("N/m", "load on each cable, equation (3)"),
    "paper_skirt_radius": ("m", "radius of the skirt's arc"),
    "paper_skirt_sagitta": ("m", "sagitta of the skirt's arc"),
    "chord": ("m", "straight distance of the skirt's edges"),
    # shapes
    "section_x": ("m", "section, downstream of the top"),
    "section_z": ("m", "section, height above still water"),
    "section_tension": ("N/m", "tension along the skirt"),
    "section_angle": ("rad", "angle of the skirt from the vertical"),
    "on_bed_x": ("m", "part of the skirt on the bed, downstream of the top"),
    "on_bed_z": ("m", "part of the skirt on the bed, height"),
    "profile_z": ("m", "height above still water"),
    "profile_speed": ("m/s", "current along the normal"),
    "plan_x": ("m", "plan, downstream of the line between the supports"),
    "plan_y": ("m", "plan, along the span from the first support"),
    "plan_angle": ("rad", "angle between curtain and span"),
    **{
        f"{end}_{axis}": ("m", f"{end} end of the anchor line, {axis}")
        for end in ("anchor", "float")
        for axis in ("x", "y", "z")
    },
    # impact
    "impact_time": ("s", "from taut to the peak"),
    "impact_upper_tension": ("N", "largest tension of the upper cable"),
    "impact_lower_tension": ("N", "largest tension of the lower cable"),
    "impact_skirt_tension": ("N/m", "largest tension of the skirt"),
    "impact_ratio": ("1", "tension over that of model A"),
    "counts": ("1", "whether the model is used in the load table"),
    "start_speed": ("m/s", "speed of the curtain when it becomes taut"),
    "draught": ("m", "depth of the skirt as a flat plate"),
    "added_mass": ("kg/m", "added mass of the paper, 2 rho d^2/pi"),
    "added_mass_in_depth": ("kg/m", "added mass of the flat skirt in this depth"),
    "taut_sag": ("m", "sag of the just-taut cable"),
    "shape_number": ("1", "shape number b of the just-taut cable"),
    "cable_stiffness": ("N", "EA of model A"),
    "tension_coefficient": ("1", "C_T = T/(rho U^2 B d/2)"),
    "cauchy_number": ("1", "C_E = sqrt(EA/rho)/(h sqrt(gh))"),
    "rise_ratio": ("1", "rise of the tension over √(d/g)"),
    "relative_step": ("1", "omega dt of the marching"),
    "time_step": ("s", "time step of the marching"),
    "spread": ("1", "largest over smallest tension of the models"),
    "design_tension": ("N", "tension of the model that the load table takes"),
    "steps_to_peak": ("1", "steps from taut to the peak"),
    "march_tension": ("N", "peak of the marching scheme"),
    "march_error": ("1", "marched peak over the exact one, less 1"),
    "march_predicted_error": ("1", "-(pi/8) omega dt, for a linear spring"),
    "forward_iteration_converges": ("1", "whether the paper's iteration of one step converges"),
    "reverse_iteration_converges": ("1", "whether the reverse iteration converges"),
    "displacement": ("m", "mid-span from its just-taut place, downstream"),
    "speed": ("m/s", "speed of mid-span"),
    "tension": ("N", "sum of the tensions of both cables"),
    "upper_displacement": ("m", "upper edge at mid-span from its just-taut place"),
    "lower_displacement": ("m", "lower edge at mid-span from its just-taut place"),
    "position": ("m", "mid-span downstream of the line between the supports"),
    "frame_time": ("s", "time of a picture"),
    "frame_position": ("m", "mid-span downstream of the line between the supports"),
    "frame_tension": ("N", "sum of the tensions of both cables"),
    "frame_plan_x": ("m", "plan, downstream of the line between the supports"),
    "frame_plan_y": ("m", "plan, along the span from the first support"),
    "frame_section_x": ("m", "section at mid-span, downstream of the line between the supports"),
    "frame_section_z": ("m", "section at mid-span, height above still water"),
    # record
    "record_tension": ("N", "tension of a cable in the record, without offset and drift"),
    "release_time": ("s", "when the curtain was released"),
    "taut_time": ("s", "when the cables become taut"),
    "peak_time": ("s", "when their sum is largest"),
    "plateau_start": ("s", "from when on the sum stays at its plateau"),
    "rise_time": ("s", "from taut to the peak"),
    "peak_missed": ("1", "largest share of the peak that the sampling may have missed"),
    "cable_peak_tension": ("N", "largest tension of a cable"),
    "cable_plateau_tension": ("N", "plateau of a cable"),
    "cable_impact_tension": ("N", "peak of a cable above its plateau"),
    "cable_noise": ("N", "standard deviation of the noise"),
    "record_ratio": ("1", "impact tension of the model over that of the record"),
    "record_time_ratio": ("1", "rise time of the model over that of the record"),
    "record_upper_ratio": ("1", "upper cable of model A2 over the record"),
    "record_lower_ratio": ("1", "lower cable of model A2 over the record"),
    "memory_force": ("N/m", "force of the waves that the impact made"),
    # waves
    "period": ("s", "wave period"),
    "velocity_amplitude": ("m/s", "amplitude of the water's speed along the normal, mean over the skirt"),
    "water_excursion": ("m", "double amplitude of the water's travel"),
    "threshold_water_excursion": ("m", "double amplitude below which the curtain never becomes taut without a current"),
    "both_cables_tension_maximum": (
        "N",
        "sum of the tensions of both cables: largest that repeats, mean of the largest of 100 periods or realisations",
    ),
    "both_cables_tension_maximum_low": ("N", "least of the largest tensions of 100 periods or of the realisations"),
    "lower_wave_tension": ("N", "largest tension of waves of half to nine tenths of the height, both cables together"),
    "judged_tension": (
        "N",
        "tension at which limits are judged: the end of the 95 % interval of a mean, lower waves too",
    ),
    "strong_drag_tension": ("N", "judged tension with the drag coefficient at the upper end of its range"),
    "lower_wave_height": ("m", "height of the wave in which it occurs"),
    "both_cables_tension_maximum_high": ("N", "largest of the largest tensions of 100 periods or of the realisations"),
    "periods_left_out": ("1", "periods left out at the start"),
    "periods_analysed": ("1", "periods that count"),
    "repeats_after": ("1", "periods after which the motion repeats; none: it does not"),
    "realisations": ("1", "realisations of the sea"),
    "realisation_tension": ("N", "largest tension of each realisation"),
    "left_out": ("s", "time left out at the start of each realisation"),
    "model_role": ("", "whether a model governs, is a bound, a comparison or out of range"),
    "model_of": ("", "what a model gives"),
    "model_reason": ("", "why it has that role"),
    "model_value": ("1", "number that decides the role"),
    "model_limit": ("1", "limit of that number"),
    "both_cables_tension_mean": ("N", "mean of the sum of the tensions of both cables"),
    "first_contact_tension": ("N", "largest tension of the first contacts"),
    "later_contact_tension": ("N", "largest tension of the later contacts"),
    "largest_contact_speed": ("m/s", "speed at which the largest contact began"),
    "contact_count": ("1", "times that the slack curtain or line comes taut in the analysed time"),
    "first_contact_count": ("1", "first contacts in the analysed time"),
    "contacts_per_hour": ("1/h", "contacts per hour"),
    "closed_form_tension": ("N", "peak of model A at the speed of the largest first contact"),
    "significant_height": ("m", "significant wave height"),
    "weibull_shape": ("1", "shape of the fitted Weibull distribution"),
    "weibull_scale": ("N", "scale of the fitted Weibull distribution"),
    "weibull_threshold": ("N", "threshold of the fitted Weibull distribution"),
    "contact_tension_sorted": ("N", "tensions of the first contacts, largest first"),
    "exceedance": ("1", "share of the contacts above the tension"),
    "fitted_exceedance": ("1", "share above the tension by the fit"),
    "snaps_per_hour": ("1/h", "first contacts per hour"),
    "taut_share": ("1", "share of the time in which the cables are taut"),
    "analysed_hours": ("h", "analysed time"),
    "most_probable_maximum": ("N", "most probable largest tension in the hours of the settings"),
    "most_probable_maximum_low": ("N", "lower bound of 95 % of the most probable largest tension"),
    "most_probable_maximum_high": ("N", "upper bound of 95 % of the most probable largest tension"),
    "flow_speed": ("m/s", "speed of the water along the normal, current and waves"),
    "contact_time": ("s", "when the cables become taut"),
    "contact_speed": ("m/s", "speed of mid-span at that instant"),
    "contact_tension": ("N", "largest tension until they are slack again"),
    "contact_side": ("1", "1 downstream, -1 upstream"),
    "contact_first": ("1", "whether it is the first on its side"),
    # anchor loads
    "wave_period": ("s", "wave period"),
    "wave_angle": ("rad", "angle of the waves from the normal"),
    "effective_height": ("m", "height that acts on the curtain"),
    "squared_velocity": ("m2/s2", "depth mean of the squared velocity under the crest"),
    "mean_squared_velocity": ("m2/s2", "depth and time mean of the squared velocity"),
    "orbital_speed": ("m/s", "largest horizontal wave velocity at the surface"),
    "float_speed": ("m/s", "largest speed of the float"),
    "rope_tension": ("N", "rise of the rope's tension without pretension"),
    "rope_tension_pretensioned": ("N", "rise of the rope's tension with the steady tension"),
    "wire_tension": ("N", "rise of the wire's tension"),
    "total_rope_tension": ("N", "largest tension of the rope, steady part included"),
    "conventional_tension": ("N", "rise of the rope's tension of the conventional type"),
    "rule_height": ("m", "height that acts, by the direction rule"),
    "rule_squared_velocity": ("m2/s2", "squared velocity by the direction rule"),
    "rule_tension": ("N", "rise of the rope's tension by the direction rule"),
    "angle": ("rad", "angle of the waves from the normal"),
    "angle_tension": ("N", "rise of the rope's tension against the angle"),
    "height": ("m", "significant wave height"),
    "height_tension": ("N", "rise of the rope's tension against the height"),
    "height_squared_velocity": ("m2/s2", "squared velocity against the height"),
    "energy_factor": ("1", "energy factor M"),
    "float_mass": ("kg", "mass of the float per anchor rope m_B"),
    "rope_stiffness": ("N/m", "stiffness of the rope K"),
    "mass_product": ("kg", "M m_B, the only product that tensions determine with K known"),
    "pretension": ("N", "steady tension of the rope"),
    "response_time": ("s", "period of the float on its rope"),
    # limits and loads
    "limit_height": ("m", "largest permissible significant height of all components in currents up to this speed"),
    "limit_height_alone": ("m", "largest permissible significant height of all components in this current alone"),
    "design_limit_height": ("m", "largest significant height in currents up to that of the case"),
    "rose_height": ("m", "largest permissible significant height of all components, by orientation and wave heading"),
    "sea_rose_height": ("m", "largest permissible significant height of all components in waves of the sea's heading"),
    "sea_heading": ("rad", "heading of the sea"),
    "sea_height": ("m", "significant height of the sea"),
    "held_ratio": ("1", "height held over that of the sea, worst sea"),
    "orientation": ("rad", "heading of the normal of the curtain"),
    "design_limit_low": ("m", "the same with impact, snaps and depth at their unfavourable ends"),
    "design_limit_scatter": (
        "m",
        "standard deviation of that height over other seeds of its seas",
    ),
    "speed_limit_low": ("m/s", "largest surface speed without waves at the upper end of drag or impact"),
    "speed_limit_high": ("m/s", "largest surface speed without waves at the lower end of drag or impact"),
    "speed_limit_ratio": ("1", "largest surface speed without waves over the current of the case"),
    "limit_factored_utilisation": ("1", "largest load times safety factor over strength of all components"),
    "component_factored_utilisation": ("1", "load times safety factor over strength of each component"),
    "speed_limit": ("m/s", "largest surface speed without waves"),
    "steady_load": ("", "steady load"),
    "steady_low": ("", "steady load at the lower end of its band"),
    "steady_high": ("", "steady load at the upper end of its band"),
    "governing_high": ("", "governing load with the upper ends of its parts, or of the mean of realisations"),
    "case_load": ("", "governing load in the current of the case"),
    "case_high": ("", "governing load in the current of the case at its upper end"),
    "wave_high": ("", "what waves add to the steady load at the end at which they are judged"),
    "weaker_load": ("", "load in a weaker current in which the plate governs, judged with that of the case"),
    "weaker_high": ("", "load in a weaker current at its upper end"),
    "factored_utilisation_high": ("1", "governing load at the upper end times safety factor over capacity"),
    "wave_load": ("", "what waves add to the steady load"),
    "second_wave_load": ("", "what waves add to the steady load by the model that does not lead"),
    "impact_load": ("", "what an impact adds to the steady load"),
    "impact_low": ("", "what an impact adds at the lower end of its band"),
    "impact_high": ("", "what an impact adds at the upper end of its band"),
    "dynamic_load": ("", "highest tension in the runs of the whole span"),
    "governing_load": (
        "",
        "load of the whole span where it was run, else the steady load with the larger of wave and impact",
    ),
    "load_bound": ("", "whether the governing load is only a bound"),
    "capacity": ("", "strength"),
    "safety_factor": ("1", "safety factor asked"),
    # the whole span through time
    "line_tension_peak_since_row": (
        "N",
        "highest tension of each cable over the span and of each anchor line since the row before",
    ),
    "both_cables_tension_peak_since_row": ("N", "sum of the highest tensions of both cables"),
    "kinetic_energy": ("J", "kinetic energy of the span and of the water that it moves"),
    "elastic_energy": ("J", "elastic energy of cables, skirt and lines"),
    "energy_balance": ("J", "energy less work since the start: minus what viscosity and scheme took"),
    "mid_span_x": ("m", "mid-span of the upper edge, downstream"),
    "mid_toe_x": ("m", "mid-span of the toe, downstream"),
    "mid_toe_z": ("m", "mid-span of the toe, height"),
    "line_tension_maximum": ("N", "highest tension"),
    "line_peak_time": ("s", "when the tension is highest"),
    "slack_share": ("1", "part of the time that the line is slack"),
    "slack_level": ("N", "tension up to which the line is slack"),
    "median_rise_time": ("s", "median rise of the snaps, from a tenth to nine tenths"),
    "both_cables_peak_time": ("s", "time at which it occurs"),
    "upper_peak": ("N", "highest tension of the upper cable"),
    "lower_peak": ("N", "highest tension of the lower cable"),
    "anchor_line_tension_maximum": ("N", "highest tension of an anchor line"),
    "run_of": ("", "run that was made on this and another mesh"),
    "event_peak": ("N", "highest tension in the event; larger of the means over the realisations on each mesh"),
    "event_peak_low": ("N", "lowest of the highest tensions in the runs of the event"),
    "event_peak_high": ("N", "highest tension in all runs of the event"),
    "event_peak_judged": ("N", "upper end of the one-sided 95 % interval of the mean over the realisations"),
    "event_peak_ceiling": ("N", "judged end, the change from mesh to mesh extrapolated"),
    "event_peak_open": ("", "what leaves the highest tension in the event open upwards: mesh or one realisation"),
    "event_peak_mesh_change": ("1", "change of the mean from one mesh to the other, over the larger"),
    "event_realisations": ("1", "realisations of the sea of the event"),
    "sample_peak": ("N", "highest tension in one run of an event"),
    "sample_seed": ("1", "seed of the sea; 0 where there is no chance in the event"),
    "skirt_peak": ("N/m", "highest principal tension of the skirt"),
    "half_step_peak": ("N", "highest sum of the cables at half the step"),
    "half_mesh_peak": ("N", "highest sum of the cables with half as many cells both ways"),
    "double_viscosity_peak": ("N", "highest sum of the cables with twice the viscosity"),
    "held_normals_peak": ("N", "highest sum of the cables with sections that keep the normals of the just-taut span"),
    "line_half_step": ("N", "highest tension at half the step"),
    "line_half_mesh": ("N", "highest tension with half as many cells both ways"),
    "line_double_viscosity": ("N", "highest tension with twice the viscosity"),
    "line_extrapolated": ("N", "highest tension to which both meshes point"),
    "line_held_normals": ("N", "highest tension with sections that keep the normals of the just-taut span"),
    "extrapolated_peak": ("N", "highest sum of the cables to which both meshes point"),
    "dynamic_model_tension": ("N", "peak of both cables by a model of the impact at the start speed"),
    "node_position": ("m", "places of the nodes, axes of the span"),
    "bar_tension": ("N", "tensions of the bars"),
    "triangle_tension": ("N/m", "higher principal tension of the skirt's triangles"),
    "seed": ("1", "seed of the realisation"),
    "bar_nodes": ("1", "nodes of the bar"),
    "triangle_nodes": ("1", "nodes of the triangle"),
}
"""Loads of the table have the unit of their row, in ``load_unit``."""

# Texts, and numbers that count the entries along a dimension
LABELS: dict[str, str] = {
    "bar_line": "cable or line that the bar belongs to",
    "drag_case": "end of the range of the drag coefficient",
    "section_law": "load law of the section",
    "plan_law": "load law of the plan",
    "steady_model": "model of the steady load",
    "steady_cause": "what is varied",
    "compared_why": "why the model has that standing",
    "compared_standing": "standing of the model",
    "planning_formula": "planning formula",
    "model": "model",
    "wave_source": "where the wave load is from",
    "second_wave_source": "where the wave load of the model that does not lead is from",
    "impact_source": "where the impact load is from",
    "dynamic_source": "where the load of the whole span is from",
    "case_governing": "what the governing load in the current of the case is made of",
    "case_bound": "whether the load in the current of the case is a bound",
    "governing_source": "where the governing load in a weaker current is from",
    "weaker_source": "where the load in a weaker current is from",
    "governing": "what the governing load is made of",
    "load_unit": "unit of the loads of the component",
    "rose_governing": "what governs the limit of the rose",
    "rose_bound": "whether the limit of the rose is only a bound",
    "sea_rose_governing": "what governs the limit in that sea",
    "limit_bound": "whether the limit is only a bound",
    "limit_component": "component that limits",
    "limit_governing": "what governs the limit",
    "limit_note": "note on the limit",
    "assumption": "what the model assumes",
    "dynamic_model": "model of the impact",
    "event": "sea, period of regular waves, or snap",
    "span_component": "component of the whole span (the skirt in N/m)",
    "sample_event": "event of the run",
    "sample_cells": "cells along the span by cells over the skirt",
    "impact_model": "model of the impact",
    "sea": "sea state",
    "component": "component",
    "cable": "cable",
    "direction_rule": "rule of the direction",
}

#: Other runs of the whole span through time, and of each of its cables and lines.
TRIALS = ("half_step", "half_mesh", "extrapolated", "double_viscosity", "held_normals")
#: Groups of runs of the whole span: the name of one in a weaker current ends in "m/s".
_RUN = "/[^/]+/dynamic/[^/]+(/s)?"
#: Names that a group holds whenever its analysis was run to its end.
ALWAYS = {
    "/record": (
        "record_tension cable_peak_tension cable_plateau_tension cable_impact_tension cable_noise release_time "
        "taut_time peak_time plateau_start rise_time both_cables_peak_tension both_cables_plateau_tension "
        "both_cables_impact_tension peak_missed"
    ),
    "/[^/]+/models": "model_role model_of model_reason model_value model_limit",
    "/[^/]+/statics": (
        "span unstretched_length span_ratio skirt_length surface_speed normal_speed flow_angle froude_number "
        "load_ratio drowning_speed joint_spacing anchor_spacing slack_toe_gap slack_float_reserve_ratio "
        "slack_float_reserve_ratio_low slack_float_reserve_ratio_high flooded_net_weight flooded_sinks "
        "air_to_surface holding_buoyancy drag_coefficient blockage hanging_length effective_depth flare toe_depth "
        "toe_gap toe_speed toe_speed_ratio toe_speed_undisturbed section_load top_load toe_hold top_pull "
        "sheet_tension cable_tension upper_tension lower_tension sag strain end_angle anchor_horizontal_tension "
        "end_anchor_horizontal_tension anchor_tension float_reserve float_reserve_ratio planning_load "
        "planning_drag_coefficient planning_confirmed steady_load_bound cause_line_load cause_cable_tension "
        "cause_anchor_horizontal_tension cause_effective_depth compared_line_load compared_span_load compared_ratio "
        "compared_standing compared_why direction_span_load direction_cable_tension "
        "direction_anchor_horizontal_tension "
        + " ".join(f"steady_{name} steady_{name}_low steady_{name}_high" for name, _, _ in QUANTITIES)
    ),
    "/[^/]+/statics_laws": (
        "pressure line_load law_effective_depth law_flare law_top_tension law_horizontal_load law_top_angle "
        "law_section_x law_section_z"
    ),
    "/[^/]+/statics_paper": (
        "paper_cable_tension_inextensible paper_cable_tension paper_sag paper_shape_number chord paper_skirt_tension "
        "paper_edge_load paper_skirt_radius paper_skirt_sagitta"
    ),
    "/[^/]+/section": "section_x section_z section_tension section_angle profile_z profile_speed",
    "/[^/]+/plan": "plan_x plan_y plan_angle",
    "/[^/]+/impact": (
        "both_cables_impact_tension impact_time impact_upper_tension impact_lower_tension impact_skirt_tension "
        "impact_ratio assumption counts start_speed draught added_mass added_mass_in_depth taut_sag shape_number "
        "cable_stiffness tension_coefficient cauchy_number froude_number rise_ratio relative_step time_step "
        "both_cables_plateau_tension spread design_tension steps_to_peak march_tension march_error "
        "march_predicted_error forward_iteration_converges reverse_iteration_converges"
    ),
    "/[^/]+/impact/A": "displacement speed tension",
    "/[^/]+/impact/A2": "tension upper_tension lower_tension",
    "/[^/]+/impact/memory": "displacement speed tension memory_force",
    "/[^/]+/impact/snap": (
        "position speed tension frame_time frame_position frame_tension frame_plan_x frame_plan_y frame_section_x "
        "frame_section_z"
    ),
    "/[^/]+/waves/[^/]+": (
        "both_cables_tension_maximum both_cables_tension_maximum_low both_cables_tension_maximum_high "
        "both_cables_tension_mean later_contact_tension contact_count first_contact_count"
    ),
    "/[^/]+/waves/[^/]+/[^/]+": (
        "flow_speed position speed tension contact_time contact_speed contact_tension contact_side contact_first"
    ),
    "/[^/]+/weaker_currents": "both_cables_tension_maximum both_cables_tension_maximum_low judged_tension",
    "/[^/]+/anchor_loads": (
        "significant_height wave_period wave_angle effective_height squared_velocity mean_squared_velocity "
        "orbital_speed float_speed rope_tension rope_tension_pretensioned wire_tension total_rope_tension "
        "conventional_tension rule_height rule_squared_velocity rule_tension angle_tension height height_tension "
        "height_squared_velocity energy_factor float_mass rope_stiffness mass_product pretension response_time"
    ),
    "/[^/]+/loads": (
        "steady_load steady_low steady_high wave_load wave_high wave_source second_wave_load second_wave_source "
        "impact_load impact_low impact_high impact_source dynamic_load dynamic_source governing_load governing_high "
        "governing governing_source load_bound load_unit capacity safety_factor factored_utilisation "
        "factored_utilisation_high case_load case_high case_governing case_bound weaker_load weaker_high "
        "weaker_source"
    ),
    "/[^/]+/limits": (
        "limit_height limit_governing limit_bound limit_height_alone limit_note limit_factored_utilisation "
        "limit_component component_factored_utilisation surface_speed speed_limit speed_limit_low speed_limit_high "
        "speed_limit_ratio drowning_speed design_limit_height design_limit_low design_limit_scatter"
    ),
    "/[^/]+/limits/rose": "rose_height rose_governing rose_bound",
    "/[^/]+/dynamic": (
        "both_cables_tension_maximum both_cables_peak_time upper_peak lower_peak anchor_line_tension_maximum "
        "skirt_peak " + " ".join(f"{trial}_peak" for trial in TRIALS)
    ),
    _RUN: (
        "line_tension_peak_since_row both_cables_tension_peak_since_row kinetic_energy elastic_energy "
        "energy_balance mid_span_x mid_toe_x mid_toe_z line_tension_maximum line_peak_time slack_share "
        "contact_count snap_count slack_level snap_threshold median_rise_time "
        + " ".join(f"line_{trial}" for trial in TRIALS)
    ),
    f"{_RUN}/frames": ("node_position bar_tension triangle_tension bar_nodes triangle_nodes frame_time bar_line"),
}
#: What one statement of a run writes: a group holds all of it or none.
TOGETHER = {
    # a curtain that is longer than its span has laws of its plan
    "/[^/]+/statics_laws": (
        "law_plan_tension law_sag law_downstream_end_force law_inward_end_force law_plan_x law_plan_y",
    ),
    "/[^/]+/section": ("on_bed_x on_bed_z",),
    "/[^/]+/plan": ("float_x float_y float_z anchor_x anchor_y anchor_z",),
    "/[^/]+/impact": ("record_ratio record_time_ratio record_upper_ratio record_lower_ratio",),
    "/[^/]+/waves/[^/]+": (
        (
            "period velocity_amplitude water_excursion threshold_water_excursion first_contact_tension "
            "largest_contact_speed closed_form_tension periods_left_out periods_analysed repeats_after "
            "lower_wave_tension lower_wave_height judged_tension"
        ),
        (
            "significant_height realisations contacts_per_hour snaps_per_hour taut_share weibull_shape weibull_scale "
            "weibull_threshold analysed_hours left_out most_probable_maximum most_probable_maximum_low "
            "most_probable_maximum_high contact_tension_sorted exceedance fitted_exceedance realisation_tension"
        ),
    ),
    "/[^/]+/limits/rose": ("sea_rose_height sea_rose_governing sea_heading sea_height held_ratio",),
    "/[^/]+/dynamic": (
        (
            "run_of event_peak event_peak_low event_peak_high event_peak_judged event_peak_ceiling "
            "event_peak_mesh_change event_peak_open event_realisations sample_peak sample_event sample_cells "
            "sample_seed"
        ),
    ),
    f"{_RUN}/frames": ("wave_amplitude wave_omega wave_wave_number wave_heading wave_phase",),
}

VOCABULARY = Vocabulary.of(
    "curtain",
    VARIABLES,
    labels=LABELS,
    always=ALWAYS,
    together=TOGETHER,
)
labelled = VOCABULARY.describe
