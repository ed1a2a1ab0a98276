"""Derived numbers of a cage case, by its model."""

from __future__ import annotations

from moyai.case.cage_models import part
from moyai.case.derived import Number
from moyai.case.reader import Case


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the derived numbers of a cage case."""
    numbers: tuple[Number, ...] = part(case.model.structure.model, "derived")(case)
    return numbers
