"""Validity notices: where a formula leaves its range the user is reported the number and the limit."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal

from moyai.core.options import checks_words

Severity = Literal["information", "warning", "error"]


@checks_words
@dataclass(frozen=True)
class Notice:
    """A statement about the range of validity of a result.

    Examples
    --------
    >>> from moyai.core import Notice
    >>> notice = Notice("steepness", "the wave is steep", value=0.12, limit=0.1, remedy="take a wave of finite height")
    >>> notice.severity, notice.value > notice.limit
    ('warning', True)
    """

    #: Short stable identifier, for instance ``wave-breaking``.
    code: str
    #: One sentence for the engineer, naming the quantity, its number and the limit.
    message: str
    #: The number found; NaN where there is none.
    value: float = math.nan
    #: The limit that the number was compared with; NaN where there is none.
    limit: float = math.nan
    #: ``error`` makes the status of the result ``outside_validity``; one of "information", "warning", "error".
    severity: Severity = "warning"
    #: What to do about it.
    remedy: str = ""
    #: Paper, equation or standard behind the limit.
    source: str = ""
    #: Unit of ``value`` and ``limit`` where a reader sees another one: ``rad`` of angles.
    unit: Literal["", "rad"] = ""

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready mapping (NaN becomes ``None``; no ``unit`` where there is none)."""
        record = asdict(self)
        if not self.unit:
            del record["unit"]
        return {key: None if isinstance(item, float) and math.isnan(item) else item for key, item in record.items()}


@dataclass(frozen=True)
class IdentityCheck:
    """An identity that every correct solution obeys, checked in one solution."""

    #: For instance ``energy balance of the fixed section``.
    name: str
    #: Largest relative violation found.
    value: float
    #: What is accepted.
    tolerance: float
    #: The identity in words or symbols.
    meaning: str = ""

    def __post_init__(self) -> None:
        for name in ("value", "tolerance"):
            object.__setattr__(self, name, float(getattr(self, name)))

    @property
    def passed(self) -> bool:
        """Whether the violation is within the tolerance (NaN never is)."""
        return bool(self.value <= self.tolerance)

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready mapping."""
        return {
            "name": self.name,
            "value": None if math.isnan(self.value) else self.value,
            "tolerance": self.tolerance,
            "passed": self.passed,
            "meaning": self.meaning,
        }
