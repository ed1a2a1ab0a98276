"""The array on which the kernels of the explicit scheme work: its rows by name.

Everything lies in one array whose rows are ``ROW`` apart, a constant: the compiler then knows that rows do not overlap
and turns every loop into vector instructions, also for lines of a dozen bars. ``ROW`` is no power of two, so that rows
fall on different lines of the cache.

Bars between neighbours in memory form the *spine*: bar i joins nodes i and i + 1, and gaps hold bars without
stiffness. All others are *ribs*, in runs (a, b, first, count, curve): rib first + i joins nodes a + i and b + i. Of a
rib the same rows hold its constants, shifted by ``RIB``.
"""

from __future__ import annotations

from typing import Any

#: Which re-orderings the compiler may make: none that assumes the absence of NaN, which marks a blow-up.
FAST: Any = {"contract", "arcp", "nsz", "reassoc"}

#: Keeps the direction of bars without stiffness finite where their nodes coincide.
TINY = 1e-200
#: Distance of rows; networks of up to about this many nodes fit. Memory that is not touched costs nothing.
ROW = 65536 + 24
#: Rows by name. Nodes: position, velocity, the water (velocity, acceleration, elevation): what bars see of their ends.
X, Y, Z, U, V, W = 0 * ROW, 1 * ROW, 2 * ROW, 3 * ROW, 4 * ROW, 5 * ROW
WU, WV, WW, WA, WB, WC, ETA = (row * ROW for row in range(6, 13))
#: Nodes: force in use, new load, load before, inverse mass, mass block.
PX, PY, PZ, QX, QY, QZ = 13 * ROW, 14 * ROW, 15 * ROW, 16 * ROW, 17 * ROW, 18 * ROW
BX, BY, BZ = 19 * ROW, 20 * ROW, 21 * ROW
IXX, IXY, IXZ, IYY, IYZ, IZZ = 22 * ROW, 23 * ROW, 24 * ROW, 25 * ROW, 26 * ROW, 27 * ROW
MXX, MXY, MXZ, MYY, MYZ, MZZ = 28 * ROW, 29 * ROW, 30 * ROW, 31 * ROW, 32 * ROW, 33 * ROW
#: Nodes: what does not change.
MASS, WEIGHT, VOLUME, DRAG, ADDED, STIFF, DAMP, HEIGHT, FORM = (row * ROW for row in range(34, 43))
FREE_X, FREE_Y, FREE_Z = 43 * ROW, 44 * ROW, 45 * ROW
TX, TY, TZ = 46 * ROW, 47 * ROW, 48 * ROW
#: Bars: constants, force on the first node, tension, its highest value, loads of the water on both ends, added mass.
LENGTH, SPRING, VISCOUS, LIMIT, ACROSS, SKIN, CROSS, ALONG, LIFT, SHARE, RADIUS, LIGHT, DISPLACED = (
    row * ROW for row in range(49, 62)
)
FX, FY, FZ, PULL, PEAK, WET, RATE = (row * ROW for row in range(62, 69))
AX, AY, AZ, EX, EY, EZ = (row * ROW for row in range(69, 75))
DXX, DXY, DXZ, DYY, DYZ, DZZ = (row * ROW for row in range(75, 81))
#: Difference of the lifts of both ends of a bar that crosses the surface, over the whole.
LEAN = 81 * ROW
#: Highest ``RATE`` of a bar since the start of the run, and the same of what is attached to a node.
FASTEST, FASTEST_ATTACHED = 82 * ROW, 83 * ROW
ROWS_OF_NODES, ROWS = 49, 84
#: Length of the ledger of a run; behind it stand, for each driven point, the impulse of the network on it (three
#: numbers, N s) and the moment of that impulse about the start of the call (three numbers, N s2).
LEDGER = 6
#: Ribs repeat the rows of bars, from here on.
RIB = (ROWS - ROWS_OF_NODES) * ROW
TOTAL_ROWS = ROWS + ROWS - ROWS_OF_NODES
#: Rows of nodes that a bar needs for its tension and for its loads, and where they lie a second time for both ends of
#: every rib, in the order of the ribs: loops over them then run through memory as those of the spine do.
MOTION, SEEN = 6, 13
FIRST_END, SECOND_END = TOTAL_ROWS * ROW, (TOTAL_ROWS + SEEN) * ROW
ROWS_IN_MEMORY = TOTAL_ROWS + 2 * SEEN
