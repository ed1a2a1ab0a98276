"""From the schema of a flexible cage to :mod:`moyai.structures.cage.flexible.model`."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from moyai.case.build_sea import current_of
from moyai.case.criteria import criteria_of
from moyai.core.errors import InputError
from moyai.flexible.bed import Bed
from moyai.morison.net_fouling import foul, foul_by_name
from moyai.morison.net_law_names import Net, net_law
from moyai.sea.environment import Environment
from moyai.sea.water import Water
from moyai.structures.cage.case import schema
from moyai.structures.cage.case import schema_flexible as parts
from moyai.structures.cage.case.build_rigid import seas_of
from moyai.structures.cage.flexible.collar import Collar, Pipe
from moyai.structures.cage.flexible.design import CageDesign, CageNet, Sinkers
from moyai.structures.cage.flexible.grid_mooring import Buoy, GridMooring
from moyai.structures.cage.flexible.model import CageMesh, FixedCollar, FlexibleCage
from moyai.structures.cage.flexible.problem import FlexibleCageProblem, FlexibleSettings
from moyai.tables.lines import LineProperties, line_type


@contextmanager
def _under(path: str) -> Iterator[None]:
    """Put the path of the case file before the one of another package's error."""
    try:
        yield
    except InputError as error:
        inner = error.fault.path.split(".")
        known = [_KEYS.get(name, name) for name in inner if name]
        raise error.at(".".join([path, *known[-1:]])) from None


#: What other packages call a key of the case file.
_KEYS = {"line_type": "catalogue"}


#: What a rope of its own EA may give, and what it has when it does not, as the schema states it; the
#: volume is that of the diameter.
_OF_OWN_ROPE = {
    "volume": math.nan, "drag": 1.2, "drag_tangential": 0.05, "added_mass_normal": 1.0, "added_mass_tangential": 0.0,
}  # fmt: skip


def build_problem(
    model: schema.CageCase, folder: Path, *, case_text: str = "", case_hash: str = ""
) -> FlexibleCageProblem:
    """Return the problem of a flexible cage.

    Parameters
    ----------
    model : CageCase
        Validated content with ``structure.model: flexible``.
    folder : Path
        Folder that the file names in it refer to.
    case_text, case_hash : str
        Kept with the result.

    Raises
    ------
    InputError
        For what the schema alone cannot see: closed meshes, unknown laws and lines, a cage that does not float.
    """
    if math.isinf(model.site.water_depth):
        raise InputError("a flexible cage needs a bed", path="site.water_depth", allowed="a finite depth")
    assert isinstance(model.structure, parts.FlexibleCageStructure)
    water = Water(model.site.water_depth, model.site.density, model.site.gravity)
    levels, chosen = model.site.water_levels, model.settings.water_levels
    names = tuple(levels) if isinstance(chosen, str) else chosen
    settings = model.settings.flexible
    return FlexibleCageProblem(
        title=model.title,
        cage=cage_of(model.structure, water),
        environment=Environment(
            water=water,
            water_levels=tuple((name, levels[name]) for name in names),
            current=current_of(model.current, water, model.site.x_axis_bearing_deg),
        ),
        seas=seas_of(model, water, folder),
        settings=settings.fill(FlexibleSettings, analyses=model.analyses),
        case_text=case_text,
        case_hash=case_hash,
        criteria=criteria_of(model),
    )


def pipe_of(entry: parts.PipeEntry, *, flooded: bool = False) -> Pipe:
    """Return a pipe."""
    return Pipe(
        entry.diameter, entry.wall_thickness, entry.density, entry.youngs_modulus, entry.poisson_ratio, entry.drag,
        entry.drag_along, entry.added_mass, entry.extra_mass, flooded,
    )  # fmt: skip


def clean_net_of(entry: parts.FlexibleNet) -> Net:
    """Return twine and mesh without growth."""
    d = entry.twine_diameter
    if entry.solidity is not None:
        return replace(Net.from_solidity(d, entry.solidity), solidity_measured=entry.solidity)
    pitch = entry.mesh_pitch if entry.mesh_pitch is not None else d + (entry.aperture or 0.0)
    return Net(d, pitch, None, entry.knotted)


def net_of(entry: parts.FlexibleNet) -> CageNet:
    """Return the net of a cage, with its growth."""
    with _under("structure.net"):
        net = clean_net_of(entry)
        clean, density = net.twine_diameter, 0.0
        law = net_law(entry.law)
    if entry.growth is not None:
        with _under("structure.net.growth"):
            if entry.growth.standard is not None:
                fouled = foul_by_name(net, entry.growth.standard)
            else:
                fouled = foul(net, entry.growth.diameter_factor or 1.0, entry.growth.density)
        net, density = fouled.net, fouled.density
    if (entry.bottom == "cone") != (entry.cone_depth is not None):
        raise InputError(
            "a cone needs 'cone_depth', other bottoms have none" if entry.bottom == "cone" else
            f"'cone_depth' belongs to 'bottom: cone', not to '{entry.bottom}'",
            path="structure.net.cone_depth",
        )  # fmt: skip
    with _under("structure.net"):
        return CageNet(
            net, law, entry.wake, entry.wall_depth, entry.bottom, entry.density, entry.youngs_modulus,
            entry.cone_depth or 0.0, entry.added_mass, clean, density, entry.damping,
        )  # fmt: skip


