"""The report in a real browser: no error, everything drawn, data handed out, player, dark, print."""

from __future__ import annotations

import csv
import io
import os
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from chromium_pipe import Chromium, find_chromium
from scipy.interpolate import CubicSpline
from small_results import entitled, pontoon

from moyai.core.results import Result
from moyai.report.writer import write_report

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(find_chromium() is None, reason="Chromium is not installed (set MOYAI_CHROMIUM to its path)"),
]
BODY = ("sway", "heave", "roll")
VISIBLE_PLAYER = "MOYAI.players.find((player) => MOYAI.isVisible(player.holder))"


@pytest.fixture(scope="module")
def result() -> Result:
    return pontoon()


@pytest.fixture(scope="module")
def page(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chromium]:
    folder = tmp_path_factory.mktemp("report")
    report = write_report(result, folder)[0]
    with Chromium(str(find_chromium()), 1280, 1000) as browser:
        browser.report = report  # type: ignore[attr-defined]
        browser.open(report)
        yield browser


@pytest.fixture(autouse=True)
def no_errors(page: Chromium) -> Iterator[None]:
    yield
    page.evaluate("1")
    assert page.errors == []


def press(page: Chromium, key: str, **more: object) -> None:
    text = {"text": key} if len(key) == 1 else {}
    page.send("Input.dispatchKeyEvent", type="keyDown", key=key, **text, **more)
    page.send("Input.dispatchKeyEvent", type="keyUp", key=key, **more)


def figure_where(words: str) -> str:
    return (
        "[...MOYAI.figures.values()].find((figure) => MOYAI.isVisible(figure.plot) && "
        f"figure.spec.title.startsWith({words!r}))"
    )


def run_named(result: Result, key: str) -> xr.Dataset:
    """Return the run in regular waves whose name stands in the key of a block."""
    name = next(name for name in ("T3p6", "T4p6", "T6p2") if f"-{name.lower()}-" in key)
    return result.tree[f"/HWL/time/design waves/{name}"].to_dataset()


def colours(picture: object) -> int:
    return len(np.unique(np.asarray(picture.convert("RGB")).reshape(-1, 3), axis=0))  # type: ignore[attr-defined]


def download_csv(page: Chromium, element: str, name: str) -> list[list[str]]:
    page.evaluate(f"{element}.querySelector('[data-do=csv]').click()")
    content = page.wait_download(f"{name}.csv")
    return list(csv.reader(io.StringIO(content.decode("utf-8-sig"))))


def test_it_asks_nothing_of_the_network(page: Chromium) -> None:
    outside = [address for address in page.requests if not address.startswith(("file:", "data:", "blob:"))]
    assert outside == []


def test_every_visible_figure_is_drawn(page: Chromium) -> None:
    state = page.evaluate(
        "[...MOYAI.figures.values()].map((f) => [f.spec.title, MOYAI.isVisible(f.plot), f.drawn, "
        "f.plot.querySelectorAll('.trace path.js-line, .trace path.point, .barlayer path').length])"
    )
    visible = [entry for entry in state if entry[1]]
    assert len(visible) > 12
    assert all(drawn and marks > 0 for _, _, drawn, marks in visible), visible
    assert any(not entry[1] and not entry[2] for entry in state), "hidden figures wait until they are chosen"


