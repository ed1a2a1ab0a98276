"""The drawings of a report for drawing programs: DXF to true scale, a layer for each kind of part."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.report.document import Animation, Disc, Distance, Document, Drawing, Shape, Stroke, Words

_PER_METRE = {"m": 1.0, "mm": 1000.0}
_INSUNITS = {"m": 6, "mm": 4}

#: Layer and colour of the AutoCAD index by the style of a stroke; an empty layer is left out (areas of water and bed).
_LAYERS: dict[str, tuple[str, int]] = {
    "water": ("", 0), "bed": ("", 0),
    "surface": ("WATER-LEVEL", 5), "bed-line": ("BED", 32), "hull": ("BODY", 7), "mooring": ("MOORING", 150),
    "anchor": ("ANCHORS", 7), "sheet": ("SHEET", 30), "ghost": ("SHEET-RANGE", 31), "buoy": ("FLOATS", 40),
    "chord": ("REFERENCE", 8), "flow": ("CURRENT", 140), "flow-head": ("CURRENT", 140), "axis": ("AXES", 1),
    "axis-head": ("AXES", 1), "axis-text": ("AXES", 1), "dimension": ("DIMENSIONS", 8),
    "dimension-head": ("DIMENSIONS", 8), "note": ("TEXT", 7), "faint": ("TEXT", 7), "marker": ("POINTS", 7),
    "hollow": ("POINTS", 7),
}  # fmt: skip
#: Height of capitals over the size of a font.
_CAPITALS = 0.72
#: Half the width of a letter over the height of capitals.
_WIDTH = 0.42


def document_dxf(document: Document, unit: str) -> Iterator[tuple[str, bytes]]:
    """Yield the key and the DXF file of every drawing to scale of a document.

    Parameters
    ----------
    document : Document
    unit : {"m", "mm"}
        Of the drawing; x to the right and z (in a plan y) up as on the page, x, y, z of the site in space.

    Raises
    ------
    InputError
        When ezdxf is missing, or the unit is another.
    """
    if unit not in _PER_METRE:
        raise InputError(f"'{unit}' is no unit of a drawing", path="--dxf", allowed="m, mm")
    for block in document.blocks():
        if isinstance(block, Drawing | Animation) and block.shapes:
            yield block.key, shapes_dxf(block.shapes, unit)


def shapes_dxf(shapes: tuple[Shape, ...], unit: str) -> bytes:
    """Return the DXF file (R2010) of shapes in metres.

    Parameters
    ----------
    shapes : tuple of Shape
    unit : {"m", "mm"}
    """
    try:
        import ezdxf
    except ImportError as error:
        raise InputError("DXF needs ezdxf", path="--dxf", remedy="pip install 'moyai[dxf]'") from error
    drawing = ezdxf.filemanagement.new("R2010", setup=["linetypes"])
    drawing.header["$INSUNITS"] = _INSUNITS[unit]
    drawing.header["$MEASUREMENT"] = 1
    style = drawing.dimstyles.new("MOYAI")
    style.dxf.dimtad, style.dxf.dimblk = 1, ""
    space, factor = drawing.modelspace(), _PER_METRE[unit]
    for shape in shapes:
        layer, colour = _layer(shape)
        if not layer:
            continue
        if layer not in drawing.layers:
            drawing.layers.add(layer, color=colour)
        _add(space, shape, layer, factor)
    stream = io.StringIO()
    drawing.write(stream)
    return stream.getvalue().encode("utf-8")


def _layer(shape: Shape) -> tuple[str, int]:
    if isinstance(shape, Distance):
        return _LAYERS["dimension"]
    if shape.style in _LAYERS:
        return _LAYERS[shape.style]
    # a line, sheet or body of the case keeps its name; a few characters are not allowed in the name of a layer
    return re.sub(r'[<>/\\":;?*|=`,\x00-\x1f]', "-", shape.style).strip() or "0", 7


def _add(space: Any, shape: Shape, layer: str, factor: float) -> None:
    at = {"layer": layer}
    match shape:
        case Stroke():
            _stroke(space, factor * np.asarray(shape.points, dtype=float), shape.closed, at)
        case Disc():
            space.add_circle(_scaled(shape.centre, factor), factor * shape.radius, dxfattribs=at)
        case Words():
            text = space.add_text(shape.text, height=_CAPITALS * factor * shape.size, dxfattribs=at)
            text.set_placement(_scaled(shape.place, factor), align=_aligned(shape.anchor))
        case Distance():
            _distance(space, shape, factor, at)


def _stroke(space: Any, points: Array, closed: bool, at: dict[str, str]) -> None:
    if points.shape[1] == 2:
        space.add_lwpolyline(points.tolist(), close=closed, dxfattribs=at)
    elif closed and len(points) in (3, 4):
        space.add_3dface(points.tolist(), dxfattribs=at)
    elif len(points) == 2:
        space.add_line(*points.tolist(), dxfattribs=at)
    else:
        space.add_polyline3d(points.tolist(), close=closed, dxfattribs=at)


def _distance(space: Any, shape: Distance, factor: float, at: dict[str, str]) -> None:
    start, end, offset = _scaled(shape.start, factor), _scaled(shape.end, factor), factor * shape.offset
    height = _CAPITALS * factor * shape.size
    level = abs(end[1] - start[1]) < abs(end[0] - start[0])
    base = (start[0], start[1] - offset) if level else (start[0] + offset, start[1])
    # upright dimensions stand close together: their words lie beside them, as on the page
    side = (1.0 if offset > 0.0 else -1.0) * height * (1.0 + _WIDTH * len(shape.text))
    beside = None if level else (base[0] + side, 0.5 * (start[1] + end[1]))
    sizes = {"dimtxt": 1.0, "dimasz": 1.0, "dimexe": 0.5, "dimexo": 0.5, "dimgap": 0.4}
    space.add_linear_dim(
        base=base, p1=start, p2=end, angle=0.0 if level else 90.0, text=shape.text, location=beside,
        text_rotation=None if level else 0.0, dimstyle="MOYAI", dxfattribs=at,
        override={name: share * height for name, share in sizes.items()},
    ).render()  # fmt: skip


def _aligned(anchor: str) -> Any:
    from ezdxf.enums import TextEntityAlignment

    known = {"middle": TextEntityAlignment.CENTER, "end": TextEntityAlignment.RIGHT}
    return known.get(anchor, TextEntityAlignment.LEFT)


def _scaled(point: tuple[float, float], factor: float) -> tuple[float, float]:
    return factor * float(point[0]), factor * float(point[1])


__all__ = ["document_dxf", "shapes_dxf"]
