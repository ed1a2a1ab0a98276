"""The whole chain on small synthetic pictures: planted circulation, resumption, faults of files, the command."""

import json
import math

import imageio.v3 as imageio
import numpy as np
import pytest
from synthetic_pictures import Optics, synthesise
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.errors import CaseError, InputError
from moyai.core.results import read_result
from moyai.core.store import DatasetStore
from moyai.records.streaks.camera_calibration import RayCamera, Refraction
from moyai.records.streaks.campaign import measure_campaign
from moyai.records.streaks.case.build import load_streaks
from moyai.records.streaks.flow import OrbitalFlow, circle_map
from moyai.records.streaks.timing import regular_pulses

PERIOD, BREADTH = 1.0, 0.03
REFRACTION = Refraction(0.8, 0.01, 1.5, 0.3, 1.333)
SHAPE = (560, 640)
CAMERA = RayCamera(np.array([0.0, 0.001]), np.array([0.01, 0.01, 0.0]), 4200.0, np.array([319.5, 279.5]), REFRACTION)
PLANTED = 0.95 * BREADTH**2 / PERIOD


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Pictures of one run in three exposures, targets, and their file."""
    place = tmp_path_factory.mktemp("streaks")
    speed = BREADTH / PERIOD
    flow = OrbitalFlow(circle_map(BREADTH), PERIOD, speed, speed, PLANTED)
    train = regular_pulses(PERIOD / 9.6, 0.5 * PERIOD / 9.6, [1.0, 0.65, 0.4], 12)
    for take in range(3):
        optics = Optics(density=4200.0, diameter=(0.2e-3, 0.35e-3), brightness=130.0)
        made = synthesise(flow, CAMERA, SHAPE, train, optics=optics, seed=20 + take, frames=False, phase=1.3 * take)
        imageio.imwrite(place / f"run_{take}.png", made.pictures[0])
    x, z = np.meshgrid(np.linspace(-0.06, 0.06, 7), np.linspace(-0.05, 0.05, 6))
    world = np.column_stack([x.ravel(), z.ravel()])
    pixels = CAMERA.to_pixels(world)
    lines = [f"{c:.3f}, {r:.3f}, {1e3 * a:.3f}, {1e3 * b:.3f}" for (c, r), (a, b) in zip(pixels, world)]
    (place / "targets.csv").write_text("column, row, x [mm], z [mm]\n" + "\n".join(lines) + "\n")
    (place / "streaks.yaml").write_text(TEXT)
    return place


TEXT = f"""\
moyai: 1
measure: streaks
title: small pictures
section: {{kind: circle, diameter: 30 mm}}
centre: {{x: 0 m, z: 0 m}}
calibration: {{targets: targets.csv}}
timing:
  kind: exposure
  interval: {PERIOD / 9.6} s
  on_time: {0.5 * PERIOD / 9.6} s
  power: [1, 0.65, 0.4]
  count: 12
background: {{mass_transport: 0 m/s, settling: 0 m/s}}
linking: {{absolute: 0.2 mm}}
circulation: {{size_ratios: [1.5, 1.75, 2, 2.25, 2.5], resamples: 40}}
runs:
  - name: small
    period: {PERIOD} s
    keulegan_carpenter: 1
    recordings:
      - pictures: [run_*.png]
