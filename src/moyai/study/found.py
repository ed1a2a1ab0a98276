"""What the search of every case of a study found: the values, what was to be least, and which limit governs."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from moyai.core.results import Result

_NAME_AND_UNIT = re.compile(r"(.*?)(?: \[([^\]]*)\])?")


@dataclass(frozen=True)
class Found:
    """The answer of the search of one case."""

    #: Number of the case.
    index: int
    #: Path, value and unit: the best values, or the largest one that holds (NaN where none does).
    values: tuple[tuple[str, float, str], ...]
    #: What was to be least, with its unit; ``None`` for a limit.
    objective: tuple[str, float, str] | None
    #: Responses whose limit governs, and ends of ranges; empty where nothing does.
    governing: tuple[str, ...]
    #: Whether the search settled; one that ended at its number of runs may still find better values.
    settled: bool = True

    @property
    def remark(self) -> str:
        """What the reader has to know about the search; empty where it settled."""
        return "" if self.settled else "the search ended at its 'evaluations' before it settled: better may be found"


def found_by_search(result: Result) -> tuple[Found, ...]:
    """Return the answers of a study that searched, case by case; none where it did not or where a search failed.

    Parameters
    ----------
    result : Result
        As gathered by :func:`moyai.study.table.study_result`.
    """
    for name, read in (("optimum", _optimum), ("limit", _limit)):
        if name in result.tree.children:
            held: Any = result.tree.children[name].to_dataset(inherit=False)
            return tuple(one for index in range(_cases(result)) if (one := read(held, index)) is not None)
    return ()


def _cases(result: Result) -> int:
    return int(result.tree["case_status"].size)


def _of_case(held: Any, name: str, index: int, dim: str = "") -> Any:
    """Return what a case holds of a variable, along its own dimension."""
    variable = held[name]
    values = variable.transpose(..., dim).values if dim else variable.values
    return values.reshape(-1, values.shape[-1])[index] if dim else values.reshape(-1)[index]


def _limits_that_govern(held: Any, index: int) -> list[str]:
    if "governing" not in held:
        return []
    flags = _of_case(held, "governing", index, "limit_of")
    return [f"limit of {name}" for name, flag in zip(held["limit_of"].values, flags, strict=True) if flag > 0.5]


def _optimum(held: Any, index: int) -> Found | None:
    least = float(_of_case(held, "objective", index))
    if not math.isfinite(least):
        return None
    matches = [_NAME_AND_UNIT.fullmatch(str(name)) for name in held["variable"].values]
    names = [(match[1], match[2] or "1") for match in matches if match]
    values = _of_case(held, "best", index, "variable")
    ends = _of_case(held, "at_end", index, "variable") if "at_end" in held else np.zeros(len(names))
    at_ends = [
        f"{'upper' if end > 0 else 'lower'} end of the range of {path}"
        for (path, _), end in zip(names, ends, strict=True)
        if end != 0
    ]
    objective = held["objective"]
    words = str(objective.attrs.get("long_name", "objective")).removeprefix("least ")
    return Found(
        index,
        tuple((path, float(value), unit) for (path, unit), value in zip(names, values, strict=True)),
        (words, least, str(objective.attrs.get("units", "1"))),
        (*_limits_that_govern(held, index), *at_ends),
        "settled" not in held or bool(_of_case(held, "settled", index)),
    )


def _limit(held: Any, index: int) -> Found | None:
    if not math.isfinite(float(_of_case(held, "runs", index))):
        return None
    limit = held["limit"]
    path = str(limit.attrs.get("long_name", "limit")).removeprefix("largest ").removesuffix(" that holds")
    value = float(_of_case(held, "limit", index))
    return Found(
        index, ((path, value, str(limit.attrs.get("units", "1"))),), None, tuple(_limits_that_govern(held, index))
    )
