"""The span of a level of a case, for dynamics: what the case says, and what it must say."""

from __future__ import annotations

import math

from moyai.core.errors import InputError
from moyai.structures.curtain.analyses.impact import drag_coefficient
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.dynamic.model import AnchoredSupport, CurtainSpan
from moyai.structures.curtain.dynamic.runs import DynamicSettings


def span_of(unit: LevelCurtain, settings: DynamicSettings) -> CurtainSpan:
    """Return the span of a level for dynamics.

    Raises
    ------
    InputError
        For what the case does not say: the stretch of skirt or cables, masses, the buoys of anchored supports.
    """
    curtain, water = unit.curtain, unit.water
    skirt, g = curtain.skirt, water.gravity
    if math.isinf(skirt.stiffness):
        raise InputError(
            "the skirt does not stretch: dynamics needs its stiffness",
            parameter="skirt.stiffness",
            allowed="a stiffness",
        )
    if settings.sheet_mass is None:
        raise InputError(
            "the mass of the sheet is not known",
            parameter="settings.dynamic.sheet_mass",
            remedy="give it, or the mass per area of the skirt with the density of the sheet or a film",
        )
    volume = settings.sheet_volume
    if math.isnan(volume):
        volume = (settings.sheet_mass - skirt.submerged_weight / g) / water.density
    if volume < 0.0:
        raise InputError(
            f"a sheet of {settings.sheet_mass:g} kg/m2 cannot weigh {skirt.submerged_weight:g} N/m2 under water",
            parameter="settings.dynamic.sheet_mass",
            allowed=f"at least {skirt.submerged_weight / g:.4g} kg/m2",
        )
    if not settings.ballast_density > water.density:
        raise InputError(
            f"ballast of {settings.ballast_density:g} kg/m3 floats",
            parameter="settings.dynamic.ballast_density",
            allowed=f"more than {water.density:g} kg/m3",
        )
    ballast = skirt.toe_load / g / (1.0 - water.density / settings.ballast_density)
    lift = curtain.floats.buoyancy / (water.density * g)
    height = settings.float_height if settings.float_height is not None else math.sqrt(4.0 * lift / math.pi)
    if curtain.floats.weight <= 0.0:
        raise InputError(
            "floats and top cable have no weight: dynamics needs their mass",
            parameter="floats.weight",
            allowed="greater than 0",
        )
    held = curtain.toe == "held"
    return CurtainSpan(
        span=curtain.span,
        length=curtain.length,
        skirt_length=skirt.length,
        chord=skirt.length,
        upper_stiffness=curtain.upper_stiffness,
        lower_stiffness=curtain.lower_stiffness,
        upper_mass=curtain.floats.weight / g,
        lower_mass=ballast,
        sheet_stiffness=skirt.stiffness,
        sheet_mass=settings.sheet_mass,
        lower_volume=ballast / settings.ballast_density,
        span_stiffness=settings.span_stiffness,
        shear_stiffness=settings.shear_stiffness,
        sheet_volume=volume,
        drag_coefficient=drag_coefficient(unit, unit.depth),
        float_volume=lift,
        float_height=height,
        edges="risen" if held else "free",
        support=_support(unit, settings),
    )


def _support(unit: LevelCurtain, settings: DynamicSettings) -> AnchoredSupport | None:
    anchors = unit.curtain.anchors
    if anchors is None:
        return None
    if settings.support_mass is None:
        raise InputError(
            "the buoys of anchored supports need their mass",
            parameter="settings.dynamic.support_mass",
            remedy="give the mass of one buoy with its added mass, or leave the anchors out for fixed supports",
        )
    if not math.isfinite(anchors.stiffness):
        raise InputError(
            "the stiffness of the anchor lines is not known", parameter="anchors", remedy="give 'axial_stiffness'"
        )
    pretension = anchors.pretension
    return AnchoredSupport(
        anchors.length,
        anchors.slope_in(unit.water.depth),
        anchors.stiffness * anchors.length,
        0.0 if pretension is None else pretension,
        settings.support_mass,
    )


__all__ = ["span_of"]
