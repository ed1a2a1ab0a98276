"""Up to which current and wave height a curtain holds, and what governs."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.headline import Bound
from moyai.core.progress import Progress
from moyai.sea.breaking import breaking_limit
from moyai.structures.curtain import hierarchy as models
from moyai.structures.curtain.analyses.impact import ImpactAnswer
from moyai.structures.curtain.analyses.weaker_currents import currents_of_waves, step_of_waves
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.hierarchy import CYCLES, IMPACT, OF_UPRIGHT, STRAIGHT, Role, hierarchy, role_of
from moyai.structures.curtain.limits.loads import drift_of_height, fastest_water, impact_load, sea_loads
from moyai.structures.curtain.limits.search import Limit
from moyai.structures.curtain.limits.utilisation import AddedLoads, height_limit, speed_limit, utilisation
from moyai.structures.curtain.model import UNJUDGED, CurtainSettings
from moyai.structures.curtain.seas.anchor_energy import ENERGY_FACTORS
from moyai.structures.curtain.seas.loads import DragCurve, ImpactLoad, SeaLoads
from moyai.structures.curtain.statics.hanging import CurtainStatics
from moyai.structures.curtain.statics.steady_load import drag_factors
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

PARTS = ("upper cable", "lower cable", "sheet", "joint", "anchor line", "anchor", "floats", "effective depth")
_SPEED_COUNT, _HEIGHT_COUNT = 9, 11
#: Turns in which the band of the depth and the current are brought together, and the change that ends them.
_MOST_TURNS, _SETTLED = 5, 2e-3


def limits_dataset(
    unit: LevelCurtain,
    settings: CurtainSettings,
    answer: ImpactAnswer | None,
    curve: DragCurve,
    progress: Progress,
    lost_depth: float = 1.0,
    duration: float | None = None,
    strong_drag: float = 1.0,
) -> xr.Dataset:
    """Return the group ``limits``: largest height for currents up to each speed, and the utilisation over both.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    answer : ImpactAnswer or None
        None where the impact was not asked for.
    curve : DragCurve
        Loads at rest, up to :func:`fastest_water`.
    progress : Progress
        An interrupt is handed on.
    lost_depth : float
        Depth that the skirt loses at the lower end of the band over what it loses, in the current of the case: the
        largest current is searched once more with the depth asked for at that end, as the criterion does, and again
        with what it loses in the current that was found.
    duration : float, optional
        See :func:`sea_loads`.
    strong_drag : float
        See :func:`sea_loads`.
    """
    duration = 3600.0 * settings.waves.hours if duration is None else duration
    loads = sea_loads(unit, settings, answer, curve, duration, strong_drag)
    counted = CountedLimits(unit, settings, loads, duration)
    most, most_bound = counted.speed()
    speeds = _speeds(unit, settings, most)
    rows = []
    for count, speed in enumerate(speeds):
        progress(f"operating limits, {unit.name}", count, len(speeds))
        rows.append(counted.height(speed))
    progress(f"operating limits, {unit.name}", len(speeds), len(speeds))
    heights = _heights(settings, max((row.value for row, _ in rows), default=0.0))
    parts = _grid(unit, [replace(counted.loads_in(speed), known=True) for speed in speeds], speeds, heights)
    group = _limits_group(unit, settings, counted, _FoundLimits(most, most_bound, speeds, tuple(rows)), heights, parts)
    strict = _settled(counted, lost_depth)
    height = float(group["design_limit_height"])
    return group.assign(_design_ends(_strict(counted, lost_depth), speeds)).assign_attrs(
        realisations=settings.waves.realisations,
        speed_limit_of_least_depth=math.nan if strict.unit is unit else strict.speed()[0].value,
        design_limit_period=settings.limits.period_of(height) if height > 0.0 else math.nan,
        period_follows_height=int(settings.limits.period is None),
    )


def _settled(counted: CountedLimits, lost_depth: float) -> CountedLimits:
    """Return the limits with the depth at the lower end of its band in the largest current that they then find."""
    strict = _strict(counted, lost_depth)
    for _ in range(_MOST_TURNS if strict is not counted else 0):
        speed = strict.speed()[0].value
        if not 0.0 < speed < counted.settings.limits.highest_speed:
            break
        try:
            steady = replace(counted.unit, surface_speed=speed).steady
        except (InputError, ConvergenceError):
            break
        low, depth = steady.band("effective_depth")[0], counted.unit.depth
        value = steady.governing.quantity("effective_depth")
        found = (depth - low) / (depth - value) if low < value < depth else 1.0
        if abs(found - lost_depth) < _SETTLED * lost_depth:
            break
        lost_depth = found
        strict = _strict(counted, lost_depth)
    return strict


def _strict(counted: CountedLimits, lost_depth: float) -> CountedLimits:
    """Return the limits with the depth asked for at the lower end of its band."""
    unit = counted.unit
    strengths = unit.curtain.strengths
    asked = strengths.least_depth
    if not (0.0 < asked < unit.depth and lost_depth > 1.0):
        return counted
    # d - f (d - z) is at least what is asked where z is at least this
    strict = replace(strengths, least_depth=unit.depth - (unit.depth - asked) / lost_depth)
    return replace(counted, unit=replace(unit, curtain=replace(unit.curtain, strengths=strict)))


def _design_ends(strict: CountedLimits, speeds: tuple[float, ...]) -> dict[str, xr.DataArray]:
    """Return the height held in currents up to that of the case, loads at the upper ends of their bands [m].

    It states by how much other seeds of the seas that prove it may lower it.
    """
    import xarray as xr

    own, low, lower = strict.unit.surface_speed, math.nan, math.nan
    if own > 0.0 or _drifts(strict):
        within = {speed for speed in speeds if speed < own * (1.0 - 1e-9)} | ({own} if own > 0.0 else set())

        def least(loads: SeaLoads) -> float:
            counted = replace(strict, loads=loads)
            rows = [counted.height(speed) for speed in within]
            return min(limit.value for limit, _ in (*rows, *_in_drift(counted, rows)))

        severe = _severe(strict.unit, strict.loads)
        low = least(severe)
        lower = low if severe.snaps is None else least(replace(severe, other_seeds=True))
    return {"design_limit_low": xr.DataArray(low), "design_limit_scatter": xr.DataArray(low - lower)}


def _severe(unit: LevelCurtain, loads: SeaLoads) -> SeaLoads:
    """Return loads with impact, snaps and steady part at the ends at which a design is judged."""
    impact = loads.impact
    if impact is not None:
        impact = replace(impact, factor=max(impact.uncertainty[1], 1.0) * impact.factor)
    energy = loads.energy
    if energy is not None:
        energy = replace(energy, energy_factor=max(energy.energy_factor, *ENERGY_FACTORS))
    return replace(loads, impact=impact, judged=True, energy=energy, steady_factors=_steady_factors(unit))


def _steady_factors(unit: LevelCurtain) -> AddedLoads | None:
    """Return the upper end of the band of the steady loads in the current of the case over their value [-]."""
    if not unit.surface_speed > 0.0:
        return None
    try:
        steady = unit.steady
    except (InputError, ConvergenceError):
        return None
    names = ("upper_tension", "lower_tension", "sheet_tension", "anchor_tension", "line_load")
    values = [(steady.governing.quantity(name), steady.band(name)[1]) for name in names]
    return AddedLoads(*(high / value if high > value > 0.0 else 1.0 for value, high in values))


@dataclass(frozen=True)
class _FoundLimits:
    """Limits that were searched: of the current, and of the height in each current of the table with its bound."""

    most: Limit
    most_bound: Bound
    speeds: tuple[float, ...]
    rows: tuple[tuple[Limit, Bound], ...]


@dataclass(frozen=True, eq=False)
class CountedLimits:
    """Limits by the models used for design: one out of its range gives none, a bound of the load a limit 'at least'."""

    unit: LevelCurtain
    settings: CurtainSettings
    loads: SeaLoads
    #: Of the seas that snaps are looked for in [s].
    duration: float = math.nan
    solved: dict[float, CurtainStatics | None] = field(default_factory=dict)

    @property
    def sure(self) -> SeaLoads:
        """Loads without the upright plate."""
        return replace(self.loads, impact=None, snaps=None)

    @property
    def with_plate(self) -> bool:
        """Whether an upright plate was run for the limits at all."""
        return self.loads.impact is not None or self.loads.snaps is not None

    def role(self, speed: float) -> Role:
        """Return what the upright plate counts for in a current [m/s]."""
        # a whole span is run in the state of the case alone: elsewhere the plate counts for what it is
        asked = tuple(name for name in self.settings.analyses if name != "dynamic")
        roles = hierarchy(self.unit, replace(self.settings, analyses=asked), speed=speed)
        found = {role_of(roles, model) for model in (IMPACT, CYCLES)}
        return next((role for role in _ROLES if role in found), "out of range")

    def loads_in(self, speed: float) -> SeaLoads:
        """Return the loads that count in a current [m/s]."""
        role = self.role(speed) if self.with_plate else "out of range"
        return self.loads if role in ("governs", "bound") else self.sure

    def speed(self) -> tuple[Limit, Bound]:
        """Return the largest current without waves, and whether it is a bound."""
        unit, highest = self.unit, self.settings.limits.highest_speed

        def find(loads: SeaLoads) -> Limit:
            return speed_limit(
                unit.hanging, unit.site, unit.requirements, highest=highest, waves=loads, solved=self.solved
            )

        limit, bound = self._judged(find, lambda limit: limit.value, self.loads.impact is not None)
        impact = self.loads.impact
        if limit.value > 0.0 and (impact is None or (bound == "" and not self._knows_sheet(impact, limit.value))):
            # whatever an impact adds, on the sheet or at all, lowers the limit
            return limit, "at most"
        return limit, bound

    def height(self, speed: float) -> tuple[Limit, Bound]:
        """Return the largest significant height in a current [m/s], and whether it is a bound."""
        limit, bound = self._judged(lambda loads: self._height(loads, speed), lambda _: speed, self.with_plate)
        snaps = self.loads_in(speed).snaps
        if limit.value > 0.0 and snaps is None:
            # a steady drag does not include snap loads: the limit can only be lower, whatever sets it
            return limit, "at most"
        if limit.value > 0.0 and snaps is not None and bound == "" and not self._knows_sheet(snaps[1], speed):
            return limit, "at most"
        if limit.value > 0.0 and self.with_plate and self.role(speed) == "bound":
            # a plate that is but a bound knows neither sheet nor anchors: breaking, depth or the end of the search
            # above it prove nothing in waves
            return limit, "at least"
        return limit, bound

    def _knows_sheet(self, struck: ImpactLoad, speed: float) -> bool:
        """Whether the load of the sheet in a snap is known in a current [m/s].

        That of a free toe is one of the whole span; a sheet without a strength is not judged.
        """
        if self.unit.curtain.toe == "free" or self.unit.curtain.strengths.sheet is UNJUDGED:
            return True
        at = struck.skirt_at
        return (struck.skirt if at is None else at(self.loads.normal_ratio * speed)) is not None

    def _height(self, loads: SeaLoads, speed: float) -> Limit:
        unit, highest = self.unit, self.settings.limits.highest_height
        snapping = loads.snaps is not None
        return height_limit(
            unit.hanging, unit.site, unit.requirements, loads, speed=speed, highest=highest, first_only=snapping
        )

    def _judged(
        self, find: Callable[[SeaLoads], Limit], place: Callable[[Limit], float], plate: bool
    ) -> tuple[Limit, Bound]:
        plain = find(self.sure)
        if not plate:
            return plain, ""
        struck = find(self.loads)
        role = self.role(place(struck))
        if role == "governs":
            return struck, ""
        if role == "bound":
            # where the sure loads already set the same limit, they are what sets it
            return (struck, "at least") if struck.value < plain.value else (plain, "")
        return plain, ""


#: Roles of the plate, the strongest first
_ROLES: tuple[Role, ...] = ("governs", "bound", "comparison", "out of range")


def _limits_group(
    unit: LevelCurtain,
    settings: CurtainSettings,
    counted: CountedLimits,
    found: _FoundLimits,
    heights: Array,
    parts: Array,
) -> xr.Dataset:
    import xarray as xr

    limits, loads, most = settings.limits, counted.loads, found.most
    alone = np.array([row.value for row, _ in found.rows])
    # a site with this current has every weaker one as well, twice a tide
    source = [int(np.argmin(alone[: n + 1])) for n in range(alone.size)]
    low, high, band_of = _speed_band(unit, counted, most)
    data: dict[str, Any] = {
        "limit_height": ("speed", alone[source]),
        "limit_governing": ("speed", [found.rows[n][0].governing for n in source]),
        "limit_bound": ("speed", [found.rows[n][1] for n in source]),
        "limit_height_alone": ("speed", alone),
        "limit_note": ("speed", [height_note(row, limits.highest_height) for row, _ in found.rows]),
        "limit_factored_utilisation": (("speed", "height"), np.nanmax(parts, axis=2)),
        "limit_component": (("speed", "height"), _governing(parts)),
        "component_factored_utilisation": (("speed", "height", "component"), parts),
        "surface_speed": ((), unit.surface_speed),
        "speed_limit": ((), most.value),
        "speed_limit_low": ((), low),
        "speed_limit_high": ((), high),
        "speed_limit_ratio": ((), most.value / unit.surface_speed if unit.surface_speed > 0.0 else math.nan),
        "drowning_speed": ((), unit.drowning_speed),
    }
    attributes = _design_height(unit, counted, found, alone, data)
    held = float(np.nan_to_num(data["design_limit_height"][1]))
    return labelled(
        xr.Dataset(
            data,
            coords={
                "speed": (
                    "speed",
                    np.asarray(found.speeds),
                    {"units": "m/s", "long_name": "surface speed of the current"},
                ),
                "height": heights,
                "component": list(PARTS),
            },
            attrs={
                **attributes,
                "speed_limit_governing": most.governing,
                "speed_limit_bound": found.most_bound,
                "speed_limit_text": speed_text(most),
                "speed_limit_band_of": band_of,
                "limit_not_monotone": _not_monotone(found, alone, alone[source]),
                "limit_jump": _jump(unit, counted, found),
                "least_effective_depth": unit.requirements.least_depth,
                "wave_angle": limits.wave_angle,
                "with_drift": int(_drifts(counted) and drift_of_height(unit, settings, held) > unit.surface_speed),
                "with_impact": int(loads.impact is not None),
                "with_snaps": int(loads.snaps is not None),
                "sea_duration": counted.duration,
                "with_energy_model": int(loads.energy is not None),
                "plate_role": counted.role(unit.surface_speed) if counted.with_plate else "",
            },
        )
    )


def _design_height(
    unit: LevelCurtain, counted: CountedLimits, found: _FoundLimits, alone: Array, data: dict[str, Any]
) -> dict[str, str]:
    """Add the height held in currents up to that of the case, and return what sets it and whether it is a bound."""
    own = unit.surface_speed
    if own <= 0.0 and not _drifts(counted):
        data["design_limit_height"] = ((), math.nan)
        return {"design_limit_governing": "", "design_limit_bound": "", "design_limit_note": ""}
    rows = [row for speed, row in zip(found.speeds, found.rows) if speed <= own * (1.0 + 1e-9)]
    if own > 0.0 and not any(abs(speed - own) <= 1e-9 * own for speed in found.speeds):
        rows.append(counted.height(own))
    rows += _in_drift(counted, rows)
    # where several are alike, the one nearest to the current of the case
    limit, bound = min(reversed(rows), key=lambda row: row[0].value)
    if not bound and limit.value > 0.0 and any(other for _, other in rows):
        # in another current the height is not known: it may be less
        bound = "at most"
    data["design_limit_height"] = ((), limit.value)
    return {
        "design_limit_governing": limit.governing,
        "design_limit_bound": bound,
        "design_limit_note": height_note(limit, counted.settings.limits.highest_height),
    }


def _speed_band(unit: LevelCurtain, counted: CountedLimits, most: Limit) -> tuple[float, float, str]:
    """Return the largest current at both ends of what its load varies with, and what that is; NaN where there is none.

    A load at rest goes with C_D U^2 alone, so that a factor on one is the root of a factor on the other; with an impact
    the limit is sought again with the ends of the bands of impact and steady part, as the state itself is judged.
    """
    if not most.reached:
        return math.nan, math.nan, ""
    impact = counted.loads.impact
    if impact is None or most.governing in ("effective depth", "floats"):
        low, high = drag_factors(unit.hanging.drag)
        return most.value / math.sqrt(high), most.value / math.sqrt(low), "range of the drag coefficient"
    gentle = replace(counted.loads, impact=replace(impact, factor=impact.uncertainty[0] * impact.factor))
    low, high = (replace(counted, loads=loads).speed()[0].value for loads in (_severe(unit, counted.loads), gentle))
    return min(low, most.value), max(high, most.value), "range of the impact and of the steady part"


def speed_text(limit: Limit) -> str:
    """Return what to say in place of a largest current that is none; empty where the number says it."""
    if not limit.reached:
        return f"no limit within the range searched (up to {limit.highest:.3g} m/s)"
    return _fails_at_once(limit, "m/s") if limit.value <= 0.0 else ""


def height_note(limit: Limit, highest: float) -> str:
    """Return what to say of a largest height besides its number: none found, fails at once, or holds again above."""
    if not limit.reached:
        return f"no limit within the range searched (up to {highest:.3g} m)"
    if limit.value <= 0.0:
        return _fails_at_once(limit, "m")
    again = limit.crossings[1::2]
    if not again:
        return ""
    return "holds again from " + ", ".join(f"{value:.3g} m" for value in again) + "; the smallest limit is used"


def _fails_at_once(limit: Limit, unit: str) -> str:
    if limit.governing == "no equilibrium":
        return f"0 {unit}: no equilibrium in this current"
    return f"0 {unit}: the current alone is too much for the {limit.governing} ({100.0 * limit.ratio:.0f} %)"


def _not_monotone(found: _FoundLimits, alone: Array, least: Array) -> str:
    """Say where a stronger current alone would allow a higher wave, and why."""
    risen = np.flatnonzero(alone > least * (1.0 + 1e-6) + 1e-9)
    if not risen.size:
        return ""
    n = int(risen[np.argmax(alone[risen] - least[risen])])
    return (
        f"a current of {found.speeds[n]:.3g} m/s alone would allow {alone[n]:.3g} m, more than the {least[n]:.3g} m "
        "of a weaker one: a stronger current keeps the curtain taut, and it snaps less. Weaker currents come with "
        "every stronger one, so that the smallest of them all is used"
    )


def _jump(unit: LevelCurtain, counted: CountedLimits, found: _FoundLimits) -> str:
    """Say from which current on the upright plate counts otherwise, where the heights jump for it."""
    if not counted.with_plate or unit.curtain.toe == "free":
        return ""
    roles = [counted.role(speed) for speed in found.speeds]
    for n, (before, after) in enumerate(itertools.pairwise(roles)):
        if before != after:
            low, high = found.speeds[n : n + 2]
            return (
                f"between {low:.3g} and {high:.3g} m/s the depth falls below {100.0 * STRAIGHT:.0f} % of the length: "
                "the snap of an upright plate is a value below that current and an upper bound above it; limits of "
                "wave height may be discontinuous there"
            )
    return ""


def _drifts(counted: CountedLimits) -> bool:
    """Whether snaps are sought in the drift of the waves."""
    unit = counted.unit
    return counted.loads.snaps is not None and not unit.nominal and models.held_at_both(unit.curtain)


def _in_drift(counted: CountedLimits, rows: Sequence[tuple[Limit, Bound]]) -> list[tuple[Limit, Bound]]:
    """Return what the drift of the waves makes of a height: seas up to it are run in currents up to their own drift.

    Parameters
    ----------
    counted : CountedLimits
    rows : sequence
        Limits in currents up to that of the case; no sea above the lowest of them is asked for.
    """
    from scipy.optimize import brentq

    unit, highest = counted.unit, counted.settings.limits.highest_height
    least = min((limit.value for limit, _ in rows), default=highest)
    if not (_drifts(counted) and least > 0.0):
        return []
    # an impact is one of the current, not of the drift
    drifting = replace(counted, loads=replace(counted.loads, impact=None))

    def drift(height: float) -> float:
        return drift_of_height(unit, counted.settings, height)

    def over(height: float, speeds: tuple[float, float], limits: tuple[float, float]) -> float:
        return height - float(np.interp(drift(height), speeds, limits))

    found: list[tuple[Limit, Bound]] = []
    step, speed, held = step_of_waves(unit), unit.surface_speed, least
    straight = models.upright_in(unit, drift(least)) if drift(least) > speed else speed
    most = math.inf
    if speed <= straight < drift(least):
        # what drifts faster leaves the plate as a bound: nothing is known beyond that sea
        least = most = float(brentq(lambda height: drift(height) - straight, 0.0, least, xtol=1e-4))
    while (fastest := drift(least)) > speed * (1.0 + 1e-6):
        last, speed = speed, min((math.floor(speed / step + 1e-9) + 1.0) * step, fastest)
        limit, bound = drifting.height(speed)
        before, held = held if last > 0.0 else limit.value, limit.value
        if held < least:
            # the sea whose limit is its own height, the limit straight between two currents
            least = float(brentq(over, 0.0, least, args=((last, speed), (before, held)), xtol=1e-4))
            found.append((replace(limit, value=least), bound))
    return found if least < most else [*found, (Limit(least, OF_UPRIGHT, highest=highest), "at least")]


def _speeds(unit: LevelCurtain, settings: CurtainSettings, limit: Limit) -> tuple[float, ...]:
    """Return the speeds of the table: as given, or up past the limit, with the limit and the current of the case."""
    weaker: tuple[float, ...] = ()
    if "waves" in settings.analyses:
        # in them the sheet hangs straighter and may carry more; at slack water there is no stable shape
        weaker = tuple(speed for speed in currents_of_waves(unit) if speed > 0.0)
    if settings.limits.speeds is not None:
        return tuple(sorted({max(speed, 1e-3) for speed in settings.limits.speeds}.union(weaker)))
    top = max(1.2 * limit.value, unit.surface_speed, 0.1)
    top = min(top, settings.limits.highest_speed)
    even = np.linspace(0.0, _round_up(top), _SPEED_COUNT)[1:]
    values = [float(value) for value in even]
    values += [speed for speed in weaker if min(abs(speed - value) for value in values) > 0.1 * speed]
    if unit.surface_speed > 0.0 and min(abs(unit.surface_speed - value) for value in values) > 1e-9:
        values.append(unit.surface_speed)
    if limit.reached and limit.value > 0.0:
        # just held: the height does not fall to nothing on the way to the next current of the table
        values = [
            value for value in values if abs(value - limit.value) > 0.02 * limit.value or value == unit.surface_speed
        ]
        values.append(limit.value * (1.0 - 1e-6))
    return tuple(sorted(values))


def _heights(settings: CurtainSettings, limit: float) -> Array:
    if settings.limits.heights is not None:
        return np.array(settings.limits.heights)
    top = min(max(1.3 * limit, 0.5), settings.limits.highest_height)
    return np.linspace(0.0, _round_up(top), _HEIGHT_COUNT)


def _round_up(value: float) -> float:
    size = 10.0 ** math.floor(math.log10(value))
    return float(
        next(step * size for step in (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 8.0, 10.0) if step * size >= value * 0.999)
    )


def _grid(unit: LevelCurtain, by_speed: list[SeaLoads], speeds: tuple[float, ...], heights: Array) -> Array:
    """Return the utilisation of each part at each speed and height; infinite beyond equilibrium or breaking.

    Above the first height that is too much snaps are those of that height: the utilisation is at least so much.
    """
    required = unit.requirements
    out = np.full((len(speeds), heights.size, len(PARTS)), math.nan)
    for i, speed in enumerate(speeds):
        statics, loads = _statics(unit, speed), by_speed[i]
        state = None if statics is None else unit.site.with_floats(statics, speed)
        for j, height in enumerate(heights):
            if statics is None or state is None or _breaks(unit, loads, float(height)):
                out[i, j] = math.inf
                continue
            try:
                more = loads.added(statics, float(height), speed, unit.water)
            except InputError:
                out[i, j] = math.inf
                continue
            parts = utilisation(state, required, 0.0, more)
            out[i, j] = [parts.get(name, math.nan) for name in PARTS]
    return out


def _statics(unit: LevelCurtain, speed: float) -> CurtainStatics | None:
    try:
        return unit.site.statics(unit.hanging, speed)
    except (InputError, ConvergenceError):
        return None


def _breaks(unit: LevelCurtain, loads: SeaLoads, height: float) -> bool:
    if height <= 0.0:
        return False
    return loads.height_ratio * height > breaking_limit(loads.period(height), unit.water).height


def _governing(parts: Array) -> NDArray[Any]:
    out = np.empty(parts.shape[:2], dtype=object)
    for place in np.ndindex(out.shape):
        row = parts[place]
        if np.isinf(row).all():
            out[place] = "no equilibrium or breaking"
        else:
            out[place] = PARTS[int(np.nanargmax(row))]
    return out


__all__ = [
    "PARTS",
    "CountedLimits",
    "fastest_water",
    "height_note",
    "impact_load",
    "limits_dataset",
    "sea_loads",
    "speed_text",
]
