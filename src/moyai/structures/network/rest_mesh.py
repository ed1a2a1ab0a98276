"""A network at rest on finer and finer meshes, until its tensions, pulls and places stand: [eq:rest-doublings].

How the answer is made: docs/answer/network.md.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.headline import Band
from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.refine import refined
from moyai.flexible.result import Equilibrium, State
from moyai.flexible.statics import solve_equilibrium
from moyai.structures.network.assembly import Assembly, assemble
from moyai.structures.network.bodies import rest_of
from moyai.structures.network.equilibrium import named_points, pulls
from moyai.structures.network.finer import finer_problem
from moyai.structures.network.held_rows import held_pulls
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

#: Last change of the meshes, and how far it may be from half of the change before, over what is found: below both no
#: finer mesh is looked for.
CHANGE, UNEVEN = 0.02, 0.004
#: The same up to which an answer is taken where no finer mesh can be had.
MOST_CHANGE, MOST_UNEVEN = 0.05, 0.01
#: Part of the highest tension of the network below which tensions and pulls are measured against it.
FLOOR = 0.25
#: Bars of a line clear of the bed, at least, where others lie on it: of fewer the node at the touchdown decides.
LEAST_CLEAR = 32
#: Weight of a bar at the touchdown over the pull of its line, up to which it lifts as a finer one does; part of the
#: size of the network by which points may move without.
LEAST_LIFT, MOST_LIFT = 0.125, 0.005
#: Bars of the finest mesh, at most, without bodies and with them; doublings, at most.
MOST_BARS, MOST_BARS_OF_BODIES, MOST_DOUBLINGS = 20_000, 4_000, 10
#: Segments of a line up to which one doubling alone shows nothing, and from which one is enough where it changes less
#: than half of the above.
COARSE, FINE = 12, 40
#: Height over the bed, over that of the network, up to which a node lies on it.
_ON_BED = 1e-4
#: What the band of a number at rest is of.
MESH = "mesh: twice the segments, repeatedly until the change is small, and that change extrapolated"


@dataclass(frozen=True, eq=False)
class _RestMesh:
    """A network at rest on one mesh."""

    problem: NetworkProblem
    assembly: Assembly
    #: Before bodies carry its points to their rest.
    plain: Network
    network: Network
    state: State
    tension: Array
    #: Places of the bodies [m]; shape (bodies, 3).
    solids: Array
    #: Bars of the lines, of parts of lines with a strength of their own, and of the nets.
    lines: Mapping[str, NDArray[np.int64]]
    parts: Mapping[str, NDArray[np.int64]]
    nets: Mapping[str, NDArray[np.int64]]


def _finer(mesh: _RestMesh, flow: Flow) -> _RestMesh:
    """Return the rest on twice the bars, of nets whose bars gather twines on twice the knots.

    Raises
    ------
    ConvergenceError, InputError
        Where there is none.
    """
    problem, assembly = mesh.problem, mesh.assembly
    if problem.gathers_twines:
        problem = finer_problem(problem)
        assembly = assemble(problem, assembly.level)
        plain, begin = assembly.network, None
        bars = _bars(assembly)
    else:
        plain, begin = refined(mesh.plain, 2, mesh.state)
        bars = tuple(
            {name: np.concatenate([2 * bars, 2 * bars + 1]) for name, bars in own.items()}
            for own in (mesh.lines, mesh.parts, mesh.nets)
        )
    if problem.bodies:
        both = rest_of(problem, plain, flow)
        solids = np.array([both.bodies[body.name].position for body in problem.bodies])
        return _RestMesh(problem, assembly, plain, both.network, both.state, both.tension, solids, *bars)
    if begin is None:
        # a net that hangs finds its rest in a current where one as built may not
        begin = solve_equilibrium(plain, flow=Flow()).state
    own = solve_equilibrium(plain, flow=flow, start=begin)
    return _RestMesh(problem, assembly, plain, plain, own.state, own.tension, mesh.solids, *bars)


def _bars(assembly: Assembly) -> tuple[dict[str, NDArray[np.int64]], ...]:
    lines, parts = ({name: one.bars for name, one in own.items()} for own in (assembly.lines, assembly.parts))
    return lines, parts, dict(assembly.net_bars)


@dataclass(frozen=True, eq=False)
class _OfRest:
    """Of one mesh: tensions of lines, parts and nets, pulls of nets and on points [N], places of points and bodies [m].

    ``clear``: bars of each line that are clear of the bed, infinite where none or all of it lies there. ``lift``: see
    :func:`_lift`; ``size``: of the network [m].
    """

    clear: Array
    lift: float
    size: float
    lines: Array
    parts: Array
    nets: Array
    held: Array
    held_level: Array
    pulls: Array
    places: Array
    solids: Array


def _read(mesh: _RestMesh, names: list[str], widths: Mapping[str, float]) -> _OfRest:
    """Return what is read of a mesh: tensions of nets of strips as wide as ``widths`` says, those of the first."""
    lines, parts = (
        np.array([float(mesh.tension[bars].max()) for bars in own.values()]) for own in (mesh.lines, mesh.parts)
    )
    nodes = np.array([mesh.network.points[name] for name in names], dtype=np.int64)
    load = pulls(mesh.network, nodes, mesh.state.position[None], mesh.tension[None])[0]
    nets = [float(mesh.tension[bars].max()) for bars in mesh.nets.values()]
    if mesh.problem.gathers_twines:
        own, strips = mesh.assembly.net_widths, mesh.assembly.net_tensions(mesh.tension[None])
        pairs = zip(mesh.nets, strips, strict=True)
        nets = [widths.get(name, 1.0) / own.get(name, 1.0) * float(strip.max()) for name, strip in pairs]
    held = held_pulls(mesh.network, mesh.nets, mesh.state.position[None], mesh.tension[None])
    held = np.zeros((1, len(nets), 3)) if held is None else held
    size = float(np.max(np.ptp(mesh.state.position, axis=0)))
    return _OfRest(
        _clear(mesh), _lift(mesh), size, lines, parts, np.array(nets), np.linalg.norm(held[0], axis=1),
        np.linalg.norm(held[0, :, :2], axis=1),
        np.linalg.norm(load, axis=1), mesh.state.position[nodes], mesh.solids,
    )  # fmt: skip


def _clear(mesh: _RestMesh) -> Array:
    """Return the bars of each line that are clear of the bed, infinite where none or all of it lies there.

    Of a line that touches down more than once, those of the stretch over the bed that has fewest.
    """
    on_bed, out = _on_bed(mesh), []
    for own in mesh.lines.values():
        lies = on_bed[np.sort(own)]
        stretches = np.split(lies, np.flatnonzero(np.diff(lies)) + 1)
        counts = [float(one.size) for one in stretches if not one[0]] if lies.any() else []
        out.append(min(counts, default=math.inf))
    return np.array(out)


def _on_bed(mesh: _RestMesh) -> NDArray[np.bool_]:
    """Return which bars lie on the bed."""
    bed, place, bars = mesh.network.bed, mesh.state.position, mesh.network.bars
    if bed is None:
        return np.zeros(len(bars), dtype=bool)
    lies = place[:, 2] <= bed.level_at(place) + _ON_BED * max(float(np.ptp(place[:, 2])), 1e-12)
    return np.asarray(lies[bars.start] & lies[bars.end])


def _lift(mesh: _RestMesh) -> float:
    """Return how far points may move where bars at a touchdown are too heavy for their line to lift [m].

    A bar that weighs more than its line pulls lies, or stands, as a whole, where a finer one would lift in part: two
    meshes of such bars agree by chance. Lifted is the length that weighs as much as the line pulls; over it what hangs
    moves as a straight line with its end so much higher.
    """
    network, place, on_bed = mesh.network, mesh.state.position, _on_bed(mesh)
    bars, worst = network.bars, 0.0
    weights = np.array([kind.submerged_weight_per_length(network.water) for kind in bars.types])[bars.kind]
    for line in mesh.lines.values():
        own = np.sort(line)
        for touch in np.flatnonzero(np.diff(on_bed[own])):
            pair = own[touch : touch + 2]
            pull = float(mesh.tension[pair].max())
            heavy = pair[int(np.argmax(weights[pair] * bars.length[pair]))]
            weight, length = float(weights[heavy]), float(bars.length[heavy])
            if weight * length <= LEAST_LIFT * pull:
                continue
            lifted = min(length, pull / weight)
            far = bars.end[own[-1]] if on_bed[pair[0]] else bars.start[own[0]]
            away = np.abs(place[far] - place[bars.start[pair[1]]])
            run, rise = math.hypot(away[0], away[1]), float(away[2])
            worst = max(worst, lifted + math.sqrt(run**2 + 2.0 * rise * lifted) - run)
    return worst


def heavy_touchdown(problem: NetworkProblem, assembly: Assembly, found: Mapping[str, Equilibrium]) -> bool:
    """Whether bars at a touchdown are too heavy for their line to lift in the current, and points may move by it.

    Without a current a slack line leaves its float where it is drawn, whatever its bars.

    Parameters
    ----------
    problem : NetworkProblem
    assembly : Assembly
    found : mapping of str to Equilibrium
        By condition.
    """
    if "current" not in found:
        return False
    network, rest = assembly.network, found["current"]
    mesh = _RestMesh(problem, assembly, network, network, rest.state, rest.tension, np.zeros((0, 3)), *_bars(assembly))
    return _lift(mesh) > MOST_LIFT * float(np.max(np.ptp(rest.state.position, axis=0)))


def with_finer_meshes(
    dataset: xr.Dataset,
    problem: NetworkProblem,
    assembly: Assembly,
    found: Mapping[str, Equilibrium],
    flows: Mapping[str, Flow],
) -> xr.Dataset:
    """Return the dataset with tensions, pulls and places of points on meshes of twice the bars each.

    Bars are cut in two again and again until the answer stands, or no finer rest is found. The dataset stays as it is
    where not even the first is.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of the network at rest.
    problem : NetworkProblem
    assembly : Assembly
    found : mapping of str to Equilibrium
        By condition.
    flows : mapping of str to Flow
        In which it is at rest.
    """
    names, _ = named_points(assembly)
    bars = _bars(assembly)
    lines, parts, nets = bars
    few = min((line.size for line in lines.values()), default=0)
    most = MOST_BARS_OF_BODIES if problem.bodies else MOST_BARS
    every: dict[str, list[_OfRest]] = {}
    for name, rest in found.items():
        solids = dataset["solid_position"].sel(condition=name).values if problem.bodies else np.zeros((0, 3))
        network = assembly.network
        mesh = _RestMesh(problem, assembly, network, network, rest.state, rest.tension, solids, *bars)
        own = every[name] = [_read(mesh, names, assembly.net_widths)]
        while len(own) <= MOST_DOUBLINGS and not _stands(own, few):
            if len(own) > 1 and len(mesh.plain.bars) > most // 2:
                break
            try:
                mesh = _finer(mesh, flows[name])
            except (ConvergenceError, InputError):
                break
            own.append(_read(mesh, names, assembly.net_widths))
    count = max(map(len, every.values()))
    lifts = np.array([[one.lift for one in own] + [math.nan] * (count - len(own)) for own in every.values()])
    if min(map(len, every.values())) < 2:
        return dataset

    def of(key: str) -> Array:
        values = [np.array([getattr(one, key) for one in own]) for own in every.values()]
        return np.array([np.concatenate([one, np.full((count - len(one), *one.shape[1:]), np.nan)]) for one in values])

    data: dict[str, object] = {
        "point_load_of_mesh": (("condition", "mesh", "point"), of("pulls")),
        "point_position_of_mesh": (("condition", "mesh", "point", "axis"), of("places")),
        "lift_of_mesh": (("condition", "mesh"), lifts),
    }
    if problem.bodies:
        data["solid_position_of_mesh"] = (("condition", "mesh", "solid", "axis"), of("solids"))
    if lines:
        data["line_tension_of_mesh"] = (("condition", "mesh", "line"), of("lines"))
        data["clear_bars_of_mesh"] = (("condition", "mesh", "line"), of("clear"))
    if parts:
        data["part_tension_of_mesh"] = (("condition", "mesh", "part"), of("parts"))
    if nets:
        data["net_tension_of_mesh"] = (("condition", "mesh", "net"), of("nets"))
        data["held_pull_of_mesh"] = (("condition", "mesh", "net"), of("held"))
        data["held_level_pull_of_mesh"] = (("condition", "mesh", "net"), of("held_level"))
    out = dataset.assign(data).assign_coords(mesh=2 ** np.arange(count))
    return labelled(out)


def _stands(own: list[_OfRest], few: int) -> bool:
    """Whether no finer mesh is needed; ``few``: segments of the line that has fewest."""
    if len(own) < 2 or (len(own) < 3 and few < FINE):
        return False
    lines, loads = (np.array([getattr(one, key) for one in own]) for key in ("lines", "pulls"))
    if own[-1].lift > MOST_LIFT * own[-1].size:
        return False
    floor, clear = _floor(lines, loads), float(own[-1].clear.min(initial=math.inf))
    return all(Reach.of(column, floor, clear=clear).stands for values in (lines, loads) for column in values.T)


def _floor(lines: Array, loads: Array) -> float:
    """Return what small tensions and pulls are measured against."""
    return FLOOR * float(max(lines[-1].max(initial=0.0), loads[-1].max(initial=0.0)))


@dataclass(frozen=True)
class Reach:
    """What finer and finer meshes make of a number: [eq:rest-doublings]."""

    low: float
    high: float
    #: Whether the last changes are small and of one kind, and whether they are so small that no more is needed.
    settled: bool
    stands: bool

    @classmethod
    def of(cls, values: Array, floor: float = 0.0, few: bool = True, clear: float = math.inf) -> Reach:
        """Return it for a number on meshes of 1, 2, 4 ... times the bars.

        Parameters
        ----------
        values : ndarray, shape (meshes,)
        floor : float
            What changes are measured against where the number itself is smaller.
        few : bool
            Whether the first mesh is so coarse that one doubling alone shows nothing.
        clear : float
            Bars of the line that are clear of the bed on the finest mesh, infinite where none lies on it: the
            touchdown is known to half a bar, and the tension stands half a bar from the end.
        """
        values = values[np.isfinite(values)]
        last = float(values[-1])
        if len(values) < 2:
            return cls(last, last, False, False)
        scale = max(abs(last), floor)
        change = float(values[-1] - values[-2])
        uneven = abs(change - 0.5 * float(values[-2] - values[-3])) if len(values) > 2 else 0.5 * abs(change)
        # an error of first order continues by the last change; what is not of first order, by as much as it differs
        bar = abs(last) / clear
        ends = [float(values[0]), last - bar, last + bar, last + change - uneven, last + change + uneven]
        if len(values) > 2:
            settled = abs(change) <= MOST_CHANGE * scale and uneven <= MOST_UNEVEN * scale
            stands = abs(change) <= CHANGE * scale and uneven <= UNEVEN * scale
        else:
            settled = not few and abs(change) <= MOST_CHANGE * scale
            stands = abs(change) <= 0.5 * CHANGE * scale
        enough = clear >= LEAST_CLEAR
        return cls(max(min(ends), min(0.0, last)), max(ends), settled and enough, stands and enough)


def reach_at_rest(rest: xr.Dataset, network: xr.Dataset, key: str, condition: str, **of: str) -> Reach | None:
    """Return what finer meshes make of a tension or pull at rest; None where none was run.

    Parameters
    ----------
    rest, network : xarray.Dataset
        Of the network at rest, and of the network itself.
    key : str
        One of the variables that end with ``_of_mesh``.
    condition : str
    of : str
        Name of the line, part, net or point.
    """
    if key not in rest:
        return None
    here = rest.sel(condition=condition)
    here = here.isel(mesh=np.isfinite(here["point_load_of_mesh"].values).all(axis=1))
    lines = here["line_tension_of_mesh"].values if "line_tension_of_mesh" in here else np.zeros((here.sizes["mesh"], 0))
    return Reach.of(
        here[key].sel(of).values, _floor(lines, here["point_load_of_mesh"].values), _few(network), _clear_of(here, of)
    )  # fmt: skip


def _clear_of(here: xr.Dataset, of: Mapping[str, str]) -> float:
    """Return the bars clear of the bed of the line that is asked for, of the one that has fewest where none is."""
    if "clear_bars_of_mesh" not in here:
        return math.inf
    line = of.get("line", "")
    last = here["clear_bars_of_mesh"].isel(mesh=-1)
    return float(last.sel(line=line) if line else last.min())


def _few(network: xr.Dataset) -> bool:
    return bool((network["line_segments"].values <= COARSE).any())


def band_at_rest(
    rest: xr.Dataset, network: xr.Dataset, key: str, condition: str, **of: str
) -> tuple[Band | None, bool]:
    """Return the band of a tension or pull at rest, and whether finer meshes settle it: where not, it may be more."""
    reach = reach_at_rest(rest, network, key, condition, **of)
    if reach is None:
        return None, False
    return Band(reach.low, reach.high, MESH), reach.settled


def coarse_rest(rest: xr.Dataset, network: xr.Dataset, goal: float, said: str) -> list[Notice]:
    """Warn of a line whose highest tension at rest finer meshes move by more than a part of it.

    Parameters
    ----------
    rest, network : xarray.Dataset
        Of the network at rest, and of the network itself.
    goal : float
        That part.
    said : str
        Water level, in words.
    """
    if "line_tension_of_mesh" not in rest:
        return []
    worst: tuple[float, Notice] | None = None
    for condition in (str(name) for name in rest["condition"].values):
        values = rest["line_tension_of_mesh"].sel(condition=condition).values
        values = values[np.isfinite(values).all(axis=1)]
        scale = np.maximum(values[-1], FLOOR * values[-1].max(initial=0.0))
        for number, line in enumerate(str(name) for name in rest["line"].values):
            own = values[:, number]
            change = abs(own[-1] - own[0]) / scale[number] if scale[number] > 0.0 else 0.0
            if not change > goal or (worst is not None and change <= worst[0]):
                continue
            segments = int(network["line_segments"].sel(line=line))
            most = segments * 2 ** (len(own) - 1)
            enough = next((k for k, one in enumerate(own) if abs(own[-1] - one) <= goal * scale[number]), len(own) - 1)
            worst = change, Notice(
                "coarse-rest",
                f"{said}the highest tension of '{line}' at rest in {condition}, {spoken(own[0], 'N')}, is "
                f"{spoken(own[-1], 'N', like=own[-1])} with {most} segments",
                float(change), goal, "warning", f"give the line {segments * 2**enough} segments",
            )  # fmt: skip
    return [] if worst is None or not math.isfinite(worst[0]) else [worst[1]]
