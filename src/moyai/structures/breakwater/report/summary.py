"""The first page of the report of a floating breakwater: what governs, as the structure decided it."""

from __future__ import annotations

from moyai.core.results import Result
from moyai.report.document import Block, Paragraph
from moyai.report.general_page import notice_blocks
from moyai.report.headlines import headline_figures, headline_text
from moyai.structures.breakwater.report import tables
from moyai.structures.breakwater.report.reading import SeaNumbers


def summary_blocks(result: Result, numbers: tuple[SeaNumbers, ...], decides: SeaNumbers | None) -> tuple[Block, ...]:
    """Return the governing numbers: key figures first, then the table by sea state, then what limits them.

    Parameters
    ----------
    result : Result
    numbers : tuple of SeaNumbers
        Of every water level, sea state and domain.
    decides : SeaNumbers or None
        The entry that governs.

    Returns
    -------
    tuple of Block
    """
    blocks: list[Block] = []
    first = next((item for item in result.headlines if item.name == "line_tension"), None)
    if first is not None:
        blocks.append(Paragraph(f"{first.label}: {headline_text(first)}; {first.where} ({first.model})."))
    blocks += notice_blocks(result)
    figures = headline_figures(result)
    blocks.append(figures if figures is not None else Paragraph("The result holds no governing numbers."))
    blocks += tables.governing_tables(numbers, decides)
    if any(entry.domain == "time" for entry in numbers) and any(entry.domain == "frequency" for entry in numbers):
        blocks.append(
            Paragraph(
                "Where a sea state was run in both domains the time domain decides lines and offset, since it carries "
                "the non-linear lines; transmission is that of the frequency domain. Numbers of irregular seas in time "
                "are means over the realisations. The frequency domain is given for comparison; a "
                "tension beyond five times the mean is out of its range.",
                quiet=True,
            )
        )
    return tuple(blocks)
