"""Streaks in pictures: ends to a fraction of a pixel, overlaps, noise, faults."""

import math

import imageio.v3 as imageio
import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.streaks.detection import DetectionSettings, background_level, detect_streaks, read_picture
from moyai.records.streaks.fit import fit_streaks, streak_grey
from moyai.records.streaks.run import read_pictures

RANDOM = np.random.default_rng(45)


def smear(picture, first, last, brightness, blur, bow=0.0, disc=0.0):
    """Add a streak by stepping a blurred disc along a bowed path: made apart from the profile that is fitted."""
    first, last = np.asarray(first, float), np.asarray(last, float)
    rows, columns = np.mgrid[0 : picture.shape[0], 0 : picture.shape[1]]
    along = (last - first) / np.hypot(*(last - first))
    aside = np.array([-along[1], along[0]])
    count = 6 * math.ceil(np.hypot(*(last - first))) + 1
    points = RANDOM.uniform(-1.0, 1.0, (60, 2))
    inside = points[(points**2).sum(axis=1) < 1.0] if disc else np.zeros((1, 2))
    for share in np.linspace(0.0, 1.0, count):
        centre = first + share * (last - first) + 4.0 * bow * share * (1.0 - share) * aside
        for offset in inside[:1] if not disc else inside[:6]:
            x, y = centre + disc * offset
            square = (columns - x) ** 2 + (rows - y) ** 2
            picture += brightness / count / len(inside[:6]) * np.exp(-0.5 * square / blur**2) * 10.0


def end_errors(found, first, last):
    pairs = np.array([first, last])
    return min(np.hypot(*(ends - pairs).T).max() for ends in (found, found[::-1]))


@pytest.mark.parametrize("trial", range(4))
def test_ends_of_a_random_streak_are_found_to_a_fraction_of_a_pixel(trial):
    picture = np.full((80, 90), 12.0)
    angle, length, bow = RANDOM.uniform(0.0, math.pi), RANDOM.uniform(12.0, 35.0), RANDOM.uniform(-1.0, 1.0)
    half = 0.5 * length * np.array([math.cos(angle), math.sin(angle)])
    centre = RANDOM.uniform(35.0, 45.0, 2)
    smear(picture, centre - half, centre + half, 60.0, RANDOM.uniform(0.9, 1.8), bow)
    noisy = np.rint(picture + RANDOM.normal(0.0, 1.5, picture.shape))
    found = detect_streaks(noisy)
    assert found.count == 1
    assert end_errors(found.ends[0], centre - half, centre + half) < 0.4
    assert abs(abs(found.bow[0]) - abs(bow)) < 0.35


def test_errors_of_the_ends_have_no_bias_from_blur():
    """The mean over many streaks of the error of the length, for two widths of the blur."""
    for blur in (1.0, 2.0):
        errors = []
        for _ in range(12):
            picture = np.full((50, 60), 10.0)
            first = RANDOM.uniform([14.0, 22.0], [16.0, 26.0])
            last = first + RANDOM.uniform([20.0, -4.0], [26.0, 4.0])
            smear(picture, first, last, 50.0, blur)
            found = detect_streaks(np.rint(picture + RANDOM.normal(0.0, 1.0, picture.shape)))
            errors.append(found.length[0] - np.hypot(*(last - first)))
        assert abs(np.mean(errors)) < 0.25


def test_crossing_streaks_are_taken_apart():
    picture = np.full((90, 90), 12.0)
    ends = [((25.0, 30.0), (62.0, 58.0)), ((30.0, 62.0), (60.0, 25.0))]
    for first, last in ends:
        smear(picture, first, last, 60.0, 1.2)
    found = detect_streaks(np.rint(picture + RANDOM.normal(0.0, 1.5, picture.shape)))
    assert found.count == 2
    assert found.overlapping.all()
    for first, last in ends:
        assert min(end_errors(item, first, last) for item in found.ends) < 0.6


