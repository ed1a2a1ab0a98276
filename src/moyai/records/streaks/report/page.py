"""Compose the report of flow images: circulation and its law first, then pictures, drift and contours of every run."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.results import Result
from moyai.records.streaks.report.drawings import drift_map, overlay
from moyai.report.document import (
    Abscissa,
    Block,
    Chapter,
    Choice,
    Column,
    Document,
    Figure,
    KeyFigure,
    KeyFigures,
    Mark,
    Option,
    Panel,
    Paragraph,
    Series,
    Table,
)
from moyai.report.encoding import slug
from moyai.report.formatting import DASH, format_number
from moyai.report.general_page import case_listing, closing_section, notice_blocks, provenance, report_title
from moyai.report.reading import Group, root_of

# Circulations of models are a few square centimetres per second
_CM2 = 1e4
_PUBLISHED = (
    ("Arai, circle, square and rectangle", "published_arai", "dash"),
    ("Otsuka and Ikeda", "published_otsuka", "dot"),
    ("Chaplin", "published_chaplin", "dashdot"),
)


def compose(result: Result) -> Document:
    """Compose the report of ``moyai measure streaks``.

    Parameters
    ----------
    result : Result
        Groups ``runs/<name>``, ``law`` and ``calibration``; whatever is absent is left out.

    Returns
    -------
    Document
    """
    root = root_of(result)
    runs = root.child("runs").children()
    law = root.child("law")
    sections = [
        Chapter("summary", "Summary", (*_key_figures(root, runs, law), *notice_blocks(result), *_runs(root, runs)))
    ]
    if law.exists:
        sections.append(Chapter("law", "Law of circulation and force", tuple(_law_figures(root, law))))
    if runs:
        sections.append(Chapter("contours", "Circulation and size of the contour", (_choice(root, runs, "contours"),)))
        sections.append(Chapter("drift", "Drift velocity", (_choice(root, runs, "drift"),)))
        sections.append(Chapter("pictures", "Pictures and streaks", (_choice(root, runs, "pictures"),)))
    sections.append(Chapter("input", "Input", (case_listing(root),)))
    sections.append(closing_section(result))
    return Document(
        title=report_title(result),
        subtitle=f"Circulation from particle streaks, {root.attributes.get('section', 'section')}",
        status=result.status,
        message=result.message,
        sections=tuple(sections),
        provenance=provenance(result),
    )


def _number(group: Group, name: str) -> float:
    value = group.attributes.get(name, math.nan)
    return float(value) if np.ndim(value) == 0 else math.nan


def _pair(group: Group, name: str) -> tuple[float, float]:
    value = np.asarray(group.attributes.get(name, (math.nan, math.nan)), dtype=float).ravel()
    return (float(value[0]), float(value[1])) if value.size == 2 else (math.nan, math.nan)


def _array(group: Group, name: str) -> Array:
    found = group.variable(name)
    return np.zeros(0) if found is None else np.asarray(found.values, dtype=float)


def _along(root: Group, value: float) -> float:
    """Return a circulation about +y as it runs along the orbits."""
    return value * (_number(root, "sense") if "sense" in root.attributes else 1.0)


def _key_figures(root: Group, runs: tuple[Group, ...], law: Group) -> tuple[Block, ...]:
    items = []
    for run in runs[:6]:
        low, high = sorted(_along(root, side) for side in _pair(run, "limit_interval"))
        level = 100.0 * _number(root, "confidence")
        items.append(
            KeyFigure(
                f"Circulation, {run.name}",
                f"{format_number(_CM2 * _along(root, _number(run, 'limit')), 3)} cm²/s",
                f"{format_number(_CM2 * low, 3)} to {format_number(_CM2 * high, 3)} at {level:g} %",
            )
        )
    if law.exists:
        deviation = _number(law, "coefficient_deviation")
        spread = f" ± {format_number(deviation, 1)}" if math.isfinite(deviation) else ""
        items.append(
            KeyFigure(
                "Law G / (f B² KC²)",
                f"{format_number(_number(law, 'coefficient'), 3)}{spread}",
                f"Arai {_number(law, 'published_arai'):.3f}, Otsuka {_number(law, 'published_otsuka'):.3f}, "
                f"Chaplin {_number(law, 'published_chaplin'):.3f}",
            )
        )
    return (KeyFigures(tuple(items)),) if items else ()


def _runs(root: Group, runs: tuple[Group, ...]) -> tuple[Block, ...]:
    if not runs:
        return ()

    def numbers(name: str, factor: float = 1.0) -> list[float]:
        return [factor * _number(run, name) for run in runs]

    def sides(name: str, which: int) -> list[float]:
        return [sorted(_CM2 * _along(root, side) for side in _pair(run, name))[which] for run in runs]

    table = Table(
        "runs",
        "Runs",
        (
            Column("Run", [run.name for run in runs]),
            Column("KC", numbers("keulegan_carpenter")),
            Column("Period", numbers("period"), "s", fixed=True),
            Column("Particles", [len(_array(run, "deviation")) for run in runs]),
            Column("Circulation", [_CM2 * _along(root, _number(run, "limit")) for run in runs], "cm2/s", fixed=True),
            Column("from", sides("limit_interval", 0), "cm2/s", fixed=True),
            Column("to", sides("limit_interval", 1), "cm2/s", fixed=True),
            Column("Straight line", [_CM2 * _along(root, _number(run, "linear")) for run in runs], "cm2/s", fixed=True),
        ),
        note="Circulation along the orbits: the G of G + c (B/Bc)⁴ through the larger contours. The straight line "
        "through all contours at the section is the paper's; it counts the particles' Stokes drift as circulation.",
    )
    counts = Table(
        "counts",
        "From streaks to drift velocities",
        (
            Column("Run", [run.name for run in runs]),
            Column("Streaks", [int(_number(run, "streaks")) for run in runs]),
            Column("Regions refused", [int(_number(run, "rejected")) for run in runs]),
            Column("Chains", [int(_number(run, "chains")) for run in runs]),
            Column("Too short, rough or off", [int(_number(run, "refused")) for run in runs]),
            Column("Without direction", [int(_number(run, "undecided")) for run in runs]),
            Column(
                "Misfit of ends, median", [1e3 * _median(_array(run, "residual")) for run in runs], "mm", fixed=True
            ),
            Column(
                "Error of a drift, median",
                [1e3 * _median(_array(run, "deviation")) for run in runs],
                "mm/s",
                fixed=True,
            ),
            Column("Background x", [1e3 * _pair(run, "background_mean")[0] for run in runs], "mm/s", fixed=True),
            Column("Background z", [1e3 * _pair(run, "background_mean")[1] for run in runs], "mm/s", fixed=True),
        ),
        note="Background: mass transport and settling at the centre, measured without the model or given.",
        collapsed=True,
    )
    residual = _array(root.child("calibration"), "residual")
    words = f"The targets of the calibration miss by {float(residual):.2g} pixels." if residual.size == 1 else ""
    return (table, counts, Paragraph(words, quiet=True)) if words else (table, counts)


def _median(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else math.nan


def _law_figures(root: Group, law: Group) -> list[Block]:
    kc = _array(law, "keulegan_carpenter")
    period = _median(_array(law, "period"))
    scale = _number(root, "breadth") ** 2 / period
    fine = np.linspace(0.0, 1.1 * float(kc.max()), 60)
    factor = _number(root, "breadth") ** 2 / (2.0 * math.pi * _number(root, "area"))
    axis = (Abscissa("kc", "KC"),)
    coefficient = _number(law, "coefficient")

    def curves(unit: float) -> list[Series]:
        found = [Series(f"law {coefficient:.3g} KC²", {"kc": fine}, coefficient * unit * fine**2, tone=0)]
        for number, (label, name, dash) in enumerate(_PUBLISHED):
            value = _number(law, name)
            found.append(Series(label, {"kc": fine}, value * unit * fine**2, tone=2 + number, dash=dash, faint=True))  # type: ignore[arg-type]
        return found

    def points(name: str, unit: float) -> list[Series]:
        found = [Series("measured", {"kc": kc}, unit * _array(law, name), style="points", tone=1)]
        low, high = unit * _array(law, f"{name}_low"), unit * _array(law, f"{name}_high")
        gaps = np.full(kc.size, np.nan)
        found.append(
            Series(
                "its interval",
                {"kc": np.column_stack([kc, kc, gaps]).ravel()},
                np.column_stack([low, high, gaps]).ravel(),
                tone=1,
            )
        )
        return found

    circulation = Figure(
        "circulation-law",
        "Circulation along the orbits",
        axis,
        (Panel("circulation G", "cm2/s", from_zero=True),),
        (
            *points("circulation", _CM2),
            Series(
                "straight line (paper)", {"kc": kc}, _CM2 * _array(law, "circulation_linear"), style="points", tone=6
            ),
            *curves(_CM2 * scale),
        ),
        caption="Robust fit with the slope 2. Otsuka and Chaplin: what explains their inertia coefficients.",
        height=400,
    )
    measured = _array(law, "measured_reduction")
    series = [*points("reduction", 1.0), *curves(factor)]
    known = np.isfinite(measured)
    if known.any():
        series.append(Series("from forces", {"kc": kc[known]}, measured[known], style="points", tone=5))
    reduction = Figure(
        "inertia-reduction",
        "Reduction of the inertia coefficient",
        axis,
        (Panel("ideal C_M − C_M", from_zero=True),),
        tuple(series),
        caption="What the Magnus force of the circulation takes from the inertia force: G / (ω A). "
        + ("Circles: found from measured forces." if known.any() else "No reduction from forces was given to compare."),
        height=400,
    )
    blocks: list[Block] = [circulation, reduction]
    weights = _array(law, "weight")
    names = [str(name) for name in law.labels("run")]
    if known.any():
        found = _array(law, "reduction")
        blocks.append(
            Table(
                "force-comparison",
                "Circulation against force",
                (
                    Column("Run", names),
                    Column("KC", list(kc)),
                    Column("From circulation", list(found)),
                    Column("From forces", list(measured)),
                    Column("Ratio", [a / b if b else math.nan for a, b in zip(found, measured)]),
                ),
            )
        )
    outliers = [name for name, weight in zip(names, weights) if weight < 0.5]
    if outliers:
        blocks.append(Paragraph(f"Far off the law, and of little weight in it: {', '.join(outliers)}."))
    return blocks


def _choice(root: Group, runs: tuple[Group, ...], what: str) -> Block:
    makers = {"contours": _contours, "drift": _drift, "pictures": _pictures}
    options = tuple(Option(run.name, makers[what](root, run)) for run in runs)
    return Choice("run", "Run", options, print_all=what != "pictures")


def _contours(root: Group, run: Group) -> tuple[Block, ...]:
    ratio, value = _array(run, "contour"), _CM2 * _along(root, 1.0) * _array(run, "circulation")
    samples = _CM2 * _along(root, 1.0) * _array(run, "circulation_samples")
    limit, term = _CM2 * _along(root, _number(run, "limit")), _CM2 * _along(root, _number(run, "stokes_term"))
    line = _CM2 * _along(root, _number(run, "linear"))
    bias = np.nan_to_num(_CM2 * _along(root, _number(run, "estimator_bias")))
    least = _number(root, "least_ratio")
    known = np.isfinite(value)
    if not known.any():
        return (Paragraph(f"No contour of {run.name} has a circulation."),)
    top = float(ratio[known].max())
    fine = np.linspace(1.0, top, 80)
    used = known & (ratio >= least - 1e-12)
    slope = np.polyfit(ratio[known] - 1.0, value[known], 1)[0]
    series = [
        Series("used in the fit", {"ratio": ratio[used]}, value[used], style="points", tone=1),
        Series("G + c (B/Bc)⁴", {"ratio": fine}, limit + bias + term * fine**-4.0, tone=0),
        Series("straight line (paper)", {"ratio": fine}, line + slope * (fine - 1.0), tone=6, dash="dash"),
        Series("G, without Stokes drift", {"ratio": fine}, np.full(fine.size, limit), tone=2, dash="dot"),
    ]
    left = known & ~used
    if left.any():
        series.insert(1, Series("too close for the fit", {"ratio": ratio[left]}, value[left], style="points", tone=4))
    if samples.ndim == 2 and len(samples) > 2:
        half = 50.0 * (1.0 - _number(root, "confidence"))
        low, high = np.percentile(samples[:, known], [half, 100.0 - half], axis=0)
        gaps = np.full(low.size, np.nan)
        series.append(
            Series(
                f"{100.0 - 2.0 * half:g} % interval",
                {"ratio": np.column_stack([ratio[known], ratio[known], gaps]).ravel()},
                np.column_stack([low, high, gaps]).ravel(),
                tone=1,
            )
        )
    return (
        Figure(
            f"contours-{slug(run.name)}",
            f"Circulation of the drift, {run.name}",
            (Abscissa("ratio", "size of the contour Bc/B"),),
            (Panel("circulation", "cm2/s", from_zero=True),),
            tuple(series),
            caption="Along contours similar to the section. Particles carry the Stokes drift of their orbits on top of "
            "the mean flow; its part falls like the fourth power of the distance and exerts no lift.",
            marks=(Mark("fit from here", x=least),) if least > 1.0 else (),
            height=400,
        ),
    )


def _drift(root: Group, run: Group) -> tuple[Block, ...]:
    position, velocity = _array(run, "position"), _array(run, "drift_velocity")
    outline = _array(run, "outline")
    if position.ndim != 2 or outline.ndim != 2:
        return (Paragraph(DASH),)
    value = _array(run, "circulation")
    ratios = [float(item) for item in _array(run, "contour")[np.isfinite(value)]]
    drawing = drift_map(
        f"drift-{slug(run.name)}",
        f"Drift velocity, {run.name}",
        position,
        velocity,
        outline,
        ratios,
        _number(run, "period"),
    )
    distance = np.hypot(position[:, 0], position[:, 1]) / (0.5 * _number(root, "breadth"))
    around = (velocity[:, 0] * position[:, 1] - velocity[:, 1] * position[:, 0]) / np.hypot(
        position[:, 0], position[:, 1]
    )
    fine = np.linspace(max(1.0, 0.95 * float(distance.min())), float(distance.max()), 80)
    half = 0.5 * _number(root, "breadth")
    vortex = 100.0 * _along(root, 1.0) * _number(run, "limit") / (2.0 * math.pi * half * fine)
    profile = Figure(
        f"profile-{slug(run.name)}",
        f"Drift around the section, {run.name}",
        (Abscissa("distance", "distance from the centre over B/2"),),
        (Panel("drift along the orbits' sense", "cm/s"),),
        (
            Series("particles", {"distance": distance}, 100.0 * _along(root, 1.0) * around, style="points", tone=1),
            Series("vortex of G", {"distance": fine}, vortex, tone=0),
        ),
        caption="Tangential drift of every particle. Near the section the Stokes drift lifts it above the vortex.",
        height=340,
    )
    return (drawing, profile)


def _pictures(root: Group, run: Group) -> tuple[Block, ...]:
    grey, ends = run.variable("picture"), _array(run, "streak_end")
    owner = run.variable("streak_particle")
    if grey is None or owner is None or ends.ndim != 3:
        return (Paragraph("The result holds no picture of this run."),)
    return (
        overlay(
            f"overlay-{slug(run.name)}",
            f"Streaks of the first recording, {run.name}",
            np.asarray(grey.values, dtype=np.uint8),
            ends,
            np.asarray(owner.values, dtype=np.int64),
        ),
    )
