"""Validity notices: where a formula leaves its range the user is reported the number and the limit."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal

Severity = Literal["information", "warning", "error"]


@dataclass(frozen=True)
class Notice:
    """A statement about the range of validity of a result.

    Parameters
    ----------
    code : str
        Short stable identifier, for instance ``wave-breaking``.
    message : str
        One sentence for the engineer, naming the quantity, its number and the limit.
    value, limit : float
        The number found and the limit it was held against (NaN where there is none).
    severity : {"information", "warning", "error"}
        ``error`` makes the status of the result ``outside_validity``.
    remedy : str
        What to do about it.
    source : str
        Paper, equation or standard behind the limit.
    """

    code: str
    message: str
    value: float = math.nan
    limit: float = math.nan
    severity: Severity = "warning"
    remedy: str = ""
    source: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready mapping (NaN becomes ``None``)."""
        record = asdict(self)
        return {key: None if isinstance(item, float) and math.isnan(item) else item for key, item in record.items()}


@dataclass(frozen=True)
class IdentityCheck:
    """An identity that every correct solution obeys, held against the solution at hand.

    Parameters
    ----------
    name : str
        For instance ``energy balance of the fixed section``.
    value : float
        Largest relative violation found.
    tolerance : float
        What is accepted.
    meaning : str
        The identity in words or symbols.
    """

    name: str
    value: float
    tolerance: float
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
