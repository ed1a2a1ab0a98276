"""A made-up but plausible result of a silt curtain in the documented layout, to try the report on.

Shapes are catenaries and parabolas with invented loads; nothing here is physics to rely on.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from moyai.core.results import Result, make_provenance
from moyai.core.validity import IdentityCheck, Notice
from moyai.structures.curtain.headlines import curtain_headlines
from moyai.structures.curtain.statics.steady_load import QUANTITIES
from moyai.structures.curtain.variables import VOCABULARY

DRAG = ["low", "given", "high"]
COMPONENTS = ["upper cable", "lower cable", "skirt", "joint", "float", "anchor line", "anchor"]
SPAN, LENGTH, SKIRT, DEPTH = 20.0, 23.0, 5.0, 8.0
CASE_TEXT = "# Curtain at the outfall (汚濁防止膜)\nmoyai: 1\ntitle: Curtain at the outfall\n"


def v(dims: Any, values: Any, units: str = "1", long_name: str = "quantity") -> xr.Variable:
    return xr.Variable(dims, np.asarray(values), {"units": units, "long_name": long_name})


def section(flare: float) -> tuple[np.ndarray, np.ndarray]:
    z = -np.linspace(0.0, np.sqrt(SKIRT**2 - flare**2), 41)
    return flare * (z / z[-1]) ** 1.6, z


def plan(sag: float) -> tuple[np.ndarray, np.ndarray]:
    y = np.linspace(0.0, SPAN, 41)
    return 4.0 * sag * y * (SPAN - y) / SPAN**2, y


def statics(factor: float) -> xr.Dataset:
    spread = np.array([0.8, 1.0, 1.3]) * factor
    scalars = {
        "span": (SPAN, "m"), "unstretched_length": (LENGTH, "m"), "span_ratio": (SPAN / LENGTH, "1"),
        "skirt_length": (SKIRT, "m"), "surface_speed": (0.3, "m/s"), "normal_speed": (0.26, "m/s"),
        "flow_angle": (0.35, "rad"), "froude_number": (0.034, "1"), "load_ratio": (1.2, "1"),
        "drowning_speed": (0.62, "m/s"), "joint_spacing": (18.0, "m"), "anchor_spacing": (24.0, "m"),
        "flooded_net_weight": (40.0, "N/m"), "flooded_sinks": (1, "1"), "air_to_surface": (0.02, "m3/m"),
        "holding_buoyancy": (200.0, "N/m"),
    }  # fmt: skip
    cases = {
        "drag_coefficient": ([1.0, 1.3, 1.7], "1"), "blockage": ([0.5, 0.52, 0.55], "1"),
        "effective_depth": (4.6 - 0.5 * spread, "m"), "flare": (1.6 * spread, "m"),
        "toe_depth": (4.6 - 0.5 * spread, "m"),
        "toe_gap": (DEPTH - 4.6 + 0.5 * spread, "m"), "toe_speed": (0.5 * spread, "m/s"),
        "toe_speed_ratio": (1.8 * spread, "1"), "section_load": (260 * spread, "N/m"),
        "top_load": (140 * spread, "N/m"),
        "toe_hold": (120 * spread, "N/m"), "top_pull": (300 * spread, "N/m"), "sheet_tension": (310 * spread, "N/m"),
        "cable_tension": (5200 * spread, "N"), "upper_tension": (2800 * spread, "N"),
        "lower_tension": (2400 * spread, "N"), "sag": (5.6 * spread**0.1, "m"), "strain": (2e-4 * spread, "1"),
        "end_angle": (0.8 * spread**0, "rad"), "anchor_force": (4700 * spread, "N"),
        "end_anchor_force": (2500 * spread, "N"), "anchor_line_tension": (5100 * spread, "N"),
        "float_reserve": (400 - 150 * spread, "N/m"), "float_reserve_ratio": (0.5 - 0.2 * spread, "1"),
    }  # fmt: skip
    steady = {
        f"steady_{name}{end}": v((), 1e3 * share * factor if unit != "1" else 0.3, unit)
        for name, unit, _ in QUANTITIES
        for end, share in (("", 1.0), ("_low", 0.8), ("_high", 1.3))
    }
    return xr.Dataset(
        {
            **steady,
            **{name: v((), value, unit, name.replace("_", " ")) for name, (value, unit) in scalars.items()},
            **{name: v("drag_case", value, unit, name.replace("_", " ")) for name, (value, unit) in cases.items()},
            "planning_load": v("planning_formula", [8200.0, 31400.0, 9000.0], "N"),
            "planning_drag_coefficient": v("planning_formula", [1.88, 7.2, np.nan]),
            "planning_confirmed": v("planning_formula", [1, 0, 0]),
        },
        {"drag_case": DRAG, "planning_formula": ["us_navy", "itopf", "tow_trials"]},
        attrs={"curtain_class": "C", "class_for_site": "B"},
    )


def laws() -> xr.Dataset:
    names, plans = ["catenary", "circular", "rigid", "elastic"], ["catenary", "circular", "small sag", "elastic"]
    flares, sags = [1.6, 1.9, 1.3, 1.65], [5.4, 5.6, 5.2, 5.5]
    shapes, tops = [section(flare) for flare in flares], [plan(sag) for sag in sags]
    return xr.Dataset(
        {
            "law_effective_depth": v("section_law", [-float(z[-1]) for _, z in shapes], "m"),
            "law_flare": v("section_law", flares, "m"),
            "law_top_tension": v("section_law", [300, 320, 290, 302], "N/m"),
            "law_horizontal_load": v("section_law", [250, 262, 240, 251], "N/m"),
            "law_top_angle": v("section_law", [0.3, 0.35, 0.27, 0.3], "rad"),
            "law_section_x": v(("section_law", "law_point"), [x for x, _ in shapes], "m"),
            "law_section_z": v(("section_law", "law_point"), [z for _, z in shapes], "m"),
            "law_plan_tension": v("plan_law", [5200, 5900, 5000, 5150], "N"),
            "law_sag": v("plan_law", sags, "m"),
            "law_downstream_end_force": v("plan_law", [2600, 2600, 2600, 2590], "N"),
            "law_inward_end_force": v("plan_law", [4500, 5300, 4300, 4450], "N"),
            "law_plan_x": v(("plan_law", "law_point"), [x for x, _ in tops], "m"),
            "law_plan_y": v(("plan_law", "law_point"), [y for _, y in tops], "m"),
            "line_load": v((), 260.0, "N/m"),
            "pressure": v((), 55.0, "N/m2"),
        },
        {"section_law": names, "plan_law": plans},
    )


def impact(factor: float) -> dict[str, xr.Dataset]:
    names = [
        "A marched",
        "A",
        "A closed form",
        "A in this depth",
        "A2",
        "B literal",
        "B energy_mid",
        "B energy_proj",
        "AB",
    ]
    tension = np.array([20.9, 21.0, 21.2, 21.1, 20.6, 4.0, 16.0, 18.5, 19.0]) * 1e3 * factor
    counts = [int(name != "B literal") for name in names]
    steps = np.array([1, 4, 16, 64, 256])
    main = xr.Dataset(
        {
            "impact_tension": v("impact_model", tension, "N"),
            "impact_time": v("impact_model", [0.2] * 4 + [np.nan, 0.05, 0.06, 0.06, 0.18], "s"),
            "impact_upper_tension": v("impact_model", 0.47 * tension, "N"),
            "impact_lower_tension": v("impact_model", 0.53 * tension, "N"),
            "impact_skirt_tension": v("impact_model", [np.nan] * 5 + [90, 372, 447, 300], "N/m"),
            "impact_ratio": v("impact_model", tension / tension[1]),
            "assumption": v("impact_model", ["rigid flat skirt"] * 5 + ["skirt stretches"] * 3 + ["both stretch"]),
            "counts": v("impact_model", counts),
            **{
                name: v((), value, unit)
                for name, value, unit in (
                    ("start_speed", 0.24, "m/s"), ("draught", 4.1, "m"), ("added_mass", 10900.0, "kg/m"),
                    ("added_mass_in_depth", 11100.0, "kg/m"), ("taut_sag", 5.1, "m"), ("shape_number", 0.9, "1"),
                    ("cable_stiffness", 2e6, "N"), ("tension_coefficient", 31.0, "1"), ("cauchy_number", 0.6, "1"),
                    ("froude_number", 0.03, "1"), ("rise_ratio", 0.31, "1"), ("relative_step", 0.015, "1"),
                    ("time_step", 0.001, "s"), ("plateau_tension", 5200.0, "N"), ("spread", 1.32, "1"),
                    ("design_tension", 21000.0 * factor, "N"),
                )
            },
            "march_tension": v("march_step", 21e3 * (1 - 0.4 / steps), "N"),
            "march_error": v("march_step", -0.314 / steps),
            "march_predicted_error": v("march_step", -0.3 / steps),
            "forward_iteration_converges": v("march_step", [1, 0, 0, 0, 0]),
            "reverse_iteration_converges": v("march_step", [0, 1, 1, 1, 1]),
        },
        {"impact_model": names, "steps_to_peak": ("march_step", steps)},
        attrs={"design_model": "A", "start_speed_source": "slack phase"},
    )  # fmt: skip
    time = np.linspace(0.0, 0.4, 200)
    rise = np.sin(0.5 * np.pi * time / 0.2)
    series = {
        name: xr.Dataset(
            {
                "displacement": v("time", 0.05 * rise, "m"),
                "speed": v("time", 0.24 * np.cos(0.5 * np.pi * time / 0.2), "m/s"),
                "tension": v("time", 21e3 * factor * share * np.clip(rise, 0, None), "N"),
            },
            {"time": v("time", time, "s")},
        )
        for name, share in (("A", 1.0), ("A2", 0.98), ("memory", 1.02))
    }
    series["A2"] = series["A2"].assign(
        upper_tension=0.47 * series["A2"]["tension"], lower_tension=0.53 * series["A2"]["tension"]
    )
    return {"impact": main, **{f"impact/{name}": data for name, data in series.items()}, "impact/snap": snap(factor)}


def snap(factor: float) -> xr.Dataset:
    time = np.linspace(0.0, 60.0, 4000)
    taut, peak = 32.0, 32.2
    slack = np.minimum(time / taut, 1.0)
    late = np.clip(time - taut, 0.0, None)
    tension = np.where(
        time > taut, 5200 + 21e3 * factor * np.exp(-late / 1.5) * np.sin(0.5 * np.pi * late / 0.2).clip(0), 0.0
    )
    position = 5.1 * np.sin(0.5 * np.pi * slack) + np.where(time > taut, 2e-6 * tension, 0.0)
    frames = np.unique(np.concatenate([np.linspace(0, 60, 90), np.linspace(taut - 0.1, taut + 1.0, 80), [peak]]))
    at = np.interp(frames, time, position)
    curves = [plan(max(float(x), 1e-3)) for x in at]
    shapes = [section(1.5 * float(x) / 5.1) for x in at]
    return xr.Dataset(
        {
            "position": v("time", position, "m"),
            "speed": v("time", np.gradient(position, time), "m/s"),
            "tension": v("time", tension, "N"),
            "frame_position": v("frame", at, "m"),
            "frame_tension": v("frame", np.interp(frames, time, tension), "N"),
            "frame_plan_x": v(("frame", "plan_point"), [x for x, _ in curves], "m"),
            "frame_plan_y": v(("frame", "plan_point"), [y for _, y in curves], "m"),
            "frame_section_x": v(("frame", "section_point"), [x for x, _ in shapes], "m"),
            "frame_section_z": v(("frame", "section_point"), [z for _, z in shapes], "m"),
        },
        {"time": v("time", time, "s"), "frame_time": v("frame", frames, "s")},
        attrs={"taut_time": taut, "peak_time": peak},
    )


def waves(factor: float) -> dict[str, xr.Dataset]:
    period = np.array([4.0, 5.0, 6.0, 8.0])
    peak = np.array([0.0, 12e3, 18e3, 24e3]) * factor
    regular = xr.Dataset(
        {
            "velocity_amplitude": v("period", 0.1 * period, "m/s"), "excursion": v("period", 0.032 * period**2, "m"),
            "threshold_excursion": v("period", 10.2 + 0 * period, "m"), "maximum_tension": v("period", peak, "N"),
            "maximum_tension_low": v("period", peak, "N"), "maximum_tension_high": v("period", peak, "N"),
            "mean_tension": v("period", 0.1 * peak, "N"),
            "first_contact_tension": v("period", 0.98 * peak, "N"),
            "later_contact_tension": v("period", 0.4 * peak, "N"),
            "largest_contact_speed": v("period", 0.1 * period, "m/s"), "contact_count": v("period", [0, 30, 25, 19]),
            "first_contact_count": v("period", [0, 10, 10, 10]), "closed_form_tension": v("period", 1.05 * peak, "N"),
        },
        {"period": v("period", period, "s")},
    )  # fmt: skip
    rng = np.random.default_rng(2)
    time = np.linspace(0.0, 600.0, 12001)
    contact = np.sort(rng.choice(np.arange(20.0, 580.0, 6.0), 60, replace=False))
    load = np.sort(8e3 * factor * rng.weibull(1.6, 60) + 2e3)
    tension = np.zeros_like(time)
    for moment, value in zip(contact, rng.permutation(load)):
        tension += value * np.exp(-(((time - moment) / 0.15) ** 2))
    exceedance = 1.0 - (np.arange(60) + 0.6) / 60.2
    irregular = xr.Dataset(
        {
            "significant_height": v((), 1.2, "m"), "maximum_tension": v((), tension.max(), "N"),
            "maximum_tension_low": v((), 0.9 * tension.max(), "N"), "mean_tension": v((), tension.mean(), "N"),
            "maximum_tension_high": v((), 1.1 * tension.max(), "N"),
            "contact_count": v((), 60), "first_contact_count": v((), 41), "contacts_per_hour": v((), 360.0, "1/h"),
            "most_probable_maximum": v((), 26e3 * factor, "N"), "taut_share": v((), 0.1),
            "snaps_per_hour": v((), 360.0, "1/h"), "weibull_shape": v((), 1.6),
            "weibull_scale": v((), 8e3 * factor, "N"),
            "weibull_threshold": v((), 2e3, "N"),
            "contact_tension_sorted": v("snap", load, "N"), "exceedance": v("snap", exceedance),
            "fitted_exceedance": v("snap", np.exp(-(((load - 2e3) / (8e3 * factor)) ** 1.6))),
        }
    )  # fmt: skip
    run = xr.Dataset(
        {
            "flow_speed": v("time", 0.3 + 0.5 * np.sin(2 * np.pi * time / 6.1), "m/s"),
            "position": v("time", 5.0 * np.sin(2 * np.pi * time / 6.1), "m"),
            "speed": v("time", 5.0 * np.cos(2 * np.pi * time / 6.1), "m/s"),
            "tension": v("time", tension, "N"),
            "contact_time": v("contact", contact, "s"), "contact_speed": v("contact", 0.4 + 0 * contact, "m/s"),
            "contact_tension": v("contact", np.interp(contact, time, tension), "N"),
            "contact_side": v("contact", np.where(np.arange(60) % 3, 1, -1)),
            "contact_first": v("contact", (np.arange(60) % 3 > 0).astype(int)),
        },
        {"time": v("time", time, "s")},
        attrs={"period": 6.0, "time_step": 0.05, "duration": 600.0},
    )  # fmt: skip
    return {"waves/swell": regular, "waves/storm": irregular, "waves/storm/seed 1": run}


def anchor_loads() -> xr.Dataset:
    seas, rules = ["swell", "storm"], ["paper", "normal", "none"]
    angle, height = np.radians(np.linspace(0, 90, 31)), np.linspace(0.1, 3.0, 30)
    per_sea = {
        "significant_height": ([0.8, 1.2], "m"), "wave_period": ([6.0, 5.0], "s"), "wave_angle": ([0.2, 0.5], "rad"),
        "effective_height": ([1.4, 1.7], "m"), "squared_velocity": ([0.6, 1.1], "m2/s2"),
        "mean_squared_velocity": ([0.3, 0.5], "m2/s2"), "surface_speed": ([0.7, 1.0], "m/s"),
        "float_speed": ([1.6, 2.2], "m/s"), "rope_tension": ([15e3, 21e3], "N"),
        "rope_tension_pretensioned": ([9e3, 14e3], "N"), "wire_tension": ([9e3, 12.6e3], "N"),
        "total_rope_tension": ([14e3, 19e3], "N"), "conventional_tension": ([21e3, 30e3], "N"),
    }  # fmt: skip
    power = np.array([2.0, 1.0, 0.0])
    return xr.Dataset(
        {
            **{name: v("sea", values, unit) for name, (values, unit) in per_sea.items()},
            "rule_height": v(("sea", "direction_rule"), [[1.4, 1.42, 1.44], [1.6, 1.8, 2.1]], "m"),
            "rule_squared_velocity": v(("sea", "direction_rule"), [[0.6, 0.62, 0.64], [0.9, 1.1, 1.5]], "m2/s2"),
            "rule_tension": v(("sea", "direction_rule"), [[15e3, 15.2e3, 15.4e3], [19e3, 21e3, 25e3]], "N"),
            "angle_tension": v(
                ("sea", "direction_rule", "angle"),
                [[load * np.cos(angle) ** p + 1e3 for p in power] for load in (15e3, 21e3)], "N",
            ),
            "height_tension": v(("sea", "height_step"), [8e3 * height, 10e3 * height], "N"),
            "height": v(("sea", "height_step"), [height, height], "m"),
            "height_squared_velocity": v(("sea", "height_step"), [0.5 * height**2, 0.7 * height**2], "m2/s2"),
            "energy_factor": v((), 0.2), "float_mass": v((), 518.0, "kg"), "rope_stiffness": v((), 890e3, "N/m"),
            "mass_product": v((), 103.6, "kg"), "pretension": v((), 5e3, "N"), "response_time": v((), 0.068, "s"),
        },
        {"sea": seas, "direction_rule": rules, "angle": v("angle", angle, "rad")},
    )  # fmt: skip


def limits(factor: float) -> xr.Dataset:
    speed, height = np.linspace(0.0, 0.7, 8), np.linspace(0.0, 2.0, 9)
    u, h = np.meshgrid(speed, height, indexing="ij")
    parts = np.stack(
        [
            factor * (0.4 * u**2 * k + 0.3 * h * m)
            for k, m in ((4, 1), (3, 1), (2, 0.6), (1, 0.3), (5, 0.1), (3, 2), (2, 1.5))
        ],
        axis=-1,
    )
    largest = parts.argmax(axis=-1)
    used = parts.max(axis=-1)
    return xr.Dataset(
        {
            "limit_height": v("speed", np.clip((1 / factor - 1.2 * speed**2) / 0.6, 0, None), "m"),
            "limit_governing": v("speed", ["anchor line"] * 6 + ["float"] * 2),
            "limit_utilisation": v(("speed", "height"), used),
            "limit_component": v(("speed", "height"), np.array(COMPONENTS)[largest]),
            "component_utilisation": v(("speed", "height", "component"), parts),
            "surface_speed": v((), 0.3, "m/s"),
            "speed_limit": v((), 0.66, "m/s"),
            "drowning_speed": v((), 0.62, "m/s"),
        },
        {"speed": v("speed", speed, "m/s"), "height": v("height", height, "m"), "component": COMPONENTS},
        attrs={"speed_limit_governing": "float", "with_impact": 1, "with_snaps": 0, "with_energy_model": 1},
    )


def loads(factor: float) -> xr.Dataset:
    steady = np.array([2800.0, 2400.0, 310.0, 4600.0, 260.0, 5100.0, 4700.0]) * factor
    wave = np.array([3000.0, 2500.0, 200.0, 3000.0, np.nan, 14e3, 12e3]) * factor
    snap_load = np.array([9800.0, 11200.0, 370.0, 5000.0, np.nan, 19e3, 15e3]) * factor
    more = np.fmax(np.nan_to_num(wave), np.nan_to_num(snap_load))
    capacity = np.array([60e3, 40e3, 9000.0, np.nan, 660.0, 90e3, 40e3])
    safety = np.array([3.0, 3.0, 4.0, np.nan, 1.0, 3.0, 1.5])
    return xr.Dataset(
        {
            "steady_load": v("component", steady, "N"),
            "wave_load": v("component", wave, "N"),
            "impact_load": v("component", snap_load, "N"),
            "impact_low": v("component", 0.6 * snap_load, "N"),
            "impact_high": v("component", 1.1 * snap_load, "N"),
            "governing_load": v("component", steady + more, "N"),
            "load_bound": ("component", [""] * len(steady)),
            "capacity": v("component", capacity, "N"),
            "safety_factor": v("component", safety),
            "utilisation": v("component", (steady + more) * safety / capacity),
            "load_unit": v("component", ["N", "N", "N/m", "N", "N/m", "N", "N"]),
            "governing": v("component", ["steady and impact"] * 4 + ["steady"] + ["steady and impact"] * 2),
            "wave_source": v("component", ["slack and taut, storm"] * 5 + ["energy model"] * 2),
            "impact_source": v("component", ["model A"] * 7),
        },
        {"component": COMPONENTS},
        attrs={"governing_component": "anchor"},
    )


def build(*, anchored: bool = True) -> Result:
    tree: dict[str, xr.Dataset] = {
        "/": xr.Dataset(
            attrs={
                "structure": "curtain",
                "title": "Curtain at the outfall",
                "case_text": CASE_TEXT,
                "case_hash": "ab12",
            }
        )
    }
    for name, elevation, factor in (("HWL", 1.2, 1.0), ("LWL", 0.0, 0.9)):
        depth = DEPTH + elevation
        tree[f"/{name}"] = xr.Dataset(
            attrs={"water_level": elevation, "water_depth": depth, "normal_heading": 0.0, "toe": "free"}
        )
        shapes, tops = [section(x) for x in (1.2, 1.6, 2.1)], [plan(x) for x in (5.3, 5.5, 5.7)]
        profile = np.linspace(-depth, 0.0, 25)
        tree[f"/{name}/section"] = xr.Dataset(
            {
                "section_x": v(("drag_case", "section_point"), [x for x, _ in shapes], "m"),
                "section_z": v(("drag_case", "section_point"), [z for _, z in shapes], "m"),
                "section_tension": v(("drag_case", "section_point"), 300 + 0 * np.array([x for x, _ in shapes]), "N/m"),
                "profile_z": v("profile_point", profile, "m"),
                "profile_speed": v("profile_point", 0.3 * ((profile + depth) / depth) ** (1 / 7), "m/s"),
            },
            {"drag_case": DRAG},
        )
        held = {}
        if anchored:
            held = {
                "anchor_x": v("anchor", [-18.0, -18.0], "m"), "anchor_y": v("anchor", [-6.0, SPAN + 6.0], "m"),
                "anchor_z": v("anchor", [-depth, -depth], "m"), "float_x": v("anchor", [0.0, 0.0], "m"),
                "float_y": v("anchor", [0.0, SPAN], "m"), "float_z": v("anchor", [0.0, 0.0], "m"),
            }  # fmt: skip
        tree[f"/{name}/plan"] = xr.Dataset(
            {
                "plan_x": v(("drag_case", "plan_point"), [x for x, _ in tops], "m"),
                "plan_y": v(("drag_case", "plan_point"), [y for _, y in tops], "m"),
                **held,
            },
            {"drag_case": DRAG},
        )
        parts = {"statics": statics(factor), "statics_laws": laws(), "limits": limits(factor), "loads": loads(factor)}
        parts |= {"anchor_loads": anchor_loads(), **impact(factor), **waves(factor)}
        for part, data in parts.items():
            tree[f"/{name}/{part}"] = data
    return Result(
        tree=xr.DataTree.from_dict(VOCABULARY.close(tree)),
        checks=(IdentityCheck("force balance of the plan", 1e-9, 1e-6, "pull of the ends equals the load"),),
        notices=(
            Notice("curtain-class", "class C does not allow 0.3 m/s", 0.3, 0.1, "warning", "take class B", "SEPTA"),
        ),
        provenance=make_provenance(case_hash="ab12"),
        headlines=curtain_headlines(tree, ["HWL", "LWL"]),
    )
