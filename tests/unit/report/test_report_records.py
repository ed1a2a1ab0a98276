"""Long records made small: decimation, animation tracks, travelling surface."""

from __future__ import annotations

import base64
import math

import numpy as np
import pytest

from moyai.report.animation import displaced_line, encode_track, fairlead_motion, frame_times, tabulated_line
from moyai.report.decimate import envelope_indices, focus_indices, mean_crossing_period, window_around
from moyai.report.waves import travelling_surface


@pytest.mark.parametrize("seed", range(5))
def test_no_extreme_is_lost(seed: int) -> None:
    random = np.random.default_rng(seed)
    samples, channels, bins = int(random.integers(500, 40000)), int(random.integers(1, 6)), int(random.integers(3, 60))
    record = np.cumsum(random.normal(size=(samples, channels)), axis=0)
    record[random.integers(0, samples, 20), 0] = np.nan
    kept = envelope_indices(record, bins)
    assert kept.size <= 2 * bins * channels + 2 or kept.size == samples
    assert kept[0] == 0 and kept[-1] == samples - 1 and (np.diff(kept) > 0).all()
    length = -(-samples // bins)
    for start in range(0, samples, length):
        part, mine = record[start : start + length], kept[(kept >= start) & (kept < start + length)]
        np.testing.assert_array_equal(np.nanmax(part, axis=0), np.nanmax(record[mine], axis=0))
        np.testing.assert_array_equal(np.nanmin(part, axis=0), np.nanmin(record[mine], axis=0))


def test_the_window_is_whole() -> None:
    random = np.random.default_rng(3)
    time = np.arange(20000) * 0.05
    record = random.normal(size=(20000, 3))
    for centre in (0.0, 333.0, 999.9):
        first, last = window_around(time, centre, 60.0)
        assert time[last - 1] - time[first] == pytest.approx(60.0, abs=0.11)
        assert time[first] <= centre <= time[last - 1]
        kept = focus_indices(record, (first, last), 50)
        assert set(range(first, last)) <= set(kept.tolist())
        assert kept.size < 20000
    thin = focus_indices(record, (0, 20000), 50, window_budget=600)
    assert thin.size < 1500 and record[thin, 1].max() == record[:, 1].max()


def test_crossing_period_of_a_sine() -> None:
    random = np.random.default_rng(9)
    for period in random.uniform(2.0, 15.0, 8):
        time = np.arange(0.0, 60.0 * period, period / 200.0)
        values = 3.0 + np.sin(2.0 * np.pi * time / period + 0.4)
        assert mean_crossing_period(time, values) == pytest.approx(period, rel=1e-3)
    assert math.isnan(mean_crossing_period([0.0, 1.0], [1.0, 1.0]))


def decode_track(coded: dict) -> np.ndarray:
    def array(entry: object) -> np.ndarray:
        if isinstance(entry, list):
            return np.array(entry, dtype=float)
        return np.frombuffer(base64.b64decode(entry["f4"]), dtype="<f4").astype(float)

    packed = coded["coefficients"]
    kind, dtype = ("i1", "i1") if "i1" in packed else ("i2", "<i2")
    integers = np.frombuffer(base64.b64decode(packed[kind]), dtype=dtype).reshape(-1, packed["columns"])
    coefficients = np.array(packed["offset"]) + np.array(packed["step"]) * integers
    return array(coded["mean"]) + coefficients @ np.array([array(entry) for entry in coded["basis"]])


@pytest.mark.parametrize("seed", range(6))
def test_tracks_keep_their_tolerance(seed: int) -> None:
    random = np.random.default_rng(seed)
    frames, places, ways = int(random.integers(20, 800)), int(random.integers(2, 120)), int(random.integers(1, 9))
    values = random.normal(size=(frames, ways)) @ random.normal(size=(ways, places)) + random.normal(size=places)
    for tolerance in (1e-1, 1e-3):
        coded = encode_track(values, tolerance)
        assert np.abs(decode_track(coded) - values).max() <= tolerance
        assert len(coded["basis"]) <= min(ways, places)
        rough = encode_track(values, tolerance, everywhere=False)
        assert np.sqrt(np.mean((decode_track(rough) - values) ** 2)) <= tolerance
        assert len(rough["basis"]) <= len(coded["basis"])


def test_frames_are_dense_in_the_window_and_hit_the_maximum() -> None:
    random = np.random.default_rng(4)
    for _ in range(30):
        time = np.arange(0.0, random.uniform(50.0, 4000.0), 0.05)
        period = random.uniform(1.0, 9.0)
        moment = float(random.uniform(time[0], time[-1]))
        first, last = window_around(time, moment, 12.0 * period)
        frames = frame_times(time, (time[first], time[last - 1]), period, (moment,))
        assert moment in frames and frames[0] == time[0] and frames[-1] == time[-1]
        assert (np.diff(frames) > 0.0).all()
        inside = frames[(frames > time[first]) & (frames < time[last - 1])]
        assert np.diff(inside).max() <= period * (1.0 / 40.0 + 1e-3)
        assert np.diff(frames).max() <= max(period * (1.0 / 8.0 + 1e-3), 1.001 * time[-1] / 12000)
        near = frame_times(time, (time[first], time[last - 1]), period, (moment,), around=5.0)
        assert moment in near
        np.testing.assert_allclose(near[0], max(time[0], time[first] - 5.0 * period))
        np.testing.assert_allclose(near[-1], min(time[-1], time[last - 1] + 5.0 * period))


def test_body_points_turn_as_rigid_bodies_do() -> None:
    random = np.random.default_rng(6)
    pose = random.normal(size=(50, 3))
    for arm in random.normal(size=(5, 2)):
        moved = fairlead_motion(pose, (arm[0], arm[1])) - pose[:, :2] + arm
        np.testing.assert_allclose(np.linalg.norm(moved, axis=1), np.linalg.norm(arm), rtol=1e-12)
    small = 1e-6
    # positive roll moves a point by theta * (rz, -rx)
    turned = fairlead_motion(np.array([[0.0, 0.0, small]]), (2.0, 3.0)) / small
    np.testing.assert_allclose(turned, [[3.0, -2.0]], rtol=1e-5)


def test_drawn_lines_hold_at_both_ends() -> None:
    rest = np.array([[-50.0, -10.0], [-40.0, -10.0], [-20.0, -8.0], [-5.0, -3.0]])
    shift = np.array([[0.0, 0.0], [1.0, -0.5]])
    moved = displaced_line(rest, shift, -10.0)
    np.testing.assert_allclose(moved[0], rest)
    np.testing.assert_allclose(moved[1, :2], rest[:2])
    np.testing.assert_allclose(moved[1, -1], rest[-1] + shift[1])


def test_stored_line_shapes_are_met_and_led_to_the_fairlead() -> None:
    random = np.random.default_rng(13)
    shift_x, shift_z = np.sort(random.normal(size=6)), np.sort(random.normal(size=4))
    share = np.linspace(0.0, 1.0, 9)
    anchor, fairlead = np.array([-50.0, -10.0]), np.array([-5.0, -3.0])
    ends = fairlead + np.stack(np.meshgrid(shift_x, shift_z, indexing="ij"), axis=-1)
    shapes = anchor + share[None, None, :, None] * (ends[:, :, None, :] - anchor)
    shapes[..., 1] -= 4.0 * (share * (1.0 - share)) * (1.0 + shift_x[:, None, None]) ** 2
    for i, j in ((0, 0), (3, 2), (5, 3), (2, 0)):
        moved = tabulated_line(shift_x, shift_z, shapes, np.array([[shift_x[i], shift_z[j]]]))
        np.testing.assert_allclose(moved[0], shapes[i, j], atol=1e-12)
    wanted = random.normal(size=(40, 2)) * 3.0
    moved = tabulated_line(shift_x, shift_z, shapes, wanted)
    np.testing.assert_allclose(moved[:, -1], fairlead + wanted, atol=1e-12)
    np.testing.assert_allclose(moved[:, 0], np.broadcast_to(anchor, (40, 2)), atol=1e-12)


def test_surface_is_that_of_linear_theory() -> None:
    """Random components: Re sum a (e^{ikx} + R e^{-ikx}) e^{-iwt} before x = 0, Re sum a T e^{ikx} e^{-iwt} behind."""
    random = np.random.default_rng(7)
    duration, count = 400.0, 8
    omega = 2.0 * np.pi / duration * random.choice(np.arange(40, 160), count, replace=False)
    amplitude = random.normal(size=count) + 1j * random.normal(size=count)
    grid = np.linspace(0.2, 4.0, 4000)
    k = grid**2 / 9.81
    reflection = 0.5 * np.exp(1j * 0.7 * grid) * grid / 4.0
    transmission = 0.8 * np.exp(-1j * 0.3 * grid)
    time = np.arange(0.0, duration, 0.05)
    record = (np.exp(-1j * np.outer(time, omega)) @ amplitude).real
    x = np.array([-60.0, -25.0, 0.0, 31.0])
    moments = random.uniform(100.0, 300.0, 60)
    found = travelling_surface(
        time, record, x, moments, omega=grid, wave_number=k, reflection=reflection, transmission=transmission
    )
    numbers = omega**2 / 9.81
    r = 0.5 * np.exp(1j * 0.7 * omega) * omega / 4.0
    t = 0.8 * np.exp(-1j * 0.3 * omega)
    expected = np.empty_like(found)
    for column, place in enumerate(x):
        wave = np.exp(1j * numbers * place)
        there = wave + r * np.exp(-1j * numbers * place) if place < 0.0 else t * wave
        expected[:, column] = (np.exp(-1j * np.outer(moments, omega)) @ (amplitude * there)).real
    # the record is closed to a ring by a joint, whose leakage is the error in the middle
    assert np.abs(found - expected).max() < 0.03 * np.abs(expected).max()
