"""Structures in space over time for ParaView and its relatives: VTK files in plain XML, a file a moment, SI units."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, IntArray
from moyai.report.document import Animation, Document
from moyai.report.encoding import unique_slugs
from moyai.report.scene_3d import Scene3D

_TYPES = {"f": "Float64", "i": "Int64"}


def document_vtk(document: Document) -> Iterator[tuple[str, bytes]]:
    """Yield name and content of the VTK files of every structure in space of a document.

    Parameters
    ----------
    document : Document

    Yields
    ------
    str, bytes
        ``<key>.pvd``, which names the files and their times, ``<key>/0000.vtp`` and so on, and ``<key>/parts.csv``,
        which names the numbers of the cell data ``part``. Lines carry ``tension`` [N], faces ``load`` [N/m] where it is
        known.
    """
    shown = [(block, block.scene_3d) for block in document.blocks() if isinstance(block, Animation)]
    known = [(block, scene) for block, scene in shown if isinstance(scene, Scene3D)]
    for name, (_, scene) in zip(unique_slugs(block.key for block, _ in known), known, strict=True):
        rows = range(1) if scene.is_still else range(len(scene.time))
        files = [f"{name}/{row:04d}.vtp" for row in rows]
        yield f"{name}.pvd", _collection(files, [float(scene.time[row]) for row in rows])
        yield f"{name}/parts.csv", _part_names(scene)
        for file, row in zip(files, rows, strict=True):
            yield file, frame_vtp(scene, row)


def frame_vtp(scene: Scene3D, row: int) -> bytes:
    """Return one moment of a scene as VTK PolyData: bars as lines, faces and bodies as polygons.

    Parameters
    ----------
    scene : Scene3D
    row : int
        Of its times.
    """
    points = [np.asarray(scene.position[row], dtype=float)]
    polygons: list[Sequence[int]] = []
    loads: list[float] = []
    parts = [*_bar_parts(scene)]
    for number, face in enumerate(scene.faces):
        corners = np.asarray(face.nodes)
        polygons += corners.tolist()
        loads += [0.0] * len(corners) if face.load is None else np.nan_to_num(face.load[row]).tolist()
        parts += [_first_of_faces(scene) + number] * len(corners)
    count = len(points[0])
    for number, body in enumerate(scene.bodies):
        points.append(body.origin[row] + np.asarray(body.vertices) @ np.asarray(body.rotation[row]).T)
        polygons += [[count + int(corner) for corner in face] for face in body.faces]
        loads += [0.0] * len(body.faces)
        parts += [_first_of_faces(scene) + len(scene.faces) + number] * len(body.faces)
        count += len(points[-1])
    tension = np.nan_to_num(scene.tension[row])
    return _polydata(
        np.concatenate(points),
        scene.bars,
        polygons,
        {
            "tension": np.concatenate([tension, np.zeros(len(polygons))]),
            "load": np.concatenate([np.zeros(len(tension)), np.asarray(loads, dtype=float)]),
            "part": np.asarray(parts, dtype=np.int64),
        },
    )


def _lines(scene: Scene3D) -> list[str]:
    return list(dict.fromkeys(scene.names)) or ["bars"]


def _bar_parts(scene: Scene3D) -> list[int]:
    names = _lines(scene)
    return [names.index(name) for name in scene.names] if scene.names else [0] * len(scene.bars)


def _first_of_faces(scene: Scene3D) -> int:
    return len(_lines(scene))


def _part_names(scene: Scene3D) -> bytes:
    names = [*_lines(scene), *(face.name for face in scene.faces), *(body.name for body in scene.bodies)]
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows([("part", "name"), *enumerate(names)])
    return stream.getvalue().encode("utf-8")


def _collection(files: Sequence[str], times: Sequence[float]) -> bytes:
    sets = "".join(
        f'<DataSet timestep="{time:.9g}" part="0" file={quoteattr(file)}/>\n'
        for file, time in zip(files, times, strict=True)
    )
    return _file("Collection", f"<Collection>\n{sets}</Collection>\n")


def _polydata(points: Array, lines: IntArray, polygons: Sequence[Sequence[int]], cells: dict[str, Array]) -> bytes:
    fields = "".join(_array(values, name) for name, values in cells.items())
    return _file(
        "PolyData",
        f'<PolyData>\n<Piece NumberOfPoints="{len(points)}" NumberOfVerts="0" NumberOfLines="{len(lines)}" '
        f'NumberOfStrips="0" NumberOfPolys="{len(polygons)}">\n'
        f'<CellData Scalars="tension">\n{fields}</CellData>\n'
        f"<Points>\n{_array(points.ravel(), 'points', 3)}</Points>\n"
        f"<Lines>\n{_cells(lines.tolist())}</Lines>\n<Polys>\n{_cells(polygons)}</Polys>\n</Piece>\n</PolyData>\n",
    )


def _cells(corners: Sequence[Sequence[int]]) -> str:
    flat = [int(node) for cell in corners for node in cell]
    ends = np.cumsum([len(cell) for cell in corners], dtype=np.int64)
    return _array(np.asarray(flat, dtype=np.int64), "connectivity") + _array(ends, "offsets")


def _array(values: ArrayLike, name: str, components: int = 1) -> str:
    array = np.asarray(values)
    kind = "i" if array.dtype.kind in "iu" else "f"
    written: Iterable[str] = map(str, array.tolist()) if kind == "i" else (f"{value:.9g}" for value in array.tolist())
    size = f' NumberOfComponents="{components}"' if components > 1 else ""
    return f'<DataArray type="{_TYPES[kind]}" Name="{name}"{size} format="ascii">\n{" ".join(written)}\n</DataArray>\n'


def _file(kind: str, content: str) -> bytes:
    text = (
        f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian">\n{content}</VTKFile>\n'
    )
    return text.encode("utf-8")
