"""Records and files as strangers bring them: each of these was once read wrongly, silently, or with a bad message."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from moyai.core.errors import CaseError, InputError
from moyai.core.results import Result
from moyai.records.calibration import Parameter, calibrate
from moyai.records.survey.case.build import load_survey
from moyai.records.survey.irregular_reflection import separate_irregular
from moyai.records.survey.motions import fit_decay_record, response_function
from moyai.records.survey.run import run_survey
from moyai.records.survey.tensions import wave_maxima
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.series.spectra import WelchOptions, spectrum_of

TIME = np.arange(0.0, 1200.0, 0.5)
LEVEL = np.sin(2 * math.pi * TIME / 7.0) + 0.3 * np.sin(2 * math.pi * TIME / 5.3)

SURVEY = """moyai: 1
site: {{water_depth: 12 m, density: 1025, gravity: 9.81}}
loggers:
  - name: g
    file: {file}
    {keys}
    time: {time}
    channels: [{{name: level, column: level, kind: elevation{channel}}}]
blocks: {{length: {block}}}
waves: {{channels: [level]}}
spectrum: {{segment: {segment}, lowest: 0.05, highest: 0.5}}
"""


def survey_of(folder: Path, name: str, content: str | bytes, **keys: str) -> Result:
    """Write a file and a survey of it, and work it off."""
    usual = {"keys": "", "time": "{column: time}", "channel": "", "block": "20 min", "segment": "100 s"}
    file = folder / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
    plan = folder / "plan.yaml"
    plan.write_text(SURVEY.format(file=name, **{**usual, **keys}), encoding="utf-8")
    return run_survey(load_survey(plan))


def table(heading: str = "time,level [m]", mark: str = ",", comma: bool = False) -> str:
    rows = [heading]
    for t, e in zip(TIME, LEVEL):
        cells = [f"{t:.2f}", f"{e:.4f}"]
        rows.append(mark.join(cell.replace(".", ",") if comma else cell for cell in cells))
    return "\n".join(rows) + "\n"


def reported(error: pytest.ExceptionInfo[InputError]) -> str:
    fault = error.value.fault
    return f"{fault.path} {fault.message} {fault.remedy}"


@pytest.mark.parametrize("ending", ["nc", "mat", "parquet"])
@pytest.mark.parametrize("content", [b"", b"time,level\n0,1\n"])
def test_what_is_no_such_file_is_reported_by_its_name(tmp_path: Path, ending: str, content: bytes) -> None:
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    with pytest.raises(InputError) as error:
        survey_of(tmp_path, f"record.{ending}", content, channel=", unit: m")
    assert f"record.{ending} cannot be read as" in reported(error) and "engine" not in reported(error)


def test_a_mat_file_is_opened_before_its_units_are_asked_for(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read as a MATLAB file"):
        survey_of(tmp_path, "record.mat", b"no such thing at all")


def test_headings_between_spaces_keep_their_units(tmp_path: Path) -> None:
    result = survey_of(tmp_path, "one.txt", table("time [s]  level [cm]", "  "), keys="format: csv")
    assert result.tree["waves"]["maximum_height"].values[0, 0] < 0.03  # centimetres
    alone = "level [m]\n" + "\n".join(f"{value:.3f}" for value in LEVEL)
    result = survey_of(tmp_path, "alone.csv", alone, time="{rate: 2 Hz}")
    assert result.tree["waves"]["count"].values[0, 0] > 100


def test_decimal_commas_are_not_taken_for_delimiters(tmp_path: Path) -> None:
    rows = ["time;level [m];T;p"]
    rows += [f"{t:.2f};{e:.3f};15.2;1013.2".replace(".", ",") for t, e in zip(TIME, LEVEL)]
    with pytest.raises(InputError) as error:
        survey_of(tmp_path, "comma.csv", "\n".join(rows))
    assert "line 2" in reported(error) and "decimal" in reported(error)
    result = survey_of(tmp_path, "comma.csv", "\n".join(rows), keys="decimal: ','")
    assert result.tree["waves"]["count"].values[0, 0] > 100


def test_a_name_in_a_file_without_headings(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="has no column 'level'"):
        survey_of(tmp_path, "bare.csv", table(), keys="header_row: 0")


def test_dates_without_a_format_ask_for_one(tmp_path: Path) -> None:
    rows = ["time,level [m]"] + [f"2024-01-01T00:{i // 60:02d}:{i % 60:02d},{LEVEL[i]:.3f}" for i in range(1000)]
    with pytest.raises(InputError) as error:
        survey_of(tmp_path, "dates.csv", "\n".join(rows))
    assert "line 2" in reported(error) and "time.format" in reported(error)


def test_a_word_that_is_no_format_of_time_is_refused_before_the_files_are_read(tmp_path: Path) -> None:
    with pytest.raises(
        CaseError, match=r"time\.format: 'numbr' is not a known word; allowed: number, iso, or a pattern"
    ):
        survey_of(tmp_path, "dates.csv", "no table at all", time="{column: time, format: numbr}")


def test_an_offset_from_utc_counts_once(tmp_path: Path) -> None:
    rows = ["time,level [m]"] + [f"2024-01-01T09:{i // 60:02d}:{i % 60:02d}+09:00,{LEVEL[i]:.3f}" for i in range(1200)]
    text = "\n".join(rows)
    with pytest.raises(InputError, match="states its own offset"):
        survey_of(tmp_path, "zone.csv", text, time="{column: time, format: iso, utc_offset: 9 h}")
    result = survey_of(tmp_path, "zone.csv", text, time="{column: time, format: iso}")
    assert result.tree["blocks"]["time"].values[0] == 1704067200.0  # 2024-01-01T00:00:00Z
    with pytest.raises(CaseError, match="belongs to stamps"):
        survey_of(tmp_path, "s.csv", table(), time='{column: time, start: "2024-01-01T00:00:00", utc_offset: 9 h}')


def test_stamps_that_know_their_zone_in_parquet(tmp_path: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    import pyarrow.parquet as pq

    stamps = pa.array([1704067200_000 + 500 * i for i in range(TIME.size)], pa.timestamp("ms", "Asia/Tokyo"))
    pq.write_table(pa.table({"time": stamps, "level": LEVEL}), tmp_path / "z.parquet")
    content = (tmp_path / "z.parquet").read_bytes()
    result = survey_of(tmp_path, "z.parquet", content, channel=", unit: m")
    assert result.tree["blocks"]["time"].values[0] == 1704067200.0
    with pytest.raises(InputError, match="has a time zone"):
        survey_of(tmp_path, "z.parquet", content, channel=", unit: m", time="{column: time, utc_offset: 9 h}")


@pytest.mark.parametrize(
    ("units", "expected"),
    [
        ("seconds since 1970-1-1", 0.0),
        ("seconds since 1970-01-01 00:00:00.0", 0.0),
        ("seconds since 1970-01-01 9:30:0 +9:30", 0.0),
        ("seconds since 1970-01-02T00:00:00Z", 86400.0),
        ("seconds since 1970-01-01 00:00 UTC", 0.0),
    ],
)
def test_times_since_any_spelling(tmp_path: Path, units: str, expected: float) -> None:
    import xarray as xr

    file = tmp_path / "cf.nc"
    xr.Dataset({"level": ("time", LEVEL, {"units": "m"})}, {"time": ("time", TIME, {"units": units})}).to_netcdf(
        file, engine="h5netcdf"
    )
    result = survey_of(tmp_path, "cf.nc", file.read_bytes())
    assert result.tree["blocks"]["time"].values[0] == expected


def test_segments_longer_than_the_blocks_are_refused(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="do not fit into blocks"):
        survey_of(tmp_path, "a.csv", table(), block="1 min")


def test_blocks_too_short_for_a_figure_say_so(tmp_path: Path) -> None:
    result = survey_of(tmp_path, "a.csv", "\n".join(table().splitlines()[:3]))
    assert any("holds 2 sound samples: no waves" in notice.message for notice in result.notices)
    result = survey_of(tmp_path, "a.csv", "\n".join(table().splitlines()[:101]))
    assert any("shorter than a segment" in notice.message for notice in result.notices)


def test_unit_slips_can_be_turned_off_and_many_are_reported_together(tmp_path: Path) -> None:
    steps = np.where((TIME // 60).astype(int) % 2 == 1, 100.0, 1.0)
    text = "time,level [m]\n" + "\n".join(f"{t:.1f},{s * e:.4f}" for t, s, e in zip(TIME, steps, LEVEL))
    few = {"block": "1 min", "segment": "30 s"}
    result = survey_of(tmp_path, "a.csv", text, **few, channel=", quality: {unit_slips: false}")
    assert not [notice for notice in result.notices if notice.code.startswith("unit-slip")]
    jump = np.where((TIME >= 300) & (TIME < 420), 100.0, 1.0)
    text = "time,level [m]\n" + "\n".join(f"{t:.1f},{s * e:.4f}" for t, s, e in zip(TIME, jump, LEVEL))
    result = survey_of(tmp_path, "a.csv", text, **few)
    assert [notice.code for notice in result.notices if notice.code.startswith("unit-slip")] == ["unit-slip"]


def test_gauges_of_two_loggers_are_joined(tmp_path: Path) -> None:
    """Directions, currents and reflection of channels of two loggers were left out without a word."""
    random = np.random.default_rng(2)
    time = np.arange(0.0, 1200.0, 0.25)
    f = np.fft.rfftfreq(time.size, 0.25)[1:]
    k = np.asarray(wave_number(2 * math.pi * f, 12.0, 9.81))
    a = np.where((f > 0.06) & (f < 0.3), random.normal(size=f.size) + 1j * random.normal(size=f.size), 0.0)

    def gauge(x: float, at: np.ndarray) -> np.ndarray:
        used = a != 0.0
        wave = a[used] * (np.exp(1j * k[used] * x) + 0.4 * np.exp(1j * k[used] * (60.0 - x)))
        return np.real(np.exp(-2j * math.pi * np.outer(at, f[used])) @ wave) / 20.0

    late = time + 0.11
    rows = ["time,a [m],b [m]"] + [f"{t:.2f},{p:.5f},{q:.5f}" for t, p, q in zip(time, gauge(0, time), gauge(4, time))]
    (tmp_path / "one.csv").write_text("\n".join(rows))
    rows = ["time,c [m],u [m/s]"] + [f"{t:.2f},{p:.5f},0.3" for t, p in zip(late, gauge(9.5, late))]
    (tmp_path / "two.csv").write_text("\n".join(rows))
    (tmp_path / "plan.yaml").write_text(
        """moyai: 1
