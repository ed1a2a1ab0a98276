"""Sphinx extension: tables and figures of the validation pages from what `moyai validate --json` prints.

The cases are computed once a build and kept while no source of the package is newer. MOYAI_DOCS_QUICK=1 leaves out the
topics of :data:`SLOW`; MOYAI_VALIDATION=FILE takes the records of a file that `moyai validate --json` wrote.
"""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any, ClassVar

from computed_ahead import ahead
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

#: Topics of half a minute and more.
SLOW = ("units", "units_time")
#: Colour and shape of each kind of reference.
MARKS = {
    "exact": ("#1b6ca8", "circle"),
    "published": ("#2a8a4a", "square"),
    "measured": ("#8a4fa0", "diamond"),
    "other program": ("#c2571a", "triangle"),
    "own second": ("#6b7680", "cross"),
}
#: Errors are drawn from this share of what is allowed; smaller ones and none at the left end.
LEAST = 1e-6
_ROW, _LEFT, _WIDTH, _HEAD = 15, 30, 460, 46


def computed(folder: Path, *, quick: bool) -> list[dict[str, Any]]:
    """Return the records of all cases; they stand in the folder then."""
    import moyai
    from moyai.validation import choose, compute, topics

    given = os.environ.get("MOYAI_VALIDATION")
    if given:
        return list(json.loads(Path(given).read_text(encoding="utf-8"))["cases"])
    kept = folder / ("quick.json" if quick else "results.json")
    newest = max(path.stat().st_mtime for path in Path(moyai.__file__).parent.rglob("*.py"))
    if not kept.exists() or kept.stat().st_mtime <= newest:
        logging.getLogger(__name__).info("computing the validation cases")
        outcomes = compute(choose([topic for topic in topics() if not quick or topic not in SLOW]))
        folder.mkdir(parents=True, exist_ok=True)
        cases = [{key: _finite(value) for key, value in one.as_dict().items()} for one in outcomes]
        kept.write_text(json.dumps({"cases": cases}), encoding="utf-8")
    return list(json.loads(kept.read_text(encoding="utf-8"))["cases"])