def test_light_of_a_streak_does_not_depend_on_its_length():
    lights = []
    for length in (12.0, 24.0, 36.0):
        picture = np.full((60, 80), 10.0)
        smear(picture, (20.0, 30.0), (20.0 + length, 32.0), 60.0, 1.3)
        lights.append(detect_streaks(picture + RANDOM.normal(0.0, 0.5, picture.shape)).light[0])
    assert np.ptp(np.log(lights)) < 0.12


def test_fit_finds_its_own_profile_exactly():
    row, column = (item.ravel().astype(float) for item in np.mgrid[0:30, 0:40])
    truth = np.array([9.3, 12.4, 28.1, 17.9, 1.1, 40.0, math.log(1.4), 2.0])
    grey = streak_grey(column, row, truth)
    start = truth + np.array([1.0, -0.8, -1.2, 0.7, -0.8, 8.0, 0.2, -1.0])
    found, squares = fit_streaks(column, row, grey, start, 100)
    assert squares < 1e-8
    assert found == pytest.approx(truth, abs=1e-4)


def test_uneven_light_is_taken_off_and_noise_gives_no_streaks():
    rows, columns = np.mgrid[0:200, 0:260]
    level = 20.0 + 15.0 * columns / 260 + 8.0 * np.sin(rows / 70.0)
    noisy = np.rint(level + RANDOM.normal(0.0, 2.0, level.shape))
    hidden = np.zeros(level.shape, dtype=bool)
    assert np.abs(background_level(noisy, 32, hidden) - level).max() < 2.0
    found = detect_streaks(noisy)
    assert found.count == 0
    assert found.noise == pytest.approx(2.0, rel=0.15)


def test_masked_and_cut_streaks_are_left_out():
    picture = np.full((80, 120), 10.0)
    smear(picture, (20.0, 20.0), (40.0, 22.0), 60.0, 1.2)
    smear(picture, (100.0, 50.0), (130.0, 52.0), 60.0, 1.2)
    noisy = np.rint(picture + RANDOM.normal(0.0, 1.0, picture.shape))
    assert detect_streaks(noisy).count == 1
    mask = np.zeros(noisy.shape, dtype=bool)
    mask[10:30, 10:60] = True
    assert detect_streaks(noisy, mask=mask).count == 0


def test_faults_of_pictures_are_reported(tmp_path):
    with pytest.raises(InputError, match="no such picture"):
        read_picture(tmp_path / "absent.png")
    (tmp_path / "words.png").write_text("no picture")
    with pytest.raises(InputError, match="cannot be read as a picture"):
        read_picture(tmp_path / "words.png")
    imageio.imwrite(tmp_path / "tiny.png", np.zeros((5, 5), dtype=np.uint8))
    with pytest.raises(InputError, match="at least 32 by 32"):
        read_picture(tmp_path / "tiny.png")
    imageio.imwrite(tmp_path / "a.png", np.zeros((40, 50), dtype=np.uint8))
    imageio.imwrite(tmp_path / "b.png", np.zeros((40, 60), dtype=np.uint8))
    with pytest.raises(InputError, match="60 by 40 pixels and a"):
        read_pictures([tmp_path / "a.png", tmp_path / "b.png"])
    with pytest.raises(InputError, match="threshold"):
        DetectionSettings(threshold=2.0, edge_threshold=5.0)


def test_colours_and_16_bits_are_read(tmp_path):
    grey = RANDOM.integers(0, 60000, (40, 50)).astype(np.uint16)
    imageio.imwrite(tmp_path / "deep.png", grey)
    assert read_picture(tmp_path / "deep.png") == pytest.approx(grey)
    colour = RANDOM.integers(0, 255, (40, 50, 3)).astype(np.uint8)
    imageio.imwrite(tmp_path / "colour.png", colour)
    assert read_picture(tmp_path / "colour.png") == pytest.approx(colour.mean(axis=2))
