"""Whether a cage floats in its grid, and whether the lines of the grid reach."""

from __future__ import annotations

import math

from moyai.core.errors import InputError
from moyai.flexible.bed import Bed
from moyai.sea.water import Water
from moyai.structures.cage.flexible.design import CageDesign
from moyai.structures.cage.flexible.grid_mooring import GridMooring

#: Share of its straight way by which a line may be too short before it cannot reach [-].
_STRETCH = 0.15


def floating_balance(design: CageDesign, water: Water) -> tuple[float, float]:
    """Return the submerged weight of one cage below its collar, and the buoyancy of the collar less its weight [N].

    Net, growth, sinkers, sinker tube and centre weight against the pipes of the collar wholly immersed.
    """
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


def check_moored(design: CageDesign, mooring: GridMooring, water: Water, bed: Bed) -> None:
    """Raise InputError at the first error of a cage in a grid.

    Raises
    ------
    InputError
        For a cage that does not float, a grid too narrow or too deep, lines that cannot reach.
    """
    weight, spare = floating_balance(design, water)
    if spare <= 0.0:
        raise InputError(
            f"the pipes of the collar weigh {-spare:.4g} N more than the water that they displace",
            parameter="collar.pipe",
            allowed="lighter than water",
            remedy="check diameter, wall_thickness, density and extra_mass_per_length",
        )
    if weight >= spare:
        raise InputError(
            f"the cage does not float: net and weights weigh {weight:.4g} N in water, the buoyancy of the collar is "
            f"{spare:.4g} N "
            "wholly immersed",
            parameter="collar.pipe.diameter",
            allowed=f"weights below {spare:.4g} N",
            remedy="take a larger collar pipe, a second ring, or lighter weights",
        )
    width = design.size + 2.0 * (design.collar.spacing if design.collar.rings == 2 else 0.0)
    if mooring.spacing <= width:
        raise InputError(
            f"a bay of {mooring.spacing:g} m for a cage of {width:g} m",
            parameter="mooring.spacing",
            allowed=f"above {width:g} m",
        )
    rise = -bed.level - mooring.depth
    if rise <= 0.0:
        raise InputError(
            f"the frame lies {mooring.depth:g} m deep, the bed {-bed.level:g} m",
            parameter="mooring.depth",
            allowed=f"less than {-bed.level:g} m",
        )
    _check_reach(design, mooring, rise)


def _check_reach(design: CageDesign, mooring: GridMooring, rise: float) -> None:
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
        reach = 0.5 * math.sqrt(2.0) * mooring.spacing - 0.5 * design.size * (
            1.0 if design.shape == "circular" else math.sqrt(2.0)
        )
        reach = math.hypot(max(reach, 0.0), mooring.depth)
        if mooring.bridle_length < (1.0 - _STRETCH) * reach:
            raise InputError(
                f"bridles of {mooring.bridle_length:g} m cannot reach: {reach:.4g} m from frame to collar",
                parameter="mooring.bridle_length",
                allowed=f"about {reach:.4g} m or more",
                remedy="lengthen the bridles, narrow the bay or raise the frame",
            )