def _finite(value: Any) -> Any:
    """Return a value, none for a number that JSON does not know."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def share(record: dict[str, Any]) -> float:
    """Return the error of a record over what is allowed, 0 where neither is anything, infinite where there is none."""
    if record["error"] is None:
        return math.inf
    if not record["error"]:
        return 0.0
    return float(record["error"] / record["tolerance"]) if record["tolerance"] else math.inf


def amount(value: float, relative: bool) -> str:
    """Return an error as text, relative ones in per cent."""
    if not value:
        return "0"
    value = 100.0 * value if relative else value
    text = f"{value:.2g}" if 1e-3 <= value < 1e4 else number(float(f"{value:.1e}"))
    return f"{text} %" if relative else text


def number(value: float) -> str:
    """Return a number with six digits, powers of ten without filling zeros."""
    return re.sub(r"e([+-])0*", r"e\1", f"{value:.6g}" if abs(value) > 1e-6 else f"{value:.2g}").replace("e+", "e")


def mark(kind: str, x: float, y: float, hint: str = "") -> str:
    """Return the sign of a kind of reference as SVG."""
    colour, shape = MARKS[kind]
    title = f"<title>{escape(hint)}</title>" if hint else ""
    drawn = {
        "circle": f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4"',
        "square": f'<rect x="{x - 3.6:.1f}" y="{y - 3.6:.1f}" width="7.2" height="7.2"',
        "diamond": f'<path d="M{x:.1f} {y - 5:.1f}l5 5l-5 5l-5-5z"',
        "triangle": f'<path d="M{x:.1f} {y - 4.6:.1f}l4.8 8.4h-9.6z"',
        "cross": f'<path d="M{x - 3.6:.1f} {y - 3.6:.1f}l7.2 7.2m0-7.2l-7.2 7.2" stroke="{colour}" stroke-width="2"',
    }[shape]
    return f'{drawn} fill="{"none" if shape == "cross" else colour}">{title}{_END[shape]}'


_END = {"circle": "</circle>", "square": "</rect>", "diamond": "</path>", "triangle": "</path>", "cross": "</path>"}


def place(value: float) -> float:
    """Return where on the axis a share of what is allowed stands."""
    decades = -math.log10(LEAST)
    exponent = min(max(math.log10(max(value, LEAST)), -decades), 0.3)
    return _LEFT + 12 + (exponent + decades) / (decades + 0.4) * (_WIDTH - _LEFT - 24)


def error_chart(records: Sequence[dict[str, Any]], names: Sequence[str] = ()) -> str:
    """Return the errors over what is allowed, a row a record, as SVG on a logarithmic axis.

    Parameters
    ----------
    records : sequence of dict
        Those of one topic.
    names : sequence of str
        Of the rows; their numbers in the table where empty.
    """
    height = _HEAD + _ROW * len(records) + 22
    parts = []
    for power in range(round(math.log10(LEAST)), 1):
        x = place(10.0**power)
        colour = "#c0392b" if power == 0 else "#d5dbe1"
        parts.append(f'<path d="M{x:.1f} {_HEAD - 8}V{height - 20}" stroke="{colour}" stroke-width="1"/>')
        words = "allowed" if power == 0 else f"10<tspan dy='-4' font-size='8'>{power}</tspan>"
        parts.append(f'<text x="{x:.1f}" y="{height - 6}" text-anchor="middle">{words}</text>')
    kinds = [kind for kind in MARKS if any(record["reference_kind"] == kind for record in records)]
    for number, kind in enumerate(kinds):
        x = 12 + number * 95
        parts.append(mark(kind, x, 11) + f'<text x="{x + 9}" y="15">{kind}</text>')
    parts.append(f'<text x="{_LEFT}" y="{_HEAD - 14}" fill="#5b6775">error over what is allowed</text>')
    for number, record in enumerate(records):
        y = _HEAD + _ROW * (number + 0.5)
        label = names[number] if names else str(number + 1)
        parts.append(f'<text x="{_LEFT - 6}" y="{y + 4:.1f}" text-anchor="end" fill="#5b6775">{escape(label)}</text>')
        parts.append(f'<path d="M{_LEFT} {y}H{_WIDTH}" stroke="#eef1f4"/>')
        parts.append(mark(record["reference_kind"], place(share(record)), y, record["name"]))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {height}" font-family="sans-serif" '
        f'font-size="11" fill="#1b2430"><rect width="100%" height="100%" fill="#fff"/>{"".join(parts)}</svg>'
    )


def figure(svg: str, words: str) -> str:
    """Return a drawing with its caption as HTML."""
    return (
        f'<figure class="validation" role="img" aria-label="{escape(words)}">{svg}'
        f"<figcaption>{escape(words)}</figcaption></figure>"
    )


def rows(records: Sequence[dict[str, Any]]) -> str:
    """Return the table of records as HTML."""
    lines = []
    for row, record in enumerate(records, 1):
        value = "-" if record["value"] is None else number(record["value"])
        relative = record["relative"]
        note = f'<br><span class="quiet">{escape(record["note"])}</span>' if record["note"] else ""
        error = "-" if record["error"] is None else amount(record["error"], relative)
        lines.append(
            f"<tr><td>{row}</td><td>{escape(record['name'].split(': ', 1)[-1])}</td><td>{value}</td>"
            f"<td>{number(record['reference'])}</td><td>{escape(record['source'])}<br>"
            f'<span class="quiet">{record["reference_kind"]}</span></td><td>{error}</td>'
            f"<td>{amount(record['tolerance'], relative)}{note}</td></tr>"
        )
    heads = ("", "claim", "here", "reference", "source, kind", "error", "allowed")
    head = "".join(f"<th>{word}</th>" for word in heads)
    return (
        '<div class="table-wrapper"><table class="docutils validation"><thead><tr>'
        f"{head}</tr></thead><tbody>{''.join(lines)}</tbody></table></div>"
    )


class _FromResults(SphinxDirective):
    """What has the records of a build at hand."""

    def records(self) -> list[dict[str, Any]]:
        """Return the records; a case that fails is a warning of the build."""
        quick = os.environ.get("MOYAI_DOCS_QUICK") == "1"
        return list(ahead(computed, Path(self.env.app.outdir) / "validation", quick=quick))


class Validation(_FromResults):
    """Figure and table of one or more topics: ``{validation} sea``.

    ``:curve:`` draws a curve too, ``:cases:`` takes those whose names have one of these words, parted by commas.
    """

    required_arguments = 1
    final_argument_whitespace = True
    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {"curve": directives.unchanged, "cases": directives.unchanged}

    def run(self) -> list[nodes.Node]:
        """Return the figure, the command and the table."""
        from moyai.validation import topics

        wanted = self.arguments[0].split()
        unknown = set(wanted) - set(topics())
        if unknown:
            raise self.error(f"no topic of moyai validate: {', '.join(sorted(unknown))}")
        words = [word.strip() for word in self.options.get("cases", "").split(",")]
        found = [record for record in self.records()
                 if record["topic"] in wanted and any(word in record["name"] for word in words)]  # fmt: skip
        command = f"moyai validate --only {' --only '.join(wanted)}"
        for record in found:
            if not record["passed"]:
                self.state_machine.reporter.warning(f"validation case fails: {record['name']} {record['failure']}")
        if not found and set(wanted) - set(SLOW):
            raise self.error(f"no validation case of {self.arguments[0]}: {self.options.get('cases', '')}")
        if not found:
            return [nodes.raw("", f"<p>Left out of the quick build: <code>{command}</code>.</p>", format="html")]
        drawn = ""
        if "curve" in self.options:
            from validation_curves import CURVES

            drawn = figure(*CURVES[self.options["curve"]](found))
        caption = f"Each point is a row of the table: error over what is allowed, {len(found)} cases."
        html = (
            f"{drawn}{figure(error_chart(found), caption)}<p>Computed with this documentation; command of every row: "
            f"<code>{command}</code></p>{rows(found)}"
        )
        return [nodes.raw("", html, format="html")]


class ValidationSummary(_FromResults):
    """The largest error of each topic over what is allowed, and how many cases of which kind there are."""

    has_content = False

    def run(self) -> list[nodes.Node]:
        """Return a figure with a row a topic and a sentence."""
        found = self.records()
        kinds = [kind for kind in MARKS if any(record["reference_kind"] == kind for record in found)]
        counts = [f"{sum(one['reference_kind'] == kind for one in found)} {kind}" for kind in kinds]
        passed = sum(record["passed"] for record in found)
        html = f"<p>{passed} of {len(found)} cases of this build hold; by kind of reference: {', '.join(counts)}.</p>"
        return [nodes.raw("", html + figure(strip_chart(found), STRIPS), format="html")]


STRIPS = "Each sign is a case, each row a topic: error over what is allowed."


def strip_chart(records: Sequence[dict[str, Any]]) -> str:
    """Return all cases, a row a topic, as SVG on a logarithmic axis."""
    names = sorted({record["topic"] for record in records})
    left, height = 112, 30 + 17 * len(names) + 20
    parts = []

    def moved(value: float) -> float:
        return left + (place(value) - _LEFT) * (_WIDTH + 60 - left) / (_WIDTH - _LEFT)

    for power in range(round(math.log10(LEAST)), 1):
        x = moved(10.0**power)
        colour = "#c0392b" if power == 0 else "#d5dbe1"
        parts.append(f'<path d="M{x:.1f} 26V{height - 20}" stroke="{colour}"/>')
        words = "allowed" if power == 0 else f"10<tspan dy='-4' font-size='8'>{power}</tspan>"
        parts.append(f'<text x="{x:.1f}" y="{height - 6}" text-anchor="middle">{words}</text>')
    for number, kind in enumerate(MARKS):
        parts.append(mark(kind, 12 + number * 100, 11) + f'<text x="{21 + number * 100}" y="15">{kind}</text>')
    for number, name in enumerate(names):
        y = 30 + 17 * (number + 0.5)
        parts.append(f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{name.replace("_", " ")}</text>')
        parts.append(f'<path d="M{left} {y}H{_WIDTH + 60}" stroke="#eef1f4"/>')
        own = [record for record in records if record["topic"] == name]
        parts += [mark(record["reference_kind"], moved(share(record)), y, record["name"]) for record in own]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH + 60} {height}" font-family="sans-serif" '
        f'font-size="11" fill="#1b2430"><rect width="100%" height="100%" fill="#fff"/>{"".join(parts)}</svg>'
    )


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directives."""
    app.add_directive("validation", Validation)
    app.add_directive("validation-summary", ValidationSummary)
    return {"parallel_read_safe": False}
