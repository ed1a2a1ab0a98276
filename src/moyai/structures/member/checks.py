"""Checks of a member: does it stand in its water, and does the circulation law cover its waves."""

from __future__ import annotations

import math

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.morison.circulation import HELD_LIMIT, LAMINAR_EDGE, LAW_LIMIT
from moyai.morison.flow import LinearFlow, NonlinearFlow
from moyai.morison.members import StraightMember
from moyai.sea.regular_theory import linear_limit
from moyai.sea.water import Water
from moyai.structures.member.march import WaveForces
from moyai.structures.member.model import MemberProblem
from moyai.structures.member.waves import MemberWave

#: Breadth over wavelength above which diffraction matters
SLENDER_LIMIT = 0.2
#: The same ratio below which the flow is planar: there is no circulation that a law could be beyond
PLANAR_ORBIT = 1e-3
#: Smaller over larger axis of the orbit below which no law of the circulation has been measured
FLAT_ORBIT = 0.8


def require_in_water(member: StraightMember, water: Water, name: str) -> None:
    """Refuse members that are wholly above the surface or reach under the bed.

    Raises
    ------
    InputError
        With the height and the limit.
    """
    if member.lowest >= 0.0:
        raise InputError(
            f"the member is above the still water of {name}: its lowest point is at z = {member.lowest:+.3g} m",
            parameter="start",
            allowed="at least one end below still water",
            remedy="z is measured upwards from datum; heights below it are negative",
        )
    # the rim at the foot of a leaning member dips into the bed; its axis must not, nor its whole underside
    ends = (member.start[2], member.end[2])
    lowest = min(min(ends), max(ends) + member.lowest - min(ends))
    if lowest < -water.depth * (1.0 + 1e-9):
        raise InputError(
            f"the member reaches to z = {lowest:.4g} m, below the bed of {name}",
            parameter="start",
            allowed=f"at least {-water.depth:.4g} m",
        )


def member_notices(problem: MemberProblem, member: StraightMember) -> tuple[Notice, ...]:
    """Say what the theory of a case leaves out, whatever its waves."""
    notices = []
    law = problem.circulation
    if law.counted and problem.environment.current is not None:
        notices.append(
            Notice(
                "circulation-with-current",
                "no measurement shows how a current changes the circulation; it is formed from the waves alone",
                remedy="compare with 'purpose: extreme', which leaves it out",
            )
        )
    gamma = law.gamma()
    if law.counted and gamma > LAMINAR_EDGE:
        notices.append(
            Notice(
                "circulation-ceiling",
                f"gamma = {gamma:.3g} exceeds the circulation at the edge of a laminar layer",
                value=gamma,
                limit=LAMINAR_EDGE,
                remedy="measurements give 0.94 to 1.04",
                source="laminar theory of small KC",
            )
        )
    if member.highest > 0.0:
        notices.append(
            Notice(
                "member-pierces-surface",
                "the member reaches above still water: slamming, run-up and changing buoyancy are not covered",
                value=member.highest,
                limit=0.0,
                severity="information",
            )
        )
    if isinstance(problem.rule.drag, str) or problem.rule.inertia == "api":
        notices.append(
            Notice(
                "coefficients-unconfirmed",
                "tabulated drag coefficients were not compared with the original publications",
                severity="information",
                remedy="check them against the source named in the table before design use",
            )
        )
    return tuple(notices)


def wave_notices(
    problem: MemberProblem, member: StraightMember, wave: MemberWave, found: WaveForces
) -> tuple[Notice, ...]:
    """Compare one wave with slenderness and the range of the circulation law."""
    notices = list(found.notices)
    if isinstance(wave.flow, NonlinearFlow):
        notices.extend(wave.flow.wave.notices())
    section = member.placed_section
    length = 2.0 * math.pi / wave.wave_number
    where = wave.name if wave.regular else "the sea"
    if section.breadth > SLENDER_LIMIT * length:
        notices.append(
            Notice(
                "member-not-slender",
                f"{where}: the member is {section.breadth / length:.2g} of a wavelength wide; diffraction matters",
                value=section.breadth / length,
                limit=SLENDER_LIMIT,
                remedy="use potential theory",
            )
        )
    if not problem.circulation.counted:
        return tuple(notices)
    minor_major = orbit_ratio(found)
    if minor_major >= PLANAR_ORBIT:
        number = float(found.strip["keulegan_carpenter"][found.governing])
        notices.extend(_law_notices(problem, number, where))
    notices.extend(_reduction_notices(found, where))
    if minor_major < FLAT_ORBIT:
        notices.append(
            Notice(
                "circulation-flat-orbit",
                f"{where}: the orbit across the member has axes in the ratio {minor_major:.2g}; the circulation of "
                "flat orbits follows gamma vx vy T by reasoning, not by measurement",
                value=minor_major,
                limit=FLAT_ORBIT,
                severity="information",
            )
        )
    return tuple(notices)


def theory_notices(wave: MemberWave) -> list[Notice]:
    """Refuse to answer with linear waves that neglect more than the limit: the case asked for them by name."""
    if not isinstance(wave.flow, LinearFlow):
        return []
    return linear_limit(
        wave.name, wave.flow.components, "use 'theory: automatic', which takes the stream function here"
    )


def _law_notices(problem: MemberProblem, number: float, where: str) -> list[Notice]:
    law = problem.circulation
    if number <= LAW_LIMIT or (law.table and law.table[0][0] <= number <= law.table[-1][0]):
        return []
    if number <= HELD_LIMIT:
        return [
            Notice(
                "circulation-held",
                f"{where}: KC = {number:.3g} is beyond the law's {LAW_LIMIT:g}; the reduction of KC = {LAW_LIMIT:g} is "
                "held",
                value=number,
                limit=LAW_LIMIT,
                remedy="give a table of the reduction for KC 2 to 4",
            )
        ]
    return [
        Notice(
            "circulation-beyond-law",
            f"{where}: KC = {number:.3g} is beyond the law and every table; no reduction is counted there",
            value=number,
            limit=law.largest,
            remedy="give a table of the reduction for KC 2 to 4, or use 'purpose: extreme'",
        )
    ]


def _reduction_notices(found: WaveForces, where: str) -> list[Notice]:
    """Tell where the law takes more than the whole inertia force: no slender section was ever measured."""
    left = found.strip["effective_inertia"][found.governing]
    plain = found.strip["plain_inertia"][found.governing]
    lost = [axis for axis in (0, 1) if left[axis] < 0.0 < plain[axis]]
    if not lost:
        return []
    axis = lost[0]
    return [
        Notice(
            "circulation-exceeds-inertia",
            f"{where}: the reduction of {plain[axis] - left[axis]:.3g} exceeds the inertia coefficient "
            f"{plain[axis]:.3g} along the {('first', 'second')[axis]} axis; the law was measured on sections of "
            "proportions up to 1.9",
            value=float(plain[axis] - left[axis]),
            limit=float(plain[axis]),
            remedy="use 'purpose: extreme', or give a table measured on this section",
        )
    ]


def orbit_ratio(found: WaveForces) -> float:
    """Return smaller over larger axis of the orbit at the governing strip."""
    return float(found.strip["orbit_ratio"][found.governing])
