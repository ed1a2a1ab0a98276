"""What the report of a floating breakwater asks of a result: water levels, sea states, runs and governing numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from moyai.core.arrays import Array
from moyai.core.results import Result
from moyai.report.formatting import largest_magnitude
from moyai.report.reading import Group, root_of

MODES = ("sway", "heave", "roll")
SNAP_RATIO = 5.0  # as moyai.structures.breakwater.responses has it: lines at rest serve up to so many times the mean
DOMAIN_WORDS = {"frequency": "frequency domain", "time": "time domain"}
LEVEL_GROUPS = ("statics", "mooring", "hydrodynamics", "rao", "frequency", "time", "sensitivity")


@dataclass(frozen=True)
class BreakwaterLevel:
    """One water level of a result."""

    group: Group

    @property
    def name(self) -> str:
        """Name as in the case file."""
        return self.group.name

    @property
    def elevation(self) -> float:
        """Height above datum [m], NaN where not known."""
        return _number(self.group.attributes.get("water_level"))

    @property
    def depth(self) -> float:
        """Water depth [m], infinite in deep water, NaN where not known."""
        return _number(self.group.attributes.get("water_depth"))

    def sea_names(self) -> tuple[str, ...]:
        """Names of the sea states of either domain, in order."""
        names: dict[str, None] = {}
        for domain in DOMAIN_WORDS:
            for child in self.group.child(domain).children():
                names.setdefault(child.name)
        return tuple(names)

    def sea(self, name: str) -> Sea:
        """Return a sea state in both domains."""
        return Sea(name, self.group.child(f"frequency/{name}"), self.group.child(f"time/{name}"))


@dataclass(frozen=True)
class Sea:
    """One sea state at one water level; either domain may be absent."""

    name: str
    frequency: Group
    time: Group

    @property
    def regular(self) -> bool:
        """Whether it is a series of regular waves."""
        return any(bool(group.labels("period")) for group in (self.frequency, self.time))

    def domain(self, name: str) -> Group:
        """Return the group of ``frequency`` or ``time``."""
        return self.frequency if name == "frequency" else self.time

    def runs(self) -> tuple[Group, ...]:
        """Return the runs of the time domain that hold a record."""
        return tuple(run for run in self.time.children() if run.real("position", "time", "dof") is not None)


def attribute_number(group: Group, name: str) -> float:
    """Return a number among the attributes of a group, NaN where it is absent or no number."""
    return _number(group.attributes.get(name))


def _number(value: object) -> float:
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return math.nan


def water_levels(result: Result) -> tuple[BreakwaterLevel, ...]:
    """Return the water levels that a result holds, in the order of the case file."""
    root = root_of(result)
    return tuple(
        BreakwaterLevel(child)
        for child in root.children()
        if "water_depth" in child.attributes or any(child.child(name).exists for name in LEVEL_GROUPS)
    )


@dataclass(frozen=True)
class SeaNumbers:
    """Governing numbers of one sea state at one water level in one domain; NaN where not known.

    Tensions in N, offsets and motions in m and rad. For regular waves each is the largest over the periods, with the
    period [s] at which it occurs. ``beyond_range`` is the largest tension over the mean where a chain at rest at every
    instant passes its range.
    """

    level: str
    sea: str
    domain: str
    regular: bool
    tension: float = math.nan
    line: str = ""
    tension_period: float = math.nan
    breaking_load: float = math.nan
    uplift: float = math.nan
    mean_offset: float = math.nan
    largest_offset: float = math.nan
    motions: dict[str, float] = field(default_factory=dict)
    transmission: float = math.nan
    transmission_period: float = math.nan
    reflection: float = math.nan
    drift: float = math.nan
    overtopping: float = math.nan
    significant_height: float = math.nan
    beyond_range: float = math.nan

    @property
    def utilisation(self) -> float:
        """Tension over breaking load."""
        return self.tension / self.breaking_load if self.breaking_load > 0.0 else math.nan

    @property
    def words(self) -> str:
        """Water level, sea and domain in words."""
        return f"{self.level}, {self.sea}, {DOMAIN_WORDS.get(self.domain, self.domain)}"


_TENSION_NAMES = ("line_tension_maximum", "most_probable_maximum_tension")
_UPLIFT_NAMES = ("anchor_vertical_tension_maximum",)


def sea_numbers(level: BreakwaterLevel, sea: Sea, domain: str) -> SeaNumbers | None:
    """Return the governing numbers of a sea state in one domain, ``None`` where that domain was not run."""
    group = sea.domain(domain)
    if not group.exists:
        return None
    periods = group.real("period", "period")
    tension, line, breaking, tension_period = _largest_tension(level, sea, domain, periods)
    transmission, reflection, at = _transmission(group, periods)
    return SeaNumbers(
        level=level.name,
        sea=sea.name,
        domain=domain,
        regular=sea.regular,
        tension=tension,
        line=line,
        tension_period=tension_period,
        breaking_load=breaking,
        uplift=_largest(group, _UPLIFT_NAMES, absolute=False),
        mean_offset=_largest(group, ("mean_offset",), dof="sway"),
        largest_offset=_largest_offset(sea, group, domain),
        motions={mode: _largest(group, ("motion_amplitude", "significant_motion"), dof=mode) for mode in MODES},
        transmission=transmission,
        transmission_period=at,
        reflection=reflection,
        drift=_largest(group, ("mean_drift_force",)),
        overtopping=_largest(group, ("overtopping_share",)),
        significant_height=group.value("significant_height"),
        beyond_range=_beyond_range(level, group, domain),
    )


def ratios_beyond_range(level: BreakwaterLevel, group: Group, domain: str) -> Array | None:
    """Return largest over mean tension ((periods,) lines) where lines at rest pass their range, NaN elsewhere."""
    largest, mean = group.variable("line_tension_maximum"), group.variable("line_tension_mean")
    if largest is None or mean is None:
        return None
    length = level.group.child("statics").real("unstretched_length", "line")
    moving = group.variable("lines_in_motion")
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.asarray(largest.values / mean.values, dtype=float)
    passing = ratio > SNAP_RATIO
    if length is not None:
        passing &= np.isfinite(length)  # springs have no range
    if domain == "time" and moving is not None:
        passing &= np.asarray(moving.values) != 1
    return np.where(passing, ratio, math.nan)


def _beyond_range(level: BreakwaterLevel, group: Group, domain: str) -> float:
    found = ratios_beyond_range(level, group, domain)
    return float(np.nanmax(found)) if found is not None and np.isfinite(found).any() else math.nan


def _largest(group: Group, names: tuple[str, ...], absolute: bool = True, **choice: str) -> float:
    """Return the largest of the first variable that is there, over whatever dimensions it has."""
    for name in names:
        found = group.selected(name, **choice)
        if found is None:
            continue
        values = np.asarray(found.values)
        values = np.abs(values) if absolute or np.iscomplexobj(values) else values
        known = values[np.isfinite(values)]
        if known.size:
            return float(known.max())
    return math.nan


def breaking_loads(level: BreakwaterLevel) -> dict[str, float]:
    """Return the breaking load of each line [N]; NaN where not known."""
    statics = level.group.child("statics")
    loads = statics.real("breaking_load", "line")
    return {} if loads is None else dict(zip(statics.labels("line"), map(float, loads), strict=True))


def _largest_tension(
    level: BreakwaterLevel, sea: Sea, domain: str, periods: Array | None
) -> tuple[float, str, float, float]:
    """Return tension, line, its breaking load and the period, for the line with the highest utilisation."""
    group = sea.domain(domain)
    table = None
    for name in _TENSION_NAMES:
        table = group.real(name, *(("period", "line") if periods is not None else ("line",)))
        if table is not None:
            break
    names = group.labels("line")
    if table is None and domain == "time":
        records = [record for run in sea.runs() if (record := run.real("tension", "time", "line")) is not None]
        if records:
            table = np.fmax.reduce(np.array([np.fmax.reduce(record, axis=0) for record in records]), axis=0)
            names = sea.runs()[0].labels("line")
            periods = None
    if table is None or not np.isfinite(table).any():
        return math.nan, "", math.nan, math.nan
    loads = breaking_loads(level)
    broken = np.array([loads.get(name, math.nan) for name in names])
    rank = table / broken if np.isfinite(broken).all() else table
    place = np.unravel_index(int(np.nanargmax(rank)), rank.shape)
    at = float(periods[place[0]]) if periods is not None else math.nan
    return float(table[place]), names[place[-1]], float(broken[place[-1]]), at


def _largest_offset(sea: Sea, group: Group, domain: str) -> float:
    """Return the largest sway from rest: that of the records in time, mean + amplitude in the frequency domain."""
    if domain == "time":
        for name in ("largest_offset_by_dof", *(("maximum_motion",) if sea.regular else ())):
            largest = _largest(group, (name,), dof="sway")
            if math.isfinite(largest):
                return largest
        found = [run.real("position", "time", dof="sway") for run in sea.runs()]
        extreme = max((largest_magnitude(record) for record in found if record is not None), default=0.0)
        if extreme > 0.0:
            return extreme
    if domain == "frequency" and math.isfinite(group.value("largest_offset")):
        return group.value("largest_offset")
    offset = group.real("mean_offset", "period", dof="sway")
    amplitude = group.real("motion_amplitude", "period", dof="sway")
    if offset is not None and amplitude is not None and np.isfinite(offset + amplitude).any():
        return float(np.nanmax(np.abs(offset) + np.abs(amplitude)))
    mean = group.value("mean_offset", dof="sway")
    for name in ("maximum_motion", "most_probable_maximum_motion"):
        largest = group.value(name, dof="sway")
        if math.isfinite(largest):  # both are counted from the mean
            return abs(mean if math.isfinite(mean) else 0.0) + largest
    return math.nan


def _transmission(group: Group, periods: Array | None) -> tuple[float, float, float]:
    """Return transmission, reflection and the period of the largest transmission."""
    if periods is None:
        return group.value("transmission_coefficient"), group.value("reflection_coefficient"), math.nan
    transmission = group.real("transmission_coefficient", "period")
    if transmission is None or not np.isfinite(transmission).any():
        return math.nan, math.nan, math.nan
    at = int(np.nanargmax(transmission))
    reflection = group.real("reflection_coefficient", "period")
    return float(transmission[at]), math.nan if reflection is None else float(reflection[at]), float(periods[at])


def all_numbers(levels: tuple[BreakwaterLevel, ...]) -> tuple[SeaNumbers, ...]:
    """Return the governing numbers of every water level, sea state and domain."""
    found = []
    for level in levels:
        for name in level.sea_names():
            for domain in ("time", "frequency"):
                numbers = sea_numbers(level, level.sea(name), domain)
                if numbers is not None:
                    found.append(numbers)
    return tuple(found)


def governing_entry(result: Result, numbers: tuple[SeaNumbers, ...]) -> SeaNumbers | None:
    """Return the entry that the headline of the line tension (without lines: of the offset) stands for.

    What governs is decided by the structure (:mod:`moyai.structures.breakwater.headlines`), not here.
    """
    wanted = [item for name in ("line_tension", "offset") for item in result.headlines if item.name == name]
    for headline in wanted:
        domain = "time" if headline.model.startswith("time") else "frequency"
        for entry in numbers:
            head = f"{entry.level}, {entry.sea}"
            if entry.domain == domain and (headline.where == head or headline.where.startswith(f"{head}, ")):
                return entry
    return None
