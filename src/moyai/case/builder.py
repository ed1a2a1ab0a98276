"""From a case to the problem that its structure's package solves: the only place where degrees become radians."""

from __future__ import annotations

from typing import Any

from moyai.case.reader import Case
from moyai.core.kinds import structure_kind


def build(case: Case) -> Any:
    """Return the problem of a case, for instance a :class:`moyai.structures.breakwater.model.BreakwaterProblem`.

    Parameters
    ----------
    case : Case
        From :func:`moyai.case.reader.load_case`.

    Returns
    -------
    object
        The problem in SI units, that the analyses of its structure take.

    Raises
    ------
    InputError
        When a file that the case names has changed or become unreadable since it was checked.

    Examples
    --------
    >>> import moyai
    >>> from moyai.case import build
    >>> type(build(moyai.load_case(moyai.template("member")))).__name__
    'MemberProblem'
    """
    return structure_kind(case.kind).build(case.model, case.folder, case_text=case.text, case_hash=case.case_hash)
