"""A made-up but plausible result of a floating breakwater in the documented layout, to try the report on.

The numbers are those of three uncoupled oscillators with invented coefficients; nothing here is physics to rely on.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import xarray as xr

from moyai.core.results import Result, make_provenance
from moyai.core.validity import IdentityCheck, Notice
from moyai.structures.breakwater.headlines import headlines
from moyai.structures.breakwater.variables import VOCABULARY

MODES = ["sway", "heave", "roll"]
LINES = ["offshore", "shore"]
BEAM, HEIGHT, LENGTH, GRAVITY = 10.0, 4.5, 21.0, 9.81
CASE_TEXT = """# Pontoon, first estimate (浮防波堤)
moyai: 1
title: Pontoon at the harbour mouth
site: {water_depth: 10 m, water_levels: {HWL: 1.2 m, LWL: 0 m}}
waves: {kind: jonswap, significant_height: 1.5 m, peak_period: 5 s}
"""


def variable(dims: tuple[str, ...], values: Any, units: str, long_name: str) -> xr.Variable:
    return xr.Variable(dims, np.asarray(values), {"units": units, "long_name": long_name})


def wave_number(omega: np.ndarray, depth: float) -> np.ndarray:
    k = omega**2 / GRAVITY
    for _ in range(200):
        k = 0.5 * k + 0.5 * omega**2 / (GRAVITY * np.tanh(k * depth))
    return k


def operators(omega: np.ndarray) -> np.ndarray:
    """Complex response per metre of wave amplitude: sway, heave, roll [rad/m]."""
    natural, damping, gain = np.array([0.45, 1.21, 1.31]), np.array([0.2, 0.25, 0.16]), np.array([0.25, 1.0, 0.05])
    ratio = omega[:, None] / natural
    shape = gain / (1.0 - ratio**2 - 2j * damping * ratio)
    return shape * np.array([4.0, 1.0, 1.0]) * np.exp(1j * np.array([0.5, 0.1, -1.0]))


def wave_coefficients(omega: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    transmission = (0.95 / (1.0 + (omega / 1.3) ** 6) + 0.05) * np.exp(0.4j * omega)
    reflection = 0.9 * omega**4 / (1.3**4 + omega**4) * np.exp(-0.8j * omega)
    return reflection, transmission


def statics(depth: float, breaking: float) -> xr.Dataset:
    draught, freeboard = 3.0, 1.5
    s = np.linspace(0.0, 1.0, 40)
    line_x, line_z = [], []
    for side in (-1.0, 1.0):
        grounded = 0.5
        lift = np.clip((s - grounded) / (1.0 - grounded), 0.0, None) ** 2
        line_x.append(side * (5.0 + 50.66 * (1.0 - s)))
        line_z.append(-depth + (depth - draught) * lift)
    names = ("influenced_dof", "radiating_dof")
    scalars = {
        "draught": (draught, "m"),
        "freeboard": (freeboard, "m"),
        "beam": (BEAM, "m"),
        "section_height": (HEIGHT, "m"),
        "unit_length": (LENGTH, "m"),
        "body_mass": (6.186e5, "kg"),
        "displaced_mass": (6.4575e5, "kg"),
        "line_vertical_pull": (2.66e5, "N"),
        "imbalance": (0.02, "%"),
        "heel": (0.0, "rad"),
        "metacentric_height": (2.03, "m"),
        "centre_of_gravity_x": (0.0, "m"),
        "centre_of_gravity_z": (-0.71, "m"),
    }
    data = {name: variable((), value, unit, name.replace("_", " ")) for name, (value, unit) in scalars.items()}
    per_line = {
        "line_count": ([2, 2], "1"),
        "fairlead_tension": ([38.2e3, 38.2e3], "N"),
        "anchor_tension": ([32.7e3, 32.7e3], "N"),
        "horizontal_tension": ([32.7e3, 32.7e3], "N"),
        "fairlead_vertical_tension": ([19.7e3, 19.7e3], "N"),
        "anchor_vertical_tension": ([0.0, 0.0], "N"),
        "grounded_length": ([26.6, 26.6], "m"),
        "unstretched_length": ([51.97, 51.97], "m"),
        "breaking_load": ([breaking, breaking], "N"),
        "utilisation": ([38.2e3 / breaking, 38.2e3 / breaking], "1"),
        "fairlead_x": ([-5.0, 5.0], "m"),
        "fairlead_z": ([-3.0, -3.0], "m"),
        "anchor_x": ([-55.66, 55.66], "m"),
        "anchor_z": ([-depth, -depth], "m"),
    }
    data |= {name: variable(("line",), value, unit, name.replace("_", " ")) for name, (value, unit) in per_line.items()}
    data |= {
        "hydrostatic_stiffness": variable(names, np.diag([0.0, 2.11e6, 1.29e7]), "N/m", "hydrostatic stiffness"),
        "mooring_stiffness": variable(
            names, [[2.06e5, 0.0, -1.8e5], [0.0, 2.2e4, 0.0], [-1.8e5, 0.0, 1.1e6]], "N/m", "mooring stiffness"
        ),
        "inertia_matrix": variable(names, np.diag([6.186e5, 6.186e5, 4.41e6]), "kg", "inertia matrix"),
        "natural_period": variable(("mode",), [14.4, 5.2, 4.6], "s", "natural period"),
        "natural_period_without_lines": variable(("mode",), [np.nan, 5.25, 4.8], "s", "natural period without lines"),
        "mode_shape": variable(("mode", "dof"), np.eye(3), "1", "mode shape"),
        "steady_offset": variable(("dof",), [0.12, 0.0, 0.001], "m", "steady offset"),
        "outline_x": variable(("outline_point",), [-5.0, 5.0, 5.0, -5.0, -5.0], "m", "outline x"),
        "outline_z": variable(("outline_point",), [-3.0, -3.0, 1.5, 1.5, -3.0], "m", "outline z"),
        "line_x": variable(("line", "line_point"), line_x, "m", "line x"),
        "line_z": variable(("line", "line_point"), line_z, "m", "line z"),
    }
    coordinates = {"dof": MODES, "influenced_dof": MODES, "radiating_dof": MODES, "mode": MODES, "line": LINES}
    return xr.Dataset(data, coordinates)


def mooring(breaking: float) -> xr.Dataset:
    offset = np.linspace(-2.0, 2.0, 81)
    windward = 38.2e3 * np.exp(1.3 * offset)
    lee = windward[::-1]
    return xr.Dataset(
        {
            "restoring_force": variable(("offset",), -2.0 * (windward - lee), "N", "restoring force"),
            "vertical_force": variable(("offset",), -0.5 * (windward + lee), "N", "vertical force"),
            "line_tension": variable(("line", "offset"), [windward, lee], "N", "line tension"),
        },
        {"offset": variable(("offset",), offset, "m", "offset"), "line": LINES},
    )


def rao(depth: float) -> xr.Dataset:
    omega = np.linspace(0.3, 3.5, 60)
    reflection, transmission = wave_coefficients(omega)
    loss = 1.0 - np.abs(reflection) ** 2 - np.abs(transmission) ** 2
    wavelength = 2.0 * np.pi / wave_number(omega, depth)
    k = 2.0 * np.pi / wavelength
    return xr.Dataset(
        {
            "rao": variable(("omega", "dof"), operators(omega), "m/m", "response operator"),
            "reflection_coefficient": variable(("omega",), reflection, "1", "reflection"),
            "transmission_coefficient": variable(("omega",), transmission, "1", "transmission"),
            "dissipation": variable(("omega",), loss, "1", "dissipation"),
            "drift_coefficient": variable(("omega",), np.abs(reflection) ** 2 + loss / 2, "1", "drift coefficient"),
            "mean_drift_force_per_amplitude_squared": variable(
                ("omega",), 5e3 * np.abs(reflection) ** 2, "N/m2", "mean drift force"
            ),
            "transmission_macagno": variable(("omega",), 1 / np.sqrt(1 + (3 * k) ** 2), "1", "Macagno"),
            "transmission_wiegel": variable(("omega",), np.exp(-3.0 * k), "1", "Wiegel"),
        },
        {
            "omega": variable(("omega",), omega, "rad/s", "angular frequency"),
            "period": variable(("omega",), 2 * np.pi / omega, "s", "period"),
            "wavelength": variable(("omega",), wavelength, "m", "wavelength"),
            "wavelength_over_beam": variable(("omega",), wavelength / BEAM, "1", "wavelength over beam"),
            "dof": MODES,
        },
    )


def hydrodynamics() -> xr.Dataset:
    omega = np.concatenate([[0.0], np.linspace(0.3, 3.5, 40)])
    shape = np.exp(-omega / 1.5)
    added = np.array([2.6e4, 3.6e4, 1.4e5])[None, :] * (0.5 + 0.5 * shape[:, None])
    names = ("omega", "radiating_dof", "influenced_dof")
    return xr.Dataset(
        {
            "added_mass": variable(names, added[:, :, None] * np.eye(3), "kg/m", "added mass"),
            "radiation_damping": variable(
                names, (omega * shape)[:, None, None] * 2e4 * np.eye(3), "kg/(m s)", "radiation damping"
            ),
            "excitation_force": variable(
                ("omega", "wave_direction", "influenced_dof"),
                (shape[:, None] * np.array([3e4, 5e4, 6e4]) * np.exp(0.3j))[:, None, :],
                "N/m2",
                "excitation",
            ),
            "infinite_frequency_added_mass": variable(names[1:], np.diag([1.3e4, 1.8e4, 7e4]), "kg/m", "added mass"),
        },
        {
            "omega": variable(("omega",), omega, "rad/s", "angular frequency"),
            "radiating_dof": MODES,
            "influenced_dof": MODES,
            "wave_direction": [0.0],
        },
    )


def regular(height: float, depth: float, in_time: bool, breaking: float) -> xr.Dataset:
    period = np.array([3.1, 3.6, 4.1, 4.4, 4.6, 4.9, 5.1, 5.6, 6.2, 7.2, 8.2])
    omega = 2 * np.pi / period
    response = np.abs(operators(omega)) * (0.93 if in_time else 1.0)
    reflection, transmission = (np.abs(entry) for entry in wave_coefficients(omega))
    tension = np.stack([60e3 + 4e4 * response[:, 0], 50e3 + 2e4 * response[:, 0]], axis=1) * (1.15 if in_time else 1.0)
    drift = 1.1e4 * reflection**2
    stiffness = np.diag([2.06e5, 2.2e4, 1.1e6])[None] * (1 + 0.1 * reflection**2)[:, None, None]
    names = ("period", "influenced_dof", "radiating_dof")
    data = {
        "motion_amplitude": variable(("period", "dof"), response * height / 2, "m", "motion amplitude"),
        "motion_ratio": variable(("period", "dof"), response * np.array([1, 1, BEAM / 2]), "1", "motion ratio"),
        "reflection_coefficient": variable(("period",), reflection, "1", "reflection"),
        "transmission_coefficient": variable(("period",), transmission, "1", "transmission"),
        "dissipation": variable(("period",), 1 - reflection**2 - transmission**2, "1", "dissipation"),
        "mean_drift_force": variable(("period",), drift, "N", "mean drift force"),
        "drift_coefficient": variable(("period",), reflection**2, "1", "drift coefficient"),
        "mean_offset": variable(("period", "dof"), drift[:, None] / 2e5 * np.array([1, 0, 0]), "m", "mean offset"),
        "mooring_stiffness": variable(names, stiffness, "N/m", "mooring stiffness"),
    }
    data["line_tension_maximum"] = variable(("period", "line"), tension, "N", "largest tension")
    data["line_tension_mean"] = variable(("period", "line"), 0.0 * tension + [45e3, 36e3], "N", "mean tension")
    if not in_time:
        data["maximum_anchor_vertical_tension"] = variable(("period", "line"), tension * 0.0, "N", "uplift")
    coordinates = {
        "period": variable(("period",), period, "s", "period"),
        "dof": MODES,
        "influenced_dof": MODES,
        "radiating_dof": MODES,
        "line": LINES,
        "wavelength_over_beam": variable(("period",), 2 * np.pi / wave_number(omega, depth) / BEAM, "1", "L/B"),
    }
    return xr.Dataset(data, coordinates)


def spectrum(omega: np.ndarray, height: float = 1.5, peak: float = 5.0) -> np.ndarray:
    safe = np.maximum(omega, 1e-6)
    shape = safe**-5.0 * np.exp(-1.25 * (2 * np.pi / peak / safe) ** 4)
    return height**2 / 16 * shape / np.trapezoid(shape, omega)


def irregular_frequency(breaking: float) -> xr.Dataset:
    omega = np.linspace(0.3, 3.5, 150)
    density = spectrum(omega)
    response = density[:, None] * np.abs(operators(omega)) ** 2
    significant = 4 * np.sqrt(np.trapezoid(response, omega, axis=0))
    _, transmission = wave_coefficients(omega)
    passed = density * np.abs(transmission) ** 2
    height = 4 * np.sqrt(np.trapezoid(passed, omega))
    return xr.Dataset(
        {
            "wave_spectrum": variable(("omega",), density, "m2 s/rad", "wave spectrum"),
            "response_spectrum": variable(("omega", "dof"), response, "m2 s/rad", "response spectrum"),
            "transmitted_spectrum": variable(("omega",), passed, "m2 s/rad", "transmitted spectrum"),
            "significant_height": variable((), 1.5, "m", "significant height"),
            "transmitted_significant_height": variable((), height, "m", "transmitted significant height"),
            "transmission_coefficient": variable((), height / 1.5, "1", "transmission"),
            "mean_drift_force": variable((), 6.1e3, "N", "mean drift force"),
            "mean_offset": variable(("dof",), [0.03, 0.0, 0.0], "m", "mean offset"),
            "significant_motion": variable(("dof",), significant, "m", "significant motion"),
            "most_probable_maximum_motion": variable(("dof",), 0.93 * significant, "m", "most probable maximum"),
            "most_probable_maximum_tension": variable(("line",), [65e3, 55e3], "N", "most probable maximum"),
            "line_tension_maximum": variable(("line",), [70e3, 60e3], "N", "largest tension"),
            "line_tension_mean": variable(("line",), [45e3, 36e3], "N", "mean tension"),
        },
        {"omega": variable(("omega",), omega, "rad/s", "angular frequency"), "dof": MODES, "line": LINES},
    )


def record(omega: np.ndarray, amplitude: np.ndarray, duration: float, step: float, seed: int) -> xr.Dataset:
    time = np.arange(0.0, duration, step)
    phase = np.random.default_rng(seed).uniform(0, 2 * np.pi, omega.size)
    position = np.zeros((time.size, 3))
    elevation = np.zeros(time.size)
    gains = operators(omega)
    ramp = 0.5 - 0.5 * np.cos(np.pi * np.clip(time / (0.05 * duration), 0, 1))
    for number in range(omega.size):
        turning = amplitude[number] * np.exp(1j * (phase[number] - omega[number] * time)) * ramp
        elevation += turning.real
        position += (turning[:, None] * gains[number]).real
    position[:, 0] += 0.12
    tension = 38.2e3 * np.exp(np.stack([1.0 * position[:, 0], -1.0 * position[:, 0]], axis=1))
    return xr.Dataset(
        {
            "position": variable(("time", "dof"), position, "m", "position"),
            "tension": variable(("time", "line"), tension, "N", "tension at the fairlead"),
            "surface_elevation": variable(("time",), elevation, "m", "incident wave at x = 0"),
        },
        {"time": variable(("time",), time, "s", "time"), "dof": MODES, "line": LINES},
        {"time_step": step, "status": "converged", "ramp": 0.05 * duration},
    )


def irregular_time(run: xr.Dataset) -> xr.Dataset:
    position, tension = run["position"].values, run["tension"].values
    return xr.Dataset(
        {
            "significant_motion": variable(("dof",), 4 * position.std(axis=0), "m", "significant motion"),
            "maximum_motion": variable(("dof",), np.abs(position).max(axis=0), "m", "maximum motion"),
            "mean_offset": variable(("dof",), position.mean(axis=0), "m", "mean offset"),
            "line_tension_maximum": variable(("line",), tension.max(axis=0), "N", "maximum tension"),
            "line_tension_mean": variable(("line",), tension.mean(axis=0), "N", "mean tension"),
            "significant_tension": variable(("line",), np.quantile(tension, 0.9, axis=0), "N", "significant tension"),
            "transmission_coefficient": variable((), 0.41, "1", "transmission"),
        },
        {"dof": MODES, "line": LINES},
    )


def sensitivity() -> dict[str, xr.Dataset]:
    period = np.linspace(3.1, 8.2, 20)
    omega = 2 * np.pi / period
    fractions = np.array([0.0, 0.05, 0.15, 0.25])
    ratio = np.stack([np.abs(operators(omega)) * np.array([1, 1, 5]) / (0.4 + 4 * z) for z in fractions])
    _, transmission = wave_coefficients(omega)
    coordinates = {"damping_fraction": fractions, "period": variable(("period",), period, "s", "period"), "dof": MODES}
    return {
        "damping": xr.Dataset(
            {
                "motion_ratio": variable(("damping_fraction", "period", "dof"), ratio, "1", "motion ratio"),
                "transmission_coefficient": variable(
                    ("damping_fraction", "period"), np.abs(transmission)[None] * (1 - fractions[:, None]), "1", "K_T"
                ),
            },
            coordinates,
        )
    }


def notices() -> tuple[Notice, ...]:
    return (
        Notice("wave-breaking", "wave height 1.05 m at T = 3.1 s is near breaking", 0.088, 0.142, "information", "",
               "Miche 1944"),
        Notice("roll-damping", "roll damping is an assumption and governs the motions at resonance", severity="warning",
               remedy="identify it from a free-decay test"),
    )  # fmt: skip


def completed(groups: dict[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """Return groups with all that a run would hold: not-a-number, and no steady load, where nothing is made up."""
    out = {}
    for path, group in groups.items():
        while missing := VOCABULARY.absent(path, group):
            blank = {}
            for name in missing:
                along = [dim for dim, words in OF_DIMENSION.items() if re.search(words, name)]
                dims = [dim for dim in ("period", *along[:1]) if dim in group.sizes]
                blank[name] = (dims, np.full([group.sizes[dim] for dim in dims], 0.0 if "steady" in name else np.nan))
            group = group.assign(blank)
        out[path] = group
    return out


#: Words in the names of what a run holds of every line and every motion.
OF_DIMENSION = {
    "line": "tension|anchor|fairlead|grounded|utilisation|slack|snap|contact|rise|line",
    "dof": "motion|mean_offset|excursion|equivalent_damping|steady",
}
#: Levels of a small result.
ONE = (("LWL", 0.0),)


def build(
    *,
    duration: float = 240.0,
    title: str = "Pontoon at the harbour mouth (港口の浮防波堤)",
    breaking: float = 2.6e6,
    levels: tuple[tuple[str, float], ...] = (("HWL", 1.2), ("LWL", 0.0)),
    time: bool = True,
    seed: int = 3,
) -> Result:
    """Return a complete result."""  # fmt: skip
    groups: dict[str, xr.Dataset] = {}
    omega = np.linspace(0.6, 3.0, 120) + 0.003 * np.random.default_rng(1).random(120)
    amplitude = np.sqrt(2 * spectrum(omega) * np.gradient(omega))
    for number, (name, elevation) in enumerate(levels):
        depth = 10.0 + elevation
        groups[f"/{name}"] = xr.Dataset(attrs={"water_level": elevation, "water_depth": depth})
        groups[f"/{name}/statics"] = statics(depth, breaking)
        groups[f"/{name}/mooring"] = mooring(breaking)
        groups[f"/{name}/rao"] = rao(depth)
        groups[f"/{name}/hydrodynamics"] = hydrodynamics()
        groups[f"/{name}/frequency/design waves"] = regular(1.05, depth, False, breaking)
        groups[f"/{name}/frequency/storm"] = irregular_frequency(breaking)
        groups |= {f"/{name}/sensitivity/{key}": value for key, value in sensitivity().items()}
        if not time:
            continue
        groups[f"/{name}/time/design waves"] = regular(1.05, depth, True, breaking)
        for period in (3.6, 4.6, 6.2):
            run = record(np.array([2 * np.pi / period]), np.array([0.525]), 40 * period, period / 80, 1)
            run.attrs["period"] = period
            groups[f"/{name}/time/design waves/T = {period} s"] = run
        run = record(omega, amplitude, duration, 0.05, seed + number)
        groups[f"/{name}/time/storm"] = irregular_time(run)
        groups[f"/{name}/time/storm/seed 1"] = run
    points = np.array([3.2, 4.0, 4.7, 5.5, 7.0])
    groups["/measured"] = xr.Dataset(
        {
            "period": variable(("point",), points, "s", "period"),
            "transmission_coefficient": variable(("point",), [0.1, 0.2, 0.42, 0.6, 0.8], "1", "K_T"),
            "roll": variable(("point",), [0.2, 0.4, 0.9, 0.6, 0.3], "1", "roll"),
        }
    )
    tree = xr.DataTree.from_dict(VOCABULARY.close(completed(groups)))
    tree.attrs.update(structure="breakwater", title=title, case_hash="5b0f9c2e77aa41d0", case_text=CASE_TEXT)
    checks = (
        IdentityCheck("energy balance of the fixed section", 3.1e-9, 1e-6, "|R|² + |T|² = 1"),
        IdentityCheck("Haskind relation", 2.2e-8, 1e-6, "X_j = −2ρg C_g r_j"),
        IdentityCheck("symmetry of added mass", 4.0e-10, 1e-8, "a_ij = a_ji"),
    )
    found = {node.path: node.to_dataset(inherit=False) for node in tree.subtree}
    numbers = headlines(found)
    provenance = make_provenance(title=title, seed=1)
    return Result(tree, "converged", "", checks, notices(), provenance, headlines=numbers)