def rope_of(entry: parts.RopeEntry, path: str) -> LineProperties:
    """Return a rope: of the catalogue, or of its own properties."""
    with _under(path):
        if entry.catalogue is not None:
            found = line_type(entry.catalogue, entry.diameter)
            for key in ("mass", "breaking_load", *_OF_OWN_ROPE):
                if getattr(entry, key) is not None:
                    raise InputError(f"'{key}' belongs to a rope with a stated EA, not to the catalogue", path=key)
            return found
        if entry.mass is None or entry.breaking_load is None:
            missing = "mass" if entry.mass is None else "breaking_load"
            raise InputError(f"a rope with a stated EA needs '{missing}'", path=missing)
        assert entry.axial_stiffness is not None
        own = {key: getattr(entry, key) for key in _OF_OWN_ROPE if getattr(entry, key) is not None}
        taken = {**_OF_OWN_ROPE, "volume": math.pi / 4.0 * entry.diameter**2, **own}
        return LineProperties(
            "own rope", "as given", entry.diameter, entry.mass, taken["volume"], entry.axial_stiffness,
            entry.breaking_load, taken["drag"], taken["drag_tangential"], taken["added_mass_normal"],
            taken["added_mass_tangential"], (entry.diameter, entry.diameter), True, "case file",
        )  # fmt: skip


def _sinkers_of(entry: parts.SinkerSet, water: Water) -> Sinkers:
    if entry.submerged_weight is not None:
        if entry.density is not None:
            share = water.density / entry.density
            if share >= 1.0:
                raise InputError("sinkers lighter than water", path="structure.sinkers.density")
            mass = entry.submerged_weight / water.gravity / (1.0 - share)
            volume = mass / entry.density
            return Sinkers(entry.count, mass, volume, entry.drag_area, 0.5 * water.density * volume)
        return Sinkers(entry.count, entry.submerged_weight / water.gravity, 0.0, entry.drag_area)
    assert entry.mass is not None
    if entry.density is None:
        raise InputError(
            "sinkers of a mass in air need their density",
            path="structure.sinkers.density",
            remedy="give 'density', or 'submerged_weight' instead of 'mass'",
        )
    volume = entry.mass / entry.density
    return Sinkers(entry.count, entry.mass, volume, entry.drag_area, 0.5 * water.density * volume)


def _grid_of(entry: parts.GridEntry) -> GridMooring:
    segments = tuple(
        (rope_of(segment, f"structure.mooring.anchor_line[{k}]"), segment.length)
        for k, segment in enumerate(entry.anchor_line)
    )
    if entry.bridle_length is not None and entry.bridle_slack != 0.0:
        raise InputError(
            "'bridle_length' and 'bridle_slack' give the same quantity", path="structure.mooring.bridle_slack"
        )
    frame = rope_of(entry.frame_rope, "structure.mooring.frame_rope")
    bridle = rope_of(entry.bridle, "structure.mooring.bridle")
    with _under("structure.mooring"):
        return GridMooring(
            entry.bay, entry.frame_depth, frame,
            Buoy(entry.buoys.diameter, entry.buoys.mass, entry.buoys.drag), bridle, entry.bridles_per_corner, segments,
            entry.anchor_distance, entry.lines_per_corner, entry.bridle_slack, entry.bridle_length, entry.damping,
        )  # fmt: skip


def cage_of(unit: parts.FlexibleCageStructure, water: Water) -> FlexibleCage:
    """Return the cage of a case."""
    held = isinstance(unit.mooring, parts.HeldCollar)
    if unit.collar is None:
        if not held:
            raise InputError("a cage that floats needs its collar", path="structure.collar")
        # never built: the knots of a held collar do not move
        collar = Collar(Pipe(0.1, 0.01, 950.0, 1e9, 0.4, 1.0, 0.1, 1.0), rigid=True)
    else:
        with _under("structure.collar"):
            if unit.collar.rings == 2 and unit.collar.spacing is None:
                raise InputError("two rings need their spacing", path="spacing")
        with _under("structure.collar.pipe"):
            pipe = pipe_of(unit.collar.pipe)
        with _under("structure.collar"):
            collar = Collar(pipe, unit.collar.rings, unit.collar.spacing or 0.0, unit.collar.rigid)
    with _under("structure.sinker_tube"):
        tube = None if unit.sinker_tube is None else pipe_of(unit.sinker_tube, flooded=True)
    net = net_of(unit.net)
    sinkers = None if unit.sinkers is None else _sinkers_of(unit.sinkers, water)
    if isinstance(unit.mooring, parts.GridEntry):
        mooring: GridMooring | FixedCollar = _grid_of(unit.mooring)
        rows, columns, wake, step = unit.mooring.rows, unit.mooring.columns, unit.mooring.array_wake, unit.mooring.bay
    else:
        mooring, rows, columns, wake, step = FixedCollar(), 1, 1, False, unit.size
    mesh = unit.mesh
    try:
        design = CageDesign(unit.shape, unit.size, collar, net, sinkers, tube, unit.centre_mass)
        return FlexibleCage(
            design, mooring, water,
            Bed(-water.depth, unit.bed.stiffness, 0.1 * unit.bed.stiffness, unit.bed.friction),
            CageMesh(mesh.around, mesh.down, mesh.bottom, mesh.rope_length or 0.1 * step), unit.kinematic_viscosity,
            rows, columns, wake,
        )  # fmt: skip
    except InputError as error:
        fault = error.fault
        known = {
            "cage.size": "size", "cage.centre_weight": "centre_mass", "mooring.spacing": "mooring.bay",
            "mooring.depth": "mooring.frame_depth",
        }  # fmt: skip
        path = f"structure.{known.get(fault.path, fault.path)}"
        raise error.at(path) from None
