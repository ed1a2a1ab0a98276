"""The first page's numbers of a row at rest: freeboard and stability; tensions and offset where no sea was run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Headline
from moyai.core.wording import spoken

if TYPE_CHECKING:
    import xarray as xr

Rests = list[tuple[str, "xr.Dataset"]]
STILL, STEADY = "still water", "at rest under wind and current"
#: Offsets up to this [m] are rounding.
_NOTHING = 1e-9


def stability_headlines(rests: Rests) -> Iterator[Headline]:
    """Return freeboard and metacentric height at their worst water level."""
    for name, label in (("freeboard", "Freeboard"), ("metacentric_height", "Metacentric height GM of a unit")):
        known = [(float(data[name]), path.split("/")[1]) for path, data in rests]
        if known:
            value, level = min(known)
            yield Headline(name, label, value, "m", level, STILL, without_waves=True)


def steady_headlines(rests: Rests) -> Iterator[Headline]:
    """Return largest tension of a line, share of its breaking load, loads of anchors, offset under wind and current."""
    loads = [data[f"steady_force_of_{name}"].values for _, data in rests for name in ("wind", "current")]
    model = STEADY if any(load.any() for load in loads) else STILL
    tensions = [
        (float(tension), f"{path.split('/')[1]}, {line}", float(load))
        for path, data in rests
        for tension, line, load in zip(
            data["line_tension_mean"].values, data["line"].values, data["breaking_load"].values, strict=True
        )
    ]
    if tensions:
        tension, where, _ = max(tensions)
        yield Headline(
            "line_tension", "Largest steady tension of a line", tension, "N", where, model, mean=tension,
            analysis="static",
        )  # fmt: skip
    shares = [(tension / load, where, load) for tension, where, load in tensions if np.isfinite(load)]
    if shares:
        share, where, load = max(shares)
        yield Headline(
            "line_utilisation", "Steady tension over breaking load of a line", share, "1", where, model, mean=share,
            analysis="static", detail=f"breaking load {spoken(load, 'N', 3)}",
        )  # fmt: skip
    for name, label, variable in (
        ("anchor_horizontal_tension", "Steady horizontal pull on an anchor", "anchor_horizontal_tension"),
        ("anchor_vertical_tension", "Steady uplift at an anchor", "anchor_vertical_tension"),
    ):
        found = [
            (float(load), f"{path.split('/')[1]}, {line}")
            for path, data in rests
            for load, line in zip(data[variable].values, data["line"].values, strict=True)
            if np.isfinite(load)
        ]
        if found:
            load, where = max(found)
            yield Headline(name, label, load, "N", where, model, text="none" * (load == 0.0))
    offsets = [
        (float(np.hypot(*offset[:2])), f"{path.split('/')[1]}, unit {unit}")
        for path, data in rests
        for offset, unit in zip(data["steady_offset"].values, data["unit"].values, strict=True)
    ]
    if any(offset > _NOTHING for offset, _ in offsets):
        offset, where = max(offsets)
        yield Headline("offset", "Steady offset of a unit", offset, "m", where, model)


__all__ = ["stability_headlines", "steady_headlines"]