"""


def changed(folder, name, *pairs):
    text = TEXT
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    path = folder / f"{name}.yaml"
    path.write_text(text)
    return path


@pytest.mark.slow
def test_planted_circulation_comes_back_from_pictures(folder, batch):
    """The command takes the recordings from where the batch has kept them."""
    runner = CliRunner()
    call = ["measure", "streaks", str(folder / "streaks.yaml"), "-o", str(folder / "out"), "--json"]
    outcome = runner.invoke(app, call)
    assert outcome.exit_code == 0, outcome.output
    record = json.loads(outcome.stdout)
    run = record["runs"][0]
    assert run["circulation"] == pytest.approx(PLANTED, rel=0.1)
    assert run["interval"][0] < run["circulation"] < run["interval"][1]
    assert record["law_coefficient"] == pytest.approx(0.95, rel=0.1)
    result = read_result(folder / "out" / "results.nc")
    assert result.tree["runs/small"].attrs["keulegan_carpenter"] == pytest.approx(1.0)
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    assert "data:image/png;base64" in page
    assert "Reduction of the inertia coefficient" in page
    again = json.loads(runner.invoke(app, call).stdout)
    assert again["runs"][0]["circulation"] == run["circulation"]
    assert len(list((folder / "out" / "recordings").glob("*.nc"))) == 3


@pytest.fixture(scope="module")
def batch(folder):
    """A measurement stopped at its third recording, and gone on with: both results, files between, what was done."""
    campaign, _ = load_streaks(folder / "streaks.yaml")
    kept = folder / "out" / "recordings"
    kept.mkdir(parents=True)
    store = DatasetStore(kept)

    def stop(what, done, total):
        if what == "recordings" and done == 2:
            raise KeyboardInterrupt

    stopped = measure_campaign(campaign, store=store, progress=stop)
    files = len(list(kept.glob("*.nc")))
    seen = []
    finished = measure_campaign(campaign, store=store, progress=lambda what, done, total: seen.append(what))
    return stopped, files, finished, seen, store


@pytest.mark.slow
def test_an_interrupted_batch_keeps_what_is_done_and_goes_on(batch):
    stopped, files, finished, seen, _ = batch
    assert stopped.status == "interrupted"
    assert "0 of 1 runs" in stopped.message
    assert files == 2
    assert finished.status == "converged"
    # Only the third recording was looked at again
    assert seen.count("pictures") == 2


@pytest.mark.slow
def test_waves_to_the_other_side_turn_the_sign(folder, batch):
    campaign, _ = load_streaks(changed(folder, "other", ("calibration:", "waves_towards: -x\ncalibration:")))
    result = measure_campaign(campaign, store=batch[-1])
    assert result.tree["runs/small"].attrs["limit"] == pytest.approx(PLANTED, rel=0.1)
    assert {notice.code for notice in result.notices} >= {"circulation-against-orbits", "no-law"}


@pytest.mark.parametrize(
    ("pairs", "line", "message"),
    [
        ([("power: [1, 0.65, 0.4]", "power: [1]")], 7, "order in time of the streaks is missing"),
        ([("count: 12", "count: 6")], 7, "do not cover a period"),
        ([("run_*.png", "walk_*.png")], 21, "no picture matches"),
        ([("run_*.png", "run_9.png")], 21, "no such picture"),
        ([("targets: targets.csv", "targets: goals.csv")], 6, "no such file"),
        ([("diameter: 30 mm", "diameter: -30 mm")], 4, "out of range"),
        ([("keulegan_carpenter: 1", "keulegan_carpentier: 1")], 19, "did you mean 'keulegan_carpenter'"),
        (
            [("keulegan_carpenter: 1", "keulegan_carpenter: 1\n    velocity_amplitude: 0.1 m/s")],
            20,
            "exclude each other",
        ),
        ([("size_ratios: [1.5, 1.75, 2, 2.25, 2.5]", "size_ratios: [1.1, 1.2, 1.8]")], 15, "fewer than two contours"),
        ([("calibration: {", "calibration: {model: rays, ")], 6, "'refraction' is missing"),
        ([("kind: exposure", "kind: film")], 8, "'film' is not known here"),
    ],
)
def test_faults_of_the_file_are_reported_with_their_line(folder, pairs, line, message):
    with pytest.raises(CaseError) as found:
        load_streaks(changed(folder, "faulty", *pairs))
    reported = [fault for fault in found.value.faults if message in str(fault)]
    assert len(reported) == 1, found.value
    assert abs(reported[0].line - line) <= 1


def test_all_faults_are_reported_at_once(folder):
    path = changed(
        folder, "many", ("power: [1, 0.65, 0.4]", "power: [1]"), ("run_*.png", "walk.png"), ("targets.csv", "a.csv")
    )
    with pytest.raises(CaseError) as found:
        load_streaks(path)
    assert len(found.value.faults) >= 2


def test_targets_on_a_line_and_dark_pictures_are_reported(folder):
    lines = "\n".join(f"{100 * k}, {50 * k}, {10 * k}, {5 * k}" for k in range(6))
    (folder / "line.csv").write_text("column, row, x [mm], z [mm]\n" + lines + "\n")
    with pytest.raises(CaseError, match="on one line"):
        load_streaks(changed(folder, "collinear", ("targets.csv", "line.csv")))
    dark = np.random.default_rng(1).poisson(12.0, SHAPE).astype(np.uint8)
    imageio.imwrite(folder / "dark.png", dark)
    campaign, _ = load_streaks(changed(folder, "dark", ("run_*.png", "dark.png")))
    with pytest.raises(InputError, match=r"dark\.png: 0 streaks exceed the noise"):
        measure_campaign(campaign)


@pytest.mark.slow
def test_too_few_particles_are_reported(folder):
    picture = imageio.imread(folder / "run_0.png")
    picture[:, 200:] = np.random.default_rng(2).poisson(12.0, picture[:, 200:].shape)
    imageio.imwrite(folder / "few.png", picture)
    campaign, _ = load_streaks(changed(folder, "few", ("run_*.png", "few.png")))
    with pytest.raises(InputError, match="the run 'small' gives"):
        measure_campaign(campaign)


@pytest.mark.slow
def test_amplitude_outside_the_range_warns(folder, batch):
    campaign, _ = load_streaks(changed(folder, "weak", ("keulegan_carpenter: 1\n", "keulegan_carpenter: 0.7\n")))
    result = measure_campaign(campaign, store=batch[-1])
    notice = next(item for item in result.notices if item.code == "streaks-amplitude")
    assert "KC = 0.7" in notice.message
    assert math.isfinite(result.tree["law"].attrs["coefficient"])


def target_table(folder, name, change):
    lines = (folder / "targets.csv").read_text().splitlines()
    (folder / f"{name}.csv").write_text("\n".join(change(lines)) + "\n")
    return ("targets.csv", f"{name}.csv")


def test_exchanged_columns_of_targets_are_reported(folder):
    """They mirror the picture and would turn the sign of the circulation without a word."""
    swapped = target_table(folder, "swapped", lambda lines: ["row, column, x [mm], z [mm]", *lines[1:]])
    campaign, _ = load_streaks(changed(folder, "swapped", swapped))
    assert [notice.code for notice in campaign.notices] == ["view-mirrored", "view-turned"]

    def turned(lines):
        rows = (line.split(",") for line in lines[1:])
        return [lines[0], *(f"{c},{r},{-float(x)},{z}" for c, r, x, z in rows)]

    behind = target_table(folder, "behind", turned)
    campaign, _ = load_streaks(changed(folder, "behind", behind))
    assert [notice.code for notice in campaign.notices] == ["view-mirrored"]
    assert load_streaks(folder / "streaks.yaml")[0].notices == ()


@pytest.mark.slow
def test_a_wrong_target_is_named_and_pictures_share_size(folder):
    wrong = target_table(folder, "wrong", lambda lines: [*lines[:10], "10, 20, 30, 4", *lines[11:]])
    with pytest.raises(CaseError, match=r"miss a plane picture by .* pixels; without target 10 by"):
        load_streaks(changed(folder, "wrong", wrong))
    imageio.imwrite(folder / "cut.png", imageio.imread(folder / "run_0.png")[:400, :500])
    with pytest.raises(CaseError, match=r"cut\.png has 500 by 400 pixels, the first picture 640 by 560"):
        load_streaks(changed(folder, "cut", ("[run_*.png]", "[run_0.png, cut.png]")))


@pytest.mark.parametrize(
    ("pair", "words"),
    [
        (("{kind: circle, diameter: 30 mm}", "{kind: polygon, corners: [[0, 0], [0.03, 0], [0.03, 0.03]]}"), "centre"),
        (
            (
                "{kind: circle, diameter: 30 mm}",
                "{kind: polygon, corners: [[-0.02, -0.02], [0.02, 0.02], [0.02, -0.02], [-0.02, 0.01]]}",
            ),
            "intersects itself",
        ),
        (("centre: {x: 0 m", "centre: {x: 3 m"), "lies outside the pictures"),
        ((f"interval: {PERIOD / 9.6} s", "interval: 3 s"), "too few for the period"),
        (("[run_*.png]", "[run_0.png, run_1.png, run_0.png]"), "'run_0.png' is given twice"),
    ],
)
def test_sections_centres_and_pulses_that_cannot_be_are_reported(folder, pair, words):
    with pytest.raises(CaseError) as found:
        load_streaks(changed(folder, "impossible", pair))
    assert [words in str(fault) for fault in found.value.faults] == [True], found.value
