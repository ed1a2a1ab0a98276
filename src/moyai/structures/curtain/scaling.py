"""A curtain in model scale, by Froude's law."""

from __future__ import annotations

from dataclasses import replace

from moyai.design.similarity import Scale
from moyai.structures.curtain.statics.hanging import FloatLine, HangingCurtain
from moyai.structures.curtain.statics.section import Skirt


def scale_curtain(curtain: HangingCurtain, scale: Scale) -> HangingCurtain:
    """Return the model curtain of a prototype curtain: same shape, same strains, forces less by S^3."""
    skirt, floats = curtain.skirt, curtain.floats
    return replace(
        curtain,
        span=scale.to_model(curtain.span, "m"),
        length=scale.to_model(curtain.length, "m"),
        skirt=Skirt(
            scale.to_model(skirt.length, "m"),
            scale.to_model(skirt.submerged_weight, "N/m2"),
            scale.to_model(skirt.toe_load, "N/m"),
            scale.to_model(skirt.stiffness, "N/m"),
        ),
        floats=FloatLine(
            scale.to_model(floats.buoyancy, "N/m"),
            scale.to_model(floats.weight, "N/m"),
            scale.to_model(floats.flooded_buoyancy, "N/m"),
        ),
        upper_stiffness=scale.to_model(curtain.upper_stiffness, "N"),
        lower_stiffness=scale.to_model(curtain.lower_stiffness, "N"),
    )
