"""Faults of a flexible cage that can be reported before anything is computed, and where it leaves its range."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.errors import InputError
from moyai.core.validity import IdentityCheck, Notice
from moyai.morison.net_law_choice import METAL, choice_notice, law_choice

if TYPE_CHECKING:
    import xarray as xr

    from moyai.structures.cage.flexible.model import FlexibleCage
    from moyai.structures.cage.flexible.problem import FlexibleCageProblem, FlexibleSettings
    from moyai.structures.cage.flexible.time import CageRun

#: Share of its straight way by which a line may be too short before it cannot reach [-].
_STRETCH = 0.15


def floating_balance(model: FlexibleCage) -> tuple[float, float]:
    """Return the submerged weight of one cage below its collar, and what the collar can bear beyond its own weight [N].

    Net, growth, sinkers, sinker tube and centre weight against the pipes of the collar wholly immersed.
    """
    design, water = model.design, model.water
    net, collar = design.net, design.collar
    area = design.rim * net.wall_depth
    if net.bottom != "none":
        base = math.pi / 4.0 * design.size**2 if design.shape == "circular" else design.size**2
        apothem = 0.5 * design.size
        area += base * math.sqrt(1.0 + (net.cone_depth / apothem) ** 2)
    twine = 2.0 / net.net.mesh_pitch * area
    weight = twine * (net.twine_mass - water.density * net.twine_volume) + design.centre_weight
    if design.sinkers is not None:
        weight += design.sinkers.count * (design.sinkers.mass - water.density * design.sinkers.volume)
    if design.bottom_ring is not None:
        ring = design.bottom_ring
        weight += design.rim * (ring.mass_per_length(water.density) - water.density * ring.volume_per_length)
    pipe = collar.pipe
    spare = water.density * pipe.volume_per_length - pipe.mass_per_length(water.density)
    length = design.rim
    if collar.rings == 2:
        outer = design.rim + (2.0 * math.pi if design.shape == "circular" else 8.0) * collar.spacing
        length += outer
    return weight * water.gravity, spare * length * water.gravity


def check_cage(model: FlexibleCage) -> None:
    """Raise InputError at the first fault of a cage.

    Raises
    ------
    InputError
        For a cage that does not float, a grid too narrow or too deep, lines that cannot reach.
    """
    from moyai.structures.cage.flexible.model import GridMooring

    weight, spare = floating_balance(model)
    mooring = model.mooring
    if not isinstance(mooring, GridMooring):
        if model.rows * model.columns > 1:
            raise InputError("several cages with held collars", parameter="mooring.rows", allowed="1 x 1")
        return
    if spare <= 0.0:
        raise InputError(
            f"the pipes of the collar weigh {-spare:.4g} N more than the water that they displace",
            parameter="collar.pipe",
            allowed="lighter than water",
            remedy="check diameter, wall_thickness, density and extra_mass_per_length",
        )
    if weight >= spare:
        raise InputError(
            f"the cage does not float: net and weights weigh {weight:.4g} N in water, the collar bears {spare:.4g} N "
            "wholly immersed",
            parameter="collar.pipe.diameter",
            allowed=f"weights below {spare:.4g} N",
            remedy="take a larger collar pipe, a second ring, or lighter weights",
        )
    width = model.design.size + 2.0 * (model.design.collar.spacing if model.design.collar.rings == 2 else 0.0)
    if mooring.spacing <= width:
        raise InputError(
            f"a bay of {mooring.spacing:g} m for a cage of {width:g} m",
            parameter="mooring.spacing",
            allowed=f"above {width:g} m",
        )
    rise = -model.bed.level - mooring.depth
    if rise <= 0.0:
        raise InputError(
            f"the frame lies {mooring.depth:g} m deep, the bed {-model.bed.level:g} m",
            parameter="mooring.depth",
            allowed=f"less than {-model.bed.level:g} m",
        )
    _check_reach(model, mooring, rise)


def _check_reach(model: FlexibleCage, mooring: object, rise: float) -> None:
    from moyai.structures.cage.flexible.model import GridMooring

    assert isinstance(mooring, GridMooring)
    straight = math.hypot(mooring.anchor_distance, rise)
    if mooring.line_length < (1.0 - _STRETCH) * straight:
        raise InputError(
            f"the anchor lines of {mooring.line_length:g} m cannot reach: {straight:.4g} m from frame to anchor",
            parameter="mooring.anchor_line",
            allowed=f"about {straight:.4g} m or more",
            remedy="lengthen the lines or bring the anchors nearer",
        )
    if mooring.line_length > mooring.anchor_distance + rise:
        raise InputError(
            f"anchor lines of {mooring.line_length:g} m hang straight down and lie slack on the way of "
            f"{mooring.anchor_distance:g} m",
            parameter="mooring.anchor_line",
            allowed=f"below {mooring.anchor_distance + rise:.4g} m",
            remedy="shorten the lines or move the anchors out",
        )
    if mooring.bridle_length is not None:
        reach = 0.5 * math.sqrt(2.0) * mooring.spacing - 0.5 * model.design.size * (
            1.0 if model.design.shape == "circular" else math.sqrt(2.0)
        )
        reach = math.hypot(max(reach, 0.0), mooring.depth)
        if mooring.bridle_length < (1.0 - _STRETCH) * reach:
            raise InputError(
                f"bridles of {mooring.bridle_length:g} m cannot reach: {reach:.4g} m from frame to collar",
                parameter="mooring.bridle_length",
                allowed=f"about {reach:.4g} m or more",
                remedy="lengthen the bridles, narrow the bay or raise the frame",
            )


def problem_notices(problem: FlexibleCageProblem) -> tuple[Notice, ...]:
    """Tell where net and speeds leave the range of their law, and where the mesh is coarse."""
    from moyai.structures.cage.rigid.model import RigidCageWaves

    model = problem.cage
    net = model.design.net
    speeds = list(problem.settings.current_speeds)
    current = problem.environment.current
    if current is not None:
        velocity = np.asarray(current.velocity(np.array([0.0, -net.wall_depth])))
        speeds.extend(np.hypot(velocity[:, 0], velocity[:, 1]).tolist())
    for sea in problem.seas:
        if isinstance(sea, RigidCageWaves):
            speeds.extend(math.pi * height / period for height, period in sea.waves())
        else:
            speeds.append(math.pi * float(sea.spectrum.significant_height) / float(sea.spectrum.peak_period))
    moving = [speed for speed in speeds if speed > 1e-3] or [0.1]
    notices = list(net.law.check(net.net, (min(moving), max(moving)), model.kinematic_viscosity))
    design = design_speed(problem)
    choice = law_choice(net.law, net.net, design, model.kinematic_viscosity, metal=net.density > METAL)
    notices.append(choice_notice(choice, net.net))
    if model.mesh.around < 16 or model.mesh.down < 4:
        notices.append(
            Notice(
                "cage-mesh",
                f"{model.mesh.around} knots around and {model.mesh.down} meshes down resolve the net coarsely",
                float(model.mesh.around),
                16.0,
                remedy="refine the mesh until volume and drag stand",
                source="mesh study in docs/validation/cage_flexible.md",
            )
        )
    return tuple(notices)


def design_speed(problem: FlexibleCageProblem) -> float:
    """Return the speed at which the laws of nets are compared: that of the current of the site at the surface, else
    of the water in the largest wave [m/s].
    """
    from moyai.structures.cage.rigid.model import RigidCageWaves

    current = problem.environment.current
    if current is not None:
        speed = float(np.hypot(*np.asarray(current.velocity(np.zeros(1)))[0]))
        if speed > 0.0:
            return speed
    speeds = [0.1]
    for sea in problem.seas:
        if isinstance(sea, RigidCageWaves):
            speeds.extend(math.pi * height / period for height, period in sea.waves())
        else:
            speeds.append(math.pi * float(sea.spectrum.significant_height) / float(sea.spectrum.peak_period))
    return max(speeds)


def rest_checks(level: str, statics: xr.Dataset) -> tuple[IdentityCheck, ...]:
    """Hold the pull on the anchors against the drag of the water on all parts."""
    moving = statics.variables["current_speed"].values > 0.0
    if not moving.any():
        return ()
    return (
        IdentityCheck(
            f"{level}: pull on the anchors equals the drag",
            float(statics.variables["balance"].values[moving].max()),
            0.02,
            "difference of both horizontal forces over the drag, the worst current",
        ),
    )


def rest_notices(level: str, model: FlexibleCage, statics: xr.Dataset, speed: float) -> tuple[Notice, ...]:
    """Tell what the rest of a cage shows that an engineer has to know, in the current of the site: no sweep decides."""
    notices = []
    residual = float(statics.variables["residual"].values.max())
    if residual > 1e-3:
        worst = float(statics.variables["current_speed"].values[int(np.argmax(statics.variables["residual"].values))])
        notices.append(
            Notice(
                "cage-rest",
                f"{level}: at {worst:.3g} m/s slack net does not come to rest: {residual:.2g} of the largest tension "
                "is left on a knot",
                residual,
                1e-3,
                remedy="take volume and drag there as those of a net that flutters",
            )
        )
    design = statics.isel(current=int(np.argmin(np.abs(statics.variables["current_speed"].values - speed))))
    least = float(design["volume_share"].values.min())
    if least < 0.5:
        notices.append(
            Notice(
                "cage-volume",
                f"{level}: at {speed:.3g} m/s only {100.0 * least:.3g} % of the volume is left",
                least,
                0.5,
                remedy="heavier weights, a sinker tube, or a site with less current",
            )
        )  # fmt: skip
    if "utilisation" in design and design["utilisation"].size and float(design["utilisation"].max()) > 1.0:
        line = str(design["line"].values[int(np.argmax(design["utilisation"].values))])
        notices.append(
            Notice(
                "cage-line-breaks", f"{level}: the tension of {line!r} exceeds its breaking load",
                float(design["utilisation"].max()), 1.0, "warning", "take a stronger rope or a looser grid",
            )
        )  # fmt: skip
    place = design["collar_place"].values[..., 2]
    draught = model.design.collar.pipe.diameter
    if isinstance_grid(model) and float(place.min()) < -0.5 * draught:
        notices.append(
            Notice(
                "cage-collar-sinks", f"{level}: the collar is drawn {-float(place.min()):.3g} m under still water",
                float(place.min()), -0.5 * draught, remedy="a larger collar, lighter weights or flatter bridles",
            )
        )  # fmt: skip
    return tuple(notices)


def isinstance_grid(model: FlexibleCage) -> bool:
    """Whether a grid holds the cage."""
    from moyai.structures.cage.flexible.model import GridMooring

    return isinstance(model.mooring, GridMooring)


def run_checks(sea: str, run: CageRun) -> tuple[IdentityCheck, ...]:
    """Return the identities of a run through time."""
    return tuple(
        IdentityCheck(f"{sea}, {run.wave.name}: {check.name}", check.value, check.tolerance, check.meaning)
        for check in run.history.checks
    )


def settling_notices(sea: str, series: xr.Dataset) -> tuple[Notice, ...]:
    """Tell what still moves at the end of a run through regular waves."""
    from moyai.structures.cage.flexible.time import unsettled

    moving = unsettled(series)
    if not moving:
        return ()
    name = max(moving, key=lambda key: abs(moving[key]))
    periods = (float(series["time"].values[-1]) - float(series.attrs["ramp"])) / float(series.attrs["period"])
    change = 100.0 * abs(moving[name])
    return (
        Notice(
            "cage-not-settled",
            f"{sea}, {series.attrs['wave']}: after {periods:.3g} periods {name} still changes by {change:.2g} % a "
            "period: what has not settled is a bound",
            change, severity="warning", remedy="give more 'settings.flexible.most_periods'",
        ),
    )  # fmt: skip


def run_notices(sea: str, run: CageRun, settings: FlexibleSettings) -> tuple[Notice, ...]:
    """Tell which lines snap and which break."""
    built, history = run.rest.built, run.history
    steady = history.time >= run.ramp - 1e-9
    notices = []
    for part in built.lines:
        bars = built.network.strands[part.strand].bars
        highest = float(history.tension_peak[steady][:, bars].max()) if steady.any() else 0.0
        if highest > part.breaking_load:
            notices.append(
                Notice(
                    "cage-line-breaks",
                    f"{sea}, {run.wave.name}: {part.name!r} reaches {highest:.4g} N, its breaking load is "
                    f"{part.breaking_load:.4g} N",
                    highest, part.breaking_load, "warning", "take a stronger rope or a looser grid",
                )
            )  # fmt: skip
    return tuple(notices[:3])
