"""The report: numbers of the first page, a table over the water levels."""

from moyai.core.results import Result
from moyai.report.document import Chapter, Column, Document, Table
from moyai.report.general_page import case_listing, closing_section, notice_blocks, provenance, report_title
from moyai.report.headlines import headline_figures
from moyai.report.reading import Group
from moyai_spar.run import VARIABLES


def compose(result: Result) -> Document:
    """Compose the report of a spar."""
    root, numbers = Group("", result.tree), headline_figures(result)
    columns = [Column(label.capitalize(), [level.value(name) for level in root.children()], unit)
               for name, (unit, label) in VARIABLES.items()]  # fmt: skip
    table = Table("levels", "Equilibrium", (Column("Water level", [level.name for level in root.children()]), *columns))
    sections = (
        Chapter("summary", "Summary", (*([] if numbers is None else [numbers]), *notice_blocks(result))),
        Chapter("statics", "Statics", (table,)),
        Chapter("input", "Input", (case_listing(root),)),
        closing_section(result),
    )
    return Document(report_title(result), "Spar", result.status, result.message, sections, provenance(result))
