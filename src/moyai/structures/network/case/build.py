"""From the network schema to :mod:`moyai.structures.network.model`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from moyai.case.build_sea import current_of, sea_state_of
from moyai.case.criteria import criteria_of
from moyai.case.headings import heading_of
from moyai.case.schema_environment import sea_names
from moyai.core.errors import InputError
from moyai.coupled.assembly import RodPart, VolumePart
from moyai.flexible.bed import Ground, plane_ground
from moyai.flexible.elements import BOX, SPHERE, BarType, RopeCurve, SlowStretch
from moyai.flexible.failures import LineFailure
from moyai.flexible.motion import Motion
from moyai.flexible.worn_law import WornRope
from moyai.sea.current_field import CurrentField
from moyai.sea.elevation_record import components_of_record
from moyai.sea.environment import Environment
from moyai.sea.states import ComponentSea, RegularSea, SeaState
from moyai.sea.water import Water
from moyai.structures.network import model
from moyai.structures.network.assembly import mesh_bars, sphere
from moyai.structures.network.body_plan import BodyCoefficients, BodyPlan
from moyai.structures.network.case import schema_bodies as bodies
from moyai.structures.network.case import schema_parts as parts
from moyai.structures.network.case.schema import ElevationRecord, NetworkCase, WavesOneByOne
from moyai.tables.lines import line_type

#: Density of what has a mass and no volume, for its size [kg/m3].
_STEEL = 7850.0
#: How far a plane bed reaches [m].
_REACH = 1e4
#: Motions of a body, in the order of its degrees of freedom.
_MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def build_problem(case: NetworkCase, folder: Path, *, case_text: str = "", case_hash: str = "") -> model.NetworkProblem:
    """Return the network problem of a case.

    Parameters
    ----------
    case : NetworkCase
        Validated content.
    folder : Path
        Folder that the file names in it refer to.
    case_text, case_hash : str
        Kept with the result.

    Raises
    ------
    InputError
        For what the schema alone cannot see: names that are not there, files, catalogue entries.
    """
    water = Water(case.site.water_depth, case.site.density, case.site.gravity)
    levels, chosen, bearing = case.site.water_levels, case.settings.water_levels, case.site.x_axis_bearing_deg
    names = tuple(levels) if isinstance(chosen, str) else chosen
    unit = case.structure
    return model.NetworkProblem(
        title=case.title,
        points=tuple(_point(name, point) for name, point in unit.points.items()),
        lines=tuple(_line(name, line, unit.line_types, folder) for name, line in unit.lines.items()),
        nets=tuple(_net(name, net, unit.line_types, folder) for name, net in unit.nets.items()),
        bed=None if unit.bed is None else _bed(unit.bed, water, folder),
        motions={name: motion_of(name, motion, folder) for name, motion in unit.motions.items()},
        environment=Environment(
            water=water,
            water_levels=tuple((name, levels[name]) for name in names),
            # a network runs any sum of waves through time: nothing else requires its spectrum
            sea_states=tuple(
                _sea(case, state, index, water, folder, bearing)  # type: ignore[misc]
                for index, state in enumerate(case.waves)
            ),
            current=current_of(case.current, water, bearing),
        ),
        settings=_settings(case, folder),
        sheets=tuple(_sheet(name, sheet) for name, sheet in unit.sheets.items()),
        bodies=tuple(_body(name, body, case, folder) for name, body in unit.bodies.items()),
        case_text=case_text,
        case_hash=case_hash,
        criteria=criteria_of(case),
        current_field=_current_field(case, folder),
        failures=tuple(
            LineFailure(
                item.line, item.at == "end", math.inf if item.time is None else item.time,
                math.inf if item.tension is None else item.tension,
            )
            for item in unit.failures
        ),
    )  # fmt: skip


def _bed(given: parts.NetworkBed, water: Water, folder: Path) -> model.BedPlan:
    """Return the bed, with the grid of its file or the plane of its slope."""
    ground = None
    if given.slope is not None:
        towards = math.radians(given.slope.towards_deg)
        rise = given.slope.rise * math.cos(towards), given.slope.rise * math.sin(towards)
        ground = plane_ground(-water.depth, rise, _REACH)
    elif given.grid is not None:
        path = "structure.bed.grid.file"
        if given.grid.form == "seafloor":
            from moyai.interop.moordyn_rows import read_seafloor_file

            try:
                rows = np.array(read_seafloor_file(folder / given.grid.file).rows)
            except InputError as error:
                raise error.at(path) from None
        else:
            rows = read_columns(folder, given.grid.file, 3, path) * [1.0, 1.0, -1.0]
        try:
            ground = Ground.of_rows(rows)
        except InputError as error:
            raise InputError(
                f"{given.grid.file}: {error.fault.message}", path=path, allowed=error.fault.allowed
            ) from None
    return model.BedPlan(given.stiffness, given.damping, float(given.friction), ground)


def _current_field(case: NetworkCase, folder: Path) -> CurrentField | None:
    """Return the current that changes with time, from its file."""
    given = case.current_field
    if given is None:
        return None
    from moyai.interop.moordyn_currents import read_current_field

    try:
        return read_current_field(folder / given.file, given.form)
    except InputError as error:
        raise error.at("current_field.file") from None


def _settings(case: NetworkCase, folder: Path) -> model.NetworkSettings:
    given = case.settings
    return given.fill(
        model.NetworkSettings,
        analyses=case.analyses,
        resume=None if given.resume is None else folder / given.resume,
        mesh_check="off" if case.structure.failures else given.mesh_check,
    )


def _sea(
    case: NetworkCase, state: Any, index: int, water: Water, folder: Path, bearing: float | None
) -> SeaState | ComponentSea:
    """Return one sea; those that only networks know are built here. Coefficients of bodies answer linear waves."""
    states, bodies = case.waves, case.structure.bodies.values()
    path, name = f"waves[{index}]", sea_names(states)[index]
    if isinstance(state, WavesOneByOne):
        rows = [
            (
                wave.angular_frequency or 2.0 * math.pi / (wave.period or math.nan), wave.amplitude,
                math.radians(wave.phase_deg), heading_of(wave, bearing, f"{path}.waves[{number}]"),
            )
            for number, wave in enumerate(state.waves)
        ]  # fmt: skip
        return ComponentSea(name, *np.array(rows).T)
    if isinstance(state, ElevationRecord):
        table = read_columns(folder, state.file, 2, f"{path}.file")
        try:
            found = components_of_record(table[:, 0], table[:, 1], step=state.time_step)
        except InputError as error:
            fault = error.fault
            raise InputError(
                f"{state.file}: {fault.message}", path=f"{path}.file", allowed=fault.allowed, remedy=fault.remedy
            ) from None
        heading = np.full(found.omega.size, heading_of(state, bearing, path))
        return ComponentSea(name, found.omega, found.amplitude, found.phase, heading, found.period, found.period)
    sea = sea_state_of(state, index, states, water, folder, bearing)
    if isinstance(sea, RegularSea) and any(getattr(body, "coefficients_file", None) is not None for body in bodies):
        return replace(sea, theory="linear")
    return sea


def read_columns(folder: Path, name: str, count: int, path: str) -> np.ndarray:
    """Return the numbers of a text file, shape (rows, count); headings and remarks after # are passed over.

    Raises
    ------
    InputError
        For a file that is absent, a row of another length, or a word among the numbers; with its line.
    """
    file = folder / name
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{name} is no text", path=path, allowed="a text file of columns in UTF-8") from None
    except OSError as error:
        raise InputError(
            f"{name} cannot be read: {error.strerror or error}", path=path, remedy="paths count from the case file"
        ) from None
    rows: list[list[float]] = []
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split("#")[0].replace(",", " ").replace(";", " ").split()
        if not words:
            continue
        try:
            row = [float(word) for word in words]
        except ValueError:
            if not rows:
                continue  # a heading
            raise InputError(f"{name}, line {number}: '{line.strip()}' holds no numbers", path=path) from None
        if len(row) != count or not all(math.isfinite(value) for value in row):
            found = f"{len(row)} numbers" if len(row) != count else f"'{line.strip()}' is not finite"
            raise InputError(
                f"{name}, line {number}: {found}", path=path, allowed=f"{count} finite numbers in each row"
            )
        rows.append(row)
    if len(rows) < 2:
        raise InputError(f"{name} holds {len(rows)} row(s) of numbers", path=path, allowed="two rows or more")
    return np.array(rows)


def _curve(entry: parts.RopeTable | None, folder: Path, path: str) -> RopeCurve | None:
    if entry is None:
        return None
    rows = (
        np.array(entry.table) if entry.table is not None else read_columns(folder, entry.file or "", 2, f"{path}.file")
    )
    try:
        return RopeCurve(rows[:, 0], rows[:, 1])
    except InputError as error:
        raise InputError(
            f"{entry.file or 'table'}: {error.fault.message}", path=path, allowed=error.fault.allowed
        ) from None


def bar_type_of(
    name: str, entry: parts.CatalogueType | parts.OwnType, folder: Path, bar_length: float
) -> tuple[BarType, float]:
    """Return the material of a line type on bars of a length [m], and its breaking load (NaN where not known) [N]."""
    path = f"structure.line_types.{name}"
    curve = _curve(entry.curve, folder, f"{path}.curve")
    breaking = math.nan
    if isinstance(entry, parts.CatalogueType):
        try:
            properties = line_type(entry.catalogue, entry.diameter)
        except InputError as error:
            key = "diameter" if "diameter" in error.fault.path else "catalogue"
            raise error.at(f"{path}.{key}") from None
        breaking = properties.breaking_load
        made = {
            "mass_per_length": properties.mass_per_length, "axial_stiffness": properties.axial_stiffness,
            "diameter": properties.diameter, "volume_per_length": properties.volume_per_length,
            "drag_normal": properties.drag_normal, "drag_tangential": properties.drag_tangential,
            "added_mass_normal": properties.added_mass_normal,
            "added_mass_tangential": properties.added_mass_tangential,
        }  # fmt: skip
        tension_only = True
    else:
        volume = math.pi / 4.0 * entry.diameter**2 if entry.volume is None else entry.volume
        made = {
            "mass_per_length": entry.mass, "axial_stiffness": entry.axial_stiffness or 1.0, "diameter": entry.diameter,
            "volume_per_length": volume, "drag_normal": entry.drag_normal, "drag_tangential": entry.drag_tangential,
            "added_mass_normal": entry.added_mass_normal, "added_mass_tangential": entry.added_mass_tangential,
        }  # fmt: skip
        breaking = entry.breaking_load or math.nan
        tension_only = not entry.bears_compression
    stiffness = float(curve.stiffness[0]) if curve is not None else made["axial_stiffness"]
    viscosity = entry.viscosity
    if viscosity is None:
        # the two ends of a bar swing against each other at 2/l sqrt(EA/m)
        viscosity = (entry.damping_ratio or 0.0) * bar_length * math.sqrt(stiffness * made["mass_per_length"])
    made["axial_stiffness"] = stiffness
    slow: SlowStretch | WornRope | None = _slow_stretch(getattr(entry, "slow_stretch", None))
    worn = getattr(entry, "worn_rope", None)
    if worn is not None:
        slow, curve = _worn_rope(worn, curve, slow is not None), None
        made["axial_stiffness"] = worn.quick_stiffness
    bar = BarType(
        name, viscosity=viscosity, bending_stiffness=entry.bending_stiffness, tension_only=tension_only, curve=curve,
        slow=slow, **made,
    )  # fmt: skip
    return bar, breaking


def _slow_stretch(entry: parts.SlowStretchKeys | None) -> SlowStretch | None:
    return None if entry is None else SlowStretch(entry.static_stiffness, entry.viscosity, entry.growth)


def _worn_rope(entry: parts.WornRopeKeys, curve: RopeCurve | None, doubled: bool) -> WornRope:
    if curve is None or doubled:
        raise InputError(
            "a worn rope has 'slow_stretch' as well" if doubled else "a worn rope has no curve", path="worn_rope",
            allowed="with 'curve', that of the new rope, and without 'slow_stretch'",
        )  # fmt: skip
    return WornRope(
        curve.strain, curve.tension, entry.form, entry.k1, entry.k2, entry.quick_stiffness, entry.growth,
        entry.viscosity, entry.highest_mean_tension,
    )  # fmt: skip


def _known(name: str, types: Any, path: str) -> Any:
    from moyai.case.faults import did_you_mean

    if name not in types:
        raise InputError(
            f"there is no line type '{name}'",
            path=path,
            allowed=", ".join(types) or "a name in structure.line_types",
            remedy=did_you_mean(name, types),
        )
    return types[name]


def _attached(entry: Any) -> model.Attached:
    """Return what a clump, a float of a row or a free point carries: a sphere where no height is given."""
    height, form = entry.height, BOX
    if height is None:
        height, form = _diameter(entry.volume), SPHERE
    across = _diameter(entry.volume or entry.mass / _STEEL)
    return model.Attached(
        entry.mass, entry.volume, height, form, drag_area=entry.drag_area,
        added_mass_coefficient=entry.added_mass_coefficient, contact_area=_contact_area(entry, across),
    )  # fmt: skip


def _contact_area(entry: Any, diameter: float) -> float:
    """Return the area with which something of a diameter [m] lies on the bed, unless the case gives it."""
    given = entry.bed_contact_area
    return math.pi / 4.0 * diameter**2 if given is None else float(given)


def _diameter(volume: float) -> float:
    """Return the diameter of a sphere of a volume."""
    return float((6.0 / math.pi * volume) ** (1.0 / 3.0))


def _place(position: Sequence[float | None]) -> tuple[float, float, float]:
    x, y, z = position
    return float(x or 0.0), float(y or 0.0), math.nan if z is None else float(z)


def _point(name: str, entry: Any) -> model.PointPlan:
    place = _place(entry.position)
    if isinstance(entry, parts.HeldPoint):
        return model.PointPlan(name, "fixed", place, floats=entry.z_from == "still_water")
    if isinstance(entry, parts.DrivenPoint):
        return model.PointPlan(name, "driven", place, entry.motion or "", entry.z_from == "still_water")
    held = tuple(axis in entry.held for axis in "xyz")
    diameter = 0.0
    if isinstance(entry, parts.SphereFloat):
        carried = sphere(entry.diameter, entry.mass, entry.drag_coefficient, entry.added_mass_coefficient)
        diameter = entry.diameter
    elif isinstance(entry, parts.CylinderFloat):
        carried = model.Attached(
            entry.mass, math.pi / 4.0 * entry.diameter**2 * entry.height, entry.height,
            drag_area=entry.drag_coefficient * entry.diameter * entry.height,
            added_mass_coefficient=entry.added_mass_coefficient,
        )  # fmt: skip
        diameter = entry.diameter
    else:
        carried = _attached(entry)
        diameter = _diameter(carried.volume)
    if diameter and not isinstance(entry, parts.FreePoint):
        carried = replace(carried, contact_area=_contact_area(entry, diameter))
    # free points start from still water, wherever it stands
    return model.PointPlan(name, "free", place, "", True, carried, held, diameter)  # type: ignore[arg-type]


def _line(name: str, entry: parts.NetworkLine, types: Any, folder: Path) -> model.LinePlan:
    path = f"structure.lines.{name}"
    if entry.parts is None:
        if entry.type is None or entry.length is None or entry.segments is None:
            remedy = "a line of one type has a length and a number of segments"
            raise InputError("'length' or 'segments' is missing", path=path, remedy=remedy)
        given: tuple[Any, ...] = (parts.LinePartKeys(type=entry.type, length=entry.length, segments=entry.segments),)
    else:
        for key in ("length", "segments"):
            if getattr(entry, key) is not None:
                raise InputError(f"'{key}' and 'parts' exclude each other", path=f"{path}.{key}", remedy="remove it")
        given = entry.parts
    pieces: list[model.PartPlan] = []
    between: list[model.Attached | None] = []
    breaking: list[float] = []
    for number, item in enumerate(given):
        if isinstance(item, parts.WeightEntry):
            between[-1] = _attached(item.clump)
            continue
        where = f"{path}.parts[{number}].type" if entry.parts is not None else f"{path}.type"
        kind = _known(item.type, types, where)
        bar, load = bar_type_of(item.type, kind, folder, item.length / item.segments)
        pieces.append(model.PartPlan(bar, item.length, item.segments, load))
        between.append(None)
        breaking.append(load)
    total = sum(piece.length for piece in pieces)
    known = [load for load in breaking if math.isfinite(load)]
    return model.LinePlan(
        name, entry.start, entry.end, tuple(pieces), tuple(between[:-1]),
        tuple(
            model.RowPlan(row.count or max(1, round(total / (row.spacing or total))), _attached(row))
            for row in entry.along
        ),
        entry.shape, entry.flow_factor, min(known) if len(known) == len(breaking) else math.nan,
    )  # fmt: skip


def _net(name: str, entry: parts.NetworkNet, types: Any, folder: Path) -> model.NetPlan:
    path = f"structure.nets.{name}"
    corners = tuple(_place(corner) for corner in entry.corners)
    points = np.nan_to_num(np.array(corners))
    sides = [float(np.linalg.norm(points[(k + 1) % 4] - points[k])) for k in range(4)]
    wide = 0.5 * (sides[0] + sides[2]) / (entry.columns - 1) / entry.hanging_ratio
    high = 0.5 * (sides[1] + sides[3]) / (entry.rows - 1) / entry.hanging_ratio
    if entry.type is not None:
        kind = _known(entry.type, types, f"{path}.type")
        along = (bar_type_of(entry.type, kind, folder, wide)[0],) * 2
        across = (bar_type_of(entry.type, kind, folder, high)[0],) * 2
    else:
        twine = entry.twine
        assert twine is not None
        area = math.pi / 4.0 * twine.diameter**2
        mass, stiffness = twine.density * area, twine.modulus * area

        def one(length: float) -> BarType:
            ratio = (twine.damping_ratio or 0.0) * length * math.sqrt(stiffness * mass)
            return BarType(
                f"{name} twine", mass, stiffness, twine.diameter, area,
                viscosity=ratio if twine.viscosity is None else twine.viscosity, drag_normal=twine.drag_normal,
                drag_tangential=twine.drag_tangential, added_mass_normal=twine.added_mass_normal,
            )  # fmt: skip

        # a bar along a row gathers the twines of the strip between rows, a bar across those between columns
        along = mesh_bars(one(wide), twine.mesh_pitch, high, f"{name} rows")
        across = mesh_bars(one(high), twine.mesh_pitch, wide, f"{name} columns")
    return model.NetPlan(
        name, corners, entry.rows, entry.columns, along, across, entry.hanging_ratio, entry.first_row,  # type: ignore[arg-type]
        entry.motion or "", entry.ballast or 0.0, entry.flow_factor, entry.z_from == "still_water",
        (high, wide) if entry.type is None else None,
    )  # fmt: skip


def _sheet(name: str, entry: parts.NetworkSheet) -> model.SheetPlan:
    corners = [_place(corner) for corner in entry.corners]
    properties = {
        "warp_stiffness": entry.warp_stiffness, "weft_stiffness": entry.weft_stiffness,
        "shear_stiffness": entry.shear_stiffness, "mass_per_area": entry.mass, "volume_per_area": entry.thickness,
        "drag_normal": entry.drag_normal, "drag_tangential": entry.drag_tangential,
        "damping_time": entry.damping_time,
    }  # fmt: skip
    if entry.added_mass is not None:
        properties["added_mass_per_area"] = entry.added_mass
    return model.SheetPlan(
        name, (corners[0], corners[1], corners[2], corners[3]), entry.rows, entry.columns, properties,
        entry.fullness, entry.first_row, entry.motion or "", entry.z_from == "still_water",
    )  # fmt: skip


def _body(
    name: str, entry: bodies.BoxBody | bodies.CylinderBody | bodies.AssembledBody, case: NetworkCase, folder: Path
) -> BodyPlan:
    if isinstance(entry, bodies.AssembledBody):
        return _assembled(name, entry)
    size = entry.size if isinstance(entry, bodies.BoxBody) else (entry.diameter, entry.diameter, entry.height)
    if entry.inertia is not None:
        inertia = entry.inertia
    else:
        inertia = _three([entry.mass * radius**2 for radius in entry.gyration_radii or ()])
    return BodyPlan(
        name, entry.shape, size, entry.mass, inertia, entry.centre_of_gravity, entry.position,
        _three([math.radians(angle) for angle in entry.rotation_deg]), dict(entry.points), entry.drag,
        entry.added_mass or (0.0, 0.0, 0.0), free=tuple(motion not in entry.held for motion in _MOTIONS),
        coefficients=_coefficients(entry.coefficients_file, case, folder),
    )  # fmt: skip


def _coefficients(entry: Any, case: NetworkCase, folder: Path) -> BodyCoefficients | None:
    if entry is None:
        return None
    options: dict[str, Any] = {}
    for key in ("reference_point", "body", "length_scale", "first_column"):
        if getattr(entry, key, None) is not None:
            options[key] = getattr(entry, key)
    if isinstance(entry, bodies.WamitBody):
        # WAMIT files are made dimensionless with these
        options |= {"density": case.site.density, "gravity": case.site.gravity}
    return BodyCoefficients(entry.program, folder / entry.path, entry.draught, entry.origin, entry.memory, options)


def _assembled(name: str, entry: bodies.AssembledBody) -> BodyPlan:
    pieces: list[RodPart | VolumePart] = [
        RodPart(
            rod.start, rod.end, rod.diameter, rod.mass, rod.drag_normal, rod.added_mass_normal, rod.drag_end,
            rod.added_mass_end, rod.slices,
        )
        for rod in entry.rods
    ]  # fmt: skip
    pieces += [
        VolumePart(item.position, item.mass, item.volume, item.drag_area, item.added_mass_coefficient)
        for item in entry.volumes
    ]
    corners = [np.zeros(3), *(np.array(p) for rod in entry.rods for p in (rod.start, rod.end))]
    size = _three([float(extent) for extent in np.ptp(corners, axis=0)])
    return BodyPlan(
        name, "assembly", size, entry.mass, entry.inertia or (0.0, 0.0, 0.0), entry.centre_of_gravity, entry.position,
        _three([math.radians(angle) for angle in entry.rotation_deg]), dict(entry.points), (0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0), free=tuple(motion not in entry.held for motion in _MOTIONS), parts=tuple(pieces),
        pin=entry.pin, turning_drag=entry.turning_drag,
    )  # fmt: skip


def _three(values: Sequence[float]) -> tuple[float, float, float]:
    return values[0], values[1], values[2]


def motion_of(name: str, entry: Any, folder: Path) -> model.MotionPlan:
    """Return one prescribed motion."""
    path = f"structure.motions.{name}"
    if isinstance(entry, parts.HarmonicMotionKeys):
        phase = [math.radians(angle) for angle in entry.phase_deg]
        return model.MotionPlan(
            name, "harmonic", entry.period, math.inf, entry.amplitude, _three(phase), entry.ramp,
        )  # fmt: skip
    if isinstance(entry, parts.CircularMotion):
        amplitude, turn = [0.0] * 3, [0.0] * 3
        first, second = ("xyz".index(letter) for letter in entry.plane)
        amplitude[first] = amplitude[second] = entry.radius
        # sin and cos: from the second axis to the first, or the other way
        turn[second] = 0.5 * math.pi if entry.turns == "with_waves" else -0.5 * math.pi
        return model.MotionPlan(
            name, "circular", entry.period, math.inf, _three(amplitude), _three(turn), entry.ramp,
        )  # fmt: skip
    rows = np.array(entry.rows) if entry.rows is not None else read_columns(folder, entry.file, 4, f"{path}.file")
    key = "rows" if entry.rows is not None else "file"
    late = np.flatnonzero(np.diff(rows[:, 0]) <= 0.0)
    if late.size:
        raise InputError(
            f"the times do not rise: {rows[late[0] + 1, 0]:g} s follows {rows[late[0], 0]:g} s", path=f"{path}.{key}",
            allowed="rising times",
        )  # fmt: skip
    table = Motion.from_table(rows[:, 0], rows[:, 1:])
    return model.MotionPlan(name, "table", math.nan, table.end, ramp=entry.ramp, table=table)
