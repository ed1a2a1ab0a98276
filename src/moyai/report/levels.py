"""Blocks of a report at each water level, behind one choice."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

from moyai.report.document import Block, Choice, Option, Paragraph
from moyai.report.formatting import MINUS

LEVEL_GROUP = "water-level"


class Named(Protocol):
    """What is run at one water level."""

    @property
    def name(self) -> str: ...


class Elevated(Named, Protocol):
    """What is run at one water level of known height."""

    @property
    def elevation(self) -> float: ...


L = TypeVar("L", bound=Named)


def _name_of(level: Named) -> str:
    return level.name


def level_words(level: Elevated) -> str:
    """Return the name of a water level with its height over datum, where that is known."""
    if not math.isfinite(level.elevation):
        return level.name
    height = f"{level.elevation:+.2f} m".replace("-", MINUS)
    return f"{level.name} ({height})"


def at_each_level(
    levels: Sequence[L],
    compose: Callable[[L], Sequence[Block | None]],
    *,
    words: Callable[[L], str] = _name_of,
    default: int = 0,
    choice_of_one: bool = True,
) -> tuple[Block, ...]:
    """Return a choice of the water level, empty where no level has anything to show.

    Parameters
    ----------
    levels : sequence
        The water levels.
    compose : callable
        Gives the blocks of a level; ``None`` among them is left out.
    words : callable
        Gives the words of a level in the choice.
    default : int
        Number of the level that is shown first.
    choice_of_one : bool
        Whether a single level stands behind a choice too.
    """
    options = []
    for level in levels:
        blocks = tuple(block for block in compose(level) if block is not None)
        options.append(Option(words(level), blocks or (Paragraph("Not run at this water level.", quiet=True),)))
    if all(isinstance(option.blocks[0], Paragraph) for option in options):
        return ()
    if len(options) == 1 and not choice_of_one:
        return options[0].blocks
    return (Choice(LEVEL_GROUP, "Water level", tuple(options), default),)
