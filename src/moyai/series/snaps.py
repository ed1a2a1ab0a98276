"""Snap loads in a record of tension: when a line is slack, when it comes taut, how fast and how high the load rises."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.series.wave_statistics import exceedance


@dataclass(frozen=True)
class Contact:
    """One time that a slack line comes taut, and the load that follows until it is slack again."""

    #: When the tension leaves the slack level [s].
    time: float
    #: How long it was slack before [s].
    slack_before: float
    #: Highest tension until the next slack or the end [N].
    peak: float
    #: When [s].
    peak_time: float
    #: From a tenth to nine tenths of the peak, on the way to it [s].
    rise_time: float
    #: Whether the peak exceeds the threshold.
    is_snap: bool


@dataclass(frozen=True, eq=False)
class SnapRecord:
    """Snap loads of one record."""

    #: Tension below which a line counts as slack [N].
    slack_level: float
    #: Peak above which a contact counts as a snap [N].
    threshold: float
    #: Begin and end of every slack interval [s]; shape (k, 2).
    slack: Array
    #: In order.
    contacts: tuple[Contact, ...]

    @property
    def snaps(self) -> tuple[Contact, ...]:
        """Contacts whose peak exceeds the threshold."""
        return tuple(contact for contact in self.contacts if contact.is_snap)

    @property
    def slack_time(self) -> float:
        """Total time that the line is slack [s]."""
        return float(np.sum(self.slack[:, 1] - self.slack[:, 0]))

    def exceedance(self) -> tuple[Array, Array]:
        """Return the peaks of the snaps, falling [N], and the part of snaps that reaches each (Weibull positions)."""
        return exceedance([contact.peak for contact in self.snaps])


def _crossing(time: Array, tension: Array, i: int, level: float) -> float:
    """Return when the straight piece from i to i + 1 crosses a level."""
    low, high = tension[i], tension[i + 1]
    return float(time[i] + (level - low) / (high - low) * (time[i + 1] - time[i])) if high != low else float(time[i])


def _reaches(time: Array, tension: Array, first: int, last: int, level: float) -> float:
    """Return when the tension, seen back from its peak, last passed a level upwards."""
    for i in range(last - 1, first - 1, -1):
        if tension[i] < level <= tension[i + 1]:
            return _crossing(time, tension, i, level)
    return float(time[first])


def _with_peaks(time: Array, tension: Array, peaks: Array) -> tuple[Array, Array]:
    """Return the record with a point in the middle of every two rows whose peak between stands over both."""
    over = np.flatnonzero(peaks[1:] > np.maximum(tension[1:], tension[:-1])) + 1
    middle = 0.5 * (time[over - 1] + time[over])
    return np.insert(time, over, middle), np.insert(tension, over, peaks[over])


def find_snaps(
    time: ArrayLike, tension: ArrayLike, *, slack_level: float, threshold: float, peaks: ArrayLike | None = None
) -> SnapRecord:
    """Find slack intervals, contacts and snaps in a record of tension.

    There is no standard: slack levels from zero to a tenth of the pretension and thresholds of the wave-frequency
    amplitude are in use. Both are therefore given by the user and returned with the record.

    Parameters
    ----------
    time, tension : array_like, shape (n,)
        [s], rising; [N].
    slack_level : float
        Tension at or below which the line is slack [N].
    threshold : float
        A contact with a higher peak is a snap [N].
    peaks : array_like, optional
        Highest tension since the row before (:attr:`moyai.flexible.result.History.tension_peak`), so that no peak is
        lost between rows: one that stands over both is put in their middle, also when the line is slack at both.

    Returns
    -------
    SnapRecord
        Slack intervals [s], shape (k, 2), and contacts with their peaks [N] and rise times [s]; ``snaps`` are those
        above the threshold.

    Raises
    ------
    InputError
        For records of different lengths, values that are not finite, times that do not rise, or a negative level.

    Examples
    --------
    >>> from moyai.series import find_snaps
    >>> time = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]                       # [s]
    >>> tension = [500.0, 0.0, 0.0, 900.0, 300.0, 0.0, 200.0]            # [N]
    >>> found = find_snaps(time, tension, slack_level=10.0, threshold=600.0)
    >>> [(snap.peak, snap.peak_time) for snap in found.snaps], len(found.contacts)   # [N], [s]
    ([(900.0, 3.0)], 2)
    """
    t, pull = np.asarray(time, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    most = pull if peaks is None else np.asarray(peaks, dtype=np.float64)
    if t.ndim != 1 or t.shape != pull.shape or most.shape != t.shape or t.size < 2:
        raise InputError(
            f"records of {t.shape}, {pull.shape}, {most.shape}",
            parameter="tension",
            allowed="equal, two values or more",
        )
    for name, values in (("time", t), ("tension", pull), ("peaks", most)):
        if not np.isfinite(values).all():
            raise InputError(
                f"{name} is {values[~np.isfinite(values)][0]:g} in row {int(np.argmin(np.isfinite(values)))}",
                parameter=name,
                allowed="finite numbers",
            )
    if not np.all(np.diff(t) > 0.0):
        raise InputError("times do not rise", parameter="time", allowed="rising")
    if not (slack_level >= 0.0 and threshold >= slack_level):
        raise InputError(
            f"slack level {slack_level:g} N, threshold {threshold:g} N",
            parameter="slack_level",
            allowed="0 <= level <= threshold",
        )
    t, pull = _with_peaks(t, pull, most)
    loose = pull <= slack_level
    turns = np.flatnonzero(np.diff(loose.astype(np.int8)))
    begin = float(t[0])
    slack, contacts = [], []
    taut_from: list[tuple[float, float, int]] = []
    for i in turns:
        now = _crossing(t, pull, int(i), slack_level)
        if loose[i]:
            slack.append((begin, now))
            taut_from.append((now, now - begin, int(i)))
        begin = now
    if loose[-1]:
        slack.append((begin, float(t[-1])))
    for when, before, row in taut_from:
        ends = [j for j in turns if j > row and not loose[j]]
        last = int(ends[0]) if ends else t.size - 1
        top = row + 1 + int(np.argmax(pull[row + 1 : last + 1]))
        highest = float(pull[top])
        rise = _reaches(t, pull, row, top, 0.9 * pull[top]) - _reaches(t, pull, row, top, 0.1 * pull[top])
        contacts.append(Contact(when, before, highest, float(t[top]), rise, highest > threshold))
    return SnapRecord(slack_level, threshold, np.array(slack).reshape(-1, 2), tuple(contacts))
