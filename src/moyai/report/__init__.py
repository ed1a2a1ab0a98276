"""Reports: figures, animated side view, HTML and PDF."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.report.document import Chapter as Chapter
    from moyai.report.document import Column as Column
    from moyai.report.document import Document as Document
    from moyai.report.document import Figure as Figure
    from moyai.report.document import Series as Series
    from moyai.report.document import Table as Table
    from moyai.report.views import ReportedResult as ReportedResult
    from moyai.report.writer import compose_document as compose_document
    from moyai.report.writer import write_report as write_report
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "document": "Column Document Figure Chapter Series Table",
            "views": "ReportedResult",
            "writer": "compose_document write_report",
        },
    )
