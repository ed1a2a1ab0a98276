"""Drawings as DXF, read back by a program of other people: GDAL (pyogrio), which never saw the writer."""

from __future__ import annotations

import io
import math
import re
from pathlib import Path

import ezdxf
import numpy as np
import pyogrio
import pytest

import moyai
from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.language import said, spoken_in
from moyai.report.animation_3d import animation_3d
from moyai.report.document import Chapter, Distance, Document, Drawing, Stroke, Words
from moyai.report.dxf import document_dxf, shapes_dxf
from moyai.report.plan import LineInPlan, UnitInPlan, unit_plan
from moyai.report.scene_3d import Faces, Marker, Scene3D
from moyai.report.sketch import Sketch


def _sketch() -> Sketch:
    sketch = Sketch((-40.0, 40.0, -12.0, 3.0), title="all kinds of shapes")
    sketch.rectangle(-40.0, 0.0, 40.0, -12.0, "water")
    sketch.path(np.array([[-40.0, 0.0], [40.0, 0.0]]), "surface")
    sketch.path(np.array([[-10.0, -2.4], [10.0, -2.4], [10.0, 1.2], [-10.0, 1.2]]), "hull", closed=True)
    sketch.path(np.array([[-35.0, -12.0], [-20.0, -8.0], [-10.0, -2.4]]), "mooring")
    sketch.dot(0.0, -0.5, 4.0, "marker")
    sketch.text(0.0, -0.5, "重心 G", shift=(8.0, 0.0), anchor="start")
    sketch.dimension(-10.0, -2.4, 10.0, -2.4, "B = 20 m", offset=26.0)
    sketch.dimension(10.0, 0.0, 10.0, -2.4, "d = 2.4 m", offset=44.0)
    sketch.turn(-20.0, 1.0, 10.0, "axis")
    return sketch


Found = dict[str, list[tuple[Array, str]]]


def _read(data: bytes, folder: Path) -> Found:
    """Return what GDAL finds, by layer: bounds of every feature, and its text."""
    file = folder / "drawing.dxf"
    file.write_bytes(data)
    about, _, _, (layer, text) = pyogrio.raw.read(file, columns=["Layer", "Text"])
    assert list(about["fields"]) == ["Layer", "Text"]
    _, bounds = pyogrio.read_bounds(file)
    found: Found = {}
    for n, name in enumerate(layer):
        # DXF of 2007 and later is UTF-8; GDAL takes it for Latin-1
        words = (text[n] or "").encode("latin-1").decode("utf-8")
        found.setdefault(name, []).append((bounds[:, n], words))
    return found


@pytest.mark.parametrize(("unit", "factor"), [("m", 1.0), ("mm", 1000.0)])
def test_another_program_finds_every_shape_in_its_place(tmp_path: Path, unit: str, factor: float) -> None:
    found = _read(shapes_dxf(_sketch().drawing("all", "All").shapes, unit), tmp_path)
    assert "water" not in " ".join(found).lower().replace("water", "", 1)
    for layer, box in (
        ("BODY", (-10.0, -2.4, 10.0, 1.2)),
        ("LINES", (-35.0, -12.0, -10.0, -2.4)),
        ("WATER", (-40.0, 0.0, 40.0, 0.0)),
    ):
        ((bounds, _),) = found[layer]
        np.testing.assert_allclose(bounds, factor * np.array(box), atol=1e-6 * factor)
    words = [text for entries in found.values() for _, text in entries if text]
    assert "重心 G" in words and "B = 20 m" in words and "d = 2.4 m" in words
    # the lines of a dimension reach from end to end
    reach = np.array([bounds for bounds, text in found["DIMENSIONS"] if not text])
    assert reach[:, 0].min() == pytest.approx(-10.0 * factor, rel=1e-6)
    assert {"AXES", "POINTS", "TEXT"} <= set(found)


