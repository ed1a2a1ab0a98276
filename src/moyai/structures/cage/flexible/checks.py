"""Faults of a flexible cage that can be reported before anything is computed, and where it leaves its range."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.validity import IdentityCheck, Notice
from moyai.morison.net_law_choice import METAL, choice_notice, law_choice
from moyai.structures.cage.flexible.grid_mooring import GridMooring
from moyai.structures.cage.rigid.model import RigidCageWaves

if TYPE_CHECKING:
    import xarray as xr

    from moyai.structures.cage.flexible.model import FlexibleCage
    from moyai.structures.cage.flexible.problem import FlexibleCageProblem, FlexibleSettings
    from moyai.structures.cage.flexible.time import CageRun


def problem_notices(problem: FlexibleCageProblem) -> tuple[Notice, ...]:
    """Tell where net and speeds leave the range of their law, and where the mesh is coarse."""
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
                remedy="refine the mesh until volume and drag no longer change",
                source="mesh study in docs/validation/cage_flexible.md",
            )
        )
    return tuple(notices)


def design_speed(problem: FlexibleCageProblem) -> float:
    """Return the speed at which the laws of nets are compared: that of the current of the site at the surface, else
    of the water in the largest wave [m/s].
    """
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
    """Compare the pull on the anchors with the drag of the water on all parts."""
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
            change, severity="warning", remedy="give more periods at most",
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
