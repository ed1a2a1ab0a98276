"""The 3-D view in a real browser: no error, it turns, zooms, seeks and plays, large nets stay quick."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from chromium_pipe import Chromium, find_chromium

from moyai.report.animation_3d import animation_3d
from moyai.report.document import Chapter, Document
from moyai.report.html import render_html
from moyai.report.scene_3d import Faces, Marker, Scene3D, Trace, Waves3D, frame_rows

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(find_chromium() is None, reason="Chromium is not installed (set MOYAI_CHROMIUM to its path)"),
]
PLAYER = "MOYAI.players[0]"
COLOURS = (
    f"(() => {{ const p = {PLAYER}, pen = p.canvas.getContext('2d'); "
    "const data = pen.getImageData(0, 0, p.canvas.width, p.canvas.height).data, seen = new Set(); "
    "for (let i = 0; i < data.length; i += 16) seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]); "
    "return seen.size; })()"
)


def net_scene(side: int, frames: int) -> Scene3D:
    """A net of ``side`` x ``side`` knots that waves in a current."""
    time = np.linspace(0.0, 12.0, frames)
    u, v = np.meshgrid(np.linspace(0.0, 20.0, side), np.linspace(0.0, 12.0, side))
    phase = 2.0 * np.pi * time[:, None, None] / 6.0
    x = 0.3 * v * (1.0 + 0.3 * np.sin(phase - 0.2 * u))
    place = np.stack([x, np.broadcast_to(u, x.shape), np.broadcast_to(-1.0 - v, x.shape)], axis=3)
    number = np.arange(side * side).reshape(side, side)
    bars = np.concatenate([
        np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1),
        np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1),
    ])  # fmt: skip
    tension = 100.0 * np.abs(np.sin(time[:, None] + bars[None, :, 0])) - 20.0
    quads = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=2).reshape(-1, 4)
    return Scene3D(
        time, place.reshape(frames, -1, 3), bars, tension, np.ones(len(bars), dtype=bool),
        faces=(Faces(quads[: side // 2], "sheet"), Faces(quads[side:], "net", "net")),
        markers=(Marker(0, "corner", "anchor"), Marker(side * side - 1, "sinker", "clump", 0.6)),
        traces=(Trace("net", time, tension.max(axis=1), 0),),
        waves=Waves3D(*(np.array([value]) for value in (0.8, 1.05, 0.112, 0.3, 0.0)), 3.0), bed=-20.0,
        current=(0.5, 0.1), names=("net",) * len(bars),
    )  # fmt: skip


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chromium]:
    # 3025 nodes, 5940 bars
    scene = net_scene(55, 60)
    sections = (Chapter("view", "View", (animation_3d("net", "A large net", scene, "Caption"),)),)
    target = Path(tmp_path_factory.mktemp("scene")) / "report.html"
    target.write_text(render_html(Document("Net", "Network", "converged", "", sections)), encoding="utf-8")
    assert target.stat().st_size < 6_000_000
    with Chromium(str(find_chromium()), 1280, 1000) as browser:
        browser.open(target)
        yield browser


@pytest.fixture(autouse=True)
def no_errors(page: Chromium) -> Iterator[None]:
    yield
    page.evaluate("1")
    assert page.errors == []


def test_every_view_is_painted(page: Chromium) -> None:
    for view in ("3-D", "Side", "End", "Plan"):
        page.evaluate(f"{PLAYER}.view = '{view}'; {PLAYER}.repaint()")
        assert page.evaluate(COLOURS) > 60
    page.evaluate(f"{PLAYER}.view = '3-D'; {PLAYER}.painter.home()")


def test_places_between_frames_follow_the_motion(page: Chromium) -> None:
    scene = net_scene(55, 60)
    at = 0.5 * (scene.time[20] + scene.time[21])
    shown = page.evaluate(f"{PLAYER}.painter.seek({at}), [...{PLAYER}.painter.place.slice(9060, 9066)]")
    # the same motion, finely
    fine = net_scene(55, 119)
    row = int(np.argmin(np.abs(fine.time - at)))
    assert np.allclose(shown, fine.position[row].ravel()[9060:9066], atol=2e-3)


def test_it_turns_moves_and_zooms_about_the_pointer(page: Chromium) -> None:
    before = page.evaluate(f"[{PLAYER}.painter.yaw, {PLAYER}.painter.pitch]")
    page.evaluate(f"{PLAYER}.painter.turn(80, 30); {PLAYER}.repaint()")
    after = page.evaluate(f"[{PLAYER}.painter.yaw, {PLAYER}.painter.pitch]")
    assert abs(after[0] - before[0]) > 0.5 and abs(after[1] - before[1]) > 0.1
    place = (
        f"(() => {{ const q = {PLAYER}.painter, s = q.screen, spot = [s[30], s[31]]; q.zoomBy(1.7, spot); "
        f"{PLAYER}.repaint(); return [spot, [s[30], s[31]]]; }})()"
    )
    spot, moved = page.evaluate(place)
    # perspective aside, what is under the pointer stays there
    assert np.allclose(spot, moved, atol=0.5)
    page.evaluate(f"{PLAYER}.painter.home()")


def test_surface_follows_the_waves(page: Chromium) -> None:
    for t in (1.0, 5.0):
        grown = 1.0 if t >= 3.0 else 0.5 * (1.0 - np.cos(np.pi * t / 3.0))
        x, y = 3.0, 7.0
        wanted = grown * 0.8 * np.cos(0.112 * (x * np.cos(0.3) + y * np.sin(0.3)) - 1.05 * t)
        assert page.evaluate(f"{PLAYER}.painter.elevation({x}, {y}, {t})") == pytest.approx(wanted, abs=1e-6)


def test_the_pointer_finds_a_bar_and_the_trace_seeks(page: Chromium) -> None:
    found = page.evaluate(
        f"(() => {{ const q = {PLAYER}.painter, s = q.screen, b = q.bars, i = 3 * b[200], j = 3 * b[201]; "
        f"q.pointAt([0.5 * (s[i] + s[j]), 0.5 * (s[i + 1] + s[j + 1])]); return q.hover !== null; }})()"
    )
    assert found
    page.evaluate(
        f"(() => {{ const q = {PLAYER}.painter, c = {PLAYER}.canvas, r = c.getBoundingClientRect(); "
        "const [x, y, w, h] = q.strip; "
        "c.dispatchEvent(new PointerEvent('pointerdown', { pointerId: 1, clientX: r.left + x + 0.25 * w, "
        "clientY: r.top + y + 0.5 * h, bubbles: true })); })()"
    )
    assert page.evaluate(f"{PLAYER}.t") == pytest.approx(3.0, abs=0.1)


@pytest.mark.slow
def test_a_frame_of_three_thousand_nodes_is_quick(page: Chromium) -> None:
    spent = page.evaluate(
        f"(() => {{ const p = {PLAYER}; const began = performance.now(); "
        "for (let k = 0; k < 8; k++) { p.t = k; p.repaint(); } return (performance.now() - began) / 8; })()"
    )
    # a software canvas on a shared core; 60 ms still plays
    assert spent < 150.0


@pytest.mark.slow
def test_rows_of_frames_fit_their_budget() -> None:
    rows = frame_rows(np.arange(0.0, 100.0, 0.01), nodes=3025, bars=5940)
    assert 100 < rows.size < 400
