"""Readings that are none: numbers that stand for 'no value', spikes and plateaus, with the rows where they begin."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from moyai.core.validity import Notice
from moyai.core.wording import counted
from moyai.records.reading.quality import QualityOptions, find_spikes
from moyai.records.reading.record import Record
from moyai.series.plateaus import find_plateaus

STAND_IN = "record-stand-in"
"""Code of the notice of such a number."""


def stand_in_notice(place: str, sign: float, count: int, where: str, remedy: str) -> Notice:
    """Return the notice of a number that seems to mean 'no value'.

    Parameters
    ----------
    place : str
        File and column.
    sign : float
        The number.
    count : int
        How often it was met.
    where : str
        Line or row of the first.
    remedy : str
        What to do if it does.
    """
    return Notice(
        STAND_IN,
        f"{place} holds {counted(count, 'value')} of {sign:g} far outside of all others, the first in {where}; if it "
        f"means 'no value', {remedy}",
        sign,
    )


def doubtful_samples(record: Record, where: Callable[[int], str]) -> tuple[Notice, ...]:
    """Return notices of spikes, of plateaus at the end of a gauge's range and of channels that do not change.

    Parameters
    ----------
    record : Record
        Evenly spaced, or nearly so.
    where : callable
        Line or row of a sample, for the message.
    """
    notices = []
    for place, name in enumerate(record.names):
        values, unit = record.values[:, place], record.units[place]
        spikes = np.flatnonzero(find_spikes(values, QualityOptions()))
        if spikes.size:
            notices.append(
                Notice(
                    "record-spikes",
                    f"{name}: {counted(spikes.size, 'sample')} far from the neighbours, the first in "
                    f"{where(int(spikes[0]))}: {values[spikes[0]]:.5g} {unit}; taken as measured",
                    float(spikes.size),
                    0.0,
                    remedy="leave the value out of the file, or name its sign as missing",
                )
            )
        plateaus = find_plateaus(values)
        # a body that is held, or one long slack, stands at an extreme once
        if sum(plateau.count for plateau in plateaus) > 1:
            first = min(plateaus, key=lambda plateau: plateau.first)
            notices.append(
                Notice(
                    "record-clipped",
                    f"{name}: stands {counted(sum(plateau.count for plateau in plateaus), 'time')} at its limit, first "
                    f"at {first.level:.5g} {unit} from {where(first.first)} on: what the gauge can show ends there",
                    float(first.longest),
                    0.0,
                    remedy="use a record within the range of the gauge: amplitudes come out too small",
                )
            )
    return tuple(notices)
