"""From the schema of a rigid cage to :mod:`moyai.structures.cage.rigid.model`."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.case.build_sea import current_of, sea_state_of
from moyai.case.criteria import criteria_of
from moyai.case.headings import heading_of
from moyai.case.schema_environment import RegularWavesOfHeights, sea_names
from moyai.core.errors import InputError
from moyai.morison.net_law_names import Net, NetLaw, net_law
from moyai.sea.environment import Environment
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.cage.case import schema
from moyai.structures.cage.case import schema_parts as parts
from moyai.structures.cage.rigid import shapes
from moyai.structures.cage.rigid.model import (
    CageSea,
    RigidCageProblem,
    RigidCageSettings,
    RigidCageWaves,
    RigidLinePlan,
)
from moyai.structures.cage.rigid.parts import Floats, PointWeight, RigidCage, Rod

#: Stated weight against the sum of the parts: what weighing and rounding may differ by
WEIGHT_TOLERANCE = 0.03


def build_problem(
    model: schema.CageCase, folder: Path, *, case_text: str = "", case_hash: str = ""
) -> RigidCageProblem:
    """Return the problem of a rigid cage.

    Parameters
    ----------
    model : CageCase
        Validated content with ``structure.model: rigid``.
    folder : Path
        Folder that the file names in it refer to.
    case_text, case_hash : str
        Kept with the result.

    Raises
    ------
    InputError
        For what the schema alone cannot see: contradictory weights, closed meshes, unknown laws, files.
    """
    water = Water(model.site.water_depth, model.site.density, model.site.gravity)
    levels, chosen = model.site.water_levels, model.settings.water_levels
    names = tuple(levels) if isinstance(chosen, str) else chosen
    unit, rigid = model.structure, model.settings.rigid
    assert isinstance(unit, schema.RigidCageStructure)
    return RigidCageProblem(
        title=model.title,
        cage=cage_of(unit, rigid.patches),
        plans=plans_of(unit),
        kinematic_viscosity=unit.kinematic_viscosity,
        environment=Environment(
            water=water,
            water_levels=tuple((name, levels[name]) for name in names),
            current=current_of(model.current, water, model.site.x_axis_bearing_deg),
        ),
        seas=seas_of(model, water, folder),
        equations=unit.equations,
        settings=rigid.fill(RigidCageSettings, analyses=model.analyses),
        case_text=case_text,
        case_hash=case_hash,
        criteria=criteria_of(model),
    )


def _at(path: str, error: InputError, known: Any = None) -> InputError:
    """Return an error of another package with the path of the case file before its key."""
    key = error.fault.path.split(".")[-1]
    inner = f".{key}" if known is not None and key in type(known).model_fields else ""
    return error.at(f"{path}{inner}")


def net_of(entry: parts.RigidNet) -> Net:
    """Return twine and mesh of a net entry."""
    d = entry.twine_diameter
    try:
        if entry.solidity is not None:
            return replace(
                Net.from_solidity(d, entry.solidity),
                solidity_listed=entry.solidity_listed,
                solidity_measured=entry.solidity,
            )
        pitch = entry.mesh_pitch if entry.mesh_pitch is not None else d + (entry.aperture or 0.0)
        return Net(d, pitch, entry.solidity_listed, entry.knotted)
    except InputError as error:
        raise _at("structure.net", error, entry) from None


def law_of(entry: parts.NetDrag) -> NetLaw:
    """Return the law of a net entry; options that the law does not have are left out."""
    try:
        law = net_law(entry.law)
        options: dict[str, object] = {
            key: value
            for key, value in (("cap", entry.cap), ("tangential_share", entry.tangential_share))
            if key in type(law).__dataclass_fields__ and value is not None
        }
        if entry.solidity is not None:
            if "solidity" not in type(law).__dataclass_fields__:
                raise InputError(
                    f"the law '{entry.law}' is for one solidity only", path="solidity", remedy="leave 'solidity' out"
                )
            options["solidity"] = entry.solidity
        return net_law(entry.law, **options)
    except InputError as error:
        raise _at("structure.net.drag", error, entry) from None


def cage_of(unit: schema.RigidCageStructure, patches: int) -> RigidCage:
    """Return the body of a rigid cage case."""
    shape, net = unit.shape, unit.net
    if isinstance(shape, parts.BoxShape):
        extent = (shape.length, shape.width, shape.height)
        faces = shapes.box_patches(*extent, net.faces, patches)
        rods = shapes.box_rods(*extent, unit.frame.diameter)
        if unit.floats.per_side is None:
            raise InputError(
                "the floats of a box are counted by side", path="structure.floats.count", remedy="give 'per_side'"
            )
        level = 0.5 * shape.height + unit.floats.above_top
        points = shapes.box_floats(shape.length, shape.width, level, unit.floats.per_side)
    else:
        extent = (shape.diameter, shape.diameter, shape.height)
        faces = shapes.cylinder_patches(shape.diameter, shape.height, net.faces, patches)
        rods = shapes.cylinder_rods(shape.diameter, shape.height, unit.frame.diameter)
        if unit.floats.count is None:
            raise InputError(
                "the floats of a cylinder are counted around the ring",
                path="structure.floats.per_side",
                remedy="give 'count'",
            )
        points = shapes.ring_floats(shape.diameter, 0.5 * shape.height + unit.floats.above_top, unit.floats.count)
    floats = Floats(points, unit.floats.diameter, unit.floats.mass, unit.floats.drag, unit.floats.added_mass)
    mass_per_area = net.mass_per_area
    if mass_per_area > 0.0 and net.density is None:
        raise InputError(
            "the density of the twine is missing", path="structure.net", remedy="give 'density' with 'mass_per_area'"
        )
    frame_mass = _frame_mass(unit, rods, floats, mass_per_area * faces.area)
    length = sum(rod.length for rod in rods)
    rods = tuple(replace(rod, mass=frame_mass * rod.length / length) for rod in rods)
    return RigidCage(
        floats=floats,
        patches=faces,
        net=net_of(net),
        law=law_of(net.drag),
        net_mass=mass_per_area,
        net_volume=mass_per_area / net.density if net.density else 0.0,
        net_added_mass=net.added_mass,
        rods=rods,
        rod_drag=unit.frame.drag,
        rod_added_mass=unit.frame.added_mass,
        extent=extent,
        weights=tuple(
            PointWeight(
                entry.name or f"sinker {n + 1}",
                (entry.x, 0.0, entry.z),
                entry.mass,
                entry.volume,
                entry.drag,
                entry.added_mass,
            )
            for n, entry in enumerate(unit.sinkers)
        ),
        outline=shape.kind,
        wake=net.wake,
    )


def _frame_mass(unit: schema.RigidCageStructure, rods: tuple[Rod, ...], floats: Floats, net_mass: float) -> float:
    """Return the mass of the frame: as given, from its density, or what the weight of the cage leaves over."""
    frame, weight = unit.frame, unit.weight
    all_floats = floats.mass * len(floats.points)
    if frame.mass is not None:
        given: float | None = frame.mass
    elif frame.density is not None:
        given = frame.density * sum(rod.volume for rod in rods)
    else:
        given = None
    if weight is None:
        if given is None:
            raise InputError(
                "the mass of the frame is not known",
                path="structure.frame",
                remedy="give 'density' or 'mass', or the weight of the whole cage as 'structure.weight'",
            )
        return given
    rest = weight.mass - net_mass - (all_floats if weight.floats_included else 0.0)
    if given is None:
        if rest < 0.0:
            raise _contradiction(weight, net_mass, 0.0, all_floats)
        return rest
    parts_mass = net_mass + given + (all_floats if weight.floats_included else 0.0)
    if abs(parts_mass - weight.mass) > WEIGHT_TOLERANCE * weight.mass:
        raise _contradiction(weight, net_mass, given, all_floats)
    return given


def _contradiction(weight: parts.RigidWeight, net: float, frame: float, floats: float) -> InputError:
    """Word a weight that the parts contradict, and which reading of it they would fit."""
    grams = 1e3
    without, whole = net + frame, net + frame + floats
    said = "with" if weight.floats_included else "without"
    sums = f"net {net * grams:.4g} g, frame {frame * grams:.4g} g and floats {floats * grams:.4g} g"
    remedy = "check the masses"
    if weight.floats_included and abs(without - weight.mass) <= WEIGHT_TOLERANCE * weight.mass:
        remedy = f"{weight.mass * grams:.4g} g fits net and frame alone: set 'floats_included: false'"
    elif not weight.floats_included and abs(whole - weight.mass) <= WEIGHT_TOLERANCE * weight.mass:
        remedy = f"{weight.mass * grams:.4g} g fits the cage with its floats: set 'floats_included: true'"
    elif abs(floats - weight.mass) <= WEIGHT_TOLERANCE * weight.mass:
        remedy = f"{weight.mass * grams:.4g} g is the mass of the floats alone"
    elif frame > 0.0:
        remedy = "check the masses, or leave the frame's out: it then takes what the weight leaves over"
    total = whole if weight.floats_included else without
    return InputError(
        f"the cage {said} floats is said to weigh {weight.mass * grams:.4g} g, its parts weigh {total * grams:.4g} g: "
        f"{sums}",
        path="structure.weight.mass",
        allowed=f"within {100.0 * WEIGHT_TOLERANCE:g} % of the parts",
        remedy=remedy,
    )


def plans_of(unit: schema.RigidCageStructure) -> tuple[RigidLinePlan, ...]:
    """Return the planned lines of a case: of a pair the offshore one (-x) first."""
    mooring = unit.mooring
    if mooring is None:
        return ()
    if isinstance(mooring, parts.LinesMooring):
        return tuple(_own_plan(line) for line in mooring.lines)
    shape = unit.shape
    half = 0.5 * (shape.length if isinstance(shape, parts.BoxShape) else shape.diameter)
    level = {"top": 0.5, "middle": 0.0, "bottom": -0.5}[mooring.kind.split("_")[1]] * shape.height
    crossed = mooring.kind.startswith("crossed")
    setting, value = _setting(mooring, ("pull_down", "pretension", "slack", "length"))
    plans = []
    for name, side in (("offshore line", -1.0), ("shore line", 1.0)):
        anchor = side * mooring.anchor_distance * (-1.0 if crossed else 1.0)
        plans.append(
            RigidLinePlan(
                name,
                (side * half, level),
                anchor,
                mooring.anchor_above_bed,
                setting,
                value,
                mooring.stiffness,
                mooring.axial_stiffness,
                mooring.gauge_stiffness,
                mooring.damping,
                mooring.submerged_weight,
                mooring.breaking_load,
            )
        )
    return tuple(plans)


def _setting(entry: Any, keys: tuple[str, ...]) -> tuple[Any, float]:
    for key in keys:
        value = getattr(entry, key, None)
        if value is not None:
            return key, float(value)
    raise AssertionError("the schema requires one of them")


def _own_plan(line: parts.OwnLine) -> RigidLinePlan:
    setting, value = _setting(line, ("pretension", "slack", "length"))
    return RigidLinePlan(
        line.name,
        (line.attachment.x, line.attachment.z),
        line.anchor.x,
        line.anchor.above_bed,
        setting,
        value,
        line.stiffness,
        line.axial_stiffness,
        line.gauge_stiffness,
        line.damping,
        line.submerged_weight,
        line.breaking_load,
    )


def seas_of(model: schema.CageCase, water: Water, folder: Path) -> tuple[CageSea, ...]:
    """Return every sea state."""
    bearing = model.site.x_axis_bearing_deg
    names = sea_names(model.waves)
    found: list[CageSea] = []
    for index, state in enumerate(model.waves):
        if isinstance(state, RegularWavesOfHeights):
            heading = heading_of(state, bearing, f"waves[{index}]")
            sizes = state.all_heights(), state.all_periods()
            found.append(RigidCageWaves(names[index], *sizes, _straight(heading), state.theory))
            continue
        sea = sea_state_of(state, index, model.waves, water, folder, bearing)
        assert isinstance(sea, IrregularSea)
        found.append(replace(sea, heading=_straight(sea.heading)))
    return tuple(found)


def _straight(heading: float) -> float:
    """Return 0 or pi where a heading [rad] is that but for rounding."""
    for exact in (0.0, math.pi):
        if abs(math.remainder(heading - exact, 2.0 * math.pi)) < 1e-9:
            return exact
    return heading
