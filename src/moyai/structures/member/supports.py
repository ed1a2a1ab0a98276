"""How a member is held: forces at its ends and bending moments along it [eq:member-ends] [eq:member-bending]."""

from __future__ import annotations

from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.options import checks_words

Support = Literal["both_ends", "start", "end"]
"""Resting simply on both ends, or fixed at one and free at the other."""

MOST_STATIONS = 21


def stations(strips: int, length: float) -> Array:
    """Return where bending moments are taken: ends of strips, distances from the start of the member [m].

    Parameters
    ----------
    strips : int
    length : float
        [m].
    """
    count = min(strips + 1, MOST_STATIONS)
    return np.round(np.linspace(0.0, strips, count)) * (length / strips)


@checks_words
def influence(support: Support, strips: int, length: float) -> Array:
    """Return what a unit force on each strip gives, (2 + stations, strips).

    Rows: force at the start, force at the end [1], then the bending moment at each station [m]. The load of a strip
    acts in its middle; at the ends of strips that gives the moment of a load spread evenly over each.

    Parameters
    ----------
    support : {"both_ends", "start", "end"}
    strips : int
    length : float
        [m].
    """
    place = (np.arange(strips) + 0.5) * (length / strips)
    at = stations(strips, length)[:, None]
    if support == "both_ends":
        ends = np.array([1.0 - place / length, place / length])
        moment = np.minimum(at, place) * (length - np.maximum(at, place)) / length
    else:
        beyond = place - at if support == "start" else at - place
        moment = np.maximum(beyond, 0.0)
        ends = np.zeros((2, strips))
        ends[0 if support == "start" else 1] = 1.0
    return np.concatenate([ends, moment])


@checks_words
def held_at(support: Support) -> str:
    """Return the words for it."""
    return {
        "both_ends": "of a member that rests simply on both ends",
        "start": "of a member fixed at its start, free at its end",
        "end": "of a member fixed at its end, free at its start",
    }[support]


__all__ = ["Support", "held_at", "influence", "stations"]