@pytest.mark.slow
def test_pictures_are_not_blank(page: Chromium, tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    folder = Path(os.environ.get("MOYAI_REPORT_PICTURES", tmp_path))
    folder.mkdir(parents=True, exist_ok=True)
    page.evaluate(f"{figure_where('Motions in regular waves')}.element.scrollIntoView({{behavior: 'instant'}})")
    with image.open(page.screenshot(folder / "figures.png", whole=False)) as picture:
        assert colours(picture) > 100
    page.evaluate(f"{VISIBLE_PLAYER}.holder.scrollIntoView({{behavior: 'instant'}})")
    with image.open(page.screenshot(folder / "player.png", whole=False)) as picture:
        assert colours(picture) > 100


def test_csv_of_a_figure_holds_its_data(page: Chromium, result: Result) -> None:
    figure = figure_where("Motion response amplitude")
    rows = download_csv(page, f"{figure}.element", page.evaluate(f"{figure}.spec.key"))
    assert rows[0][:4] == ["wave period T [s]", "wavelength over beam L/B", "angular frequency ω [rad/s]", "sway [m/m]"]
    found = np.array(rows[1:], dtype=float)
    rao = result.tree["/HWL/rao"].to_dataset().sortby("omega", ascending=False)
    np.testing.assert_allclose(found[:, 0], rao["period"], rtol=1e-6)
    np.testing.assert_allclose(found[:, 3], np.abs(rao["rao"].sel(dof="sway")), rtol=1e-5)
    np.testing.assert_allclose(found[:, 5], np.degrees(np.abs(rao["rao"].sel(dof="roll"))), rtol=1e-5)


def test_csv_of_a_record_is_the_run(page: Chromium, result: Result) -> None:
    figure = figure_where("Record of the run")
    rows = download_csv(page, f"{figure}.element", page.evaluate(f"{figure}.spec.key"))
    found = np.array(rows[1:], dtype=float)
    name = page.evaluate(f"{figure}.spec.key")
    run = run_named(result, name)
    column = rows[0].index("sway [m]")
    expected = np.interp(found[:, 0], run["time"], run["position"].sel(dof="sway"))
    np.testing.assert_allclose(found[:, column], expected, atol=2e-4 * np.abs(expected).max())
    tension = [number for number, head in enumerate(rows[0]) if head.startswith("tension: offshore")]
    assert found[:, tension[0]].max() == pytest.approx(float(run["tension"].sel(line="offshore").max()) / 1e3, rel=1e-5)


def test_csv_of_a_table_is_the_file(page: Chromium) -> None:
    rows = download_csv(page, "document.getElementById('derived-numbers')", "derived-numbers")
    folder = page.report.parent / "report_tables"  # type: ignore[attr-defined]
    with (folder / "derived-numbers.csv").open(encoding="utf-8-sig", newline="") as stream:
        assert rows == list(csv.reader(stream))


def test_copied_data_paste_into_cells(page: Chromium) -> None:
    page.evaluate("window.copied = ''; MOYAI.copy = async (text) => { window.copied = text; return true; }")
    page.evaluate("document.querySelector('#derived-numbers [data-do=copy]').click()")
    copied = page.evaluate("window.copied")
    assert copied.splitlines()[0].split("\t") == ["Quantity", "Unit", "HWL", "LWL"]
    assert all(line.count("\t") == 3 for line in copied.splitlines())


def test_pictures_of_a_figure_can_be_saved(page: Chromium) -> None:
    figure = figure_where("Reflection, transmission")
    name = page.evaluate(f"{figure}.spec.key")
    for kind, start in (("png", b"\x89PNG"), ("svg", b"<svg")):
        page.evaluate(f"{figure}.element.querySelector('[data-do={kind}]').click()")
        assert page.wait_download(f"{name}.{kind}").startswith(start)
    page.evaluate("document.querySelector('.drawing [data-do=svg]').click()")
    assert page.wait_download("hwl-elevation.svg").startswith(b"<svg")


@pytest.mark.slow
def test_choices_of_a_group_change_together(page: Chromium) -> None:
    page.evaluate("document.querySelector('#rest [data-option^=LWL]').click()")
    panes = "document.querySelectorAll('.choice[data-group=water-level] > .pane:not([hidden])')"
    shown = page.evaluate(f"[...{panes}].map((pane) => pane.dataset.option)")
    assert len(shown) >= 5 and set(shown) == {"LWL (+0.00 m)"}
    assert page.evaluate("[...MOYAI.figures.values()].filter((f) => MOYAI.isVisible(f.plot)).every((f) => f.drawn)")
    page.evaluate("MOYAI.choose('water-level', 'HWL (+1.20 m)')")


def test_abscissa_can_be_changed(page: Chromium) -> None:
    figure = figure_where("Motions in regular waves")
    before = page.evaluate(f"[...{figure}.plot.data[0].x].slice(0, 3)")
    page.evaluate(f"{figure}.element.querySelector('[data-abscissa=ratio]').click()")
    assert "L/B" in page.evaluate(f"{figure}.plot.layout.xaxis.title.text")
    assert page.evaluate(f"[...{figure}.plot.data[0].x].slice(0, 3)") != before
    page.evaluate(f"{figure}.element.querySelector('[data-abscissa=period]').click()")


def test_the_strip_moves_the_window(page: Chromium) -> None:
    figure = figure_where("Record of the run")
    page.evaluate(f"{figure}.overview.canvas.scrollIntoView({{block: 'center', behavior: 'instant'}})")
    before = page.evaluate(f"{figure}.shown ? null : {figure}.plot.layout.xaxis.range.slice()") or page.evaluate(
        f"{figure}.range.slice()"
    )
    page.evaluate(f"window.box = {figure}.overview.canvas.getBoundingClientRect()")
    box = page.evaluate("[box.left, box.top, box.width, box.height]")
    y = box[1] + box[3] / 2
    for kind, x in (("mousePressed", 0.3), ("mouseMoved", 0.45), ("mouseReleased", 0.45)):
        page.send(
            "Input.dispatchMouseEvent", type=kind, x=box[0] + x * box[2], y=y, button="left", buttons=1, clickCount=1
        )
    after = page.evaluate(f"{figure}.range.slice()")
    assert after != before
    assert after[1] - after[0] == pytest.approx(before[1] - before[0], rel=1e-6)
    page.evaluate(f"{figure}.show(null)")
    assert page.evaluate(f"{figure}.range") is None


@pytest.mark.slow
def test_player_plays_scrubs_and_marks_the_maximum(page: Chromium) -> None:
    page.evaluate(f"window.player = {VISIBLE_PLAYER}; player.holder.scrollIntoView(); player.holder.focus()")
    at = page.evaluate("player.t")
    assert at == pytest.approx(page.evaluate("player.scene.maximum"))
    colours = page.evaluate(
        "(() => { const c = player.canvas, d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
        " const s = new Set(); for (let i = 0; i < d.length; i += 4) s.add((d[i] << 16) | (d[i + 1] << 8) | d[i + 2]);"
        " return s.size; })()"
    )
    assert colours > 50
    press(page, " ")
    time.sleep(0.6)
    assert page.evaluate("player.playing") and page.evaluate("player.t") > at
    press(page, " ")
    assert not page.evaluate("player.playing")
    press(page, "m")
    assert page.evaluate("player.t") == pytest.approx(at)
    press(page, "ArrowRight")
    assert page.evaluate("player.t") > at
    press(page, "Home")
    assert page.evaluate("player.t") == pytest.approx(page.evaluate("player.scene.window[0]"))
    view = page.evaluate("player.view")
    press(page, "v")
    assert page.evaluate("player.view") != view
    press(page, "w")
    assert page.evaluate("player.whole")
    press(page, "w")
    page.evaluate("player.scrub.value = 500; player.scrub.dispatchEvent(new Event('input'))")
    window = page.evaluate("player.scene.window")
    assert page.evaluate("player.t") == pytest.approx(0.5 * (window[0] + window[1]), abs=1e-6)


@pytest.mark.slow
def test_player_moves_as_the_run(page: Chromium, result: Result) -> None:
    """At random moments the drawn pose and tension must be those of the record."""
    page.evaluate(f"window.player = {VISIBLE_PLAYER}")
    start, end = page.evaluate("player.scene.window")
    name = page.evaluate("player.holder.dataset.scene")
    run = run_named(result, name)
    scale = np.abs(run["position"].values).max(axis=0)
    for moment in np.random.default_rng(3).uniform(start, end, 12).tolist():
        place = f"MOYAI.placeInTime(player.painter.times, {moment!r})"
        pose = page.evaluate(f"[...player.painter.bodies[0].track.at({place})]")
        exact = [float(CubicSpline(run["time"], run["position"].sel(dof=mode))(moment)) for mode in BODY]
        np.testing.assert_allclose(pose / scale, exact / scale, atol=3e-3)
        tension = page.evaluate(f"player.painter.tensionAt(player.painter.lines[0], {place})")
        assert tension == pytest.approx(float(np.interp(moment, run["time"], run["tension"][:, 0])), rel=5e-3)


@pytest.mark.slow
def test_dark_follows_the_reader(page: Chromium) -> None:
    light = page.evaluate("getComputedStyle(document.body).backgroundColor")
    page.prefer("dark")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") != light
    ink = page.evaluate(f"{figure_where('Mean drift')}.plot.layout.font.color")
    assert ink == page.evaluate("MOYAI.style('--ink')")
    page.prefer("light")


@pytest.mark.slow
def test_narrow_page_does_not_overflow(page: Chromium) -> None:
    for width in (390, 760, 1280):
        page.resize(width, 900)
        end = time.monotonic() + 5.0
        while page.evaluate("document.documentElement.scrollWidth") > width and time.monotonic() < end:
            time.sleep(0.1)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.resize(1280, 1000)


@pytest.mark.slow
def test_print_is_light_and_whole(page: Chromium, tmp_path: Path) -> None:
    page.prefer("dark")
    printed = page.print_pdf(tmp_path / "print.pdf")
    assert printed.read_bytes().startswith(b"%PDF")
    assert printed.stat().st_size > 100_000
    page.prefer("light")
    assert page.evaluate("document.documentElement.classList.contains('paper')") is False
    assert page.evaluate("[...document.querySelectorAll('details')].some((d) => d.open)") is False


@pytest.mark.slow
def test_hostile_title_runs_nothing(tmp_path: Path) -> None:
    bad = '<img src=x onerror="window.hit=1"></script><script>window.hit=1</script>'
    report = write_report(entitled(pontoon(), bad, "<img src=x onerror=alert(1)>'&"), tmp_path)[0]
    with Chromium(str(find_chromium())) as browser:
        browser.open(report)
        assert browser.evaluate("window.hit === undefined && document.title") == bad
        assert browser.errors == []
        assert browser.evaluate("MOYAI.players.length") == 4
