"""What the kernels of the explicit scheme are handed, by its parts."""

from __future__ import annotations

from typing import Any

from moyai.core.arrays import Array, IntArray

#: Whether the water moves, whether a part may be dry, water at the start (7, n), its rate, time of the start [s].
Waves = tuple[bool, bool, Array, Array, float]
#: Driven nodes with their tables, places at rest, tables of their motion, its start and step [s].
Driving = tuple[IntArray, Array, Array, float, float]
#: Time of the state, step, steps a load interval, load intervals a row, rows, first row, time of the row that is gone.
Timing = tuple[float, float, int, int, int, int, float]
#: Positions (rows, nodes, 3), tensions (rows, bars), highest since the row before, energies and work (rows, 3), nodes
#: that are kept, bars that are kept as places in the memory.
Saved = tuple[Array, Array, Array, Array, IntArray, IntArray]
#: Bars with gauges, gauges, falls on the bed, steps done of a row that was broken off, bounds of the rate of drag
#: times the load interval and times the step.
Watch = tuple[IntArray, Array, Array, IntArray, float, float]
#: Panels, rings, sheets and dense mass blocks, ``None`` where there are none; :mod:`moyai.flexible.explicit_parts`.
Panels = tuple[Any, ...] | None
Rings = tuple[Any, ...] | None
Sheets = tuple[Any, ...] | None
Blocks = tuple[Any, ...] | None
Parts = tuple[Panels, Rings, Sheets, Blocks]
