"""Lines of the catalogue: where a diameter lies outside of the range of its source."""

from __future__ import annotations

from moyai.case.findings import Findings
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import InputError
from moyai.tables.lines import check_line_properties, line_type


def check_catalogue(path: KeyPath, name: str, diameter: float, findings: Findings) -> None:
    """Record a line type that is not there, a diameter that it cannot have, and one outside of its source's range.

    Parameters
    ----------
    path : tuple
        Of the block that holds ``catalogue`` and ``diameter``.
    name : str
    diameter : float
        Nominal [m].
    findings : Findings
    """
    try:
        properties = line_type(name, diameter)
    except InputError as error:
        key = "diameter" if error.fault.path == "diameter" else "catalogue"
        findings.fault((*path, key), error.fault.message, allowed=error.fault.allowed, remedy=error.fault.remedy)
        return
    for notice in check_line_properties(properties):
        known = any(notice.message == warning.message for warning in findings.warnings)
        if notice.code == "line-diameter-range" and not known:
            findings.warn((*path, "diameter"), notice.message, remedy=notice.remedy)


__all__ = ["check_catalogue"]


#: Findings on lines that a structure's own check, or its run, states better.
SAID_OTHERWISE = ("mooring-anchor-above-bed", "mooring-fairlead-dry", "mooring-anchor-uplift")
_LINE_PLACES = {
    "mooring-line-breaks": "segments",
    "mooring-line-heap": "segments",
    "mooring-line-unreachable": "segments",
    "mooring-touches-between": "segments",
    "mooring-anchor-in-body": "anchor",
    "mooring-fairlead-below-bed": "fairlead",
}


def line_place(findings: Findings, index: int, code: str) -> KeyPath:
    """Return the key of a line that a finding of :func:`moyai.mooring.checks.check_line_system` is for."""
    path: KeyPath = ("lines", index)
    inner = (*path, _LINE_PLACES.get(code, ""))
    return inner if inner in findings.document.values else path
