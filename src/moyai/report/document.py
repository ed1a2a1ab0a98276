"""What a report consists of, free of HTML and of typst: sections of blocks, each a frozen record.

A page composer (``breakwater_page`` for the floating breakwater) turns a result into a :class:`Document`;
``html`` and ``pdf`` turn the document into files. Nothing here knows a structure.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.core.validity import IdentityCheck, Notice

Style = Literal["line", "points", "line+points", "bar"]
Tone = Literal["good", "caution", "bad", "neutral"]
Cell = str | float | int | bool | None


@dataclass(frozen=True)
class Abscissa:
    """One way to plot a figure along: period, L/B, time."""

    #: Short name by which the series give their values.
    key: str
    #: Words of the axis.
    label: str
    #: Unit of the axis, in display units.
    unit: str = ""
    #: Logarithmic scale.
    log: bool = False


@dataclass(frozen=True)
class Panel:
    """One of the diagrams stacked in a figure over a common abscissa."""

    #: Words of the ordinate.
    label: str
    #: Unit of the ordinate, in display units.
    unit: str = ""
    #: Range of the axis; found from the data when absent.
    limits: tuple[float, float] | None = None
    #: Let the axis start at zero.
    from_zero: bool = False


@checks_words
@dataclass(frozen=True)
class Series:
    """A curve, points or bars."""

    #: Name in the legend and in the data.
    label: str
    #: Values along every abscissa of the figure, keyed as those are (bars: the names are in ``Figure.categories``).
    x: Mapping[str, Array]
    #: Values in the unit of the panel.
    y: Array
    #: Index of the panel.
    panel: int = 0
    #: Place in the colour-blind-safe palette.
    tone: int = 0
    #: ``line``, ``points``, ``line+points`` or ``bar``.
    style: Style = "line"
    #: ``solid``, ``dash``, ``dot`` or ``dashdot``.
    dash: Literal["solid", "dash", "dot", "dashdot"] = "solid"
    #: Draw it thin, as a companion of something else.
    faint: bool = False
    #: Label of the series that the legend names in its stead: its fit, its intervals.
    belongs_to: str = ""


@dataclass(frozen=True)
class Mark:
    """A labelled line across a panel (``x`` along the first abscissa or ``y``), or a point (both)."""

    label: str
    x: float | None = None
    y: float | None = None
    panel: int = 0

    @property
    def known(self) -> bool:
        """Whether its place is known (no NaN)."""
        return all(value is None or math.isfinite(value) for value in (self.x, self.y))


@checks_words
@dataclass(frozen=True)
class Figure:
    """A figure with its data."""

    #: Unique name, also the file name of a download.
    key: str
    title: str
    #: The first is drawn; the reader may change to another.
    abscissae: tuple[Abscissa, ...]
    #: From top to bottom.
    panels: tuple[Panel, ...]
    series: tuple[Series, ...]
    #: What the figure shows and the conditions it holds for.
    caption: str = ""
    marks: tuple[Mark, ...] = ()
    #: Part of the first abscissa shown at first.
    window: tuple[float, float] | None = None
    #: Give a small overview below with handles for the part that is shown.
    slider: bool = False
    #: Names below the bars of a bar chart.
    categories: tuple[str, ...] = ()
    #: Height of the diagram in CSS pixels.
    height: int = 340
    #: How to use it on the screen; not on paper.
    hint: str = ""


@checks_words
@dataclass(frozen=True)
class Column:
    """A column of a table.

    Examples
    --------
    >>> from moyai.report import Column
    >>> column = Column("Tension", [12345.0, 9870.0], unit="N", digits=3)
    >>> len(column.values)                                               # rows
    2
    """

    label: str
    #: Numbers (NaN or None: not known), texts or truth values.
    values: Sequence[Cell]
    #: Unit of the values as given; shown values are scaled to a display unit unless ``fixed``.
    unit: str = ""
    #: Significant digits shown.
    digits: int = 3
    #: Keep the unit as given.
    fixed: bool = False
    #: One number of decimals for the column; switch off where rows are of different kinds.
    uniform: bool = True
    #: Drop trailing zeros (input echo).
    trim: bool = False
    #: File next to the report that each cell leads to, empty text where to none; on the screen only.
    links: Sequence[str] = ()
    #: Magnitude that chooses the display unit together with the values (see :func:`in_one_unit`).
    like: float = 0.0
    #: The texts are numbers with unit and bound, ``at least 1.99 m``: a workbook parts them.
    quantities: bool = False


def in_one_unit(columns: Sequence[Column], unit: str = "N") -> tuple[Column, ...]:
    """Return columns of which those of one unit are shown in the same display unit, so that they can be compared.

    Parameters
    ----------
    columns : sequence of Column
    unit : str
        Unit of the columns that belong together; others stay as they are.
    """
    kin = [column for column in columns if column.unit == unit]
    sizes = [
        abs(value)
        for column in kin
        for value in column.values
        if isinstance(value, float | int) and not isinstance(value, bool) and math.isfinite(value)
    ]
    largest = float(max(sizes, default=0.0))
    return tuple(replace(column, like=largest) if column.unit == unit else column for column in columns)


@checks_words
@dataclass(frozen=True)
class Table:
    """A table that is shown and written as CSV.

    Examples
    --------
    >>> from moyai.report import Column, Table
    >>> tension = Column("Tension", [12345.0, 9870.0], unit="N")
    >>> table = Table("tensions", "Tensions", (Column("Line", ["A", "B"]), tension))
    >>> [column.label for column in table.columns]
    ['Line', 'Tension']
    """

    #: Unique name and name of the CSV file.
    key: str
    title: str
    #: All of one length.
    columns: tuple[Column, ...]
    note: str = ""
    #: Rows that govern.
    emphasised: tuple[int, ...] = ()
    #: Rows that did not pass.
    failed: tuple[int, ...] = ()
    #: Fold it away at first (screen only).
    collapsed: bool = False

    @property
    def row_count(self) -> int:
        """Number of rows."""
        return len(self.columns[0].values) if self.columns else 0


@checks_words
@dataclass(frozen=True)
class KeyFigure:
    """One governing number: what, how much, where, and how it stands against its limit."""

    label: str
    #: The number with its unit, formatted.
    text: str
    #: Where and when it occurs.
    detail: str = ""
    #: Fraction of the limit (NaN where there is none): draws a bar.
    utilisation: float = float("nan")
    #: Colour and word of the bar.
    judgement: Literal["", "good", "caution", "bad"] = ""


@dataclass(frozen=True)
class KeyFigures:
    """The governing numbers on top of the summary."""

    items: tuple[KeyFigure, ...]


@dataclass(frozen=True)
class Paragraph:
    """Plain text."""

    text: str
    quiet: bool = False


@dataclass(frozen=True)
class Listing:
    """Text kept as it was typed, such as the case file."""

    title: str
    text: str
    collapsed: bool = True


@dataclass(frozen=True, eq=False)
class Stroke:
    """A line or an outline through ``points`` of shape (n, 2), or (n, 3) in space [m]; ``style`` names its kind."""

    style: str
    points: Array
    closed: bool = False
    #: Of the line or body that it belongs to.
    name: str = ""


@dataclass(frozen=True)
class Disc:
    """A circle [m], in space at the height of its centre."""

    style: str
    centre: tuple[float, ...]
    radius: float


@dataclass(frozen=True)
class Words:
    """A text of ``size`` [m] at a point [m]; ``anchor`` is ``start``, ``middle`` or ``end``."""

    style: str
    place: tuple[float, ...]
    text: str
    size: float
    anchor: str


@dataclass(frozen=True)
class Distance:
    """A dimension from one point to another [m], drawn ``offset`` [m] away, downwards or to the right."""

    start: tuple[float, float]
    end: tuple[float, float]
    text: str
    offset: float
    size: float


Shape = Stroke | Disc | Words | Distance


@dataclass(frozen=True)
class Drawing:
    """A drawing made of SVG by :mod:`moyai.report.sketch`.

    ``svg`` uses only CSS classes for colour, so that it follows light and dark; ``fixed_svg`` carries its colours.
    ``shapes`` hold the same to scale in metres; none for a picture that is not to scale.
    """

    key: str
    title: str
    svg: str
    fixed_svg: str
    caption: str = ""
    shapes: tuple[Shape, ...] = ()


@dataclass(frozen=True)
class Animation:
    """A scene for the canvas player; ``scene`` is JSON-ready and made by :mod:`moyai.report.animation`.

    ``picture`` is an SVG of its governing moment with colours, for paper, or what draws it when it is asked for;
    ``scene_3d`` the :class:`moyai.report.scene_3d.Scene3D` of one in space.
    """

    key: str
    title: str
    scene: Mapping[str, Any]
    caption: str = ""
    picture: str | Callable[[], str] = ""
    scene_3d: Any = None

    @property
    def still(self) -> str:
        """Return the picture for paper as SVG."""
        return self.picture if isinstance(self.picture, str) else self.picture()


@dataclass(frozen=True)
class NoticeBlock:
    """Notices and failed identity checks."""

    notices: tuple[Notice, ...]
    failed_checks: tuple[IdentityCheck, ...] = ()


@dataclass(frozen=True)
class Option:
    """One alternative of a :class:`Choice`."""

    label: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Choice:
    """Alternatives of which one is shown: water levels, sea states, runs."""

    #: Choices of one group change together, wherever they stand.
    group: str
    #: What is chosen.
    label: str
    options: tuple[Option, ...]
    #: The one shown at first (the governing one).
    default: int = 0
    #: Whether the PDF carries all of them, or the default alone and says so.
    print_all: bool = True


Block = Figure | Table | KeyFigures | Paragraph | Listing | Drawing | Animation | NoticeBlock | Choice


@dataclass(frozen=True)
class Chapter:
    """A chapter of the report."""

    key: str
    title: str
    blocks: tuple[Block, ...]


@checks_words
@dataclass(frozen=True)
class Badge:
    """What a reader sees before all numbers: whether they were computed, and whether the design holds."""

    #: ``Computation`` or ``Design``.
    label: str
    #: The outcome.
    word: str
    #: One sentence behind it.
    message: str = ""
    #: One of "good", "caution", "bad", "neutral".
    tone: Tone = "neutral"


@dataclass(frozen=True)
class Document:
    """A whole report."""

    title: str
    subtitle: str
    #: Status of the result.
    status: str
    #: Sentence behind the status.
    message: str
    sections: tuple[Chapter, ...]
    #: For the foot of the page.
    provenance: Mapping[str, Any] = field(default_factory=dict)
    #: At the head of the page; of the status alone where empty.
    badges: tuple[Badge, ...] = ()
    #: System of units that it was composed in, and is shown in; one of "SI", "tf".
    units: str = "SI"
    #: Language that it is shown in; its texts are English until it is rendered. One of "en", "ja".
    language: str = "en"

    def tables(self) -> tuple[Table, ...]:
        """Return every table of the report, once."""
        return tuple(block for block in self.blocks() if isinstance(block, Table))

    def blocks(self) -> tuple[Block, ...]:
        """Return every block, choices opened, in reading order."""
        found: list[Block] = []

        def collect(blocks: tuple[Block, ...]) -> None:
            for block in blocks:
                found.append(block)
                if isinstance(block, Choice):
                    for option in block.options:
                        collect(option.blocks)

        for section in self.sections:
            collect(section.blocks)
        return tuple(found)
