"""The drawings of a report for drawing programs: DXF to true scale, a layer for each kind of part."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.language import spoken_in, spoken_language
from moyai.report.document import Animation, Disc, Distance, Document, Drawing, Shape, Stroke, Words
from moyai.report.language import in_the_language
from moyai.report.scene_3d import Scene3D
from moyai.report.scene_shapes import plan_and_elevation, space_shapes
from moyai.report.systems import displayed_in

_PER_METRE = {"m": 1.0, "mm": 1000.0}
_INSUNITS = {"m": 6, "mm": 4}

#: Layer and colour of the AutoCAD index by the style of a stroke; an empty layer is left out (areas of water and bed).
_LAYERS: dict[str, tuple[str, int]] = {
    "water": ("", 0), "bed": ("", 0), **{f"ratio-{number}": ("", 0) for number in range(9)},
    "surface": ("WATER", 5), "bed-line": ("BED", 32), "hull": ("BODY", 7), "mooring": ("LINES", 150),
    "anchor": ("ANCHORS", 6), "net": ("NET", 94), "sheet": ("SHEET", 30), "ghost": ("SHEET-RANGE", 31),
    "buoy": ("FLOATERS", 40), "weight": ("WEIGHTS", 8), "chord": ("REFERENCE", 8), "flow": ("CURRENT", 140),
    "flow-head": ("CURRENT", 140), "wave": ("WAVES", 5), "wave-head": ("WAVES", 5), "axis": ("AXES", 1),
    "axis-head": ("AXES", 1), "axis-text": ("AXES", 1), "dimension": ("DIMENSIONS", 8),
    "dimension-head": ("DIMENSIONS", 8), "note": ("TEXT", 7), "faint": ("TEXT", 7), "marker": ("POINTS", 7),
    "hollow": ("POINTS", 7),
}  # fmt: skip
#: Font of texts with Japanese letters, which every Japanese Windows has
_JAPANESE = "msgothic.ttc"
#: Height of capitals over the size of a font.
_CAPITALS = 0.72
#: Half the width of a letter over the height of capitals.
_WIDTH = 0.42


def require_drawing_unit(unit: str) -> None:
    """Refuse a unit that drawings are not written in.

    Raises
    ------
    InputError
    """
    if unit not in _PER_METRE:
        raise InputError(f"'{unit}' is no unit of a drawing", path="--dxf", allowed="m, mm")


def document_dxf(document: Document, unit: str) -> tuple[tuple[str, bytes], ...]:
    """Return the key and the DXF file of every drawing to scale of a document, texts in the language of the document.

    A structure in space that stands still gives three: in space, in plan, in elevation. Where all of them move, they
    are drawn at their first moment.

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
    require_drawing_unit(unit)
    with displayed_in(document.units), spoken_in(document.language):
        return tuple((key, shapes_dxf(in_the_language(shapes), unit)) for key, shapes in _drawn(document))


def _drawn(document: Document) -> Iterator[tuple[str, tuple[Shape, ...]]]:
    scenes = []
    for block in document.blocks():
        if isinstance(block, Drawing) and block.shapes:
            yield block.key, block.shapes
        elif isinstance(block, Animation) and isinstance(block.scene_3d, Scene3D):
            scenes.append((block, block.scene_3d))
    still = [pair for pair in scenes if pair[1].is_still]
    for block, scene in still or scenes:
        yield block.key, space_shapes(scene)
        title = block.title if scene.is_still else f"{block.title}, t = {scene.time[0]:.3g} s"
        for view in plan_and_elevation(scene, block.key, title):
            yield view.key, view.shapes


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
    if spoken_language() == "ja":
        drawing.styles.get("Standard").dxf.font = _JAPANESE
    space, factor = drawing.modelspace(), _PER_METRE[unit]
    named: dict[str, list[Any]] = {}
    for shape in shapes:
        layer, colour = _layer(shape)
        if not layer:
            continue
        if layer not in drawing.layers:
            drawing.layers.add(layer, color=colour)
        made = _add(space, shape, layer, factor)
        if made is not None and isinstance(shape, Stroke) and shape.name:
            named.setdefault(_allowed(shape.name), []).append(made)
    for name, parts in named.items():
        drawing.groups.new(name).extend(parts)
    _frame(space)
    stream = io.StringIO()
    drawing.write(stream)
    return stream.getvalue().encode("utf-8")


