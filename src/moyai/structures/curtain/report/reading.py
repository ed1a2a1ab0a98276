"""What the report of a curtain asks of a result: water levels, components with their loads, sea states, texts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.results import Result
from moyai.report.encoding import slug
from moyai.report.reading import Group, root_of

LEVEL_GROUPS = (
    "statics",
    "statics_laws",
    "statics_paper",
    "section",
    "plan",
    "impact",
    "waves",
    "anchor_loads",
    "limits",
    "loads",
    "dynamic",
    "models",
)
GIVEN = "given"
PARTS = ("steady", "wave", "impact", "dynamic", "governing")


@dataclass(frozen=True)
class CurtainLevel:
    """One water level of a result."""

    group: Group

    @property
    def name(self) -> str:
        """Name as in the case file."""
        return self.group.name

    @property
    def elevation(self) -> float:
        """Height above datum [m], NaN where not known."""
        return self.group.number("water_level")

    @property
    def depth(self) -> float:
        """Water depth [m], NaN where not known."""
        return self.group.number("water_depth")

    @property
    def toe(self) -> str:
        """``free``, ``held`` or ``on the bed``; empty where not known."""
        return str(self.group.attributes.get("toe", ""))

    def part(self, name: str) -> Group:
        """Return a group of the level."""
        return self.group.child(name)

    def given(self, name: str, group: str = "statics") -> float:
        """Return a number of the drag coefficient as given, NaN where not known."""
        part = self.part(group)
        return part.value(name, drag_case=GIVEN) if "drag_case" in part.dims(name) else part.value(name)

    def spread(self, name: str) -> tuple[float, float]:
        """Return the least and the largest of a static number over the range of the drag coefficient."""
        values = self.part("statics").real(name, "drag_case")
        known = np.array([]) if values is None else values[np.isfinite(values)]
        return (float(known.min()), float(known.max())) if known.size else (math.nan, math.nan)

    def seas(self) -> tuple[Group, ...]:
        """Return the sea states whose slack and taut cycles were run."""
        return tuple(sea for sea in self.part("waves").children() if sea.exists)


@dataclass(frozen=True)
class Component:
    """One component with its loads, in ``unit``; NaN where not known."""

    name: str
    #: ``steady``, and what ``wave`` and ``impact`` add to it; ``dynamic`` is that of the whole span through time;
    #: ``governing`` is the dynamic one where it was run, else the steady load with the larger of what is added.
    loads: dict[str, float]
    #: ``N`` or ``N/m``.
    unit: str
    capacity: float
    safety_factor: float
    utilisation: float
    #: Words for what governs.
    governing: str
    #: Where wave and impact come from, and the run of the whole span.
    sources: tuple[str, str, str]
    #: ``at most`` where the governing load is only a bound.
    bound: str = ""

    def share(self, part: str) -> float:
        """Return the utilisation by one part of the load alone, NaN where not known or where it does not count."""
        whole = self.loads["governing"]
        if part in ("wave", "impact") and not whole > self.loads["steady"] * (1.0 + 1e-9):
            return math.nan
        return self.utilisation * self.loads[part] / whole if whole > 0.0 else math.nan


def texts(group: Group, name: str, *dims: str) -> NDArray[np.str_] | None:
    """Return a variable of words with its dimensions in the order of ``dims``, ``None`` where it is absent."""
    found = None if group.node is None else group.node.variables.get(name)
    if found is None or set(found.dims) != set(dims):
        return None
    return np.asarray(found.transpose(*dims).values).astype(str)


def words(group: Group, name: str, dim: str, count: int) -> list[str]:
    """Return the words of a variable along one dimension, empty ones where it is absent."""
    found = texts(group, name, dim)
    return [""] * count if found is None else [str(text) for text in found]


def key(level: CurtainLevel, *parts: str) -> str:
    """Return the key of a figure or table at a water level."""
    return slug(level.name, *parts)


def water_levels(result: Result) -> tuple[CurtainLevel, ...]:
    """Return the water levels that a result holds, in the order of the case file."""
    root = root_of(result)
    return tuple(
        CurtainLevel(child)
        for child in root.children()
        if "water_depth" in child.attributes or any(child.child(name).exists for name in LEVEL_GROUPS)
    )


def components(level: CurtainLevel) -> tuple[Component, ...]:
    """Return the components of the load table."""
    group = level.part("loads")
    names = group.labels("component")
    if not names:
        return ()

    def column(name: str) -> Array:
        found = group.real(name, "component")
        return np.full(len(names), math.nan) if found is None else found

    loads = {part: column(f"{part}_load") for part in PARTS}
    capacity, factor, used = column("capacity"), column("safety_factor"), column("factored_utilisation")
    units = words(group, "load_unit", "component", len(names))
    governing = words(group, "governing", "component", len(names))
    weaker = words(group, "governing_source", "component", len(names))
    bounds = words(group, "load_bound", "component", len(names))
    sources = [words(group, f"{what}_source", "component", len(names)) for what in ("wave", "impact", "dynamic")]
    return tuple(
        Component(
            name,
            {part: float(values[row]) for part, values in loads.items()},
            units[row],
            float(capacity[row]),
            float(factor[row]),
            float(used[row]),
            weaker[row] or governing[row],
            (sources[0][row], sources[1][row], sources[2][row]),
            bounds[row],
        )
        for row, name in enumerate(names)
    )


def governing_component(levels: tuple[CurtainLevel, ...]) -> tuple[CurtainLevel, Component] | None:
    """Return the component of the largest utilisation over all water levels, ``None`` where none is judged."""
    judged = [
        (level, component)
        for level in levels
        for component in components(level)
        if math.isfinite(component.utilisation)
    ]
    return max(judged, key=lambda entry: entry[1].utilisation) if judged else None


def curve(group: Group, x: str, y: str, dim: str, **choice: str) -> Array | None:
    """Return two variables along one dimension as points (n, 2), ``None`` where either is absent or unknown."""
    first, second = group.real(x, dim, **choice), group.real(y, dim, **choice)
    if first is None or second is None:
        return None
    points = np.stack([first, second], axis=1)
    points = points[np.isfinite(points).all(axis=1)]
    return points if len(points) > 1 else None