site: {water_depth: 12 m, density: 1025, gravity: 9.81}
loggers:
  - {name: one, file: one.csv, time: {column: time}, channels: [{name: a, column: a, kind: elevation},
     {name: b, column: b, kind: elevation}]}
  - {name: two, file: two.csv, time: {column: time}, channels: [{name: c, column: c, kind: elevation}]}
blocks: {length: 20 min}
spectrum: {segment: 200 s, lowest: 0.08, highest: 0.25}
reflection: {front: [{channel: a, x: 0}, {channel: b, x: 4}, {channel: c, x: 9.5}]}
"""
    )
    result = run_survey(load_survey(tmp_path / "plan.yaml"))
    assert abs(result.tree["reflection"]["reflection_coefficient"].values[0] - 0.4) < 0.03
    assert any("joined by straight lines" in notice.message for notice in result.notices)


def test_a_wave_whose_tension_has_a_gap_has_no_maximum() -> None:
    time = np.arange(0.0, 100.0, 0.1)
    tension = np.maximum(np.sin(2 * math.pi * time / 10.0), 0.0)
    start = np.arange(0.0, 90.0, 10.0)
    kept = (time < 31.0) | (time > 34.0)  # the pull of the fourth wave is among the missing
    found = wave_maxima(time[kept], tension[kept], start, np.full(start.size, 10.0))
    assert np.flatnonzero(np.isnan(found.maximum)).tolist() == [3]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("window", "overlap", "bands"),
    [
        ("rectangular", 0.5, 5),
        ("cosine_tenth", 0.6, 3),
        pytest.param("hann", 0.9, 2, marks=pytest.mark.slow),
        ("hann", 0.3, 4),
    ],
)
def test_freedom_of_bands_under_overlap(window: str, overlap: float, bands: int) -> None:
    """Bands and overlapping segments share information: their degrees of freedom do not simply multiply."""
    random = np.random.default_rng(9)
    options = WelchOptions(segment=64.0, overlap=overlap, window=window, bands=bands, detrend="mean")  # type: ignore[arg-type]
    runs = [spectrum_of(1.0, random.normal(size=600), options) for _ in range(600)]
    density = np.array([run.density[2:-2] for run in runs])
    measured = 2.0 * density.mean() ** 2 / float(np.mean(density.var(axis=0)))
    assert abs(runs[0].degrees_of_freedom / measured - 1.0) < 0.06


def test_more_bands_than_frequencies_are_refused() -> None:
    with pytest.raises(InputError, match="40 bands of 32 frequencies"):
        spectrum_of(1.0, np.sin(np.arange(200.0)), WelchOptions(segment=64.0, bands=40))


@pytest.mark.slow
@pytest.mark.parametrize(
    "count", [5, pytest.param(8, marks=pytest.mark.slow), pytest.param(25, marks=pytest.mark.slow)]
)
def test_intervals_of_few_observations_hold_the_truth(count: int) -> None:
    """1.96 standard errors of a scatter found from three degrees of freedom held 86 of 100."""
    random = np.random.default_rng(count)
    x = np.linspace(0.5, 3.0, count)
    held = 0
    for _ in range(300):
        y = 4.0 * (1.0 - np.exp(-0.8 * x)) + 0.1 * random.normal(size=count)
        found = calibrate(
            lambda p: p[0] * (1.0 - np.exp(-p[1] * x)),
            y,
            [Parameter("a", 3.0, 0.1, 20.0), Parameter("b", 1.0, 0.05, 5.0)],
        )
        held += int(found.interval[1, 0] <= 0.8 <= found.interval[1, 1])
    assert 0.92 <= held / 300 <= 0.985


def test_bootstrap_of_few_observations_is_widened() -> None:
    """Draws from eight observations scatter too little by the root of 6/8, and their scatter is uncertain itself."""
    random = np.random.default_rng(3)
    x = np.linspace(1.0, 3.0, 8)
    y = 2.0 * x + 0.5 + 0.2 * random.normal(size=8)
    unknown = [Parameter("slope", 1.0, -9.0, 9.0), Parameter("zero", 0.1, -9.0, 9.0)]
    found = calibrate(lambda p: p[0] * x + p[1], y, unknown, bootstrap=60)
    plain = np.quantile(found.samples, (0.025, 0.975), axis=0).T - found.values[:, None]
    assert np.allclose((found.interval - found.values[:, None]) / plain, math.sqrt(8 / 6) * 2.446912 / 1.959964)


@pytest.mark.parametrize("seed", range(5))
def test_a_decay_that_still_swings_at_its_end(seed: int) -> None:
    """The rest is found from the swings: a median of the end, still moving, threw the damping far off."""
    from scipy.integrate import solve_ivp

    random = np.random.default_rng(seed)
    natural, zeta = random.uniform(0.3, 6.0), random.uniform(0.01, 0.08)
    first = random.uniform(0.05, 2.0)
    drag, rest = random.uniform(0.02, 0.3) / first, 0.3 * first * random.normal()

    def rate(_: float, y: np.ndarray) -> list[float]:
        return [y[1], -2 * zeta * natural * y[1] - drag * abs(y[1]) * y[1] - natural**2 * (y[0] - rest)]

    time = np.arange(0.0, 60.0 / natural, 0.05 / natural)
    solved = solve_ivp(rate, (0.0, time[-1]), [first + rest, 0.0], t_eval=time, rtol=1e-8, atol=1e-10 * first)
    found = fit_decay_record(time, solved.y[0] + 1e-4 * first * random.normal(size=time.size))
    assert abs(found.decay.period / (2 * math.pi / natural / math.sqrt(1 - zeta**2)) - 1.0) < 0.004
    assert abs(found.decay.damping_ratio - zeta) < 0.001
    assert abs(found.decay.quadratic_over_inertia - drag) * first < 0.005
    assert abs(found.equilibrium - rest) < 0.001 * first


def test_a_response_blurred_by_short_segments_is_reported() -> None:
    random = np.random.default_rng(8)
    size, step = 72000, 0.2
    f = np.fft.rfftfreq(size, step)
    sea = np.where((f > 0.03) & (f < 0.5), np.exp(-0.5 * ((f - 0.15) / 0.07) ** 2), 0.0)
    wave = np.fft.irfft(sea * (random.normal(size=f.size) + 1j * random.normal(size=f.size)), size)
    truth = 1.0 / (1.0 - (f / 0.14) ** 2 - 0.2j * f / 0.14)
    motion = np.fft.irfft(np.conj(truth) * np.fft.rfft(wave), size)
    motion = motion + 0.3 * motion.std() * random.normal(size=size)
    for segment, blurred in ((50.0, True), (800.0, False)):
        found = response_function(step, wave, motion, WelchOptions(segment=segment), lowest=0.08, highest=0.25)
        assert any(notice.code == "response-resolution" for notice in found.notices) is blurred
        error = (found.modulus - np.interp(found.frequency, f, np.abs(truth))) / found.error
        assert bool(np.nanstd(error) > 2.0) is blurred


def test_gauges_too_far_apart_for_their_segments_are_reported() -> None:
    random = np.random.default_rng(4)
    size, step, water = 8192, 0.5, Water(15.0, 1025.0, 9.81)
    f = np.fft.rfftfreq(size, step)[1:]
    k = np.asarray(wave_number(2 * math.pi * f, 15.0, 9.81))
    a = np.where((f > 0.1) & (f < 0.45), np.exp(-(((f - 0.2) / 0.06) ** 2) / 2), 0.0)
    a = a * (random.normal(size=f.size) + 1j * random.normal(size=f.size))
    x = np.array([0.0, 17.5, 35.0])
    gauges = np.stack(
        [
            np.fft.irfft(
                np.r_[0.0, np.conj(a * (np.exp(1j * k * place) + 0.15 * np.exp(1j * k * (74.0 - place))))], size
            )
            for place in x
        ],
        axis=1,
    )
    for segment, far in ((128.0, True), (1024.0, False)):
        found = separate_irregular(step, gauges, x, water, WelchOptions(segment=segment), lowest=0.12, highest=0.4)
        assert any(notice.code == "gauge-delay" for notice in found.notices) is far
        assert bool(abs(found.reflection - 0.15) > 0.03) is far


def test_records_of_a_comparison_as_others_write_them(tmp_path: Path) -> None:
    """Remarks next to the numbers, and decimal commas."""
    from moyai.records.comparison.run import Pairing, compare_result

    result = survey_of(tmp_path, "a.csv", table(), block="2 min")
    start = result.tree["blocks"]["time"].values
    height = result.tree["waves"]["third_height"].values[:, 0]
    rows = ["start [s];third_height [m];remark"]
    rows += [f"{t:.1f};{1.1 * h:.4f};calm".replace(".", ",") for t, h in zip(start, height)]
    file = tmp_path / "other.csv"
    file.write_text("\n".join(rows))
    for pairs in ((), (Pairing("third_height", "third_height"),)):
        found = compare_result(result, file, pairs, decimal=",")
        group = found.tree[next(iter(found.tree.children))]
        figures = dict(zip(map(str, group["figure"].values), group["agreement"].values))
        assert abs(figures["slope through the origin, model over record"] - 1 / 1.1) < 1e-3
        assert abs(figures["mean of (model - record)/model (Tabata et al.)"] + 0.1) < 1e-3
    with pytest.raises(InputError, match="no column 'heights'"):
        compare_result(result, file, (Pairing("third_height", "heights"),), decimal=",")


def test_a_decay_with_rounded_stamps_is_even_and_one_with_a_gap_is_not() -> None:
    time = np.arange(0.0, 40.0, 1 / 30)
    motion = np.exp(-0.05 * time) * np.cos(2.0 * time)
    found = fit_decay_record(np.round(time, 2), motion, quadratic=False)
    assert abs(found.decay.damping_ratio - 0.025) < 1e-3
    kept = (time < 10.0) | (time > 10.2)
    with pytest.raises(InputError, match=r"0\.\d+ s after 9\.9\d+ s"):
        fit_decay_record(time[kept], motion[kept])


def test_no_reflection_has_an_error_all_the_same() -> None:
    """A reflection below the noise was stated as 0.000 with an error of 0.000."""
    random = np.random.default_rng(5)
    size, step = 8192, 0.5
    f = np.fft.rfftfreq(size, step)[1:]
    k = np.asarray(wave_number(2 * math.pi * f, 15.0, 9.81))
    a = np.where((f > 0.15) & (f < 0.3), random.normal(size=f.size) + 1j * random.normal(size=f.size), 0.0)
    waves = [np.fft.irfft(np.r_[0.0, np.conj(a * np.exp(1j * k * x))], size) for x in (0.0, 3.0, 7.0)]
    gauges = np.stack(waves, axis=1)
    gauges = gauges / gauges.std() + 0.3 * random.normal(size=gauges.shape)
    water = Water(15.0, 1025.0, 9.81)
    found = separate_irregular(
        step, gauges, [0.0, 3.0, 7.0], water, WelchOptions(segment=128.0), lowest=0.12, highest=0.35
    )
    assert 0.01 < found.reflection_error < 0.2
    assert found.reflection < 3.0 * found.reflection_error


def test_a_model_that_misses_by_more_than_the_stated_errors_says_so() -> None:
    random = np.random.default_rng(6)
    x = np.linspace(1.0, 3.0, 12)
    unknown = [Parameter("slope", 1.0, -9.0, 9.0)]
    for noise, missed in ((0.02, False), (0.2, True)):
        found = calibrate(lambda p: p[0] * x, 2.0 * x + noise * random.normal(size=12), unknown, error=0.02)
        assert any(notice.code == "misfit" for notice in found.notices) is missed


def test_a_comparison_of_dates_is_drawn_since_its_start(tmp_path: Path) -> None:
    from moyai.records.comparison.report.page import compose
    from moyai.records.comparison.run import compare_result
    from moyai.report.document import Figure

    stamped = '{column: time, start: "2024-01-01T00:00:00"}'
    result = survey_of(tmp_path, "a.csv", table(), block="2 min", time=stamped)
    start, height = result.tree["blocks"]["time"].values, result.tree["waves"]["third_height"].values[:, 0]
    rows = ["start [s],third_height [m]"] + [f"{t:.1f},{h:.4f}" for t, h in zip(start, height)]
    (tmp_path / "b.csv").write_text("\n".join(rows))
    page = compose(compare_result(result, tmp_path / "b.csv"))
    figure = next(block for section in page.sections for block in section.blocks if isinstance(block, Figure))
    assert figure.abscissae[0].label == "time since 2024-01-01 00:00:00.000Z"
    assert figure.series[0].x["x"][0] == 0.0


def test_a_pair_whose_names_hold_the_sign_is_read_by_the_variable(tmp_path: Path) -> None:
    import xarray as xr

    from moyai.core.results import Result
    from moyai.records.comparison.run import Pairing, pairing_of

    series = xr.Dataset({"sway": ("time", np.zeros(3))}, coords={"time": np.arange(3.0)})
    result = Result(xr.DataTree.from_dict({"/": xr.Dataset(), "/SWL/time/H=2, T=6": series}))
    assert pairing_of("sway=H=2 [m]", result) == Pairing("sway", "H=2 [m]")
    assert pairing_of("/SWL/time/H=2, T=6/sway = a=b", result) == Pairing("/SWL/time/H=2, T=6/sway", "a=b")
    with pytest.raises(InputError, match="no '='"):
        pairing_of("sway", result)
    with pytest.raises(InputError, match="no variable 'heave'"):
        pairing_of("heave=a=b", result)