def _frame(space: Any) -> None:
    """State the extent of a drawing and open it there; a program that scales by it shows an empty sheet without."""
    from ezdxf import bbox, zoom

    box = bbox.extents(space, fast=True)
    if box.has_data:
        space.reset_extents(box.extmin, box.extmax)
        zoom.extents(space)


def _layer(shape: Shape) -> tuple[str, int]:
    if isinstance(shape, Distance):
        return _LAYERS["dimension"]
    return _LAYERS.get(shape.style, ("OTHER", 7))


def _allowed(name: str) -> str:
    """Return a name of the case without the few characters that names in a drawing cannot have."""
    return re.sub(r'[<>/\\":;?*|=`,\x00-\x1f]', "-", name).strip() or "part"


def _add(space: Any, shape: Shape, layer: str, factor: float) -> Any:
    """Add a shape and return what it became, None for words and dimensions."""
    at = {"layer": layer}
    match shape:
        case Stroke():
            return _stroke(space, factor * np.asarray(shape.points, dtype=float), shape, at)
        case Disc():
            space.add_circle(_scaled(shape.centre, factor), factor * shape.radius, dxfattribs=at)
        case Words():
            text = space.add_text(shape.text, height=_CAPITALS * factor * shape.size, dxfattribs=at)
            text.set_placement(_scaled(shape.place, factor), align=_aligned(shape.anchor))
        case Distance():
            _distance(space, shape, factor, at)
    return None


def _stroke(space: Any, points: Array, shape: Stroke, at: dict[str, str]) -> Any:
    if points.shape[1] == 2:
        return space.add_lwpolyline(points.tolist(), close=shape.closed, dxfattribs=at)
    if shape.closed and len(points) in (3, 4) and shape.style not in ("surface", "bed-line"):
        return space.add_3dface(points.tolist(), dxfattribs=at)
    if len(points) == 2:
        return space.add_line(*points.tolist(), dxfattribs=at)
    return space.add_polyline3d(points.tolist(), close=shape.closed, dxfattribs=at)


def _distance(space: Any, shape: Distance, factor: float, at: dict[str, str]) -> None:
    start, end, offset = _scaled(shape.start, factor), _scaled(shape.end, factor), factor * shape.offset
    height = _CAPITALS * factor * shape.size
    level = abs(end[1] - start[1]) < abs(end[0] - start[0])
    base = (start[0], start[1] - offset) if level else (start[0] + offset, start[1])
    # upright dimensions stand close together: their words lie next to them, as on the page
    side = (1.0 if offset > 0.0 else -1.0) * height * (1.0 + _WIDTH * len(shape.text))
    location = None if level else (base[0] + side, 0.5 * (start[1] + end[1]))
    sizes = {"dimtxt": 1.0, "dimasz": 1.0, "dimexe": 0.5, "dimexo": 0.5, "dimgap": 0.4}
    space.add_linear_dim(
        base=base, p1=start, p2=end, angle=0.0 if level else 90.0, text=shape.text, location=location,
        text_rotation=None if level else 0.0, dimstyle="MOYAI", dxfattribs=at,
        override={name: share * height for name, share in sizes.items()},
    ).render()  # fmt: skip


def _aligned(anchor: str) -> Any:
    from ezdxf.enums import TextEntityAlignment

    known = {"middle": TextEntityAlignment.CENTER, "end": TextEntityAlignment.RIGHT}
    return known.get(anchor, TextEntityAlignment.LEFT)


def _scaled(point: tuple[float, ...], factor: float) -> tuple[float, ...]:
    return tuple(factor * float(value) for value in point)


__all__ = ["document_dxf", "shapes_dxf"]