def _cage(still: bool = True) -> Scene3D:
    """Return a small cage: two anchor lines, a collar, one panel of net, an anchor, a buoy."""
    place = np.array(
        [
            [-60.0, 0.0, -20.0],
            [-10.0, 5.0, 0.0],
            [10.0, 5.0, 0.0],
            [10.0, -5.0, -6.0],
            [70.0, 0.0, -20.0],
            [-35.0, 2.5, -9],
        ]
    )
    bars = np.array([[0, 5], [5, 1], [1, 2], [2, 4], [2, 3]])
    return Scene3D(
        np.array([0.0, 1.0]), np.stack([place, place + (0.0 if still else 1.0)]), bars, np.zeros((2, 5)),
        np.array([False, False, False, False, True]), (Faces(np.array([[1, 2, 3]]), "net", "net"),),
        (Marker(0, "anchor 1", "anchor"), Marker(4, "anchor 2", "anchor"), Marker(1, "buoy 1", "float", 1.5)),
        bed=-20.0, names=("line: seaward", "line: seaward", "collar", "shoreward", "net"), is_still=still,
    )  # fmt: skip


def _document(*scenes: Scene3D, language: str = "en") -> Document:
    views = tuple(animation_3d(f"view-{n + 1}", "The cage at rest", scene) for n, scene in enumerate(scenes))
    return Document("t", "", "converged", "", (Chapter("a", "A", views),), language=language)


@pytest.mark.parametrize(("unit", "factor"), [("m", 1.0), ("mm", 1000.0)])
def test_the_file_states_its_extent_and_opens_on_it(unit: str, factor: float) -> None:
    """LibreOffice scales by the extent of the head: without it words lay on one point and lines off the sheet."""
    drawing = ezdxf.read(io.StringIO(shapes_dxf(_sketch().drawing("all", "All").shapes, unit).decode()))
    low, high = np.array(drawing.header["$EXTMIN"]), np.array(drawing.header["$EXTMAX"])
    assert (low[:2] <= factor * np.array([-40.0, -12.0])).all() and (high[:2] >= factor * np.array([40.0, 1.2])).all()
    assert (high - low)[:2].max() < 100.0 * factor  # of a drawing of 80 m
    (view,) = drawing.viewports.get("*Active")
    assert np.allclose(np.array(view.dxf.center)[:2], 0.5 * (low + high)[:2], atol=1e-6 * factor)
    assert view.dxf.height >= (high - low)[1]


def test_a_structure_in_space_is_drawn_in_space_in_plan_and_in_elevation(tmp_path: Path) -> None:
    files = dict(document_dxf(_document(_cage()), "mm"))
    assert list(files) == ["view-1", "view-1-plan", "view-1-section"]
    space, plan, side = (_read(data, tmp_path) for data in files.values())
    roles = {"LINES", "ANCHORS", "NET", "FLOATERS", "WATER", "BED", "TEXT"}
    assert roles <= set(space) and roles | {"DIMENSIONS"} <= set(side)
    assert roles - {"WATER", "BED"} | {"DIMENSIONS"} <= set(plan)
    # bars that follow each other are one line; its plan is x, y and its elevation x, z
    seaward = next(bounds for bounds, _ in space["LINES"] if bounds[0] == -60e3)
    np.testing.assert_allclose(seaward, [-60e3, 0.0, -10e3, 5e3], atol=1e-3)
    assert [-60e3, 0.0, -10e3, 5e3] in [np.round(bounds, 3).tolist() for bounds, _ in plan["LINES"]]
    assert [-60e3, -20e3, -10e3, 0.0] in [np.round(bounds, 3).tolist() for bounds, _ in side["LINES"]]
    assert all(bounds[1] == bounds[3] == pytest.approx(-20e3) for bounds, _ in side["BED"])
    words = [text for entries in side.values() for _, text in entries if text]
    assert {"h = 20 m", "130 m", "anchor 1", "line: seaward", "buoy 1"} <= set(words)
    drawing = ezdxf.filemanagement.read(io.StringIO(files["view-1"].decode("utf-8")))
    assert not drawing.audit().errors
    assert {name for name, _ in drawing.groups} == {"line- seaward", "collar", "shoreward", "net"}


