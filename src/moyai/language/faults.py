"""Faults in the language in force; keys and values of files stay as they are."""

from __future__ import annotations

import re
from dataclasses import replace

from moyai.core.errors import Fault
from moyai.language.current import said, spoken_language

_LIST = re.compile(r"[\w.-]+(, [\w.-]+)+")
"""An allowed range that lists values of the file."""


def spoken_fault(fault: Fault) -> Fault:
    """Return a fault with its sentences in the language in force.

    Parameters
    ----------
    fault : Fault
    """
    allowed = fault.allowed if _LIST.fullmatch(fault.allowed) else said(fault.allowed)
    return replace(fault, message=said(fault.message), allowed=allowed, remedy=said(fault.remedy))


def fault_text(fault: Fault) -> str:
    """Return a fault as one line in the language in force.

    Parameters
    ----------
    fault : Fault
    """
    spoken = spoken_fault(fault)
    if spoken_language() == "en":
        return str(spoken)
    allowed = f"{said('allowed')}：{spoken.allowed}" if spoken.allowed else ""
    return "；".join(filter(None, (str(replace(spoken, allowed="", remedy="")), allowed, spoken.remedy)))
