"""The report of a curtain in a real browser: no error, every figure drawn, the snap plays in its views."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from chromium_pipe import Chromium, find_chromium
from small_results import curtain

from moyai.core.results import Result
from moyai.report.writer import write_report

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(find_chromium() is None, reason="Chromium is not installed (set MOYAI_CHROMIUM to its path)"),
]
#: Of the case [m].
SPAN = 20.0
PLAYER = "MOYAI.players.find((player) => MOYAI.isVisible(player.holder))"
DIFFERENT = (
    f"(() => {{ const p = {PLAYER}, pen = p.canvas.getContext('2d'); "
    "const data = pen.getImageData(0, 0, p.canvas.width, p.canvas.height).data, seen = new Set(); "
    "for (let i = 0; i < data.length; i += 4) seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]); "
    "return seen.size; })()"
)


@pytest.fixture(scope="module")
def result() -> Result:
    return curtain()


@pytest.fixture(scope="module")
def page(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chromium]:
    report = write_report(result, tmp_path_factory.mktemp("curtain"))[0]
    with Chromium(str(find_chromium()), 1280, 1000) as browser:
        browser.open(report)
        yield browser


@pytest.fixture(autouse=True)
def no_errors(page: Chromium) -> Iterator[None]:
    yield
    page.evaluate("1")
    assert page.errors == []


@pytest.mark.slow
def test_it_asks_nothing_of_the_network(page: Chromium) -> None:
    assert [address for address in page.requests if not address.startswith(("file:", "data:", "blob:"))] == []


def test_every_visible_figure_is_drawn(page: Chromium) -> None:
    state = page.evaluate(
        "[...MOYAI.figures.values()].map((f) => [f.spec.title, MOYAI.isVisible(f.plot), f.drawn, "
        "f.plot.querySelectorAll('.trace path.js-line, .trace path.point, .barlayer path').length])"
    )
    visible = [entry for entry in state if entry[1]]
    assert len(visible) >= 10
    assert all(drawn and marks > 0 for _, _, drawn, marks in visible), visible


def test_snap_is_painted_in_every_view(page: Chromium) -> None:
    seen = set()
    for _ in range(3):
        seen.add(page.evaluate(f"{PLAYER}.view"))
        assert page.evaluate(DIFFERENT) > 30
        page.evaluate(f"{PLAYER}.nextView()")
    assert seen == {"Section and plan", "Section", "Plan"}


@pytest.mark.slow
def test_snap_opens_at_the_spike_and_is_slack_before(page: Chromium, result: Result) -> None:
    snap = result.tree["/HWL/impact/snap"]
    peak = float(snap["frame_tension"].max())
    rows = page.evaluate(f"{PLAYER}.painter.readouts({PLAYER}.scene.start)")
    assert rows[0]["value"] == f"{peak / 1e3:.1f} kN"
    assert rows[1]["label"] == "mid-span downstream"
    slack = page.evaluate(f"{PLAYER}.painter.readouts({PLAYER}.painter.times[2])")
    assert slack[0]["value"].startswith("0 ")


@pytest.mark.slow
def test_frames_between_the_stored_ones_follow_the_shape(page: Chromium, result: Result) -> None:
    """Unpacked and interpolated plan at a stored time: within half a per cent of its span of the result."""
    snap = result.tree["/HWL/impact/snap"]
    for frame in (10, 80, 120):
        time = float(snap["frame_time"][frame])
        shape = page.evaluate(
            f"(() => {{ const p = {PLAYER}.painter; return [...p.plan.at(MOYAI.placeInTime(p.times, {time!r}))]; }})()"
        )
        count = snap.sizes["plan_point"]
        stored = [*snap["frame_plan_x"].values[frame], *snap["frame_plan_y"].values[frame]]
        assert len(shape) == 2 * count
        assert max(abs(a - b) for a, b in zip(shape, stored, strict=True)) < 0.005 * SPAN


@pytest.mark.slow
def test_other_water_level_and_keyboard(page: Chromium) -> None:
    page.evaluate("MOYAI.choose('water-level', 'LWL (+0.00 m)')")
    assert page.evaluate(DIFFERENT) > 30
    page.evaluate(f"{PLAYER}.toggle()")
    assert page.evaluate(f"{PLAYER}.playing") is True
    page.evaluate(f"{PLAYER}.pause()")
    page.evaluate("MOYAI.choose('water-level', 'HWL (+1.20 m)')")
