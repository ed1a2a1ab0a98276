"""moyai: how moored floating and flexible coastal structures respond to waves and currents.

Five calls lead from nothing to a report, each also a command (``moyai run`` does the middle ones together):

>>> import moyai
>>> from pathlib import Path
>>> file = Path("pontoon.yaml")
>>> _ = file.write_text(moyai.template("breakwater"))          # doctest: +SKIP
>>> case = moyai.load_case(file)                               # doctest: +SKIP
>>> result = moyai.run(case)                                   # doctest: +SKIP
>>> files = moyai.write_report(result, "out/")                 # doctest: +SKIP
>>> again = moyai.read_result("out/results.nc")                # doctest: +SKIP

Imports are late: importing :mod:`moyai` or one of its packages costs nothing until a name is used. What a package
hands out stands in its ``__all__``; docs/calls.md says which call gives which quantity.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from moyai.core.exports import exports
from moyai.core.version import VERSION

__version__ = VERSION

if TYPE_CHECKING:
    from moyai.case.reader import load_case as load_case
    from moyai.case.templates import template as template
    from moyai.cli.runner import run as run
    from moyai.report.views import read_result as read_result
    from moyai.report.writer import write_report as write_report
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "case.reader": "load_case",
            "case.templates": "template",
            "cli.runner": "run",
            "report.views": "read_result",
            "report.writer": "write_report",
        },
    )
