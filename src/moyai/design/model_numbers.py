"""Which dimensionless numbers a Froude model keeps, and by how much it misses the others."""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.design.similarity import Scale, check_model
from moyai.tables.waters import WaterProperties


@dataclass(frozen=True)
class WaterMotion:
    """How water passes the member whose loads matter, in the prototype."""

    #: Largest speed of the water past it [m/s].
    speed: float
    #: Its size across the flow [m].
    across: float
    #: Wave period [s]; infinite without waves.
    period: float
    #: [m]; may be infinite.
    water_depth: float

    def __post_init__(self) -> None:
        for name, value in (("speed", self.speed), ("across", self.across)):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
        for name, value in (("period", self.period), ("water_depth", self.water_depth)):
            if not value > 0.0:
                raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")


@dataclass(frozen=True)
class ModelNumber:
    """A dimensionless number in both sizes."""

    name: str
    #: Number of the prototype [-].
    prototype: float
    #: Number of the model [-].
    model: float
    #: Whether Froude scaling with scaled stiffness keeps it.
    kept: bool
    #: What it governs, and what suffers where it is not kept.
    meaning: str


def model_numbers(
    scale: Scale, motion: WaterMotion, *, gravity: float, prototype: WaterProperties, model: WaterProperties
) -> tuple[ModelNumber, ...]:
    """Return the numbers of both sizes, the kept ones first [eq:similarity-numbers].

    Parameters
    ----------
    scale : Scale
        Ratios of prototype to model.
    motion : Motion
        Of the prototype.
    gravity : float
        Of the prototype [m/s2].
    prototype, model : WaterProperties
        Viscosity and surface tension of both; the densities are those of ``scale``.
    """
    speed, across = scale.to_model(motion.speed, "m/s"), scale.to_model(motion.across, "m")
    light = prototype.density / scale.density
    numbers = [
        ModelNumber(
            "Froude (size)",
            motion.speed / math.sqrt(gravity * motion.across),
            speed / math.sqrt(gravity / scale.gravity * across),
            True,
            "waves, drag against weight",
        )
    ]
    if math.isfinite(motion.water_depth):
        depth = scale.to_model(motion.water_depth, "m")
        numbers.append(
            ModelNumber(
                "Froude (depth)",
                motion.speed / math.sqrt(gravity * motion.water_depth),
                speed / math.sqrt(gravity / scale.gravity * depth),
                True,
                "long waves, flow under the toe",
            )
        )
    if math.isfinite(motion.period):
        period = scale.to_model(motion.period, "s")
        numbers.append(
            ModelNumber(
                "Keulegan-Carpenter",
                motion.speed * motion.period / motion.across,
                speed * period / across,
                True,
                "vortices of each half wave; kept",
            )
        )
    numbers += [
        ModelNumber("strain, Cauchy C_E", 1.0, 1.0, True, "stretch, if every EA and spring is scaled; ratio of both"),
        ModelNumber(
            "Reynolds",
            motion.speed * motion.across / prototype.viscosity,
            speed * across / model.viscosity,
            False,
            "drag coefficients of chain, rope, twine, edges: too large in the model",
        ),
        ModelNumber(
            "Weber",
            prototype.density * motion.speed**2 * motion.across / prototype.surface_tension,
            light * speed**2 * across / model.surface_tension,
            False,
            "short waves, meniscus at floats and gauges",
        ),
        ModelNumber(
            "modulus of one material",
            1.0,
            scale.length * scale.density * scale.gravity,
            False,
            "the prototype's own material, thinned by the scale, is too stiff by this factor",
        ),
    ]
    if scale.density != 1.0:
        numbers.append(
            ModelNumber(
                "density of one material",
                1.0,
                scale.density,
                False,
                "over that of the water: the same steel or concrete is too heavy by this factor, air too",
            )
        )
    return tuple(numbers)


def check_numbers(
    scale: Scale,
    motion: WaterMotion,
    numbers: tuple[ModelNumber, ...],
    *,
    gravity: float,
    prototype: WaterProperties,
    model: WaterProperties,
) -> tuple[Notice, ...]:
    """Tell where the model is too small, and where its drag would be of another kind than the prototype's.

    Parameters
    ----------
    scale, motion, gravity, prototype, model
        As for :func:`model_numbers`.
    numbers : tuple of ModelNumber
        What that gave.
    """
    reynolds = next(number for number in numbers if number.name == "Reynolds")
    notices = list(check_model(scale, period=motion.period, water_depth=motion.water_depth, reynolds=reynolds.model))
    if math.isfinite(motion.period):
        # Deep-water waves are the shortest; the share of surface tension in their restoring force is sigma k2/(rho g)
        number = (2.0 * math.pi / scale.to_model(motion.period, "s")) ** 2 / (gravity / scale.gravity)
        light = prototype.density / scale.density
        share = model.surface_tension * number**2 / (light * gravity / scale.gravity)
        if share > 0.02:
            notices.append(
                Notice(
                    "similarity-capillary",
                    f"surface tension gives {100.0 * share:.2g} % of the restoring force of the model's shortest waves",
                    share,
                    0.02,
                    "warning",
                    "choose a larger model or longer waves",
                    "omega2 = g k (1 + sigma k2/(rho g))",
                )
            )
    return tuple(notices)
