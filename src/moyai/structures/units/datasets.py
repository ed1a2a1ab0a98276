"""What the analyses of a row found, as labelled datasets."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.floating.irregular import response_statistics
from moyai.mooring.shape import even_points
from moyai.sea.states import IrregularSea, RegularSea
from moyai.structures.units.across import stretch_across
from moyai.structures.units.anchors import anchor_curves, loads_of_record
from moyai.structures.units.assembly import RowAtLevel, RowPosition, steady_position
from moyai.structures.units.connectors import UnitJoint
from moyai.structures.units.contact import distance_at, loses_contact, measured_ends, meeting_variables
from moyai.structures.units.field import MapPoints, WaveField, height_ratio, line_transmission, sea_height_ratio
from moyai.structures.units.gaps import gaps_of, largest_closing
from moyai.structures.units.hydrodynamics import RowHydrodynamics
from moyai.structures.units.links import Work
from moyai.structures.units.mesh import waterplane
from moyai.structures.units.model import DOFS, MapArea
from moyai.structures.units.seas import SeaAnswer, cell_weights, columns_of
from moyai.structures.units.section import PLANAR, SectionAnswer
from moyai.structures.units.taut import largest_at_rest
from moyai.structures.units.variables import labelled

if TYPE_CHECKING:
    import xarray as xr


def coords_of(at: RowAtLevel) -> dict[str, Any]:
    return {
        "unit": np.arange(1, at.row.count + 1),
        "dof": list(DOFS),
        "connector": [joint.name for joint in at.joints],
        "component": ["x", "y", "z"],
        "line": list(at.line_names),
        "gap": [gap.name for gap in gaps_of(at)],
    }


def statics_dataset(at: RowAtLevel, wind: Array, current: Array) -> xr.Dataset:
    """Return the row at rest: plan, lines, connectors, offset under wind and current."""
    import xarray as xr

    row = at.row
    rest = steady_position(at, wind + current)
    plans = np.array([waterplane(at.section, row.length, place) for place in row.placements])
    centres = [at.centres[number] for number, lines in enumerate(at.lines) for _ in lines]
    lines = [line for group in at.lines for line in group]
    anchor = np.array([np.add(line.anchor, centre) for line, centre in zip(lines, centres)]).reshape(-1, 3)
    fairlead = np.array([np.add(line.fairlead, centre) for line, centre in zip(lines, centres)]).reshape(-1, 3)
    shapes = np.array(
        [even_points(line, line.fairlead, at.water.depth + centre[2]) + centre for line, centre in zip(lines, centres)]
    ).reshape(len(lines), -1, 3)
    outline = at.section.drawn()
    places = np.array([joint.place for joint in at.joints]).reshape(-1, 3)
    ends = np.array(
        [
            (np.nan, np.nan) if (c := joint.connector).curve is None else measured_ends(c.curve, c.kind)
            for joint in at.joints
        ]
    ).reshape(-1, 2)
    out: dict[str, Any] = {
        "draught": ((), at.draught),
        "freeboard": ((), at.freeboard),
        "metacentric_height": ((), at.statics.metacentric_height),
        "unit_mass": ("unit", at.masses),
        "unit_x": ("unit", [place.x for place in row.placements]),
        "unit_y": ("unit", [place.y for place in row.placements]),
        "unit_heading": ("unit", [place.heading for place in row.placements]),
        "plan_x": (("unit", "corner"), plans[..., 0]),
        "plan_y": (("unit", "corner"), plans[..., 1]),
        "anchor_x": ("line", anchor[:, 0]),
        "anchor_y": ("line", anchor[:, 1]),
        "fairlead_x": ("line", fairlead[:, 0]),
        "fairlead_y": ("line", fairlead[:, 1]),
        "anchor_z": ("line", anchor[:, 2]),
        "fairlead_z": ("line", fairlead[:, 2]),
        "line_unit": ("line", [number + 1 for number, group in enumerate(at.lines) for _ in group]),
        "mooring_x": (("line", "line_point"), shapes[..., 0]),
        "mooring_y": (("line", "line_point"), shapes[..., 1]),
        "mooring_z": (("line", "line_point"), shapes[..., 2]),
        "outline_x": ("outline_point", outline[:, 0]),
        "outline_z": ("outline_point", outline[:, 1]),
        "unit_centre_z": ("unit", at.centres[:, 2]),
        "breaking_load": ("line", _known(at.breaking_load)),
        **anchor_curves(at),
        "line_tension_mean": ("line", at.tensions(rest.position)),
        **{name: ("line", load) for name, load in zip(_ANCHOR_AT_REST, _anchors_at(at, rest.position))},
        "connector_x": ("connector", places[:, 0]),
        "connector_y": ("connector", places[:, 1]),
        "connector_z": ("connector", places[:, 2]),
        "connector_breaking_load": ("connector", _known(np.array([j.connector.breaking_load for j in at.joints]))),
        "connector_endurance_exponent": (
            "connector",
            [np.nan if (e := joint.connector.endurance) is None else e.exponent for joint in at.joints],
        ),
        "curve_lowest": ("connector", ends[:, 0]),
        "curve_highest": ("connector", ends[:, 1]),
        "gap_width": ("gap", np.array([gap.width for gap in gaps_of(at)])),
        "least_distance": ((), distance_at(at, rest.position)),
        "gap_closing_steady": ("gap", largest_closing(at, rest.position, lambda corners: np.zeros(len(corners)))),
        "steady_offset": (("unit", "dof"), at.in_unit_axes(rest.position)),
        "steady_force_of_wind": (("unit", "dof"), wind.reshape(-1, 6)),
        "steady_force_of_current": (("unit", "dof"), current.reshape(-1, 6)),
    }
    coords = coords_of(at) | {"corner": np.arange(1, 5)}
    kinds = [joint.connector.kind for joint in at.joints]
    return labelled(
        xr.Dataset(out, coords=coords).assign_attrs(
            length=row.length, beam=row.hull.beam, height=row.hull.height, connector_kinds=kinds
        )
    )


_ANCHOR_AT_REST = ("anchor_horizontal_tension", "anchor_vertical_tension", "grounded_length")


def _anchors_at(at: RowAtLevel, position: Array) -> Array:
    """Return horizontal pull and uplift of the anchors and length on the bed (3, lines) at a position (m,)."""
    lines = at.row_lines
    return lines.anchor_loads_of(position.reshape(-1, 6)[lines.unit]) if at.line_names else np.zeros((3, 0))


def _known(values: Array) -> Array:
    return np.where(np.isfinite(values), values, np.nan)


def hydrodynamics_dataset(at: RowAtLevel, hydro: RowHydrodynamics) -> xr.Dataset:
    """Return the coefficients of all units together."""
    import xarray as xr

    names = [f"unit {number + 1} {dof}" for number in range(at.row.count) for dof in DOFS]
    data = xr.Dataset(
        {
            "wave_number": ("omega", hydro.wave_number),
            "added_mass": (("omega", "influenced_dof", "radiating_dof"), hydro.added_mass),
            "radiation_damping": (("omega", "influenced_dof", "radiating_dof"), hydro.damping),
            "excitation_force": (("omega", "wave_direction", "influenced_dof"), hydro.excitation),
            "hydrostatic_stiffness": (("influenced_dof", "radiating_dof"), at.hydrostatic),
        },
        coords={
            "omega": hydro.omega, "wave_direction": hydro.headings, "influenced_dof": names, "radiating_dof": names,
        },
    )  # fmt: skip
    data.attrs |= {"rho": at.water.density, "g": at.water.gravity, "water_depth": at.water.depth}
    if hydro.panels is None:
        data.attrs["source"] = hydro.source
    else:
        data.attrs |= {
            "panels": hydro.panels.mesh.count,
            "longest_panel_side": hydro.panels.mesh.longest_side,
            "mirrors": len(hydro.panels.symmetry.mirrors),
            "gap_damping_lid": hydro.panels.gap_damping,
        }
    return labelled(data)


def mean_loads(at: RowAtLevel, rest: RowPosition, work: Work) -> Array:
    """Return the mean loads (joints, 6) in the connectors [N, N m]."""
    position, held = rest.position, rest.held_load
    out = np.zeros((len(at.joints), 6))
    first = 0
    for number, joint in enumerate(at.joints):
        connector = joint.connector
        if len(joint.held):
            out[number] += held[first : first + len(joint.held)] @ joint.held
            first += len(joint.held)
        if connector.stiffness is not None:
            out[number] += connector.stiffness @ (joint.relative @ position)
    for link in at.links:
        force = link.bears(position, work)[0]
        out[link.joint, :3] += force * link.direction(position)
    return out


def _of_units(answer: SeaAnswer) -> Array:
    """Return the mean drift of every unit (u, 3): across, along, about the vertical through its centre."""
    return answer.pushed.reshape(-1, 6)[:, [0, 1, 5]]


def _drift_of(drift: Array, answer: SeaAnswer, headings: Array) -> dict[str, Any]:
    return {
        "drift_per_amplitude_squared": (("omega", "wave_direction", "direction"), drift),
        "omega": ("omega", answer.coarse.omega),
        "wave_direction": ("wave_direction", headings),
    }


def regular_dataset(at: RowAtLevel, sea: RegularSea, answers: list[SeaAnswer], hydro: RowHydrodynamics) -> xr.Dataset:
    """Return motions, loads and tensions in regular waves, one entry a period."""
    import xarray as xr

    amplitude = 0.5 * sea.height
    motion = np.array([at.in_unit_axes(item.fine.motion[0, 0]) for item in answers])
    load = amplitude * np.abs(np.array([item.fine.load[0, 0] for item in answers]))
    relative = amplitude * np.abs(np.array([item.fine.relative[0, 0] for item in answers]))
    mean_load = np.array([mean_loads(at, item.rest, item.work) for item in answers])
    offset = np.array([at.in_unit_axes(item.rest.position) for item in answers])
    tension = amplitude * np.abs(np.array([item.fine.tension[0, 0] for item in answers]))
    mean_tension = np.array([at.tensions(item.rest.position) for item in answers])
    force, moment = load[..., :3], load[..., 3:]
    largest = np.abs(mean_load) + load
    resultant = np.array(
        [_harmonic_resultant(amplitude * item.fine.load[0, 0, :, :3], mean[:, :3])
         for item, mean in zip(answers, mean_load)]
    ).reshape(len(answers), -1)  # fmt: skip

    def reach(item: SeaAnswer, joint: UnitJoint) -> float:
        return amplitude * float(np.abs(item.fine.motion[0, 0] @ joint.along))

    def closing(item: SeaAnswer) -> Callable[[Array], Array]:
        return lambda corners: amplitude * np.abs(corners @ item.fine.motion[0, 0])

    low, high = _by_curve(at, answers, reach, largest, resultant)
    closings = np.array([largest_closing(at, item.rest.position, closing(item)) for item in answers])
    meeting = [meeting_variables(at, item.rest.position, each) for item, each in zip(answers, closings, strict=True)]
    dims = ("period", "connector", "component")
    out: dict[str, Any] = {
        "wave_height": ((), sea.height),
        "rao": (("period", "unit", "dof"), np.abs(motion)),
        "motion_amplitude": (("period", "unit", "dof"), amplitude * np.abs(motion)),
        "mean_offset": (("period", "unit", "dof"), offset),
        "largest_offset": (("period", "unit"), _farthest(offset, motion, amplitude)),
        "mean_drift": (("period", "direction"), np.array([item.drift for item in answers])),
        "mean_drift_of_unit": (("period", "unit", "direction"), np.array([_of_units(item) for item in answers])),
        "connector_force_amplitude": (dims, force),
        "connector_moment_amplitude": (dims, moment),
        "connector_force_mean": (dims, mean_load[..., :3]),
        "connector_moment_mean": (dims, mean_load[..., 3:]),
        "connector_force_largest": (dims, largest[..., :3]),
        "connector_moment_largest": (dims, largest[..., 3:]),
        "connector_resultant_largest": (("period", "connector"), resultant),
        "connector_stiffness_of_curve": (("period", "connector"), np.array([item.curve_stiffness for item in answers])),
        "elongation_lowest": (("period", "connector"), low),
        "elongation_highest": (("period", "connector"), high),
        "stretch_across": (("period", "connector"), stretch_across(at.joints, relative[..., :3], high, in_time=False)),
        "relative_motion_largest": (dims, relative[..., :3]),
        "relative_turn_largest": (dims, relative[..., 3:]),
        "gap_closing_largest": (("period", "gap"), closings),
        "line_tension_mean": (("period", "line"), mean_tension),
        "tension_amplitude": (("period", "line"), tension),
        "line_tension_maximum": (
            ("period", "line"),
            np.maximum(mean_tension + tension, along_the_path(at, answers, amplitude)),
        ),
    }
    out |= _anchors_along_the_path(at, answers, amplitude)
    lost = [loses_contact(at, *ends) for ends in zip(low, high, strict=True)]
    out["connector_loses_contact"] = ("period", np.array(lost, dtype=np.int8))
    out |= {name: ("period", np.array([each[name] for each in meeting])) for name in meeting[0]}
    drift = answers[0].far.drift.copy()
    for period, item in zip(sea.periods, answers):
        row = int(np.argmin(np.abs(item.coarse.omega - 2.0 * np.pi / period)))
        drift[row] = item.far.drift[row]
    out |= _drift_of(drift, answers[0], hydro.headings)
    coords = coords_of(at) | {"period": np.array(sea.periods), "direction": ["across", "along", "about z"]}
    data = labelled(xr.Dataset(out, coords=coords))
    data.attrs |= {"kind": "regular", "heading": sea.heading, "status": _status(answers)}
    return data


def along_the_path(at: RowAtLevel, answers: list[SeaAnswer], amplitude: float) -> Array:
    """Return the largest tensions (n, lines) of lines at rest at every instant of the motion of each period.

    The tangent at the mean does not see a line that comes taut.
    """
    out = np.zeros((len(answers), len(at.line_names)))
    for number, item in enumerate(answers if at.line_names else ()):
        out[number] = np.max([at.tensions(position) for position in _path(item, amplitude)], axis=0)
    return out


def _path(item: SeaAnswer, amplitude: float) -> Array:
    """Return positions (n, m) of the row over a period."""
    phases = np.exp(-2j * np.pi * np.arange(_STATES) / _STATES)[:, None]
    return np.asarray(item.rest.position + amplitude * (item.fine.motion[0, 0] * phases).real)


def _anchors_along_the_path(at: RowAtLevel, answers: list[SeaAnswer], amplitude: float) -> dict[str, Any]:
    """Return the largest loads of the anchors of each period, as variables."""
    found: list[dict[str, Array]] = []
    for item in answers if at.line_names else ():
        path = _path(item, amplitude)
        found.append(loads_of_record(at, path, np.array([at.tensions(position) for position in path])))
    names = found[0] if found else ()
    return {name: (("period", "line"), np.array([loads[name] for loads in found])) for name in names}


def _harmonic_resultant(force: ComplexArray, mean: Array) -> Array:
    """Return the largest resultant over a period (joints,)."""
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    over = np.real(force[:, None, :] * np.exp(-1j * angle)[None, :, None]) + mean[:, None, :]
    return np.linalg.norm(over, axis=2).max(axis=1) if len(force) else np.zeros(0)


def _by_curve(
    at: RowAtLevel,
    answers: list[SeaAnswer],
    reach_of: Callable[[SeaAnswer, UnitJoint], float],
    largest: Array,
    resultant: Array,
) -> tuple[Array, Array]:
    """Take the largest loads (n, joints, 6), (n, joints) of connectors with a curve from the curve itself, in place.

    Return their lowest and highest elongations (n, joints); NaN of other connectors.
    """
    low, high = np.full_like(resultant, np.nan), np.full_like(resultant, np.nan)
    for row, item in enumerate(answers):
        for number, joint in enumerate(at.joints):
            curve = joint.connector.curve
            if curve is None:
                continue
            mean, reach = joint.elongation(item.rest.position), reach_of(item, joint)
            low[row, number], high[row, number] = mean - reach, mean + reach
            force = float(np.abs(curve.at(np.array([mean - reach, mean, mean + reach]))).max())
            largest[row, number, :3] = force * np.abs(joint.axis)
            resultant[row, number] = force
    return low, high


def irregular_dataset(at: RowAtLevel, sea: IrregularSea, answer: SeaAnswer) -> xr.Dataset:
    """Return statistics of motions, loads and tensions in an irregular sea."""
    import xarray as xr

    omega, density, fine = answer.fine.omega, answer.density, answer.fine
    duration = sea.duration

    def largest(transfer: ComplexArray) -> Array:
        return np.asarray(response_statistics(omega, transfer, density).most_probable_maximum(duration))

    motion = response_statistics(omega, at.in_unit_axes(fine.motion), density)
    load = response_statistics(omega, fine.load, density)
    offset = at.in_unit_axes(answer.rest.position)
    mean_load = mean_loads(at, answer.rest, answer.work)
    top = np.abs(mean_load) + load.most_probable_maximum(duration)
    resultant = np.linalg.norm(mean_load[:, :3], axis=1) + _gaussian_resultant(answer, duration)
    relative = largest(fine.relative)
    top, resultant = top[None], resultant[None]

    def reach(item: SeaAnswer, joint: UnitJoint) -> float:
        return float(largest(item.fine.motion @ joint.along))

    low, high = _by_curve(at, [answer], reach, top, resultant)
    closing = largest_closing(at, answer.rest.position, lambda corners: largest(fine.motion @ corners.T))
    mean_tension = at.tensions(answer.rest.position)
    waves = response_statistics(omega, np.ones(density.shape), density)
    dims = ("connector", "component")
    most = motion.most_probable_maximum(duration)
    out: dict[str, Any] = {
        "significant_height": ((), float(waves.significant)),
        "peak_period": ((), float(sea.spectrum.peak_period)),
        "significant_motion": (("unit", "dof"), motion.significant),
        "most_probable_maximum_motion": (("unit", "dof"), most),
        "mean_offset": (("unit", "dof"), offset),
        "largest_offset": ("unit", np.linalg.norm(np.abs(offset[:, :2]) + most[:, :2], axis=1)),
        "mean_drift": ("direction", answer.drift),
        "mean_drift_of_unit": (("unit", "direction"), _of_units(answer)),
        "connector_force_mean": (dims, mean_load[:, :3]),
        "connector_moment_mean": (dims, mean_load[:, 3:]),
        "connector_significant_force": (dims, 2.0 * load.standard_deviation[:, :3]),
        "connector_significant_moment": (dims, 2.0 * load.standard_deviation[:, 3:]),
        "connector_force_largest": (dims, top[0, :, :3]),
        "connector_moment_largest": (dims, top[0, :, 3:]),
        "connector_resultant_largest": ("connector", resultant[0]),
        "connector_stiffness_of_curve": ("connector", answer.curve_stiffness),
        "elongation_lowest": ("connector", low[0]),
        "elongation_highest": ("connector", high[0]),
        "stretch_across": ("connector", stretch_across(at.joints, relative[:, :3], high[0], in_time=False)),
        "relative_motion_largest": (dims, relative[:, :3]),
        "relative_turn_largest": (dims, relative[:, 3:]),
        "gap_closing_largest": ("gap", closing),
        "line_tension_mean": ("line", mean_tension),
        "line_tension_maximum": (
            "line",
            np.maximum(
                mean_tension + largest(fine.tension),
                largest_at_rest(at.row_lines, answer.rest.position, omega, fine.motion, density, duration),
            ),
        ),
    }
    out["connector_loses_contact"] = ((), np.array(loses_contact(at, low[0], high[0]), dtype=np.int8))
    out |= {name: ((), value) for name, value in meeting_variables(at, answer.rest.position, closing).items()}
    out |= _drift_of(answer.far.drift, answer, answer.headings)
    coords = coords_of(at) | {"direction": ["across", "along", "about z"]}
    data = labelled(xr.Dataset(out, coords=coords))
    data.attrs |= {
        "kind": "irregular",
        "heading": sea.heading,
        "duration": duration,
        "headings": answer.headings.tolist(),
        "status": _status([answer]),
    }
    return data


def _gaussian_resultant(answer: SeaAnswer, duration: float) -> Array:
    """Return the most probable largest force (joints,) along the direction in which each joint is loaded most.

    The direction is that of the largest variance of the three components together [eq:units-resultant].
    """
    fine = answer.fine
    out = np.zeros(fine.load.shape[2])
    weights = np.gradient(fine.omega)
    for number in range(len(out)):
        force = fine.load[:, :, number, :3]
        covariance = np.real(np.einsum("n,nh,nhi,nhj->ij", weights, answer.density, force, force.conj()))
        direction = np.linalg.eigh(covariance)[1][:, -1]
        out[number] = float(
            response_statistics(fine.omega, force @ direction, answer.density).most_probable_maximum(duration)
        )
    return out


def _farthest(offset: Array, motion: ComplexArray, amplitude: float = 1.0) -> Array:
    """Return the largest horizontal distance from rest [m] over a period, of mean offsets and motions (..., dof)."""
    turns = np.exp(-2j * np.pi * np.arange(_PHASES) / _PHASES)[:, None]
    path = offset[..., None, :2] + amplitude * (motion[..., None, :2] * turns).real
    return np.asarray(np.linalg.norm(path, axis=-1).max(axis=-1))


def _status(answers: list[SeaAnswer]) -> str:
    return "converged" if all(item.converged for item in answers) else "not_converged"


#: Phases of a period at which a distance is looked at, and at which lines are.
_PHASES, _STATES = 360, 36
#: Numbers that are given a band of the damping.
BANDED = (
    "significant_motion", "motion_amplitude", "largest_offset", "line_tension_maximum", "connector_resultant_largest",
    "connector_moment_largest", "relative_motion_largest", "gap_closing_largest", "transmission_coefficient",
    "wave_height_ratio_of_point",
)  # fmt: skip

#: What holds with the damping at either end alone holds.
_WORST = {"connector_loses_contact": np.maximum, "hulls_meet": np.maximum}


def with_damping_band(data: xr.Dataset, others: list[xr.Dataset]) -> xr.Dataset:
    """Return a dataset with the range of its numbers over its own damping and that at the ends of its band.

    Parameters
    ----------
    data : xarray.Dataset
        With the damping as given.
    others : list of xarray.Dataset
        The same with the damping at the ends; none where there is none to vary.
    """
    if not others:
        return data
    found = {}
    for name in (name for name in BANDED if name in data):
        values = np.array([item[name].values for item in (data, *others)])
        for end, pick in (("low", np.fmin), ("high", np.fmax)):
            found[f"{name}_{end}"] = (data[name].dims, pick.reduce(values, axis=0))
    for name, worst in ((name, worst) for name, worst in _WORST.items() if name in data):
        found[name] = (data[name].dims, worst.reduce([item[name].values for item in (data, *others)]))
    return labelled(data.assign(found))


def map_dataset(
    at: RowAtLevel,
    hydro: RowHydrodynamics,
    sea: RegularSea | IrregularSea,
    answers: list[SeaAnswer],
    points: MapPoints,
    area: MapArea,
    field: WaveField,
    section: SectionAnswer | None,
) -> xr.Dataset:
    """Return K on the map, at named points and along the line, with the answer of the section."""
    import xarray as xr

    columns = columns_of(hydro, answers[0].headings)
    section_transmission = np.full(len(answers), np.nan)
    extra: dict[str, Any] = {}
    if isinstance(sea, RegularSea):
        rows = [int(np.argmin(np.abs(hydro.omega - 2.0 * np.pi / period))) for period in sea.periods]
        ratio = np.array(
            [
                height_ratio(field, row, item.coarse.motion[row][columns], columns)[:, 0]
                for row, item in zip(rows, answers)
            ]
        )
        if section is not None:
            section_transmission = section.transmission[rows][:, columns[0]]
            middle = at.row.count // 2
            own = np.array([np.abs(item.fine.motion[0, 0].reshape(-1, 6)[middle, list(PLANAR)]) for item in answers])
            alone = np.abs(section.motion[rows][:, columns[0]])
            extra["section_motion_ratio"] = (("period", "section_dof"), own / alone)
            drift = np.array([item.far.drift[row, columns[0], 0] for row, item in zip(rows, answers)])
            extra["section_drift_ratio"] = (
                "period", drift / (at.row.count * section.drift[rows][:, columns[0]])
            )  # fmt: skip
        lead: tuple[str, ...] = ("period",)
    else:
        answer = answers[0]
        low, high = float(answer.fine.omega[0]), float(answer.fine.omega[-1])
        weights = cell_weights(hydro.omega, low, high)
        share = answer.density / answer.density.sum(axis=1, keepdims=True)
        near = np.argmin(np.abs(answer.fine.omega[None, :] - hydro.omega[:, None]), axis=1)
        energy = (weights * np.asarray(sea.spectrum.density_at(hydro.omega)))[:, None] * share[near]
        ratio = sea_height_ratio(field, answer.coarse.motion, columns, energy)[None]
        if section is not None:
            passed = (section.transmission[:, columns] ** 2 * energy).sum() / energy.sum()
            section_transmission = np.array([float(np.sqrt(passed))])
        lead = ()
    count = len(points.x) * len(points.y)
    grid = ratio[:, :count].reshape(len(ratio), len(points.y), len(points.x))
    transmission = np.array([line_transmission(row[points.line]) for row in ratio])

    def shaped(values: Array) -> Array:
        return values if lead else values[0]

    line = points.points[points.line]
    out: dict[str, Any] = {
        "wave_height_ratio": ((*lead, "y", "x"), shaped(grid)),
        "wave_height_ratio_of_point": ((*lead, "point"), shaped(ratio[:, points.named])),
        "wave_height_ratio_of_line": ((*lead, "station"), shaped(ratio[:, points.line])),
        "point_x": ("point", [point[1] for point in area.points]),
        "point_y": ("point", [point[2] for point in area.points]),
        "line_x": ("station", line[:, 0]),
        "line_y": ("station", line[:, 1]),
        "transmission_coefficient": (lead, shaped(transmission)),
        "section_transmission": (lead, shaped(section_transmission)),
        **extra,
    }
    coords: dict[str, Any] = {"x": points.x, "y": points.y, "point": [point[0] for point in area.points]}
    if lead:
        coords["period"] = np.array(sea.periods)  # type: ignore[union-attr]
        coords["section_dof"] = ["sway", "heave", "roll"]
    data = labelled(xr.Dataset(out, coords=coords))
    data.attrs |= {"kind": "regular" if lead else "irregular", "heading": sea.heading}
    return data


__all__ = [
    "BANDED",
    "along_the_path",
    "hydrodynamics_dataset",
    "irregular_dataset",
    "map_dataset",
    "regular_dataset",
    "statics_dataset",
    "with_damping_band",
]
