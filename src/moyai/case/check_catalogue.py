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
