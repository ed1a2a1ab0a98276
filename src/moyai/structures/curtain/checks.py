"""Practice checks of a curtain: class, current rules, extra length, toe gap, spacing, floats."""

from __future__ import annotations

import math

from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import check_drag
from moyai.structures.curtain.statics.hanging import CurtainStatics
from moyai.structures.curtain.statics.load_laws import check_section_load
from moyai.structures.curtain.statics.planning import CURRENT_RULES
from moyai.tables.curtain_classes import CurtainClass, mildest_class

_MANUALS = "state manuals (Indian River, Florida; Virginia 3.27)"
_TOE = "ERDC TN-DOER-E21 (2005), not compared with the original publication"


def check_class(
    entry: CurtainClass,
    significant_height: float,
    speed: float,
    statics: CurtainStatics,
    toe_chain: float,
    sheet_strength: float,
) -> tuple[Notice, ...]:
    """Tell where sea or curtain leave a class of the table.

    Parameters
    ----------
    entry : CurtainClass
        The class claimed.
    significant_height, speed : float
        Of the site [m], [m/s].
    statics : CurtainStatics
        The curtain.
    toe_chain : float
        Mass of the toe chain per length [kg/m].
    sheet_strength : float
        Strength of the fabric per width [N/m].
    """
    source = f"curtain classes, {entry.practice} ({entry.source})" + ("" if entry.confirmed else ", not confirmed")
    tests = (
        ("wave-height", "significant height", significant_height, entry.significant_height, "m", True),
        ("current", "current", speed, entry.current, "m/s", True),
        ("buoyancy", "float buoyancy", statics.curtain.floats.buoyancy, entry.float_buoyancy, "N/m", False),
        ("chain", "toe chain", toe_chain, entry.toe_chain[0], "kg/m", False),
        ("fabric", "fabric strength", sheet_strength, entry.fabric_strength[0], "N/m", False),
    )
    notices = []
    for code, what, value, limit, unit, upper in tests:
        # no number in the source: nothing to hold against
        if math.isnan(limit) or (value <= limit if upper else value >= limit * (1.0 - 1e-12)):
            continue
        word = "above" if upper else "below"
        notices.append(
            Notice(
                f"curtain-class-{code}",
                f"{what} {value:.4g} {unit} is {word} the {limit:.4g} {unit} of class {entry.name}",
                value,
                limit,
                "warning",
                "choose another class" if upper else "give what the class requires",
                source,
            )
        )
    return tuple(notices)


def check_statics(statics: CurtainStatics, speed: float, water: Water) -> tuple[Notice, ...]:
    """Tell where a curtain at rest leaves practice or the range of its formulas.

    Parameters
    ----------
    statics : CurtainStatics
        Result.
    speed : float
        Surface speed of the current [m/s].
    water : Water
        Site.
    """
    curtain = statics.curtain
    notices: list[Notice] = []
    notices += check_drag(curtain.drag, statics.section.blockage)
    pressure = statics.section.drag_coefficient * 0.5 * water.density * speed**2
    if curtain.toe == "free" and speed > 0.0:
        notices += check_section_load(curtain.skirt.length, curtain.skirt.toe_load, pressure)
    for rule in CURRENT_RULES:
        if speed > rule.speed:
            text = f"current of {speed:.3g} m/s: above {rule.speed:g} m/s {rule.name}"
            notices.append(
                Notice("curtain-current-rule", text, speed, rule.speed, "information", "see the source", rule.source)
            )
    if statics.float_reserve <= 0.0:
        notices.append(
            Notice(
                "curtain-floats-drown",
                f"the floats lack {spoken(-statics.float_reserve, 'N/m')}: the top goes under at this current",
                statics.float_reserve,
                0.0,
                "error",
                "give larger floats, flatter anchor lines or more anchors",
                "balance of vertical forces",
            )
        )
    extra = curtain.length / curtain.span - 1.0
    if not 0.1 <= extra <= 0.2:
        limit = 0.1 if extra < 0.1 else 0.2
        text = f"extra length of {100 * extra:.3g} % over the span; practice gives 10 to 20 %"
        notices.append(Notice("curtain-extra-length", text, extra, limit, "information", "", _MANUALS))
    if statics.toe_gap < 0.3:
        text = f"toe {statics.toe_gap:.3g} m above the bed; practice keeps 0.3 to 0.6 m"
        notices.append(Notice("curtain-toe-gap", text, statics.toe_gap, 0.3, "warning", "shorten the skirt", _TOE))
    ratio = statics.toe_speed_ratio
    if ratio > 5.0:
        text = (
            f"by continuity {statics.toe_speed:.3g} m/s go under the toe, {ratio:.3g} times the current: through so "
            "small a gap the flow would go round the ends, or scour"
        )
        notices.append(
            Notice("curtain-toe-speed", text, ratio, 5.0, "warning", "lower 'passing_fraction', or leave a gap", _TOE)
        )
    if curtain.span > 30.0:
        text = f"anchors {curtain.span:.3g} m apart; practice gives at most 30 m"
        notices.append(Notice("curtain-anchor-span", text, curtain.span, 30.0, "information", "", _MANUALS))
    depth_share = statics.section.effective_depth / curtain.skirt.length
    if depth_share < 0.7:
        text = f"the current leaves {100 * depth_share:.3g} % of the skirt's length as depth"
        notices.append(
            Notice(
                "curtain-flare", text, depth_share, 0.7, "warning", "give more toe weight", "section of this curtain"
            )
        )
    return tuple(notices)


def check_site_class(significant_height: float, speed: float) -> tuple[Notice, ...]:
    """Tell when no class of Japanese practice allows the sea and the current of a site.

    Parameters
    ----------
    significant_height : float
        Largest of the sea states [m]; 0 without waves.
    speed : float
        Of the current at the surface [m/s].
    """
    if mildest_class(significant_height, speed) is not None:
        return ()
    return (
        Notice(
            "curtain-class-none",
            f"no class of Japanese practice allows {significant_height:.3g} m and {speed:.3g} m/s",
            severity="information",
            remedy="class A ends at 1.5 m and 0.5 m/s",
            source="curtain classes A to D",
        ),
    )
