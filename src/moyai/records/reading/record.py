"""A record: channels in SI on one clock, with flags instead of repairs.

Missing and doubtful samples stay where they are. A missing one is NaN; a doubtful one keeps its value and carries a
flag. Nothing here fills a gap.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice

FlagArray = NDArray[np.uint8]

MISSING = np.uint8(1)
SPIKE = np.uint8(2)
FLAT = np.uint8(4)
CLIPPED = np.uint8(8)
DRIFT = np.uint8(16)
UNIT = np.uint8(32)
RANGE = np.uint8(64)
FLAG_NAMES = {
    int(MISSING): "missing",
    int(SPIKE): "spike",
    int(FLAT): "flat line",
    int(CLIPPED): "clipped",
    int(DRIFT): "drift",
    int(UNIT): "unit slip",
    int(RANGE): "out of range",
}


@checks_words
@dataclass(frozen=True, eq=False)
class Record:
    """Channels sampled on one clock."""

    #: Strictly increasing instants [s]: since 1970-01-01 UTC where ``dated``, else of the logger's own clock; shape
    #: (samples,).
    time: Array
    #: Samples in SI units; NaN where missing; shape (samples, channels).
    values: Array
    #: Name of each channel.
    names: tuple[str, ...]
    #: SI unit of each channel.
    units: tuple[str, ...]
    #: Whether ``time`` is a date.
    dated: bool = False
    #: File or files, for messages.
    source: str = ""
    #: Bits of what was found about each sample; :data:`FLAG_NAMES` says which; shape (samples, channels).
    flags: FlagArray | None = None
    notices: tuple[Notice, ...] = field(default=())

    def __post_init__(self) -> None:
        if self.values.shape != (self.time.size, len(self.names)) or len(self.units) != len(self.names):
            raise InputError(
                f"{self.source or 'record'}: values of shape {self.values.shape} for {self.time.size} instants and "
                f"{len(self.names)} channels",
                parameter="values",
            )

    def __len__(self) -> int:
        return int(self.time.size)

    def __getitem__(self, name: str) -> Array:
        """Return one channel."""
        return self.values[:, self.index(name)]

    def index(self, name: str) -> int:
        """Return the place of a channel.

        Parameters
        ----------
        name : str
            Of the channel.

        Raises
        ------
        InputError
            With the names there are.
        """
        try:
            return self.names.index(name)
        except ValueError:
            raise InputError(
                f"{self.source or 'the record'} has no channel '{name}'", parameter=name, allowed=", ".join(self.names)
            ) from None

    @property
    def step(self) -> float:
        """Usual time step [s], NaN with fewer than two samples."""
        return nominal_step(self.time)

    def between(self, start: float, end: float) -> Record:
        """Return the samples with ``start <= time < end`` [s].

        Parameters
        ----------
        start, end : float
            On the clock of the record [s].
        """
        first, last = np.searchsorted(self.time, (start, end), side="left")
        return self.rows(slice(int(first), int(last)))

    def rows(self, chosen: slice) -> Record:
        """Return some of the samples.

        Parameters
        ----------
        chosen : slice
            Of the rows.
        """
        flags = None if self.flags is None else self.flags[chosen]
        return replace(self, time=self.time[chosen], values=self.values[chosen], flags=flags)

    def select(self, names: Sequence[str]) -> Record:
        """Return some of the channels, in the order asked for.

        Parameters
        ----------
        names : sequence of str
            Of the channels.

        Raises
        ------
        InputError
            For a channel that is not there.
        """
        places = [self.index(name) for name in names]
        flags = None if self.flags is None else self.flags[:, places]
        return replace(
            self,
            values=self.values[:, places],
            names=tuple(names),
            units=tuple(self.units[place] for place in places),
            flags=flags,
        )

    def sound(self, name: str, *, refused: int = int(MISSING | SPIKE | UNIT | RANGE)) -> Array:
        """Return a channel (samples,), in its unit, with NaN where one of the ``refused`` flags is set.

        Parameters
        ----------
        name : str
            Of the channel.
        refused : int
            Sum of the flags.

        Raises
        ------
        InputError
            For a channel that is not there.
        """
        place = self.index(name)
        values = self.values[:, place].copy()
        if self.flags is not None:
            values[(self.flags[:, place] & np.uint8(refused)) != 0] = np.nan
        return values


def concatenate(parts: Iterable[Record]) -> Record:
    """Join records that follow each other in time.

    Raises
    ------
    InputError
        When there are none, when their channels differ, or when one begins before the last ends.
    """
    listed = [part for part in parts if len(part)]
    if not listed:
        raise InputError("there is no sample", parameter="records", remedy="check the files and the time window")
    first = listed[0]
    for before, after in itertools.pairwise(listed):
        if after.names != first.names:
            raise InputError(f"{after.source} has the channels {after.names}, not {first.names}", parameter="records")
        if after.time[0] <= before.time[-1]:
            raise InputError(
                f"{after.source} begins at {instant_text(after.time[0], after.dated)}, before the record ends at "
                f"{instant_text(before.time[-1], before.dated)}",
                parameter="time",
                remedy="list the files in the order of time",
            )
    if len(listed) == 1:
        return first
    flagged = all(part.flags is not None for part in listed)
    return replace(
        first,
        time=np.concatenate([part.time for part in listed]),
        values=np.concatenate([part.values for part in listed]),
        flags=np.concatenate([part.flags for part in listed if part.flags is not None]) if flagged else None,
        notices=tuple(dict.fromkeys(notice for part in listed for notice in part.notices)),
    )


def instant_text(seconds: float, dated: bool) -> str:
    """Return an instant as a person reads it: a date in UTC, or seconds."""
    if not np.isfinite(seconds):
        return "no time"
    if not dated:
        return f"{seconds:.6g} s"
    return datetime.fromtimestamp(float(seconds), UTC).strftime("%Y-%m-%d %H:%M:%S.%f")[:-3] + "Z"


def nominal_step(time: Array) -> float:
    """Return the usual step of a clock [s]: the mean of the steps that are no gap; equation [eq:records-step].

    The median alone is itself rounded where stamps are: 0.078 s at 12.8 Hz, which is one sample too many in 12 s.
    """
    if time.size < 2:
        return float("nan")
    steps = np.diff(time)
    usual = float(np.median(steps))
    near = steps[(steps > 0.0) & (steps < 1.75 * usual)]
    return float(np.mean(near)) if near.size else usual