def test_moving_structures_are_drawn_where_none_stands_still() -> None:
    assert [key for key, _ in document_dxf(_document(_cage(False)), "m")] == ["view-1", "view-1-plan", "view-1-section"]
    both = [key for key, _ in document_dxf(_document(_cage(False), _cage()), "m")]
    assert both == ["view-2", "view-2-plan", "view-2-section"]


def test_words_are_those_of_the_language(tmp_path: Path) -> None:
    drawing = Sketch((-10.0, 10.0, -5.0, 5.0))
    drawing.label(10.0, 10.0, "waves of heading 0°", "start")
    drawing.dimension(1.0, 0.0, 1.0, 1.5, "freeboard 1.5 m", offset=10.0)
    sections = (Chapter("a", "A", (drawing.drawing("section", "Chapter"),)),)
    ((_, data),) = document_dxf(Document("t", "", "converged", "", sections, language="ja"), "m")
    words = {text for entries in _read(data, tmp_path).values() for _, text in entries if text}
    assert words == {said_in("ja", "waves of heading 0°"), said_in("ja", "freeboard 1.5 m")}
    assert not any(re.search("[A-Za-z]{2}", text.replace("DejaVu", "")) for text in words)
    assert b"msgothic.ttc" in data


def said_in(language: str, text: str) -> str:
    with spoken_in(language):
        return said(text)


@pytest.mark.slow
def test_a_breakwater_and_a_row_have_plan_and_section(tmp_path: Path) -> None:
    for template, extra in (("breakwater", {"WAVES"}), ("units", {"BODY"})):
        case = moyai.load_case(moyai.template(template)).replace("analyses", ["statics"])
        files = dict(document_dxf(moyai.run(case).document, "m"))
        plan = next(_read(data, tmp_path) for key, data in files.items() if key.endswith("-plan"))
        assert {"LINES", "ANCHORS", "BODY", "DIMENSIONS", "TEXT"} | (extra - {"WAVES"}) <= set(plan)
        assert any(key.endswith("-section") for key in files)
        side = next(_read(data, tmp_path) for key, data in files.items() if key.endswith("-elevation"))
        assert {"LINES", "ANCHORS", "BODY", "WATER", "BED", "DIMENSIONS", "TEXT"} <= set(side)


def test_the_plan_of_a_breakwater_is_to_scale_with_evenly_spaced_lines() -> None:
    lines = [LineInPlan("seaward", 2, -60.0, -5.0), LineInPlan("shoreward", 1, 55.0, 5.0)]
    shapes = unit_plan(UnitInPlan(-5.0, 5.0, 20.0, lines, [0.0, 0.0, math.pi / 2])).drawing("plan", "Plan").shapes
    strokes = [shape for shape in shapes if isinstance(shape, Stroke)]
    drawn = [shape.points.tolist() for shape in strokes if shape.style == "mooring"]
    assert drawn == [[[-60.0, -5.0], [-5.0, -5.0]], [[-60.0, 5.0], [-5.0, 5.0]], [[55.0, 0.0], [5.0, 0.0]]]
    (hull,) = (shape.points for shape in strokes if shape.style == "hull")
    assert np.ptp(hull, axis=0).tolist() == [10.0, 20.0]
    measured = {shape.text for shape in shapes if isinstance(shape, Distance)}
    assert measured == {"B = 10 m", "l = 20 m", "55 m", "50 m"}
    ways = [shape.points[1] - shape.points[0] for shape in strokes if shape.style == "wave"]
    assert [bool(step[0] > abs(step[1])) for step in ways] == [True, False] and ways[1][1] > 0.0
    words = {shape.text for shape in shapes if isinstance(shape, Words)}
    assert {"2 x seaward", "shoreward", "waves of heading 0°", "waves of heading 90°"} <= words


def test_faults_of_a_unit_are_reported() -> None:
    picture = Drawing("map", "Map", "<svg/>", "<svg/>")
    document = Document("t", "", "converged", "", (Chapter("a", "A", (picture,)),))
    assert document_dxf(document, "m") == ()
    with pytest.raises(InputError, match="is no unit of a drawing"):
        document_dxf(document, "inch")
