"""Drawings as DXF, read back by a program of other people: GDAL (pyogrio), which never saw the writer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyogrio
import pytest

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.report.document import Document, Drawing, Section
from moyai.report.dxf import document_dxf, shapes_dxf
from moyai.report.scene_3d import Scene3D, animation_3d
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
    assert "water" not in " ".join(found).lower().replace("water-level", "")
    for layer, box in (
        ("BODY", (-10.0, -2.4, 10.0, 1.2)),
        ("MOORING", (-35.0, -12.0, -10.0, -2.4)),
        ("WATER-LEVEL", (-40.0, 0.0, 40.0, 0.0)),
    ):
        ((bounds, _),) = found[layer]
        np.testing.assert_allclose(bounds, factor * np.array(box), atol=1e-6 * factor)
    words = [text for entries in found.values() for _, text in entries if text]
    assert "重心 G" in words and "B = 20 m" in words and "d = 2.4 m" in words
    # the lines of a dimension reach from end to end
    reach = np.array([bounds for bounds, text in found["DIMENSIONS"] if not text])
    assert reach[:, 0].min() == pytest.approx(-10.0 * factor, rel=1e-6)
    assert {"AXES", "POINTS", "TEXT"} <= set(found)


def test_a_structure_in_space_keeps_its_coordinates(tmp_path: Path) -> None:
    place = np.array([[0.0, 0.0, -20.0], [30.0, 40.0, 0.0], [30.0, 45.0, 0.0], [30.0, 45.0, -5.0]])
    bars = np.array([[0, 1], [1, 2]])
    still = Scene3D(
        np.array([0.0, 1.0]), np.stack([place, place]), bars, np.zeros((2, 2)),
        names=("line: seaward", "collar"), is_still=True,
    )  # fmt: skip
    found = _read(shapes_dxf(animation_3d("rest", "At rest", still).shapes, "m"), tmp_path)
    assert set(found) == {"line- seaward", "collar"}, "a colon is not allowed in the name of a layer"
    np.testing.assert_allclose(found["line- seaward"][0][0], [0.0, 0.0, 30.0, 40.0], atol=1e-9)
    moving = Scene3D(np.array([0.0, 1.0]), np.stack([place, place]), bars, np.zeros((2, 2)))
    assert not animation_3d("run", "Run", moving).shapes


def test_faults_of_a_unit_are_reported() -> None:
    picture = Drawing("map", "Map", "<svg/>", "<svg/>")
    document = Document("t", "", "converged", "", (Section("a", "A", (picture,)),))
    assert list(document_dxf(document, "m")) == []
    with pytest.raises(InputError, match="is no unit of a drawing"):
        list(document_dxf(document, "inch"))
