"""Scenes of the 3-D player: what is packed is what was given, frames hit the moments, stills hold all parts."""

import base64
import math
import re

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.report.animation_3d import animation_3d
from moyai.report.scene_3d import (
    Body3D,
    Faces,
    Marker,
    Scene3D,
    Surface3D,
    Trace,
    Waves3D,
    frame_rows,
    home_view,
    scene_3d,
)
from moyai.report.still_3d import still_3d


def random_scene(rng, frames=12, nodes=9, **more):
    time = np.cumsum(rng.uniform(0.1, 1.0, frames))
    position = rng.normal(0.0, 20.0, (frames, nodes, 3))
    bars = np.stack([np.arange(nodes - 1), np.arange(1, nodes)], axis=1)
    tension = rng.uniform(-1.0, 5e4, (frames, nodes - 1))
    return Scene3D(time, position, bars, tension, **more)


def unpack(coded, count):
    integers = np.frombuffer(base64.b64decode(coded["i2"]), dtype="<i2").astype(float)
    return (np.array(coded["offset"]) + np.array(coded["step"]) * integers.reshape(-1, 3)).reshape(-1, count, 3)


def test_places_and_tensions_survive_the_packing():
    rng = np.random.default_rng(5)
    for _ in range(8):
        scene = random_scene(rng, frames=int(rng.integers(2, 30)), nodes=int(rng.integers(2, 40)))
        packed = scene_3d(scene)
        places = unpack(packed["nodes"], packed["nodes"]["count"])
        extent = np.ptp(scene.position, axis=(0, 1)).max()
        assert np.abs(places - scene.position).max() < extent / 60000.0
        levels = np.frombuffer(base64.b64decode(packed["tension"]["u1"]), dtype=np.uint8).reshape(scene.tension.shape)
        assert ((levels == 0) == (scene.tension <= 0.0)).all()
        shown = (levels.astype(float) - 1.0) / 254.0 * packed["scale"]
        taut = scene.tension > 0.0
        assert np.abs(shown - scene.tension)[taut].max() < packed["scale"] / 400.0


def test_frames_hit_the_moments_and_keep_to_their_budget():
    time = np.arange(0.0, 600.0, 0.01)
    rows = frame_rows(time, nodes=3000, bars=5900, window=(300.0, 330.0), moments=(317.77, math.nan))
    assert rows.size < 250
    assert 31777 in rows
    assert {0, time.size - 1} <= set(rows.tolist())
    assert (np.diff(rows) > 0).all()
    inside = ((time[rows] >= 300.0) & (time[rows] <= 330.0)).sum()
    assert inside > 0.5 * rows.size
    assert np.array_equal(frame_rows(time[:50], nodes=3, bars=2), np.arange(50))


def test_waves_keep_their_energy_when_components_are_dropped():
    rng = np.random.default_rng(1)
    amplitude = rng.uniform(0.0, 1.0, 300)
    waves = Waves3D(amplitude, *(rng.uniform(0.1, 2.0, 300) for _ in range(4)))
    packed = scene_3d(random_scene(rng, waves=waves))["waves"]
    kept = np.frombuffer(base64.b64decode(packed["amplitude"]["f4"]), dtype="<f4")
    assert kept.size == 60
    assert (kept.astype(float) ** 2).sum() == pytest.approx((amplitude**2).sum(), rel=1e-5)


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"time": np.array([0.0, 0.0])}, "time"),
        ({"position": np.full((2, 3, 3), np.nan)}, "position"),
        ({"tension": np.zeros((3, 2))}, "tension"),
        ({"bars": np.zeros((5, 2), dtype=int)}, "bars"),
        ({"names": ("one",)}, "names"),
    ],
)
def test_scenes_that_do_not_fit_are_refused(change, what):
    good = {
        "time": np.array([0.0, 1.0]), "position": np.zeros((2, 3, 3)), "bars": np.array([[0, 1], [1, 2]]),
        "tension": np.zeros((2, 2)),
    }  # fmt: skip
    Scene3D(**good)
    with pytest.raises(InputError, match=what):
        Scene3D(**{**good, **change})


def test_the_still_draws_every_part():
    rng = np.random.default_rng(2)
    turn = np.repeat(np.eye(3)[None], 12, axis=0)
    scene = random_scene(
        rng, faces=(Faces([[0, 1, 2], [2, 3, 4]], "skirt"), Faces([[4, 5, 6, 7]], "net", "net")),
        markers=(Marker(0, "anchor", "anchor"), Marker(3, "float", "float", 2.0), Marker(8, "vessel", "driven")),
        bodies=(Body3D.box("box", (-1, -2, -3), (1, 2, 3), np.zeros((12, 3)), turn),), bed=-70.0,
        traces=(Trace("line", np.arange(5.0), np.array([0.0, 1.0, 9e4, 2.0, 0.0])),),
        waves=Surface3D(np.linspace(-50, 50, 20), rng.normal(size=(12, 20))),
    )  # fmt: skip
    svg = still_3d(scene)
    assert svg.count("<path") > 8 + 3 + 6
    assert svg.count("<circle") == 2
    assert "90.0 kN" in svg
    numbers = [float(value) for value in re.findall(r"-?\d+\.\d+", svg)]
    assert np.isfinite(numbers).all()
    block = animation_3d("key", "Title", scene)
    assert block.scene["kind"] == "scene-3d"
    # the trace's peak governs, and the frame nearest to it is shown
    assert block.scene["maximum"] == 2.0


def test_the_first_view_looks_across_the_longer_side():
    yaw, pitch = home_view(np.zeros(3), np.array([100.0, 5.0, 10.0]))
    assert abs(math.cos(yaw)) > 0.8
    yaw, pitch = home_view(np.zeros(3), np.array([5.0, 100.0, 10.0]))
    assert abs(math.sin(yaw)) > 0.8
    assert 0.0 < pitch < 1.0
