"""Lines that part from a point in the course of a run: at a time, or at a tension [eq:flexible-failure].

The last bar of the line at that point loses its stiffness: what is left of the line ends at its next node. Tensions are
looked at between the calls of a run.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.flexible.network import Network

#: Longest time between two looks at the tensions [s]
LOOK = 0.02


@checks_words
@dataclass(frozen=True)
class LineFailure:
    """Where and when a line parts; whichever of time and tension comes first.

    Raises
    ------
    InputError
        When neither is given.
    """

    #: Name of the line.
    line: str
    #: Whether it parts at its end, or at its start.
    at_end: bool
    #: [s].
    time: float = math.inf
    #: [N].
    tension: float = math.inf

    def __post_init__(self) -> None:
        if not (math.isfinite(self.time) or math.isfinite(self.tension)) or self.time < 0.0 or self.tension <= 0.0:
            raise InputError(
                f"line {self.line!r} parts at {self.time:g} s or {self.tension:g} N", parameter="failures",
                allowed="a time of 0 or more, a tension greater than 0, or both",
            )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Failing:
    """The bars of a run that part."""

    #: Bars, their nodes, stiffness over length [N/m], viscosity over length [N s/m] and length [m].
    bars: IntArray
    ends: tuple[IntArray, IntArray]
    spring: Array
    viscous: Array
    length: Array
    #: When they part [s], and at which tension [N].
    time: Array
    tension: Array
    #: When each of them parted [s]; infinite of those that hold.
    parted: Array
    #: Names of their lines.
    lines: tuple[str, ...] = ()

    @classmethod
    def of(cls, network: Network, failures: Sequence[LineFailure]) -> Failing | None:
        """Return the bars of the failures, ``None`` without any.

        Raises
        ------
        InputError
            For lines that are not there, and lines that bend or follow a curve.
        """
        if not failures:
            return None
        own = network.bars
        bars = np.array([network.strand(item.line).bars[-1 if item.at_end else 0] for item in failures])
        kinds = [own.types[kind] for kind in own.kind[bars]]
        for item, kind in zip(failures, kinds):
            if kind.bending_stiffness > 0.0 or kind.curve is not None or kind.slow is not None:
                raise InputError(
                    f"line {item.line!r} is to part, and has bending stiffness, a curve or creep", parameter="failures",
                    allowed="lines of linear bars without bending stiffness",
                )  # fmt: skip
        length = own.length[bars]
        return cls(
            bars, (own.start[bars], own.end[bars]), own.of_type("axial_stiffness")[bars] / length,
            own.of_type("viscosity")[bars] / length, length, np.array([item.time for item in failures]),
            np.array([item.tension for item in failures]), np.full(len(bars), np.inf),
            tuple(item.line for item in failures),
        )  # fmt: skip

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Say which lines parted, and when."""
        return tuple(
            Notice("line-parted", f"line '{name}' parted at t = {time:.4g} s", severity="information")
            for name, time in zip(self.lines, self.parted.tolist())
            if math.isfinite(time)
        )

    def look(self, place: Array, speed: Array, now: float) -> IntArray:
        """Return the bars that part now, at places and speeds (3, n)."""
        first, last = self.ends
        reach = place[:, last] - place[:, first]
        size = np.linalg.norm(reach, axis=0)
        rate = np.sum(reach * (speed[:, last] - speed[:, first]), axis=0) / np.maximum(size, 1e-300)
        pull = self.spring * (size - self.length) + self.viscous * rate
        due = np.isinf(self.parted) & ((now >= self.time - 1e-9) | (pull >= self.tension))
        self.parted[due] = now
        return np.asarray(self.bars[due])
