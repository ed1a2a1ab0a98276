"""Sphinx extension: the pontoon of the examples in regular waves as a picture that moves, without scripts.

The motion is that of the time domain, run with the documentation; the picture is kept while no source of the package or
of the case is newer.
"""

from __future__ import annotations

import base64
import json
import math
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from computed_ahead import ahead
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

CASE = Path(__file__).parent.parent / "examples" / "pontoon.yaml"
#: Regular waves in which the pontoon rolls visibly.
PERIOD = 5.0
SEA = {"name": "swell", "kind": "regular", "height": "1 m", "periods": [PERIOD], "heading_deg": 0}
FRAMES, SIZE, HEAD_ROOM = 32, (960, 300), 3.0
WIDTH = 90.0  # of the view [m]


def scene() -> dict[str, Any]:
    """Return the scene of the pontoon in regular waves, as the player of the report has it."""
    import moyai
    from moyai.report.document import Animation

    case = moyai.load_case(CASE).replace("waves", SEA).replace("analyses", ["statics", "mooring", "frequency", "time"])
    case = case.replace("site.water_levels", {"HWL": "1.5 m"})
    blocks = moyai.report.compose_document(moyai.run(case)).blocks()
    return dict(next(block.scene for block in blocks if isinstance(block, Animation)))


def array(coded: Any) -> np.ndarray:
    """Return the numbers of a packed array."""
    if isinstance(coded, list):
        return np.array(coded, dtype=float)
    return np.frombuffer(base64.b64decode(coded["f4"]), dtype="<f4").astype(float)


def track(coded: dict[str, Any]) -> np.ndarray:
    """Return the coordinates of a packed motion, shape (frames, coordinates)."""
    packed = coded["coefficients"]
    kind = "i1" if "i1" in packed else "i2"
    integers = np.frombuffer(base64.b64decode(packed[kind]), dtype="i1" if kind == "i1" else "<i2")
    columns = np.array(packed["offset"]) + np.array(packed["step"]) * integers.reshape(-1, packed["columns"])
    return np.asarray(array(coded["mean"]) + columns @ np.array([array(column) for column in coded["basis"]]))


def moving_svg(found: dict[str, Any], period: float) -> str:
    """Return one wave period of a scene as an SVG that repeats itself."""
    times = array(found["times"])
    begin = found["window"][0] + period
    wanted = begin + period * np.linspace(0.0, 1.0, FRAMES + 1)

    def at_frames(values: np.ndarray) -> np.ndarray:
        frames = np.array([np.interp(wanted, times, column) for column in values.T]).T
        # what the last period has not yet given back is spread, so that the picture closes
        return np.asarray(frames - np.linspace(0.0, 1.0, FRAMES + 1)[:, None] * (frames[-1] - frames[0]))

    bed = float(found["bed"])
    factor = SIZE[0] / WIDTH
    height = math.ceil((HEAD_ROOM - bed + 1.5) * factor)

    def path(x: np.ndarray, z: np.ndarray) -> str:
        places = zip((x + 0.5 * WIDTH) * factor, (HEAD_ROOM - z) * factor, strict=True)
        return "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in places)

    def moved(shapes: list[str], style: str) -> str:
        values = ";".join(shapes)
        return (
            f'<path d="{shapes[0]}" {style}><animate attributeName="d" dur="{period:g}s" repeatCount="indefinite" '
            f'values="{values}"/></path>'
        )

    parts = []
    surface = found["surface"]
    x, elevation = array(surface["x"]), at_frames(track(surface["elevation"]))
    near = np.abs(x) <= 0.5 * WIDTH + 5.0
    floor = f"L{SIZE[0] + 60} {height}L-60 {height}Z"
    parts.append(moved([path(x[near], row[near]) + floor for row in elevation], 'fill="#cfe3f1" stroke="#2f6f9f"'))
    parts.append(f'<path d="M0 {(HEAD_ROOM - bed) * factor:.1f}h{SIZE[0]}v{height}H0Z" fill="#d9cdb8"/>')
    for line in found["lines"]:
        places = at_frames(track(line["path"]))
        half = places.shape[1] // 2
        shapes = [path(row[:half], row[half:]) for row in places]
        parts.append(moved(shapes, 'fill="none" stroke="#7a3b1d" stroke-width="2"'))
    for body in found["bodies"]:
        pose = at_frames(track(body["pose"]))
        pivot_x, pivot_z = body["pivot"]
        for outline in body["outlines"]:
            out_x, out_z = (array(axis) for axis in outline)
            shapes = []
            for sway, heave, roll in pose:
                cosine, sine = math.cos(roll), math.sin(roll)
                arm_x, arm_z = out_x - pivot_x, out_z - pivot_z
                moved_x = pivot_x + sway + cosine * arm_x + sine * arm_z
                shapes.append(path(moved_x, pivot_z + heave + cosine * arm_z - sine * arm_x) + "Z")
            parts.append(moved(shapes, 'fill="#8a9aa8" stroke="#33414d"'))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {SIZE[0]} {height}" role="img">'
        f'<rect width="100%" height="100%" fill="#f7fafc"/>{"".join(parts)}</svg>'
    )


def kept_picture(folder: Path) -> str:
    """Return the picture as SVG; it stands in the folder then."""
    import moyai

    kept = folder / "pontoon_in_waves.json"
    newest = max(one.stat().st_mtime for one in (CASE, Path(__file__), *Path(moyai.__file__).parent.rglob("*.py")))
    if not kept.exists() or kept.stat().st_mtime <= newest:
        logging.getLogger(__name__).info("drawing the pontoon in waves")
        folder.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(moving_svg(scene(), PERIOD)), encoding="utf-8")
    return str(json.loads(kept.read_text(encoding="utf-8")))


class MovingPicture(SphinxDirective):
    """The picture with the words of the directive as its caption."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the picture as HTML."""
        coded = base64.b64encode(ahead(kept_picture, Path(self.env.app.outdir) / "_images").encode()).decode()
        words = escape(" ".join(self.content))
        html = (
            f'<figure style="margin:0 0 1rem"><img style="width:100%" alt="{words}" '
            f'src="data:image/svg+xml;base64,{coded}"><figcaption style="font-size:.8rem">{words}</figcaption></figure>'
        )
        return [nodes.raw("", html, format="html")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("moving-picture", MovingPicture)
    return {"parallel_read_safe": False}
