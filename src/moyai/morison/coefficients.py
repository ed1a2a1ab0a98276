"""Coefficients of a strip of a member: ideal inertia, sourced drag laws by KC, Re and roughness, or given numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.headline import UNCONFIRMED
from moyai.core.validity import Notice
from moyai.morison.planar import hall_limit, stokes_wang_drag, stokes_wang_inertia
from moyai.morison.sections import MemberSection
from moyai.tables.member_drag import DragEntry, api_circle, steady_circle, steady_rectangle

#: Laws of the drag coefficient by name: what they are for
DRAG_LAWS: dict[str, str] = {
    "dnv_c205": "circle by KC and roughness, post-critical (DNV-RP-C205, 6.7 and 6.9)",
    "api": "circle in storm waves, smooth or rough (API RP 2A)",
    "stokes_wang": "circle, laminar planar flow at small KC",
    "steady": "steady flow: circle below the drag crisis, rectangles by their proportions",
}
#: Laws that give an inertia coefficient as well; "ideal" is the boundary integral of the section
INERTIA_LAWS: dict[str, str] = {
    "ideal": "ideal fluid, from the section",
    "dnv_c205": DRAG_LAWS["dnv_c205"],
    "api": DRAG_LAWS["api"],
    "stokes_wang": DRAG_LAWS["stokes_wang"],
}
#: Current over orbital speed from which the recommended practice takes the drag of steady flow, and from which a run
#: says that this is near [-].
DNV_CURRENT, DNV_NEAR_CURRENT = 0.4, 0.2
#: Relative roughness k/D from which API's values for rough members are taken
API_ROUGH = 1e-4


@dataclass(frozen=True)
class Conditions:
    """The flow at a strip, by axis of the section where it differs.

    Examples
    --------
    >>> from moyai.morison import Conditions
    >>> flow = Conditions(keulegan_carpenter=8.0, reynolds=2e5, beta=2.5e4)
    >>> flow.current_governs                                             # no current
    False
    """

    #: KC = u T / D with the larger amplitude and the larger extent [-].
    keulegan_carpenter: float
    #: Re = u D / nu [-].
    reynolds: float
    #: D^2 f / nu [-].
    beta: float
    #: k / D [-].
    relative_roughness: float = 0.0
    #: Speed of a current over the largest orbital speed of the waves [-].
    current_ratio: float = 0.0
    #: KC of the waves alone [-]; NaN: the same.
    wave_keulegan_carpenter: float = math.nan

    @property
    def current_governs(self) -> bool:
        """Whether the current is so fast that wakes are those of steady flow."""
        return self.current_ratio >= DNV_CURRENT


@dataclass(frozen=True)
class StripCoefficients:
    """Coefficients of one strip in axes of the section."""

    #: C_M before the circulation; shape (2, 2).
    inertia: Array
    #: C_D on the width across each axis; shape (2,).
    drag: Array
    notices: tuple[Notice, ...] = ()


@dataclass(frozen=True)
class KeuleganCarpenterTable:
    """Coefficients over KC, linear between the rows.

    Raises
    ------
    InputError
        When there are fewer than two rows, KC does not rise, or a value is negative.
    """

    #: KC, coefficient along the first and along the second axis; KC rising.
    rows: tuple[tuple[float, float, float], ...]

    def __post_init__(self) -> None:
        values = np.asarray(self.rows, dtype=float)
        if values.ndim != 2 or values.shape[1] != 3 or len(values) < 2:
            raise InputError("a table over KC needs two rows or more of KC and coefficients", parameter="table")
        if not np.isfinite(values).all() or (values < 0.0).any():
            raise InputError("a table over KC holds a negative value", parameter="table", allowed="at least 0")
        if not (np.diff(values[:, 0]) > 0.0).all():
            raise InputError("KC does not rise in a table of coefficients", parameter="table", allowed="rising rows")

    def at(self, keulegan_carpenter: float, name: str, notices: list[Notice]) -> Array:
        """Return both coefficients at a KC; outside the table its end values, with a notice.

        Parameters
        ----------
        keulegan_carpenter : float
            [-]; infinite in steady flow.
        name : str
            What a notice calls the table.
        notices : list of Notice
            A notice is added to it.
        """
        values = np.asarray(self.rows, dtype=float)
        low, high = float(values[0, 0]), float(values[-1, 0])
        if not low <= keulegan_carpenter <= high:
            notices.append(
                Notice(
                    "coefficients-outside-table",
                    f"in steady flow the last value of the table of {name} is taken"
                    if math.isinf(keulegan_carpenter)
                    else f"KC = {keulegan_carpenter:.3g} lies outside the table of {name}; its end value is kept",
                    value=keulegan_carpenter,
                    limit=low if keulegan_carpenter < low else high,
                    remedy="extend the table",
                )
            )
        return np.array([np.interp(keulegan_carpenter, values[:, 0], values[:, axis]) for axis in (1, 2)])


@dataclass(frozen=True)
class CoefficientRule:
    """Where the coefficients of a member come from.

    Examples
    --------
    >>> from moyai.morison import CoefficientRule, Conditions, sections
    >>> rule = CoefficientRule(drag=(1.0, 1.0))
    >>> strip = rule.at(sections.circle(0.5), Conditions(keulegan_carpenter=8.0, reynolds=2e5, beta=2.5e4))
    >>> strip.drag                                                       # along both axes of the section [-]
    array([1., 1.])
    """

    #: C_D along both axes, a law of ``DRAG_LAWS``, or a table of one's own.
    drag: tuple[float, float] | str | KeuleganCarpenterTable
    #: C_M along both axes, a law of ``INERTIA_LAWS``, or a table of one's own.
    inertia: tuple[float, float] | str | KeuleganCarpenterTable = "ideal"

    def __post_init__(self) -> None:
        for name, value, laws in (("drag", self.drag, DRAG_LAWS), ("inertia", self.inertia, INERTIA_LAWS)):
            if isinstance(value, str):
                if value not in laws:
                    raise InputError(f"unknown {name} law '{value}'", parameter=name, allowed=", ".join(laws))
            elif not isinstance(value, KeuleganCarpenterTable) and not all(
                math.isfinite(item) and item >= 0.0 for item in value
            ):
                raise InputError(f"{name} coefficients are {value}", parameter=name, allowed="at least 0")

    def at(self, section: MemberSection, flow: Conditions) -> StripCoefficients:
        """Return the coefficients of a section in a flow.

        Parameters
        ----------
        section : MemberSection
            Turned as it lies in the flow.
        flow : Conditions
            Of the strip.

        Raises
        ------
        InputError
            When a law is not for this section.
        """
        notices: list[Notice] = []
        inertia = self._inertia(section, flow, notices)
        drag = self._drag(section, flow, notices)
        return StripCoefficients(inertia, drag, tuple(notices))

    def _inertia(self, section: MemberSection, flow: Conditions, notices: list[Notice]) -> Array:
        if isinstance(self.inertia, KeuleganCarpenterTable):
            return np.diag(self.inertia.at(flow.keulegan_carpenter, "C_M", notices))
        if not isinstance(self.inertia, str):
            return np.diag(np.asarray(self.inertia, dtype=float))
        if self.inertia == "ideal":
            return section.inertia.tensor
        _require_circle(section, self.inertia, "inertia")
        if self.inertia == "stokes_wang":
            notices.extend(_laminar_notices(flow))
            return np.eye(2) * float(stokes_wang_inertia(flow.beta))
        # in a current alone no inertia acts: nothing is said of its law
        acts = not math.isinf(flow.keulegan_carpenter)
        if self.inertia == "api":
            entry = api_circle(rough=flow.relative_roughness >= API_ROUGH)
            notices.extend(_range_notices("API RP 2A", entry, flow) if acts else [])
            return np.eye(2) * entry.inertia
        notices.extend(_dnv_notices(flow) if acts else [])
        number = flow.keulegan_carpenter
        if flow.current_governs and not math.isnan(flow.wave_keulegan_carpenter):
            # no wake that a current carries away comes back to take from the added mass
            number = flow.wave_keulegan_carpenter
        return np.eye(2) * (1.0 + dnv_added_mass(number, flow.relative_roughness))

    def _drag(self, section: MemberSection, flow: Conditions, notices: list[Notice]) -> Array:
        if isinstance(self.drag, KeuleganCarpenterTable):
            return self.drag.at(flow.keulegan_carpenter, "C_D", notices)
        if not isinstance(self.drag, str):
            return np.asarray(self.drag, dtype=float)
        if self.drag == "steady":
            return _steady(section, flow, notices)
        _require_circle(section, self.drag, "drag")
        if self.drag == "stokes_wang":
            notices.extend(_laminar_notices(flow))
            return np.full(2, float(stokes_wang_drag(max(flow.keulegan_carpenter, 1e-9), flow.beta)))
        if self.drag == "api":
            entry = api_circle(rough=flow.relative_roughness >= API_ROUGH)
            notices.extend(_range_notices("API RP 2A", entry, flow))
            return np.full(2, entry.drag)
        notices.extend([*_dnv_notices(flow), *_dnv_current_notices(flow)])
        return np.full(2, dnv_drag(flow.keulegan_carpenter, flow.relative_roughness, flow.current_ratio))


#: KC beyond which the recommended practice gives a figure for the amplification of drag.
DNV_CREST = 12.0


def dnv_steady_drag(relative_roughness: float) -> float:
    """Return the steady drag coefficient of a circle in post-critical flow by its roughness k/D (DNV-RP-C205, 6.7.1).

    0.65 below 1e-4, (29 + 4 log10(k/D)) / 20 up to 1e-2, 1.05 above [eq:morison-dnv-steady].
    """
    if relative_roughness <= 1e-4:
        return 0.65
    if relative_roughness >= 1e-2:
        return 1.05
    return (29.0 + 4.0 * math.log10(relative_roughness)) / 20.0


def dnv_drag(keulegan_carpenter: float, relative_roughness: float, current_ratio: float = 0.0) -> float:
    """Return C_D = C_DS psi(KC) of a circle (DNV-RP-C205, 6.7.2) [eq:morison-dnv-drag].

    Beyond KC = 12, where the recommended practice gives a figure, the factor keeps its value of KC = 12, the crest of
    that figure. In steady flow, at infinite KC, it is one, and in waves with a current of :data:`DNV_CURRENT` of the
    orbital speed or more it is one at least: the water does not turn back far enough to bring a wake back.
    """
    return amplified_drag(dnv_steady_drag(relative_roughness), keulegan_carpenter, current_ratio)


def amplified_drag(steady: float, keulegan_carpenter: float, current_ratio: float = 0.0) -> float:
    """Return C_D in waves of a circle whose drag in steady flow is known, as in :func:`dnv_drag`."""
    if math.isinf(keulegan_carpenter):
        return steady
    level = 1.50 - 0.024 * (12.0 / steady - 10.0)
    if keulegan_carpenter < 0.75:
        factor = level - 1.0 - 2.0 * (keulegan_carpenter - 0.75)
    elif keulegan_carpenter < 2.0:
        factor = level - 1.0
    else:
        factor = level + 0.10 * (min(keulegan_carpenter, DNV_CREST) - 12.0)
    return steady * (max(factor, 1.0) if current_ratio >= DNV_CURRENT else factor)


def dnv_added_mass(keulegan_carpenter: float, relative_roughness: float) -> float:
    """Return C_A of a circle by KC and roughness (DNV-RP-C205, 6.9.1) [eq:morison-dnv-inertia]."""
    if keulegan_carpenter < 3.0:
        return 1.0
    steady = dnv_steady_drag(relative_roughness)
    return max(1.0 - 0.044 * (keulegan_carpenter - 3.0), 0.6 - (steady - 0.65))


def _steady(section: MemberSection, flow: Conditions, notices: list[Notice]) -> Array:
    if section.is_circle:
        entry = steady_circle()
        notices.extend(_range_notices("the drag of a circle in steady flow", entry, flow))
        drag = np.full(2, entry.drag)
    elif section.name in ("rectangle", "square"):
        along, up = section.extents
        entries = (steady_rectangle(along / up), steady_rectangle(up / along))
        notices.extend(_range_notices("the drag of a rectangle in steady flow", entries[0], flow))
        drag = np.array([entry.drag for entry in entries])
    else:
        raise InputError(
            f"there is no steady drag of a {section.name}",
            parameter="drag",
            remedy="give the two coefficients as numbers",
        )
    if flow.keulegan_carpenter < 20.0:
        notices.append(
            Notice(
                "steady-drag-in-waves",
                f"drag of steady flow is used at KC = {flow.keulegan_carpenter:.3g}; sharp sections in waves show more",
                value=flow.keulegan_carpenter,
                limit=20.0,
                severity="information",
                remedy="give measured coefficients where drag matters",
            )
        )
    return drag


def _require_circle(section: MemberSection, law: str, name: str) -> None:
    if not section.is_circle:
        raise InputError(
            f"the law '{law}' is for circles, the section is a {section.name}",
            parameter=name,
            allowed="circle",
            remedy="use 'ideal' or give numbers" if name == "inertia" else "use 'steady' or give numbers",
        )


def _range_notices(what: str, entry: DragEntry, flow: Conditions) -> list[Notice]:
    if entry.reynolds_low <= flow.reynolds <= entry.reynolds_high:
        return []
    limit = entry.reynolds_low if flow.reynolds < entry.reynolds_low else entry.reynolds_high
    return [
        Notice(
            "drag-reynolds",
            f"{what} was found at Re {'above' if limit == entry.reynolds_low else 'below'} {limit:.0e}, here "
            f"Re = {flow.reynolds:.3g}",
            value=flow.reynolds,
            limit=limit,
            remedy="give measured coefficients",
        )
    ]


#: Reynolds number up to which a smooth circle may have the drag below the drag crisis, that of the height of its
#: roughness up to which a rough one may, and that from which the laws of post-critical flow were found.
CRISIS, ROUGH_CRISIS, POST_CRITICAL = 5e5, 400.0, 1e6


def share_below_crisis(reynolds: float, relative_roughness: float) -> float:
    """Return how far a circle may have the drag below the drag crisis: 1 before it, 0 in post-critical flow.

    Between them it falls with the logarithm of the Reynolds number, so that what is judged by it does not jump
    [eq:morison-crisis].
    """
    crisis = CRISIS if relative_roughness <= 0.0 else min(CRISIS, ROUGH_CRISIS / relative_roughness)
    if not reynolds > crisis:
        return 1.0
    return max(math.log(POST_CRITICAL / reynolds) / math.log(POST_CRITICAL / crisis), 0.0)


def _dnv_notices(flow: Conditions) -> list[Notice]:
    notices = _range_notices("DNV-RP-C205's drag", DragEntry(math.nan, math.nan, 1e6, math.inf, False, "D"), flow)
    if DNV_CREST < flow.keulegan_carpenter < math.inf:
        notices.append(
            Notice(
                "drag-keulegan-carpenter",
                f"the amplification of drag keeps its crest of KC = 12 at KC = {flow.keulegan_carpenter:.3g}",
                value=flow.keulegan_carpenter,
                limit=DNV_CREST,
                severity="information",
                source="DNV-RP-C205, 6.7.2",
            )
        )
    return notices


def _dnv_current_notices(flow: Conditions) -> list[Notice]:
    """Say where a current takes the drag of steady flow, and warn where it nearly does: the law jumps there."""
    number, ratio = flow.keulegan_carpenter, flow.current_ratio
    if ratio < DNV_NEAR_CURRENT or math.isinf(number):
        return []
    share = dnv_steady_drag(flow.relative_roughness) / dnv_drag(number, flow.relative_roughness)
    if share <= 1.0:
        return []
    source = f"DNV-RP-C205, 6.7; {UNCONFIRMED}"
    if ratio >= DNV_CURRENT:
        return [
            Notice(
                "drag-current-governs",
                f"the current is {DNV_CURRENT:g} times the orbital speed or more: drag is that of steady flow, "
                f"{share:.2g} times that of waves alone at KC = {number:.3g}",
                share, 1.0, "information", source=source,
            )
        ]  # fmt: skip
    return [
        Notice(
            "drag-current-near",
            f"the current is {ratio:.2g} times the orbital speed: drag is read at KC = {number:.3g} as in waves alone; "
            f"from {DNV_CURRENT:g} it is that of steady flow, {share:.2g} times as much",
            share, 1.0, "warning", "give C_D as a number where drag matters", source,
        )
    ]  # fmt: skip


def _laminar_notices(flow: Conditions) -> list[Notice]:
    limit = float(hall_limit(flow.beta))
    if flow.keulegan_carpenter <= limit:
        return []
    return [
        Notice(
            "stokes-wang-unstable",
            f"Stokes and Wang's laminar flow is unstable at KC = {flow.keulegan_carpenter:.3g}, above {limit:.2g}",
            value=flow.keulegan_carpenter,
            limit=limit,
            remedy="give measured coefficients; the laminar drag is too small there",
            source="Hall (1984)",
        )
    ]
