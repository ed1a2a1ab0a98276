"""Which model of a curtain governs, which is a bound, which is shown for comparison and which is out of its range.

The models differ by what they take the skirt for. The steady section lets the toe fly up; the impact models and the
slack and taut cycles take a flat plate that stands upright; the whole span through time takes cloth between cables. A
model out of range never governs. Where only a bound is left, the number is reported as one [eq:curtain-hierarchy].
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.model import Analysis, Curtain, CurtainSettings
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

Role = Literal["governs", "bound", "comparison", "out of range"]

STATICS = "steady section and plan"
IMPACT = "impact of an upright plate"
CYCLES = "slack and taut cycles of an upright plate"
CREST = "drag under the crest"
ENERGY = "energy model of the anchor line"
SPAN = "whole span through time"

#: Straight depth of the skirt over its length below which a plate of the whole length is out of range [-]: the tension
#: of the plate goes with its depth, so that it is then more than 10 % too high.
STRAIGHT = 0.9
#: What sets a wave height beyond whose drift nothing is known.
OF_UPRIGHT = "range of the upright plate"


@checks_words
@dataclass(frozen=True)
class ModelRole:
    """What one model counts for."""

    #: One of the names of this module.
    model: str
    #: ``bound``: the load is at most this; ``comparison``: shown, and counted nowhere; one of "governs", "bound",
    #: "comparison", "out of range".
    role: Role
    #: What it gives.
    of: str
    #: Why, with the number and the limit that decide.
    reason: str
    #: That number; NaN where the kind of curtain decides.
    value: float = float("nan")
    #: That limit; NaN where the kind of curtain decides.
    limit: float = float("nan")


def hierarchy(unit: LevelCurtain, settings: CurtainSettings, *, speed: float | None = None) -> tuple[ModelRole, ...]:
    """Return what every model that is asked for counts for, the steady one first.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
        Whose ``analyses`` say which models are run.
    speed : float, optional
        Surface speed of the current [m/s]; that of the case when left out. Limits ask at other speeds.
    """
    asked: set[Analysis] = set(settings.analyses)
    moving = "dynamic" in asked
    surface = unit.surface_speed if speed is None else speed
    found: list[ModelRole] = []
    if "statics" in asked:
        found.append(ModelRole(STATICS, "governs", "steady loads, depth, toe", "equilibrium of skirt, cables and toe"))
    role, reason, share = _upright(unit, surface)
    if moving:
        found.append(
            ModelRole(
                SPAN, "governs", "cables, skirt and anchor lines in waves and in a snap",
                "cloth between cables, toe free to rise: no shape is taken for granted; its band is that of seeds and "
                "meshes",
            )
        )  # fmt: skip
    wanted: tuple[tuple[Analysis, str, str], ...] = (
        ("impact", IMPACT, "the snap after a release in the current"),
        ("waves", CYCLES, "snaps in waves"),
    )
    for analysis, model, of in wanted:
        if analysis not in asked:
            continue
        plate: Role = role
        words = reason
        if moving:
            plate = "comparison"
            words = f"the whole span is run; {reason}"
        found.append(ModelRole(model, plate, of, words, share, STRAIGHT))
    if asked != {"dynamic"}:
        found.append(_crest(asked))
    if "anchor_loads" in asked and unit.curtain.anchors is not None and settings.anchor_loads is not None:
        found.append(
            ModelRole(
                ENERGY,
                "comparison" if moving else "governs",
                "anchor lines in waves",
                "the whole span is run with its anchor lines" if moving else
                "fitted to measured anchor lines; its energy factor moved from 0.2 in the field to 0.5 in the flume",
            )
        )  # fmt: skip
    return tuple(found)


def _upright(unit: LevelCurtain, surface: float) -> tuple[Role, str, float]:
    """Return the role of a plate that stands upright as deep as the skirt is long, with the share that decides."""
    curtain = unit.curtain
    share = straight_share(unit, surface)
    need = f"plates need {100.0 * STRAIGHT:.0f} %"
    left = f"the current leaves {100.0 * share:.0f} % of the skirt's length as depth ({need})"
    if not held_at_both(curtain):
        return (
            "bound",
            "the toe is free: nothing stops the lower half of the plate; the upper cable stops all of its water; "
            f"{left}",
            share,
        )
    if share < STRAIGHT:
        return "bound", f"held at both edges, but {left}: an upright plate stops too much water", share
    return "governs", f"held at both edges, and {left}", share


def held_at_both(curtain: Curtain) -> bool:
    """Whether the skirt is held at both edges."""
    return curtain.toe != "free" and curtain.lower_stiffness > 0.0


def straight_share(unit: LevelCurtain, surface: float) -> float:
    """Return the straight depth of the skirt in a current over its length [-], 1 in still water, 0 without equilibrium.

    Of a skirt longer than the water is deep the depth of the water counts as its length.
    """
    if surface <= 0.0:
        return 1.0
    try:
        section = unit.site.statics(unit.hanging, surface).section
    except (InputError, ConvergenceError):
        return 0.0
    return min(1.0, float(section.effective_depth) / unit.depth)


def upright_in(unit: LevelCurtain, own: float) -> float:
    """Return the largest surface speed up to a given one in which an upright plate governs [m/s]; 0 for none."""
    if not held_at_both(unit.curtain) or own <= 0.0:
        return 0.0
    if straight_share(unit, own) >= STRAIGHT:
        return own
    low, high = 0.0, own
    # to a thousandth of itself, so that it is the same in every stronger current
    while high - low > max(1e-3 * high, 1e-6 * own):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if straight_share(unit, middle) >= STRAIGHT else (low, middle)
    return low


def _crest(asked: set[Analysis]) -> ModelRole:
    of = "drag in waves"
    if "dynamic" in asked:
        return ModelRole(CREST, "comparison", of, "the whole span is run; a steady drag does not include snap loads")
    if "waves" in asked:
        return ModelRole(
            CREST, "governs", of, "a steady drag does not include snap loads: the larger of it and the cycles is used"
        )
    return ModelRole(
        CREST, "governs", of, "nothing else is run in waves; a steady drag does not include snap loads: run 'waves' too"
    )


def role_of(roles: Iterable[ModelRole], model: str) -> Role:
    """Return the role of a model; ``out of range`` for one that is not run."""
    return next((item.role for item in roles if item.model == model), "out of range")


def hierarchy_dataset(roles: tuple[ModelRole, ...]) -> xr.Dataset:
    """Return the group ``models``: the table 'Which model governs'."""
    import xarray as xr

    return labelled(
        xr.Dataset(
            {
                "model_role": ("model", [item.role for item in roles]),
                "model_of": ("model", [item.of for item in roles]),
                "model_reason": ("model", [item.reason for item in roles]),
                "model_value": ("model", [item.value for item in roles]),
                "model_limit": ("model", [item.limit for item in roles]),
            },
            coords={"model": [item.model for item in roles]},
        )
    )


__all__ = [
    "CREST",
    "CYCLES",
    "ENERGY",
    "IMPACT",
    "OF_UPRIGHT",
    "SPAN",
    "STATICS",
    "STRAIGHT",
    "ModelRole",
    "Role",
    "held_at_both",
    "hierarchy",
    "hierarchy_dataset",
    "role_of",
    "straight_share",
    "upright_in",
]
