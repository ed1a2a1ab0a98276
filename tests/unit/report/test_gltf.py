"""Structures in space as glTF: read back by pygltflib and trimesh, which never saw the writer."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_vtk import scene
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.report.animation_3d import animation_3d
from moyai.report.document import Chapter, Document
from moyai.report.gltf import MOMENTS, SHAPES, TUBES, document_gltf, scene_glb
from moyai.report.scene_3d import Faces, Scene3D, Waves3D

Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def loaded(data: bytes) -> Any:
    """Return what pygltflib reads."""
    return pytest.importorskip("pygltflib").GLTF2.load_from_bytes(data)


def numbers(file: Any, accessor: int) -> np.ndarray:
    """Return the numbers of an accessor."""
    at = file.accessors[accessor]
    view = file.bufferViews[at.bufferView]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[at.type]
    kind = {5126: np.float32, 5125: np.uint32}[at.componentType]
    found = np.frombuffer(file.binary_blob(), kind, at.count * width, (view.byteOffset or 0) + (at.byteOffset or 0))
    found = found.reshape(-1, width)
    np.testing.assert_array_equal(found.min(axis=0), np.array(at.min, dtype=kind))
    np.testing.assert_array_equal(found.max(axis=0), np.array(at.max, dtype=kind))
    return found


def moved(file: Any, node: int) -> dict[str, np.ndarray]:
    """Return the values along which a node is moved, by their path."""
    (animation,) = file.animations
    return {
        channel.target.path: numbers(file, animation.samplers[channel.sampler].output)
        for channel in animation.channels
        if channel.target.node == node
    }


def test_bars_are_tubes_between_their_ends_at_every_moment() -> None:
    from scipy.spatial.transform import Rotation

    given = scene()
    file = loaded(scene_glb(given, "a run"))
    (animation,) = file.animations
    for sampler in animation.samplers:
        np.testing.assert_allclose(numbers(file, sampler.input).ravel(), given.time, rtol=1e-6)
    tubes = [number for number, node in enumerate(file.nodes) if node.name in ("rope", "chain <a>")]
    assert [file.nodes[number].name for number in tubes] == ["rope", "rope", "chain <a>"]
    for bar, number in enumerate(tubes):
        way = moved(file, number)
        for row in range(3):
            tip = Rotation.from_quat(way["rotation"][row]).apply([0.0, 0.0, way["scale"][row, 2]])
            start, end = given.position[row][given.bars[bar]]
            np.testing.assert_allclose(way["translation"][row], start, atol=1e-5)
            np.testing.assert_allclose(way["translation"][row] + tip, end, atol=1e-5)


def test_bodies_turn_and_sheets_pass_through_their_shapes() -> None:
    from scipy.spatial.transform import Rotation

    given = scene()
    file = loaded(scene_glb(given))
    names = [node.name for node in file.nodes]
    box = moved(file, names.index("box"))
    np.testing.assert_allclose(
        Rotation.from_quat(box["rotation"][1]).as_matrix(), given.bodies[0].rotation[1], atol=1e-6
    )
    np.testing.assert_allclose(box["translation"], given.bodies[0].origin, atol=1e-5)
    at = names.index("sheet")
    primitive = file.meshes[file.nodes[at].mesh].primitives[0]
    base = numbers(file, primitive.attributes.POSITION)
    targets = [numbers(file, target["POSITION"]) for target in primitive.targets]
    weights = moved(file, at)["weights"].reshape(3, 2)
    for row in range(3):
        shape = base + sum(weight * step for weight, step in zip(weights[row], targets, strict=True))
        np.testing.assert_allclose(shape, given.position[row][:3], atol=1e-5)


def test_a_second_reader_places_everything_with_y_up() -> None:
    trimesh = pytest.importorskip("trimesh")
    given = scene(still=True)
    data = scene_glb(given)
    assert "animations" not in json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    read = trimesh.load(io.BytesIO(data), file_type="glb")
    points = {
        name: trimesh.transform_points(read.geometry[geometry].vertices, read.graph.get(name)[0])
        for name in read.graph.nodes_geometry
        for geometry in [read.graph.get(name)[1]]
    }
    box = given.bodies[0]
    corners = (box.vertices @ box.rotation[0].T + box.origin[0]) @ Y_UP.T
    np.testing.assert_allclose(np.unique(points["box"], axis=0), np.unique(corners, axis=0), atol=1e-5)
    np.testing.assert_allclose(points["sheet"], given.position[0][:3] @ Y_UP.T, atol=1e-5)


@pytest.mark.slow
def test_waves_move_the_water_and_long_runs_are_thinned() -> None:
    count, bars = 2000, 1500
    time = np.linspace(0.0, 100.0, count)
    place = np.zeros((count, bars + 1, 3))
    place[..., 0] = np.linspace(0.0, 30.0, bars + 1)
    wave = Waves3D(*(np.array([value]) for value in (0.5, 1.0, 0.1, 0.0, 0.0)))
    run = Scene3D(
        time, place, np.stack([np.arange(bars), np.arange(1, bars + 1)], axis=1), np.ones((count, bars)),
        np.arange(bars) >= 40, (Faces(np.array([[0, 1, 2, 3]]), "net", "net"),), waves=wave, window=(10.0, 60.0),
    )  # fmt: skip
    file = loaded(scene_glb(run))
    assert sum(node.name == "bar" for node in file.nodes) == 40 < TUBES  # the twines are left to the faces
    (animation,) = file.animations
    clocks = [numbers(file, sampler.input).ravel() for sampler in animation.samplers]
    assert max(map(len, clocks)) <= MOMENTS
    assert all(clock[0] == 0.0 and clock[-1] == pytest.approx(50.0, abs=0.1) for clock in clocks)
    water = next(node for node in file.nodes if node.name == "water")
    primitive = file.meshes[water.mesh].primitives[0]
    assert len(primitive.targets) == SHAPES - 1
    rest = numbers(file, primitive.attributes.POSITION)
    np.testing.assert_allclose(rest[:, 2], 0.5 * np.cos(0.1 * rest[:, 0] - run.time[run.time >= 10.0][0]), atol=1e-5)


def test_files_are_named_by_their_views() -> None:
    blocks = (animation_3d("a run", "A run", scene()), animation_3d("rest", "At rest", scene(still=True)))
    files = dict(document_gltf(Document("t", "", "converged", "", (Chapter("s", "S", blocks),))))
    assert list(files) == ["a-run.glb", "rest.glb"]
    assert all(data[:4] == b"glTF" and int.from_bytes(data[8:12], "little") == len(data) for data in files.values())


@pytest.mark.slow
def test_commands_write_them_or_say_that_there_are_none(tmp_path: Path) -> None:
    from small_results import pontoon

    import moyai

    case = moyai.load_case(moyai.template("network")).replace("analyses", ["statics"])
    moyai.run(case).write(tmp_path / "net" / "results.nc")
    for words in (
        ["report", str(tmp_path / "net"), "--gltf", "-q"],
        ["convert", str(tmp_path / "net"), "--to", "gltf"],
    ):
        ran = CliRunner().invoke(app, words)
        assert ran.exit_code == 0, ran.output
    (one,), (two,) = ((tmp_path / "net" / name).glob("*.glb") for name in ("report_gltf", "gltf"))
    assert one.read_bytes() == two.read_bytes()
    pontoon().write(tmp_path / "plane" / "results.nc")
    ran = CliRunner().invoke(app, ["report", str(tmp_path / "plane"), "--gltf", "-q"])
    assert ran.exit_code == 0 and "--gltf: the report shows no structure in space" in ran.output + ran.stderr
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "plane"), "--to", "gltf", "--json"])
    assert ran.exit_code == 2 and "no structure in space" in json.loads(ran.stdout)["faults"][0]["message"]
