"""Structures in space as VTK: read back by the XML parser of Python, cell by cell."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from moyai.report.animation_3d import animation_3d
from moyai.report.document import Chapter, Document
from moyai.report.scene_3d import Body3D, Faces, Scene3D
from moyai.report.vtk import document_vtk, frame_vtp
from moyai.report.writer import write_report


def scene(still: bool = False) -> Scene3D:
    """Return two lines, a sheet and a turned box over three moments."""
    rng = np.random.default_rng(5)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    box = Body3D.box("box", (-1.0, -2.0, -0.5), (1.0, 2.0, 0.5), rng.normal(size=(3, 3)), np.stack([turn] * 3))
    return Scene3D(
        np.array([0.0, 0.5, 1.25]), rng.normal(size=(3, 5, 3)), np.array([[0, 1], [1, 2], [3, 4]]),
        np.array([[10.0, 20.0, np.nan], [11.0, 21.0, 31.0], [12.0, 22.0, 32.0]]),
        faces=(Faces(np.array([[0, 1, 2]]), "sheet", load=np.array([[1.0], [2.0], [3.0]])),), bodies=(box,),
        names=("rope", "rope", "chain <a>"), is_still=still,
    )  # fmt: skip


def arrays(data: bytes) -> dict[str, np.ndarray]:
    """Return every array of a file by the group that holds it and its name."""
    root = ElementTree.fromstring(data)
    assert root.attrib["type"] == "PolyData"
    (piece,) = root.iter("Piece")
    found = {}
    for group in piece:
        for item in group:
            found[f"{group.tag}/{item.attrib['Name']}"] = np.array((item.text or "").split(), dtype=float)
    found["count"] = np.array([int(piece.attrib[f"NumberOf{name}"]) for name in ("Points", "Lines", "Polys")])
    return found


def test_a_moment_holds_nodes_bars_faces_and_bodies() -> None:
    given = scene()
    found = arrays(frame_vtp(given, 1))
    np.testing.assert_array_equal(found["count"], [5 + 8, 3, 1 + 6])
    points = found["Points/points"].reshape(-1, 3)
    np.testing.assert_allclose(points[:5], given.position[1], rtol=1e-8)
    box = given.bodies[0]
    np.testing.assert_allclose(points[5:], box.vertices @ box.rotation[1].T + box.origin[1], rtol=1e-8, atol=1e-8)
    np.testing.assert_array_equal(found["Lines/connectivity"].reshape(-1, 2), given.bars)
    np.testing.assert_array_equal(found["Lines/offsets"], [2, 4, 6])
    np.testing.assert_array_equal(found["Polys/offsets"], [3, *range(7, 28, 4)])
    assert found["Polys/connectivity"].max() == 12
    np.testing.assert_array_equal(found["CellData/tension"], [11.0, 21.0, 31.0, *[0.0] * 7])
    np.testing.assert_array_equal(found["CellData/load"], [0.0, 0.0, 0.0, 2.0, *[0.0] * 6])
    np.testing.assert_array_equal(found["CellData/part"], [0, 0, 1, 2, *[3] * 6])
    assert np.isfinite(arrays(frame_vtp(given, 0))["CellData/tension"]).all()  # what is not known is zero


def test_the_collection_names_every_moment(tmp_path: Path) -> None:
    blocks = (animation_3d("a run", "A run", scene()), animation_3d("rest", "At rest", scene(still=True)))
    document = Document("t", "", "converged", "", (Chapter("s", "S", blocks),))
    files = dict(document_vtk(document))
    sets = list(ElementTree.fromstring(files["a-run.pvd"]).iter("DataSet"))
    assert [float(item.attrib["timestep"]) for item in sets] == [0.0, 0.5, 1.25]
    assert all(item.attrib["file"] in files for item in sets)
    assert len(list(ElementTree.fromstring(files["rest.pvd"]).iter("DataSet"))) == 1
    parts = list(csv.reader(io.StringIO(files["a-run/parts.csv"].decode())))
    assert parts == [["part", "name"], ["0", "rope"], ["1", "chain <a>"], ["2", "sheet"], ["3", "box"]]


def test_the_library_of_vtk_reads_a_moment(tmp_path: Path) -> None:
    """The reader that ParaView uses, where it is installed."""
    reading = pytest.importorskip("vtkmodules.vtkIOXML")
    numpy_support = pytest.importorskip("vtkmodules.util.numpy_support")
    given = scene()
    (tmp_path / "0001.vtp").write_bytes(frame_vtp(given, 1))
    reader = reading.vtkXMLPolyDataReader()
    reader.SetFileName(str(tmp_path / "0001.vtp"))
    reader.Update()
    found = reader.GetOutput()
    assert (found.GetNumberOfPoints(), found.GetNumberOfLines(), found.GetNumberOfPolys()) == (5 + 8, 3, 1 + 6)
    points = numpy_support.vtk_to_numpy(found.GetPoints().GetData())
    np.testing.assert_allclose(points[:5], given.position[1], rtol=1e-8)
    tension = numpy_support.vtk_to_numpy(found.GetCellData().GetArray("tension"))
    np.testing.assert_allclose(tension[:3], [11.0, 21.0, 31.0])


def test_a_report_without_structures_in_space_is_written_all_the_same(tmp_path: Path) -> None:
    from small_results import pontoon, without

    files = write_report(without(pontoon(), "/time"), tmp_path, vtk=True)
    assert files and not any(path.suffix in (".pvd", ".vtp") for path in files)


@pytest.mark.slow
def test_the_command_says_what_there_was_no_file_for(tmp_path: Path) -> None:
    from small_results import pontoon, without
    from typer.testing import CliRunner

    from moyai.cli.main import app

    without(pontoon(), "/time").write(tmp_path / "results.nc")
    ran = CliRunner().invoke(app, ["report", str(tmp_path / "results.nc"), "--vtk", "--xlsx", "--json"])
    assert ran.exit_code == 0, ran.output
    assert "no structure in space" in ran.output + ran.stderr
    assert (tmp_path / "report.xlsx").exists()
