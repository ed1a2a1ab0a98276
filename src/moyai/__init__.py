"""moyai: how moored floating and flexible coastal structures answer waves and currents.

The three steps of the front door, each also a command (``moyai run`` does all of them):

>>> import moyai                                    # doctest: +SKIP
>>> case = moyai.load_case("pontoon.yaml")          # doctest: +SKIP
>>> result = moyai.run(case)                        # doctest: +SKIP
>>> moyai.write_report(result, "out/")              # doctest: +SKIP

Imports are late: importing :mod:`moyai` costs nothing until a name is used.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_FRONT_DOOR = {
    "load_case": "moyai.case.reader",
    "run": "moyai.cli.runner",
    "write_report": "moyai.report.writer",
    "read_result": "moyai.core.results",
}

__all__ = ["__version__", "load_case", "read_result", "run", "write_report"]


def __getattr__(name: str) -> Any:
    if name in _FRONT_DOOR:
        return getattr(import_module(_FRONT_DOOR[name]), name)
    raise AttributeError(f"module 'moyai' has no attribute {name!r}")
