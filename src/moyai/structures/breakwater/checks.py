"""Checks of a breakwater beyond those of the packages below: what the case asks against what the theory covers."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.damping import LinearDamping
from moyai.floating.frequency import solve_motions
from moyai.mooring.checks import check_line_system
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.frequency.model import FrequencyModel
from moyai.structures.breakwater.model import BreakwaterProblem, RegularSea

SHORT_CREST_ANGLE = math.radians(45.0)
DAMPING_OF_CHECK = 0.1  # of critical
NEAR_FIELD_TOLERANCE = 0.02  # of the largest drift coefficient; corners limit the near field


def check_problem(problem: BreakwaterProblem) -> tuple[Notice, ...]:
    """Say what the two-dimensional model of a unit leaves out, and how far the waves are from its theory."""
    notices = [
        Notice(
            "end-effects",
            "waves round the ends of the unit and loads in connectors between units are not covered by the section",
            severity="information",
            remedy="give coefficients of a 3-D program for a short unit",
        )
    ]
    for sea in problem.environment.sea_states:
        if abs(sea.heading) > SHORT_CREST_ANGLE:
            notices.append(
                Notice(
                    "oblique-heading",
                    f"{sea.name}: waves reach the unit at {math.degrees(sea.heading):.0f} degrees, where its length "
                    "and ends matter more than its section",
                    value=abs(sea.heading),
                    limit=SHORT_CREST_ANGLE,
                    unit="rad",
                )
            )
        if sea.heading != 0.0 and "time" in problem.analyses:
            regular = isinstance(sea, RegularSea)
            notices.append(
                Notice(
                    "oblique-time-domain",
                    f"{sea.name}: in the time domain "
                    + (
                        "radiation is that of the wave's own frequency and heading, without memory of other frequencies"
                        if regular
                        else "the wave load is that of the oblique wave, the memory that of normal incidence: motions "
                        "may be off by tens of per cent far from the normal; the frequency domain is consistent"
                    ),
                    severity="information" if regular else "warning",
                )
            )
    return tuple(notices)


def check_unit(unit: FloatingUnit) -> tuple[Notice, ...]:
    """Check lines at rest and the clearance under the keel."""
    notices: list[Notice] = []
    if unit.lines:
        found = check_line_system(unit.mooring.planar.system, path="lines", still_water=-unit.centre[1])
        notices.extend(found)
    clearance = unit.water.depth + unit.section.bottom
    if clearance < 0.1 * -unit.section.bottom:
        notices.append(
            Notice(
                "keel-clearance",
                f"{unit.name}: {clearance:.3g} m of water under the keel; flow separation there is not covered",
                value=clearance / -unit.section.bottom,
                limit=0.1,
            )
        )
    return tuple(notices)


def drift_check(model: FrequencyModel, heading: float) -> tuple[IdentityCheck, ...]:
    """Compare the mean drift of the moving body by momentum with that by pressure on its surface.

    Two routes that share nothing but the potentials; only for normal incidence and a section without a damping lid,
    which takes momentum of its own. They agree in any motion: that with damping enough that no resonance stands alone
    is taken, whatever the seas are.
    """
    from moyai.potential.drift import mean_drift_far_field, mean_drift_near_field

    solution = model.hydro.solution
    if solution is None or heading != 0.0 or model.unit.breakwater.gap_damping_lid:
        return ()
    hydro = model.hydro.whole(heading)
    fraction = np.maximum(model.damping.critical_fraction, DAMPING_OF_CHECK)
    damping = LinearDamping(model.damping.matrix, fraction)
    motions = solve_motions(hydro, model.inertia, model.stiffness, damping=damping).displacement[:, 0, :]
    far = mean_drift_far_field(solution, motions, heading).horizontal
    near = mean_drift_near_field(solution, motions, heading).horizontal
    scale = float(np.max(np.abs(far)))
    if scale == 0.0:
        return ()
    return (
        IdentityCheck(
            f"{model.unit.name}: mean drift by momentum and by pressure",
            float(np.max(np.abs(far - near))) / scale,
            NEAR_FIELD_TOLERANCE,
            "far-field (Maruo) equals near-field drift of the moving section",
        ),
    )
